extends Node
## Draws frames in which scenes, lights, casters and figures come and go, techniques change and the window is resized. First
## argument: number of frames. Prints Godot's resource counts every 100 frames.

const TECHNIQUES: Array[String] = [
	"edge_count", "pcss", "penumbra_fins", "outer_fins", "shadow_map", "views", "jittered_pcf", "shadow_volume",
]

var _scene: StudyScene
var _random := RandomNumberGenerator.new()


func _ready() -> void:
	_random.seed = 7
	_add_permanent_world()
	for frame in int(OS.get_cmdline_user_args()[0]):
		# Each 100 frames make the same changes, so that the counts can be compared.
		await _change(frame % 100)
		await RenderingServer.frame_post_draw
		if frame % 100 == 99:
			await _report(frame + 1)
	get_tree().quit()


## Adds a light that is never removed, so that the add-on never frees all its caches.
func _add_permanent_world() -> void:
	var viewport := SubViewport.new()
	viewport.own_world_3d = true
	viewport.size = Vector2i(64, 64)
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	add_child(viewport)
	viewport.add_child(StudyScene.create("directional", "box"))


func _change(step: int) -> void:
	if step % 20 == 0:
		if _scene != null:
			remove_child(_scene)
			_scene.queue_free()
		_scene = StudyScene.create(StudyScene.LIGHTS[(step / 20) % 3], StudyScene.CASTERS[(step / 20) % 4])
		add_child(_scene)
		_add_figure()
	if step % 5 == 0:
		_scene.shadow.technique = TECHNIQUES[(step / 5) % TECHNIQUES.size()]
		_scene.shadow.show_mask = step % 2 == 0
	if step % 7 == 0:
		var mesh := TorusMesh.new()
		mesh.rings = 16
		_scene.add_mesh("Torus", mesh, Transform3D(Basis(), Vector3(_random.randf_range(-1, 1), 1, _random.randf_range(-1, 1))))
	if step % 9 == 0:
		_scene.add_light("spot" if step % 2 == 0 else "omni")
	if step % 25 == 0:
		get_window().size = Vector2i(96 + 32 * ((step / 25) % 3), 96)
	if step % 30 == 10:
		var viewport := SubViewport.new()
		viewport.size = Vector2i(48, 64)
		viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
		var camera := Camera3D.new()
		camera.position = Vector3(0, 2, 6)
		viewport.add_child(camera)
		_scene.add_child(viewport)
	_scene.light.position.x += 0.01
	var skeleton: Skeleton3D = _scene.get_node("Skeleton")
	skeleton.set_bone_pose_rotation(0, Quaternion(Vector3.BACK, 0.05 * (step % 20)))


## Adds a box that a bone rotates.
func _add_figure() -> void:
	var skeleton := Skeleton3D.new()
	skeleton.name = "Skeleton"
	skeleton.add_bone("Bone")
	_scene.add_child(skeleton)
	var arrays := BoxMesh.new().get_mesh_arrays()
	var bones := PackedInt32Array()
	bones.resize(4 * (arrays[Mesh.ARRAY_VERTEX] as PackedVector3Array).size())
	var weights := PackedFloat32Array()
	weights.resize(bones.size())
	for index in range(0, weights.size(), 4):
		weights[index] = 1.0
	arrays[Mesh.ARRAY_BONES] = bones
	arrays[Mesh.ARRAY_WEIGHTS] = weights
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	var node := _scene.add_mesh("Figure", mesh, Transform3D(Basis(), Vector3(1.5, 0.6, 0)))
	node.skin = skeleton.create_skin_from_rest_transforms()
	node.skeleton = node.get_path_to(skeleton)


## Reports while only the permanent world is in the tree, so that any growth is a leak.
func _report(frame: int) -> void:
	remove_child(_scene)
	_scene.queue_free()
	_scene = null
	for settled in 4:
		await RenderingServer.frame_post_draw
	SoakReport.print_line(frame)
