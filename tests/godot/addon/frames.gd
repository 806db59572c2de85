extends AddonTest
## Changes have their full effect on the mask in the frame in which they are made.


func _check_change(scene: StudyScene, change: Callable, what: String) -> void:
	var before := await read_settled(scene)
	change.call()
	var first := await read(scene)
	var settled := await read_settled(scene)
	check(count_different(before, settled) > 100, what + " changes the mask")
	check(count_different(first, settled) == 0, what + ": the first frame equals the settled one")


func test_a_light_that_moves_is_right_in_that_frame() -> void:
	for light in StudyScene.LIGHTS:
		var scene := add_study(light)
		var move := func() -> void: scene.light.look_at_from_position(Vector3(1.5, 5, 1), StudyScene.LIGHT_TARGET)
		await _check_change(scene, move, "moving a %s light" % light)
		remove(scene)


func test_every_technique_follows_a_light_in_that_frame() -> void:
	# All that the add-on offers but shadow_volume_cpu, which differs from shadow_volume only in who extrudes.
	for technique in ["edge_count", "pcss", "penumbra_fins", "outer_fins", "shadow_map", "views", "jittered_pcf", "shadow_volume"]:
		var scene := add_study("spot")
		scene.shadow.technique = technique
		var move := func() -> void: scene.light.look_at_from_position(Vector3(1.5, 5, 1), StudyScene.LIGHT_TARGET)
		await _check_change(scene, move, technique)
		remove(scene)


func test_a_caster_that_moves_is_right_in_that_frame() -> void:
	var scene := add_study()
	await _check_change(scene, func() -> void: scene.caster.position += Vector3(0.4, 0.2, 0), "moving a caster")


func test_a_camera_that_moves_is_right_in_that_frame() -> void:
	var scene := add_study()
	await _check_change(scene, func() -> void: scene.camera.position += Vector3(0.5, 0, 0), "moving the camera")


func test_a_light_that_grows_is_right_in_that_frame() -> void:
	var scene := add_study()
	await _check_change(scene, func() -> void: scene.light.light_size = 1.0, "a larger light")


func test_another_technique_is_right_in_that_frame() -> void:
	var scene := add_study()
	await _check_change(scene, func() -> void: scene.shadow.technique = "shadow_volume", "another technique")


func test_a_mesh_that_is_replaced_is_right_in_that_frame() -> void:
	var scene := add_study()
	await _check_change(scene, func() -> void: scene.caster.mesh = TorusMesh.new(), "another mesh")


func test_surfaces_of_a_mesh_that_change_are_right_in_that_frame() -> void:
	var scene := add_study()
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, BoxMesh.new().get_mesh_arrays())
	scene.caster.mesh = mesh
	var change := func() -> void:
		mesh.clear_surfaces()
		mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, SphereMesh.new().get_mesh_arrays())
	await _check_change(scene, change, "another surface")


func test_the_size_of_a_primitive_mesh_that_changes_is_followed() -> void:
	var scene := add_study()
	var before := await read_settled(scene)
	scene.caster.mesh.size = Vector3(2, 0.5, 1)
	await get_tree().process_frame  # Godot rebuilds the mesh at the end of a frame
	var after := await read_settled(scene)
	check(count_different(before, after) > 100, "a wider box changes the mask")
