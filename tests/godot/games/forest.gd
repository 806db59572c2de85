extends Game
## A flight through a forest with levels of detail: near trees, far trees and clumps of trees replace each other by visibility ranges in all
## three fade modes; grass is a MultiMesh, and rocks have reduced meshes.

const CLUMPS := 48
const TREES_OF_CLUMP := 6
const NEAR_M := 14.0  # beyond, trees are drawn as cones
const FAR_M := 34.0  # beyond, clumps are drawn as one mesh
const GRASS := 400

const FADES: Array[GeometryInstance3D.VisibilityRangeFadeMode] = [
	GeometryInstance3D.VISIBILITY_RANGE_FADE_DISABLED,
	GeometryInstance3D.VISIBILITY_RANGE_FADE_SELF,
	GeometryInstance3D.VISIBILITY_RANGE_FADE_DEPENDENCIES,
]

var _offsets: Array[Vector3] = []  # of a clump's trees
var _random := RandomNumberGenerator.new()
var _bark := make_material(Color(0.45, 0.33, 0.25))
var _needles := make_material(Color(0.25, 0.45, 0.25))
var _crown := make_cylinder(1.0, 0.0, 2.6, 12)
var _cone := make_cylinder(0.9, 0.0, 3.2, 5)
var _trunk := make_cylinder(0.2, 0.14, 1.4, 8)


func _ready() -> void:
	most_other_px = 220  # grass, and tips of far trees inside of near ones that fade: the bias of Godot's shadow lights them
	_random.seed = 29
	add_environment(Color(0.6, 0.7, 0.8), Color(0.4, 0.45, 0.5))
	main_light = add_sun(Vector3(-50, 30, 0), 1.0, 1.1)
	(main_light as DirectionalLight3D).directional_shadow_max_distance = 60.0
	add_floor(Vector2(140, 140), make_material(Color(0.45, 0.42, 0.3)))
	for index in TREES_OF_CLUMP:
		_offsets.append(Vector3(2.6, 0, 0).rotated(Vector3.UP, TAU * (index + _random.randf_range(-0.2, 0.2)) / TREES_OF_CLUMP))
	for clump in CLUMPS:
		@warning_ignore("integer_division")
		_add_clump(Vector3((clump % 6 - 2.5) * 9.0, 0, -(clump / 6) * 9.0), FADES[clump % 3])
	_add_grass()
	_add_rocks()
	add_camera(Vector3.ZERO, Vector3.FORWARD)
	camera.far = 120.0


## Adds trees around a point. Far away, one mesh replaces them: their visibility parent.
func _add_clump(centre: Vector3, fade: GeometryInstance3D.VisibilityRangeFadeMode) -> void:
	var far := _add_ranged(_make_clump_mesh(), centre, _needles, FAR_M, fade)
	for offset in _offsets:
		var at := centre + offset
		var middle := _add_ranged(_cone, at + Vector3(0, 2.1, 0), _needles, NEAR_M, fade)
		middle.visibility_parent = middle.get_path_to(far)
		for part: Array in [[_trunk, 0.7, _bark], [_crown, 2.4, _needles]]:
			var near := _add_ranged(part[0], at + Vector3(0, part[1], 0), part[2], 0.0, fade)
			near.visibility_parent = near.get_path_to(middle)


func _add_ranged(mesh: Mesh, at: Vector3, material: Material, begin: float, fade: GeometryInstance3D.VisibilityRangeFadeMode) -> MeshInstance3D:
	var node := add_mesh(mesh, at, material)
	node.visibility_range_begin = begin
	node.visibility_range_begin_margin = 3.0 if begin > 0.0 else 0.0
	node.visibility_range_fade_mode = fade
	return node


## Merged cones at the places of a clump's trees.
func _make_clump_mesh() -> ArrayMesh:
	var tool := SurfaceTool.new()
	for offset in _offsets:
		tool.append_from(_cone, 0, Transform3D(Basis.IDENTITY, offset + Vector3(0, 2.1, 0)))
	return tool.commit()


func _add_grass() -> void:
	var blade := make_crossed_quads(Vector2(0.25, 0.5), 2, false)
	var green := make_material(Color(0.4, 0.55, 0.25))
	green.cull_mode = BaseMaterial3D.CULL_DISABLED
	var transforms: Array[Transform3D] = []
	for index in GRASS:
		var at := Vector3(_random.randf_range(-5, 5), 0.24, _random.randf_range(-40, 4))
		transforms.append(Transform3D(Basis(Vector3.UP, _random.randf_range(0, PI)), at))
	add_instances(blade, transforms, green)


## Rocks whose meshes have levels of detail, as imported ones have.
func _add_rocks() -> void:
	var source := make_sphere(0.9, 32)
	var importer := ImporterMesh.new()
	importer.add_surface(Mesh.PRIMITIVE_TRIANGLES, source.surface_get_arrays(0))
	importer.generate_lods(25, 60, [])
	var rock := importer.get_mesh()
	var grey := make_material(Color(0.55, 0.55, 0.52))
	for index in 16:
		var node := add_mesh(rock, Vector3(3.0 if index % 2 == 0 else -3.0, 0.3, 2.0 - 4.0 * index), grey)
		node.scale = Vector3(1, _random.randf_range(0.6, 0.9), 1)
		node.rotation.y = _random.randf_range(0, PI)


func _play(step: int) -> void:
	var way := 24.0 * step / LOOP_FRAMES
	var sway := sin(TAU * step / LOOP_FRAMES)
	camera.look_at_from_position(Vector3(1.2 * sway, 4.0 + 0.5 * sway, 10.0 - way), Vector3(-sway, 0.5, -4.0 - way))
