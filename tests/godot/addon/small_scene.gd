class_name SmallScene
extends AddonTest
## Base class of tests that draw a small scene with a floor and a sun in a viewport of their own.

const SIZE := Vector2i(288, 162)
const POINT_TOLERANCE := 0.1 # of the brightness at a point

var _keeper: SubViewport
var _viewport: SubViewport
var _root: Node3D
var _camera: Camera3D
var _sun: DirectionalLight3D


## Keeps the shaders of plain materials from one scene to the next, because compiling them takes seconds. It is not drawn.
func _keep_shaders() -> void:
	var viewport := SubViewport.new()
	viewport.own_world_3d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	var light := OmniLight3D.new()
	light.shadow_enabled = true
	light.add_child(ClassDB.instantiate("GnomonShadow3D"))
	viewport.add_child(light)
	var node := MeshInstance3D.new()
	node.mesh = BoxMesh.new()
	node.material_override = StandardMaterial3D.new()
	viewport.add_child(node)
	add_child(viewport)
	_keeper = viewport


func _begin(has_own_world := true) -> void:
	if _keeper == null:
		_keep_shaders()
	_viewport = SubViewport.new()
	_viewport.size = SIZE
	_viewport.own_world_3d = has_own_world
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	add_child(_viewport)
	_root = Node3D.new()
	_viewport.add_child(_root)
	var world := WorldEnvironment.new()
	world.environment = Environment.new()
	world.environment.background_mode = Environment.BG_COLOR
	world.environment.background_color = Color(0.2, 0.25, 0.3)
	world.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	world.environment.ambient_light_color = Color(0.25, 0.25, 0.3)
	_root.add_child(world)
	_camera = Camera3D.new()
	_root.add_child(_camera)
	_camera.look_at_from_position(Vector3(0, 4, 6), Vector3(0, 0.4, 0))
	_sun = DirectionalLight3D.new()
	_sun.rotation_degrees = Vector3(-50, 35, 0)
	_sun.shadow_enabled = true
	_sun.light_angular_distance = 0.5
	_root.add_child(_sun)
	var plane := PlaneMesh.new()
	plane.size = Vector2(20, 20)
	_add(plane, Vector3.ZERO)


func _add(mesh: Mesh, at: Vector3, material: Material = null) -> MeshInstance3D:
	var node := MeshInstance3D.new()
	node.mesh = mesh
	node.position = at
	node.material_override = StandardMaterial3D.new() if material == null else material
	_root.add_child(node)
	return node


func _add_box(at: Vector3, material: Material = null) -> MeshInstance3D:
	return _add(BoxMesh.new(), at, material)


func _make_shader(code: String) -> ShaderMaterial:
	var material := ShaderMaterial.new()
	material.shader = Shader.new()
	material.shader.code = "shader_type spatial;\n" + code
	return material


## The point of the floor that the sun's ray through a point reaches.
func _floor_below(point: Vector3) -> Vector3:
	var direction := -_sun.global_basis.z
	return point - direction * (point.y / direction.y)


func _take() -> Image:
	await draw_frames(5)
	return _viewport.get_texture().get_image()


func _end() -> void:
	_viewport.free()
	await draw_frames(2)


## Draws with Godot's shadows and with Gnomon's, and compares the images at the points.
func _compare(label: String, points: Array[Vector3]) -> void:
	var godot := await _take()
	var shadows: Array[Node] = []
	for light in _root.find_children("*", "Light3D", true, false):
		shadows.append(ClassDB.instantiate("GnomonShadow3D"))
		light.add_child(shadows.back())
	var gnomon := await _take()
	for point in points:
		var pixel := Vector2i(_camera.unproject_position(point))
		var difference := gnomon.get_pixelv(pixel).get_luminance() - godot.get_pixelv(pixel).get_luminance()
		check(absf(difference) < POINT_TOLERANCE, "%s: %+.3f at %s" % [label, difference, point])
	godot.save_png("user://likeness_%s_godot.png" % label.validate_filename().replace(" ", "_"))
	gnomon.save_png("user://likeness_%s_gnomon.png" % label.validate_filename().replace(" ", "_"))
	for shadow in shadows:
		shadow.free()
