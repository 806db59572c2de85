extends AddonTest
## Project settings below rendering/gnomon, which a game may change while it runs.

const TECHNIQUE := "rendering/gnomon/default_technique"
const SCALE := "rendering/gnomon/mask_resolution_scale"


func test_nodes_without_a_technique_use_the_project_setting() -> void:
	var scene := add_study()
	var with_edge_count := await read_settled(scene)
	scene.shadow.technique = "pcss"
	var with_pcss := await read_settled(scene)
	check(count_different(with_edge_count, with_pcss, 0.02) > 100, "pcss differs")
	scene.shadow.technique = "default"
	ProjectSettings.set_setting(TECHNIQUE, "pcss")
	check(count_different(await read_settled(scene), with_pcss) == 0, "the project's technique")
	scene.shadow.technique = "edge_count"
	check(count_different(await read_settled(scene), with_edge_count) == 0, "the node's own technique")
	scene.shadow.technique = "default"
	ProjectSettings.set_setting(TECHNIQUE, "nothing")
	check(count_different(await read_settled(scene), with_edge_count) == 0, "edge_count for one that does not exist")
	ProjectSettings.set_setting(TECHNIQUE, null)
	remove(scene)


func test_masks_of_fewer_pixels_shadow_the_same_image() -> void:
	var scene := add_study("spot", "torus")
	get_viewport().use_hdr_2d = true
	var full := await _draw()
	scene.light.shadow_enabled = false # neither Godot's shadow nor Gnomon's
	var lit := await _draw()
	scene.light.shadow_enabled = true
	ProjectSettings.set_setting(SCALE, 0.5)
	var half := await _draw()
	check((await read(scene)).get_size() == (full.get_size() + Vector2i.ONE) / 2, "the mask has half the size")
	ProjectSettings.set_setting(SCALE, null)
	check((await _draw()).get_data() == full.get_data(), "the full masks are back")
	for refused: float in [0.1, NAN]:
		ProjectSettings.set_setting(SCALE, refused)
		check((await _draw()).get_data() == full.get_data(), "%f is refused" % refused)
	ProjectSettings.set_setting(SCALE, null)
	get_viewport().use_hdr_2d = false
	var shadowed := count_different(full, lit, 0.1)
	check(shadowed > 1000, "there is a shadow")
	check(count_different(half, full, 0.1) < 0.02 * shadowed, "%d pixels differ, %d are in shadow" % [count_different(half, full, 0.1), shadowed])
	remove(scene)


func _draw() -> Image:
	await draw_frames(3)
	var image := get_viewport().get_texture().get_image()
	image.convert(Image.FORMAT_RF)
	return image


## Compiled gradually, a new light has Godot's shadow in each frame until its masks are made.
func test_a_light_has_a_shadow_in_each_frame_while_shaders_are_compiled() -> void:
	const GRADUAL := "rendering/gnomon/gradual_compilation"
	var scene := add_study("spot", "box")
	var settled := await _draw()
	scene.light.shadow_enabled = false
	var lit_count := _count_dark(await _draw())
	var least := (lit_count + _count_dark(settled)) / 2
	check(least > lit_count + 200, "the shadow has %d dark pixels more than %d" % [_count_dark(settled) - lit_count, lit_count])
	remove(scene)
	await draw_frames(3)  # the add-on frees its pipelines
	ProjectSettings.set_setting(GRADUAL, true)
	scene = add_study("spot", "box")
	var frame := 0
	var is_settled := false
	await draw_frames(2)
	while frame < 100 and not is_settled:
		await draw_frames()
		var image := get_viewport().get_texture().get_image()
		image.convert(Image.FORMAT_RF)
		check(_count_dark(image) > least, "frame %d: %d dark pixels, must be more than %d" % [frame, _count_dark(image), least])
		is_settled = image.get_data() == settled.get_data()
		frame += 1
	check(is_settled, "the shadow is Gnomon's within 100 frames")
	check(frame > 10, "at most one shader a frame: %d frames" % frame)
	ProjectSettings.set_setting(GRADUAL, false)
	remove(scene)


func _count_dark(image: Image) -> int:
	var count := 0
	for y in image.get_height():
		for x in image.get_width():
			count += int(image.get_pixel(x, y).r < 0.05)
	return count
