extends AddonTest
## Masks that tests/godot/test_arm64.py compares between platforms.

const SIZE := Vector2i(64, 64)  # of the window: in small images, leaves of edge_count have many edges
const MIN_PIXELS := 20  # of the umbra, and of the penumbra


func test_masks_of_each_light_are_stored() -> void:
	var window := get_window()
	var window_size := window.size
	window.size = SIZE
	for light in StudyScene.LIGHTS:
		var scene := add_study(light, "torus")
		if light == "directional":
			scene.light.light_angular_distance = 6.0
		var mask := await read_settled(scene)
		check(mask.get_size() == SIZE, "%s: the mask has %s pixels" % [light, mask.get_size()])
		var umbra := count_darker(mask, 0.01)
		check(umbra > MIN_PIXELS, "%s: the umbra has %d pixels" % [light, umbra])
		check(count_darker(mask, 0.99) - umbra > MIN_PIXELS, "%s: there is a penumbra" % light)
		FileAccess.open("res://tests/mask_%s.f32" % light, FileAccess.WRITE).store_buffer(mask.get_data())
		remove(scene)
	window.size = window_size
	await draw_frames(3)
