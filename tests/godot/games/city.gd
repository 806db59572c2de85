extends Game
## A city builder: roads and houses, partly as MultiMeshes, houses that are built and demolished, cars, and street lamps in the
## evening. MSAA 4x, SSAO, glow and fog.

const BLOCK_M := 6.0
const BLOCKS := 5  # in each direction

var _houses: Array[Node3D] = []
var _cars: Array[MeshInstance3D] = []
var _box := make_box(Vector3.ONE)
var _roof := PrismMesh.new()
var _walls: Array[StandardMaterial3D] = []
var _tiles := make_material(Color(0.6, 0.25, 0.2))


func _ready() -> void:
	most_other_px = 120  # posts of lamps and gaps between towers
	get_viewport().msaa_3d = Viewport.MSAA_4X
	add_environment(Color(0.55, 0.5, 0.55), Color(0.4, 0.4, 0.5))
	environment.ssao_enabled = true
	environment.glow_enabled = true
	environment.fog_enabled = true
	environment.fog_density = 0.004
	environment.fog_light_color = Color(0.55, 0.5, 0.55)
	environment.tonemap_mode = Environment.TONE_MAPPER_FILMIC
	main_light = add_sun(Vector3(-35, 50, 0), 1.5, 0.7)
	for color: Color in [Color(0.8, 0.75, 0.6), Color(0.6, 0.65, 0.7), Color(0.75, 0.55, 0.5)]:
		_walls.append(make_material(color))
	_add_ground()
	_add_fixed_houses()
	_add_lamps()
	for index in 4:
		_cars.append(add_box(Vector3(1.0, 0.5, 0.5), Vector3.ZERO, make_material(Color.from_hsv(0.2 * index, 0.7, 0.8), 0.3, 0.5)))
	add_camera(Vector3.ZERO, Vector3.FORWARD)


func _add_ground() -> void:
	add_floor(Vector2(80, 80), make_material(Color(0.4, 0.55, 0.35)))
	var roads: Array[Transform3D] = []
	for index in range(-BLOCKS / 2, BLOCKS / 2 + 2):
		var offset := (index - 0.5) * BLOCK_M
		roads.append(Transform3D(Basis.from_scale(Vector3(BLOCKS * BLOCK_M + 12, 0.04, 1.6)), Vector3(0, 0.02, offset)))
		roads.append(Transform3D(Basis.from_scale(Vector3(1.6, 0.05, BLOCKS * BLOCK_M + 12)), Vector3(offset, 0.02, 0)))
	add_instances(_box, roads, make_material(Color(0.35, 0.35, 0.38)))


func _get_plot(index: int) -> Vector3:
	@warning_ignore("integer_division")
	return Vector3(index % BLOCKS - BLOCKS / 2, 0, index / BLOCKS - BLOCKS / 2) * BLOCK_M


## Towers of a MultiMesh on every second plot; the others are for houses that come and go.
func _add_fixed_houses() -> void:
	var random := RandomNumberGenerator.new()
	random.seed = 3
	var towers: Array[Transform3D] = []
	for plot in range(0, BLOCKS * BLOCKS, 2):
		for corner in 4:
			var offset := Vector3(1.0 if corner % 2 == 0 else -1.0, 0, 1.0 if corner < 2 else -1.0) * 1.05
			var size := Vector3(1.6, random.randf_range(1.0, 4.5), 1.6)
			towers.append(Transform3D(Basis.from_scale(size), _get_plot(plot) + offset + Vector3(0, size.y / 2, 0)))
	add_instances(_box, towers, _walls[1])


## Builds a house with a roof and a chimney.
func _build_house(plot: int) -> void:
	var house := Node3D.new()
	house.position = _get_plot(plot)
	add_child(house)
	var walls := add_mesh(_box, Vector3(0, 0.9, 0), _walls[plot % 3], house)
	walls.scale = Vector3(3, 1.8, 2.4)
	var roof := add_mesh(_roof, Vector3(0, 2.3, 0), _tiles, house)
	roof.scale = Vector3(3.4, 1.0, 2.8)
	var chimney := add_mesh(_box, Vector3(0.8, 2.5, 0.4), _walls[2], house)
	chimney.scale = Vector3(0.3, 1.2, 0.3)
	_houses.append(house)


func _demolish_house() -> void:
	var house: Node3D = _houses.pop_front()
	house.queue_free()


## Lamps at crossings: spots that shine down, and globes with an omni light inside.
func _add_lamps() -> void:
	var metal := make_material(Color(0.3, 0.3, 0.32), 0.5, 0.6)
	var glass := make_material(Color(1, 0.95, 0.8))
	glass.emission_enabled = true
	glass.emission = Color(1, 0.9, 0.6)
	glass.emission_energy_multiplier = 1.5
	for index in 5:
		var at := Vector3(index % 3 - 1.5, 0, (index + 1) % 2 - 0.5) * BLOCK_M + Vector3(1.1, 0, 1.1)
		add_mesh(make_cylinder(0.07, 0.05, 2.4), at + Vector3(0, 1.2, 0), metal)
		if index < 3:
			var spot := SpotLight3D.new()
			spot.spot_range = 7.0
			spot.spot_angle = 55.0
			spot.light_energy = 5.0
			spot.light_size = 0.1
			spot.light_color = Color(1, 0.85, 0.6)
			spot.position = at + Vector3(-0.5, 2.4, -0.5)
			spot.rotation_degrees.x = -90
			add_light(spot, self)
			var arm := add_mesh(_box, at + Vector3(-0.25, 2.45, -0.25), metal)
			arm.rotation.y = -PI / 4
			arm.scale = Vector3(0.9, 0.06, 0.12)
		else:
			var omni := OmniLight3D.new()
			omni.omni_range = 6.0
			omni.light_energy = 3.0
			omni.light_size = 0.15
			omni.light_color = Color(1, 0.9, 0.7)
			omni.position = at + Vector3(0, 2.6, 0)
			add_light(omni, self)
			# Godot's shadow culls the faces of a closed globe that are seen from inside; it casts none.
			add_mesh(make_sphere(0.25), omni.position, glass)


func _play(step: int) -> void:
	if step == 0:
		while not _houses.is_empty():
			_demolish_house()
	elif step % 8 == 1 and step < 90:
		@warning_ignore("integer_division")
		_build_house(1 + step / 8 * 2)
	elif step % 16 == 4:
		_demolish_house()
	for index in _cars.size():
		var way := fposmod(30.0 * step / LOOP_FRAMES + 9.0 * index, 30.0) - 15.0
		var lane := (index - 1.5) * BLOCK_M
		_cars[index].position = Vector3(way, 0.33, lane + 0.4) if index % 2 == 0 else Vector3(lane + 0.4, 0.33, way)
		_cars[index].rotation.y = 0.0 if index % 2 == 0 else PI / 2
	var angle := TAU * step / LOOP_FRAMES
	camera.look_at_from_position(Vector3(3 * sin(angle), 13, 15 + 2 * cos(angle)), Vector3(0, 0, 1.0))
