extends AddonTest
## Decals, fog, global illumination, and physics interpolation around lights with masks.

const SIZE := Vector2i(160, 120)
const ROUNDING := 0.004 # rounding error of half floats with values of 1 and more, as in lights.gd


func _draw(viewport: SubViewport, frames := 4) -> PackedFloat32Array:
	await draw_frames(frames)
	var image := viewport.get_texture().get_image()
	image.convert(Image.FORMAT_RGBF)
	return image.get_data().to_float32_array()


## Returns the fraction of pixels that differ by more than the tolerance.
static func _compare(left: PackedFloat32Array, right: PackedFloat32Array, tolerance: float) -> float:
	var count := 0
	for pixel in range(0, left.size(), 3):
		var differs := false
		for channel in range(pixel, pixel + 3):
			differs = differs or absf(left[channel] - right[channel]) > tolerance
		count += int(differs)
	return 3.0 * count / left.size()


func _add_linear(scene: StudyScene) -> SubViewport:
	var viewport := SubViewport.new()
	viewport.size = SIZE
	viewport.own_world_3d = true
	viewport.use_hdr_2d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	viewport.add_child(scene)
	add_child(viewport)
	return viewport


func _get_environment(scene: StudyScene) -> Environment:
	return (scene.find_children("*", "WorldEnvironment", true, false)[0] as WorldEnvironment).environment


## Draws with Godot's shadow only, and with the add-on's. The light's shadow is enabled in both.
func _draw_both(scene: StudyScene, frames := 4) -> Array[PackedFloat32Array]:
	scene.light.shadow_enabled = true
	var viewport := _add_linear(scene)
	scene.shadow.visible = false
	var godot := await _draw(viewport, frames)
	scene.shadow.visible = true
	var ours := await _draw(viewport, frames)
	return [godot, ours]


func test_decals_and_depth_fog_are_on_lit_surfaces() -> void:
	var scene := StudyScene.create("omni", "box")
	scene.caster.visible = false # all masks are 1
	var decal := Decal.new()
	decal.size = Vector3(3, 3, 3)
	var pattern := Image.create_from_data(2, 2, false, Image.FORMAT_RGBA8, PackedByteArray([255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 0, 255]))
	decal.texture_albedo = ImageTexture.create_from_image(pattern)
	decal.texture_normal = ImageTexture.create_from_image(pattern)
	scene.add_child(decal)
	_get_environment(scene).fog_enabled = true
	_get_environment(scene).fog_density = 0.05
	var images := await _draw_both(scene)
	check(_compare(images[0], images[1], ROUNDING) < 0.005, "%f of the image differ" % _compare(images[0], images[1], ROUNDING))
	decal.visible = false
	check(_compare(images[1], await _draw(scene.get_viewport()), 0.05) > 0.05, "the decal is there")
	_get_environment(scene).fog_enabled = false
	decal.visible = true
	check(_compare(images[1], await _draw(scene.get_viewport()), 0.02) > 0.1, "the fog is there")
	scene.get_viewport().free()


func test_volumetric_fog_has_the_shadow_of_godot() -> void:
	var scene := StudyScene.create("spot", "box")
	scene.get_node("Ground").visible = false # fog alone
	scene.caster.scale = Vector3(2, 0.1, 2)
	scene.light.light_volumetric_fog_energy = 16.0
	var environment := _get_environment(scene)
	environment.volumetric_fog_enabled = true
	environment.volumetric_fog_density = 0.1
	environment.volumetric_fog_temporal_reprojection_enabled = false
	var images := await _draw_both(scene, 6)
	check(_compare(images[0], images[1], 0.01) < 0.02, "%f of the image differ" % _compare(images[0], images[1], 0.01))
	scene.shadow.visible = false
	scene.light.shadow_enabled = false
	var lit := await _draw(scene.get_viewport(), 6)
	check(_compare(images[1], lit, 0.01) > 0.02, "the fog has a shadow: %f" % _compare(images[1], lit, 0.01))
	scene.get_viewport().free()


func test_reflection_probes_see_the_shadow_of_godot() -> void:
	var scene := StudyScene.create("omni", "box")
	var probe := ReflectionProbe.new()
	probe.size = Vector3(20, 8, 20)
	probe.update_mode = ReflectionProbe.UPDATE_ALWAYS
	probe.enable_shadows = true
	probe.position = Vector3(0, 1, 0)
	scene.add_child(probe)
	var images := await _draw_both(scene, 16)
	# The shadows differ along their edges, and the images with them.
	check(_compare(images[0], images[1], 0.05) < 0.05, "%f of the image differ" % _compare(images[0], images[1], 0.05))
	scene.get_viewport().free()


func test_global_illumination_has_the_shadow_of_godot() -> void:
	var scene := StudyScene.create("directional", "box")
	var environment := _get_environment(scene)
	environment.sdfgi_enabled = true
	environment.sdfgi_min_cell_size = 0.2
	var images := await _draw_both(scene, 30)
	check(_compare(images[0], images[1], 0.05) < 0.05, "%f of the image differ" % _compare(images[0], images[1], 0.05))
	scene.get_viewport().free()


func test_a_mask_is_made_where_a_surface_reads_it() -> void:
	var scene := add_study("spot")
	await draw_frames(3)
	check(scene.shadow.makes_mask(), "the ground reads it")
	var unshaded := StandardMaterial3D.new()
	unshaded.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	for node in ["Ground", "Caster"]:
		scene.get_node(node).material_override = unshaded
	await draw_frames(3)
	check(not scene.shadow.makes_mask(), "no surface is lit")
	var larger := SubViewport.new() # without masks no textures of its size are allocated; nothing may be logged
	larger.size = Vector2i(640, 480)
	larger.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	larger.add_child(scene.camera.duplicate())
	add_child(larger)
	await draw_frames(2)
	larger.free()
	scene.shadow.show_mask = true
	await draw_frames(2)
	check(scene.shadow.makes_mask(), "it is shown")
	scene.shadow.show_mask = false
	scene.get_node("Ground").material_override = null
	await draw_frames(2)
	check(scene.shadow.makes_mask(), "the ground is lit again")
	scene.light.light_cull_mask = 2
	await draw_frames(2)
	check(not scene.shadow.makes_mask(), "the light shines on other layers")
	scene.light.light_cull_mask = 1
	scene.light.spot_range = 1.0
	await draw_frames(2)
	check(not scene.shadow.makes_mask(), "the ground is out of its reach")
	remove(scene)


## A hidden GnomonShadow3D changes nothing: materials keep Godot's own shader until a mask is read. The add-on's light() would
## treat a light without a row in its table as a point.
func test_a_hidden_node_leaves_materials_as_they_were() -> void:
	var scene := StudyScene.create("omni", "box")
	scene.get_node("Ground").material_override = StandardMaterial3D.new()
	scene.light.light_size = 2.0
	scene.light.position = Vector3(-3, 0.6, 0) # grazes the ground
	var shadow := scene.shadow
	scene.light.remove_child(shadow)
	var viewport := _add_linear(scene)
	var original := await _draw(viewport)
	scene.light.add_child(shadow)
	check(_compare(original, await _draw(viewport), 0.02) > 0.01, "the shadow is there")
	shadow.visible = false
	check(_compare(original, await _draw(viewport), 0.0) == 0.0, "the image is the same bit for bit")
	shadow.visible = true
	check(_compare(original, await _draw(viewport, 2), 0.02) > 0.01, "the shadow is back")
	viewport.free()


## Between two physics ticks Godot draws nodes at interpolated positions.
func test_physics_interpolation_moves_masks_too() -> void:
	var ticks := Engine.physics_ticks_per_second
	Engine.physics_ticks_per_second = 4
	get_tree().physics_interpolation = true
	var scene := add_study("omni")
	var nodes: Array[Node3D] = [scene.caster, scene.light]
	await draw_frames(3)
	var drawn: Array[Transform3D] = []
	var found: Image
	for attempt in 60: # until a frame is drawn between two ticks
		await get_tree().physics_frame
		var side := 1.0 if attempt % 2 == 0 else -1.0
		scene.caster.position.x = 0.7 * side
		scene.light.position.x = -1.5 - 0.5 * side
		drawn = []
		RenderingServer.frame_pre_draw.connect(func() -> void:
			for node in nodes:
				drawn.append(node.get_global_transform_interpolated()), CONNECT_ONE_SHOT)
		found = await read(scene)
		if absf(drawn[0].origin.x) < 0.5:
			break
	get_tree().physics_interpolation = false
	Engine.physics_ticks_per_second = ticks
	check(absf(drawn[0].origin.x) < 0.5, "a frame between two ticks was drawn")
	for index in 2:
		nodes[index].global_transform = drawn[index]
	check(count_different(found, await read_settled(scene), 0.01) < 20, "%d pixels differ" % count_different(found, await read(scene), 0.01))
	remove(scene)
