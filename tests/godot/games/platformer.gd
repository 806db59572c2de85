extends Game
## A platformer: a level of tiles, spinning coins, a moving platform, and a character that runs and jumps. MSAA 4x.

const TILE_M := 2.0
const LENGTH := 16  # tiles
const GAP := [5, 6, 11]  # columns without ground
const SPEED_M_S := 7.0
const JUMP_M_S := 8.5
const GRAVITY := 22.0

enum Tile { GRASS, BRICK, SLAB, FLOWERS, CONE, LOG }

var _character: CharacterBody3D
var _platform: AnimatableBody3D
var _coins: Array[MeshInstance3D] = []


func _ready() -> void:
	get_viewport().msaa_3d = Viewport.MSAA_4X
	add_environment(Color(0.45, 0.65, 0.9), Color(0.4, 0.45, 0.55))
	main_light = add_sun(Vector3(-52, -40, 0), 1.0, 1.2)
	_add_level()
	_add_coins()
	_add_platform()
	_add_character()
	add_camera(Vector3.ZERO, Vector3.FORWARD)
	_restart()


func _make_library() -> MeshLibrary:
	var library := MeshLibrary.new()
	var grass := make_material(Color(1, 1, 1))
	grass.albedo_texture = make_checker(Color(0.35, 0.7, 0.25), Color(0.3, 0.62, 0.22))
	grass.texture_filter = BaseMaterial3D.TEXTURE_FILTER_NEAREST_WITH_MIPMAPS
	var brick := make_material(Color(1, 1, 1))
	brick.albedo_texture = make_checker(Color(0.75, 0.4, 0.3), Color(0.65, 0.33, 0.25))
	_add_tile(library, Tile.GRASS, make_box(Vector3.ONE * TILE_M), grass, true)
	_add_tile(library, Tile.BRICK, make_box(Vector3.ONE * TILE_M), brick, true)
	_add_tile(library, Tile.SLAB, make_box(Vector3(TILE_M, 0.5, TILE_M)), brick, true)
	_add_tile(library, Tile.FLOWERS, make_crossed_quads(Vector2(1.4, 1.2), 2, false), make_material(Color(0.9, 0.4, 0.6)), false)
	library.set_item_mesh_cast_shadow(Tile.FLOWERS, RenderingServer.SHADOW_CASTING_SETTING_OFF)
	_add_tile(library, Tile.CONE, make_cylinder(0.8, 0.0, 1.9), make_material(Color(0.2, 0.5, 0.3)), false)
	_add_tile(library, Tile.LOG, make_cylinder(0.5, 0.5, TILE_M), make_material(Color(0.5, 0.35, 0.2)), true)
	library.set_item_mesh_cast_shadow(Tile.LOG, RenderingServer.SHADOW_CASTING_SETTING_OFF)
	return library


func _add_tile(library: MeshLibrary, tile: Tile, mesh: Mesh, material: Material, is_solid: bool) -> void:
	var surface := ArrayMesh.new()
	surface.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, mesh.surface_get_arrays(0))
	surface.surface_set_material(0, material)
	library.create_item(tile)
	library.set_item_mesh(tile, surface)
	if is_solid:
		library.set_item_shapes(tile, [surface.create_convex_shape(), Transform3D.IDENTITY])


func _add_level() -> void:
	var grid := GridMap.new()
	grid.mesh_library = _make_library()
	grid.cell_size = Vector3.ONE * TILE_M
	add_child(grid)
	for x in range(-6, LENGTH + 6):
		for z in range(-3, 3):
			if x not in GAP:
				grid.set_cell_item(Vector3i(x, -1, z), Tile.GRASS)
			grid.set_cell_item(Vector3i(x, -3, z), Tile.GRASS)
		grid.set_cell_item(Vector3i(x, 0, -3), Tile.BRICK)
		if x % 3 == 0 and x not in GAP:
			grid.set_cell_item(Vector3i(x, 0, -2), [Tile.FLOWERS, Tile.CONE, Tile.LOG][absi(x) / 3 % 3])
		if x % 4 == 1:
			grid.set_cell_item(Vector3i(x, 1, -3), Tile.CONE if x % 8 == 1 else Tile.BRICK)
		if x in [3, 8, 9, 13]:
			grid.set_cell_item(Vector3i(x, 2, 0), Tile.SLAB)
		if x % 5 == 2 and x not in GAP:
			grid.set_cell_item(Vector3i(x, 0, 2), Tile.FLOWERS)


func _add_coins() -> void:
	var gold := make_material(Color(1.0, 0.8, 0.2), 0.35, 0.8)
	for x in range(1, LENGTH):
		var coin := add_mesh(make_cylinder(0.45, 0.45, 0.12, 20), Vector3(x * TILE_M + 1.0, 1.6, 1.0), gold)
		coin.rotation_degrees = Vector3(90, 0, 0)
		_coins.append(coin)


func _add_platform() -> void:
	_platform = AnimatableBody3D.new()
	_platform.sync_to_physics = false
	add_child(_platform)
	add_box(Vector3(2.5, 0.4, 2.5), Vector3.ZERO, make_material(Color(0.8, 0.75, 0.4)), _platform)
	_add_shape(_platform, make_box(Vector3(2.5, 0.4, 2.5)).create_convex_shape())


func _add_character() -> void:
	_character = CharacterBody3D.new()
	add_child(_character)
	var capsule := CapsuleMesh.new()
	capsule.radius = 0.4
	capsule.height = 1.6
	add_mesh(capsule, Vector3.ZERO, make_material(Color(0.85, 0.25, 0.2), 0.5), _character)
	add_box(Vector3(0.25, 0.2, 0.5), Vector3(0.35, 0.45, 0), make_material(Color(0.95, 0.95, 0.95)), _character)
	var shape := CapsuleShape3D.new()
	shape.radius = 0.4
	shape.height = 1.6
	_add_shape(_character, shape)


func _add_shape(body: PhysicsBody3D, shape: Shape3D) -> void:
	var node := CollisionShape3D.new()
	node.shape = shape
	body.add_child(node)


func _restart() -> void:
	_character.position = Vector3(1, 1, 1)
	_character.velocity = Vector3.ZERO
	for coin in _coins:
		coin.visible = true


func _physics_process(delta: float) -> void:
	_character.velocity.x = SPEED_M_S
	_character.velocity.y -= GRAVITY * delta
	var column := int(floor((_character.position.x + 0.6) / TILE_M))
	if _character.is_on_floor() and (column in GAP or column % 4 == 1):
		_character.velocity.y = JUMP_M_S
	_character.move_and_slide()


func _play(step: int) -> void:
	if step == 0:
		_restart()
	var angle := TAU * step / LOOP_FRAMES
	_platform.position = Vector3(12, 0.8 + 0.8 * sin(2 * angle), 1 + 0.5 * cos(angle))
	for coin in _coins:
		coin.rotation.y = 4 * angle + 0.3 * coin.position.x
		if coin.position.distance_to(_character.position) < 0.9:
			coin.visible = false
	camera.look_at_from_position(_character.position + Vector3(1.5, 3.2, 6.8), _character.position + Vector3(1.5, 0.3, -1))
