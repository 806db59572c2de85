class_name AddonTest
extends Node
## Base class of the add-on's tests: makes study scenes (demo_project/godot/study), reads masks and collects failed checks.
## Limits on numbers of pixels are of the 200 x 200 of the window.

var failures := PackedStringArray()


## Adds the text `what`, which states the expectation, to the failures unless the condition holds.
func check(condition: bool, what: String) -> void:
	if not condition:
		failures.append(what)


func add_study(light := "omni", caster := "box") -> StudyScene:
	var scene := StudyScene.create(light, caster)
	add_child(scene)
	return scene


## Removes a study scene from the tree at once, and frees it.
func remove(scene: Node) -> void:
	scene.get_parent().remove_child(scene)
	scene.queue_free()


func draw_frames(count := 1) -> void:
	for frame in count:
		await RenderingServer.frame_post_draw


## Reads the mask of the next frame.
func read(scene: StudyScene) -> Image:
	return await MaskReader.new(scene.shadow).read()


## Draws three frames, after which nothing changes any more, and reads the mask of the next one.
func read_settled(scene: StudyScene) -> Image:
	await draw_frames(3)
	return await read(scene)


## Returns how many pixels of two one-channel float images differ by more than `tolerance`. If the sizes differ, returns the
## number of bytes of the larger one.
static func count_different(left: Image, right: Image, tolerance := 0.0) -> int:
	if left.get_size() != right.get_size():
		return maxi(left.get_data_size(), right.get_data_size())
	var a := left.get_data().to_float32_array()
	var b := right.get_data().to_float32_array()
	var count := 0
	for index in a.size():
		count += int(absf(a[index] - b[index]) > tolerance)
	return count


## Returns how many receivers have a visibility below `value`. Pixels without a receiver are -1.
static func count_darker(mask: Image, value := 0.5) -> int:
	var count := 0
	for visibility in mask.get_data().to_float32_array():
		count += int(visibility >= 0.0 and visibility < value)
	return count
