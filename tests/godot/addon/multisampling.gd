extends SmallScene
## Masks and images of multisampled views (MSAA), alone and with the effects that change Godot's order of passes.

const VIEW_SIZE := Vector2i(160, 120)
const SUPERSAMPLING := 8
const MSAA := {"2x": Viewport.MSAA_2X, "4x": Viewport.MSAA_4X, "8x": Viewport.MSAA_8X}
## Largest fraction of the pixels on outlines that differ from supersampling by more than 0.1.
const MAX_WRONG_FRACTION := {"box": 0.01, "post": 0.015, "sphere": 0.03, "torus": 0.015}
const EFFECTS: Array[String] = ["", "ssao", "ssil", "ssr", "sdfgi", "glow"]


## Returns how many pixels of a mask are outside of the values that another has in the pixel and those around it: the masks of
## multisampled views belong to the pixels' first samples, up to 0.4 pixels from the centres.
func _count_outside(mask: Image, plain: Image) -> int:
	if mask.get_size() != plain.get_size():
		return mask.get_data_size()
	var found := mask.get_data().to_float32_array()
	var expected := plain.get_data().to_float32_array()
	var size := mask.get_size()
	var count := 0
	for y in range(1, size.y - 1):
		for x in range(1, size.x - 1):
			var index := y * size.x + x
			if absf(found[index] - expected[index]) <= 1.0 / 255.0:
				continue
			var low := 1.0
			var high := -1.0
			for row: int in [index - size.x, index, index + size.x]:
				for beside in range(row - 1, row + 2):
					low = minf(low, expected[beside])
					high = maxf(high, expected[beside])
			count += int(found[index] < low - 1.0 / 255.0 or found[index] > high + 1.0 / 255.0)
	return count


func test_multisampled_views_have_the_same_mask_with_every_effect() -> void:
	var scene := add_study()
	var environment: Environment = (scene.find_children("*", "WorldEnvironment", true, false)[0] as WorldEnvironment).environment
	var plain := await read_settled(scene)
	for effect in EFFECTS:
		if not effect.is_empty():
			environment.set(effect + "_enabled", true)
		for samples: String in MSAA:
			get_viewport().msaa_3d = MSAA[samples]
			var different := _count_outside(await read_settled(scene), plain)
			check(different < 60, "%s, MSAA %s: %d pixels differ" % [effect, samples, different])
		if not effect.is_empty():
			environment.set(effect + "_enabled", false)
	get_viewport().msaa_3d = Viewport.MSAA_DISABLED


## Scaled resolution and FSR 2 change the size of the buffers, or shift the camera.
func test_multisampled_views_have_the_same_mask_with_every_scaling() -> void:
	var scene := add_study()
	var viewport := get_viewport()
	for scale: float in [0.5, 0.77, 1.5]:
		viewport.scaling_3d_scale = scale
		var plain := await read_settled(scene)
		viewport.msaa_3d = Viewport.MSAA_4X
		var different := _count_outside(await read_settled(scene), plain)
		viewport.msaa_3d = Viewport.MSAA_DISABLED
		check(different < 60 * maxf(scale, 1.0), "scale %s: %d pixels differ" % [scale, different])
	viewport.scaling_3d_scale = 1.0
	var settled := await read_settled(scene)
	viewport.use_taa = true
	viewport.msaa_3d = Viewport.MSAA_4X
	var found := await read_settled(scene)
	check(count_different(settled, found, 0.1) < 600, "TAA: %d pixels differ" % count_different(settled, found, 0.1))
	viewport.use_taa = false
	viewport.scaling_3d_mode = Viewport.SCALING_3D_MODE_FSR2
	viewport.scaling_3d_scale = 0.67
	found = await read_settled(scene)
	check(count_darker(found) > 300, "FSR 2: a shadow of %d pixels in %s" % [count_darker(found), found.get_size()])
	viewport.scaling_3d_mode = Viewport.SCALING_3D_MODE_BILINEAR
	viewport.scaling_3d_scale = 1.0
	viewport.msaa_3d = Viewport.MSAA_DISABLED


func _add_viewport(scene: Node3D, size: Vector2i) -> SubViewport:
	var viewport := SubViewport.new()
	viewport.size = size
	viewport.use_hdr_2d = true # linear values
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var camera := Camera3D.new()
	viewport.add_child(camera)
	scene.add_child(viewport)
	camera.look_at_from_position(Vector3(1.5, 2.2, 3), Vector3(0, 0.3, 0))
	return viewport


func _draw(viewport: SubViewport) -> Image:
	await draw_frames(4)
	var image := viewport.get_texture().get_image()
	image.convert(Image.FORMAT_RGBF)
	return image


## Returns the image with each block of pixels averaged, and in alpha the largest difference within the block.
static func _average(image: Image) -> Image:
	var size := image.get_size() / SUPERSAMPLING
	var averaged := Image.create(size.x, size.y, false, Image.FORMAT_RGBAF)
	for y in size.y:
		for x in size.x:
			var sum := Color(0, 0, 0, 0)
			var low := INF
			var high := -INF
			for index in SUPERSAMPLING * SUPERSAMPLING:
				@warning_ignore("integer_division")
				var color := image.get_pixel(x * SUPERSAMPLING + index % SUPERSAMPLING, y * SUPERSAMPLING + index / SUPERSAMPLING)
				sum += color
				low = minf(low, color.g)
				high = maxf(high, color.g)
			sum /= SUPERSAMPLING * SUPERSAMPLING
			averaged.set_pixel(x, y, Color(sum.r, sum.g, sum.b, high - low))
	return averaged


## Compared with supersampling, in pixels that outlines cross: those whose samples differ without a shadow.
func test_outlines_have_no_dark_or_bright_pixels() -> void:
	for light: String in ["directional", "omni"]:
		for caster: String in StudyScene.CASTERS:
			var scene := add_study(light, caster)
			var large := _add_viewport(scene, VIEW_SIZE * SUPERSAMPLING)
			var exact := _average(await _draw(large))
			scene.light.shadow_caster_mask = 0
			var lit := _average(await _draw(large))
			scene.light.shadow_caster_mask = 0xffffffff
			large.free()
			var viewport := _add_viewport(scene, VIEW_SIZE)
			for samples: String in ["4x", "8x"]:
				viewport.msaa_3d = MSAA[samples]
				var found := await _draw(viewport)
				var edges := 0
				var wrong := 0
				for y in VIEW_SIZE.y:
					for x in VIEW_SIZE.x:
						if lit.get_pixel(x, y).a > 0.05:
							edges += 1
							wrong += int(absf(exact.get_pixel(x, y).g - found.get_pixel(x, y).g) > 0.1)
				var result := "%s, %s, MSAA %s: %d of %d pixels differ" % [light, caster, samples, wrong, edges]
				print(result)
				check(edges > 50 and wrong <= MAX_WRONG_FRACTION[caster] * edges, result)
			remove(scene)


func test_faded_and_transparent_nodes_show_no_mask_of_what_is_behind() -> void:
	for msaa: Viewport.MSAA in [Viewport.MSAA_DISABLED, Viewport.MSAA_4X]:
		for fade: String in ["transparency", "range"]:
			_begin()
			_viewport.msaa_3d = msaa
			var box := _add_box(Vector3(-1, 0.5, 0))
			if fade == "transparency":
				box.transparency = 0.5
			else:
				box.visibility_range_end = _camera.position.distance_to(box.position)
				box.visibility_range_end_margin = 2.0
				box.visibility_range_fade_mode = GeometryInstance3D.VISIBILITY_RANGE_FADE_SELF
			var points: Array[Vector3] = [_floor_below(Vector3(-1.3, 0.8, -0.3)), Vector3(2, 0, 2)]
			for y: float in [0.15, 0.3, 0.5, 0.7, 0.85]:
				points.append(Vector3(-1, y, 0.5))
			await _compare("faded %s %d" % [fade, msaa], points)
			await _end()


## Returns how many receivers have a visibility below `value` and only receivers around them. Materials read the mask of pixels at
## outlines from the pixel beside them.
func _count_inside(mask: Image, value: float) -> int:
	var count := 0
	for y in range(1, mask.get_height() - 1):
		for x in range(1, mask.get_width() - 1):
			var is_inside := mask.get_pixel(x, y).r < value
			for index in 9:
				is_inside = is_inside and mask.get_pixel(x + index % 3 - 1, y + int(index / 3.0) - 1).r >= 0.0
			count += int(is_inside)
	return count


## In a multisampled view, the point of a pixel must not be behind an edge between two faces of its surface.
func test_edges_of_convex_meshes_do_not_shadow_themselves_in_multisampled_views() -> void:
	for sides: int in [12, 64]:
		_begin()
		for floor_node in _root.find_children("*", "MeshInstance3D", true, false):
			floor_node.free()
		var cone := CylinderMesh.new()
		cone.top_radius = 0.0
		cone.bottom_radius = 1.0
		cone.radial_segments = sides
		_add(cone, Vector3(-1.2, 0.5, 0))
		var sphere := SphereMesh.new()
		sphere.radial_segments = sides
		sphere.rings = int(sides / 2.0)
		sphere.radius = 1.0
		sphere.height = 2.0
		_add(sphere, Vector3(1.2, 0.5, 0))
		var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
		_sun.rotation_degrees = Vector3(-50, 0, 0)
		_sun.add_child(shadow)
		var limit := 0
		for msaa: Viewport.MSAA in [Viewport.MSAA_DISABLED, Viewport.MSAA_4X, Viewport.MSAA_8X]:
			_viewport.msaa_3d = msaa
			await draw_frames(3)
			var mask := await MaskReader.new(shadow).read()
			var count := _count_inside(mask, 0.5)
			if msaa == Viewport.MSAA_DISABLED:
				limit = count + int(0.01 * _count_inside(mask, 2.0))
			check(count <= limit, "%d sides, MSAA %d: %d pixels are dark, at most %d may be" % [sides, msaa, count, limit])
		await _end()
