extends AddonTest
## Masks in viewports of every kind: several views, scaling, multisampling, compositors, levels of detail, TAA.


## An effect of the user, which counts the frames in which it runs.
class CountingEffect:
	extends CompositorEffect
	var calls := 0

	func _init() -> void:
		effect_callback_type = EFFECT_CALLBACK_TYPE_POST_TRANSPARENT

	func _render_callback(_type: int, _data: RenderData) -> void:
		calls += 1


## Returns size -> mask, for all views of the scene.
func _read_all(scene: StudyScene) -> Dictionary:
	var masks := {}
	await draw_frames(2)
	scene.shadow.read_masks(func(mask: Image, _camera: Transform3D) -> void: masks[mask.get_size()] = mask)
	await draw_frames(2)
	return masks


func _add_viewport(size: Vector2i, scene: StudyScene) -> SubViewport:
	var viewport := SubViewport.new()
	viewport.size = size
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var camera := Camera3D.new()
	viewport.add_child(camera)
	scene.add_child(viewport)
	camera.look_at_from_position(Vector3(3, 4, 5), Vector3.ZERO)
	return viewport


func test_viewports_of_several_sizes_and_cameras_at_once() -> void:
	var scene := add_study()
	var alone := await read_settled(scene)
	_add_viewport(Vector2i(120, 90), scene)
	_add_viewport(Vector2i(64, 128), scene)
	var masks := await _read_all(scene)
	check(masks.size() == 3, "%d views" % masks.size())
	for size: Vector2i in [Vector2i(120, 90), Vector2i(64, 128)]:
		check(masks.has(size) and count_darker(masks[size]) > 50, "a mask of %s" % size)
	check(masks.has(alone.get_size()) and count_different(masks[alone.get_size()], alone) == 0, "the window's mask stays")


func test_a_viewport_with_a_world_of_its_own_has_its_own_lights() -> void:
	var viewport := SubViewport.new()
	viewport.own_world_3d = true
	viewport.size = Vector2i(100, 100)
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	add_child(viewport)
	var inner := StudyScene.create("spot", "torus")
	viewport.add_child(inner)
	var outer := add_study()
	var masks := await _read_all(inner)
	check(masks.keys() == [Vector2i(100, 100)], "only the viewport shows its light: %s" % masks.keys())
	check((await _read_all(outer)).keys() == [Vector2i(200, 200)], "only the window shows the other")


func test_scaled_resolution_and_a_window_that_is_resized() -> void:
	var scene := add_study()
	get_viewport().scaling_3d_scale = 0.5
	check((await read_settled(scene)).get_size() == Vector2i(100, 100), "half of the resolution")
	get_viewport().scaling_3d_scale = 1.0
	await _resize(Vector2i(160, 120))
	var mask := await read_settled(scene)
	check(mask.get_size() == Vector2i(160, 120), "the mask has the window's size, not %s" % mask.get_size())
	check(count_darker(mask) > 100, "and a shadow")
	await _resize(Vector2i(200, 200))


func test_windows_that_stretch_their_content_have_masks() -> void:
	var scene := add_study()
	var window := get_window()
	for mode: Window.ContentScaleMode in [Window.CONTENT_SCALE_MODE_CANVAS_ITEMS, Window.CONTENT_SCALE_MODE_VIEWPORT]:
		for aspect: Window.ContentScaleAspect in [Window.CONTENT_SCALE_ASPECT_KEEP, Window.CONTENT_SCALE_ASPECT_EXPAND]:
			for size in [Vector2i(120, 80), Vector2i(900, 900)]:
				window.content_scale_mode = mode
				window.content_scale_aspect = aspect
				window.content_scale_size = size
				var mask := await read_settled(scene)
				check(count_darker(mask) > 0.005 * mask.get_width() * mask.get_height(), "mode %d, aspect %d, size %s: no shadow" % [mode, aspect, size])
	window.content_scale_mode = Window.CONTENT_SCALE_MODE_DISABLED
	window.content_scale_aspect = Window.CONTENT_SCALE_ASPECT_IGNORE
	window.content_scale_size = Vector2i.ZERO
	await draw_frames(2)
	remove(scene)


## Resizes the window, and waits up to 60 frames until the window system has done it.
func _resize(size: Vector2i) -> void:
	get_window().size = size
	for frame in 60:
		await draw_frames(1)
		if get_window().size == size:
			break
	await draw_frames(2)


func test_the_mask_is_shown_over_the_image() -> void:
	for msaa in [Viewport.MSAA_DISABLED, Viewport.MSAA_4X]:
		var scene := add_study()
		get_viewport().msaa_3d = msaa
		get_viewport().use_hdr_2d = true
		scene.shadow.show_mask = true
		var mask := await read_settled(scene)
		var image := get_viewport().get_texture().get_image()
		image.convert(Image.FORMAT_RF)
		get_viewport().use_hdr_2d = false
		get_viewport().msaa_3d = Viewport.MSAA_DISABLED
		for index in mask.get_width() * mask.get_height():  # pixels without a receiver, -1, are shown black
			mask.set_pixel(index % mask.get_width(), index / mask.get_width(), Color(maxf(mask.get_pixel(index % mask.get_width(), index / mask.get_width()).r, 0.0), 0, 0))
		check(count_different(mask, image, 0.002) == 0, "msaa %d: %d pixels differ" % [msaa, count_different(mask, image, 0.002)])
		remove(scene)
		await draw_frames(1)


func test_effects_of_the_user_stay() -> void:
	for holder in ["camera", "environment"]:
		var scene := add_study()
		var effect := CountingEffect.new()
		var compositor := Compositor.new()
		compositor.compositor_effects = [effect] as Array[CompositorEffect]
		if holder == "camera":
			scene.camera.compositor = compositor
		else:
			for node in scene.find_children("*", "WorldEnvironment", true, false):
				node.compositor = compositor
		var mask := await read_settled(scene)
		check(count_darker(mask) > 500, "a mask next to a compositor of the " + holder)
		check(effect.calls > 0, "the effect of the %s runs" % holder)
		scene.shadow.visible = false
		await draw_frames(2)
		var calls := effect.calls
		await draw_frames(2)
		check(effect.calls == calls + 2, "it runs on without the add-on's effect")
		check(compositor.compositor_effects.size() == 1, "the user's resource has only its own effect")
		remove(scene)
		await draw_frames(1)


## test_addon.py counts the message.
func test_orthogonal_cameras_are_refused_with_one_message() -> void:
	var scene := add_study()
	scene.camera.projection = Camera3D.PROJECTION_ORTHOGONAL
	var masks := await _read_all(scene)
	check(masks.is_empty(), "no mask")
	check(not scene.shadow.makes_mask(), "makes_mask() is false")
	scene.camera.projection = Camera3D.PROJECTION_PERSPECTIVE
	check(count_darker(await read_settled(scene)) > 500, "a mask again")


## Makes the caster a sphere with levels of detail, as Godot's importer generates them.
func _add_sphere_with_levels(scene: StudyScene) -> void:
	var sphere := SphereMesh.new()
	sphere.radial_segments = 96
	sphere.rings = 48
	var importer := ImporterMesh.new()
	importer.add_surface(Mesh.PRIMITIVE_TRIANGLES, sphere.get_mesh_arrays())
	importer.generate_lods(60, 60, [])
	scene.caster.mesh = importer.get_mesh()


func _count_primitives() -> int:
	return get_viewport().get_render_info(Viewport.RENDER_INFO_TYPE_VISIBLE, Viewport.RENDER_INFO_PRIMITIVES_IN_FRAME)


func test_meshes_drawn_with_fewer_triangles_have_the_full_mask() -> void:
	for light in StudyScene.LIGHTS:
		var scene := add_study(light)
		_add_sphere_with_levels(scene)
		get_viewport().mesh_lod_threshold = 0.0
		var full := await read_settled(scene)
		var full_primitives := _count_primitives()
		for threshold: float in [1.0, 3.0]:
			get_viewport().mesh_lod_threshold = threshold
			var found := await read_settled(scene)
			check(_count_primitives() < 0.8 * full_primitives, "Godot draws fewer triangles: %d of %d" % [_count_primitives(), full_primitives])
			var different := count_different(full, found, 1.0 / 255.0)
			check(different < 60 * threshold, "%s light, %s px: %d pixels differ" % [light, threshold, different])
		get_viewport().mesh_lod_threshold = 1.0
		remove(scene)


func test_antialiasing_over_time_leaves_the_mask_where_it_is() -> void:
	var scene := add_study()
	_add_sphere_with_levels(scene)
	var plain := await read_settled(scene)
	get_viewport().use_taa = true
	for frame in 4:
		var found := await read(scene)
		var different_count := count_different(plain, found, 0.1)  # outlines, and where the sphere touches its shadow
		check(different_count < 600, "frame %d: %d pixels differ by more than 0.1" % [frame, different_count])
	get_viewport().use_taa = false
	await draw_frames(2)
