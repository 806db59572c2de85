class_name AddonTest
extends Node
## A test's scene, and what it checks.

var failures := PackedStringArray()


func check(condition: bool, what: String) -> void:
	if not condition:
		failures.append(what)


func add_study(light := "omni", caster := "box") -> StudyScene:
	var scene := StudyScene.create(light, caster)
	add_child(scene)
	return scene


## Ends a study scene at once.
func remove(scene: Node) -> void:
	scene.get_parent().remove_child(scene)
	scene.queue_free()


func draw_frames(count := 1) -> void:
	for frame in count:
		await RenderingServer.frame_post_draw


## The mask of the next frame.
func read(scene: StudyScene) -> Image:
	return await MaskReader.new(scene.shadow).read()


func read_settled(scene: StudyScene) -> Image:
	await draw_frames(3)
	return await read(scene)


## How many pixels differ by more than `tolerance`.
static func count_different(left: Image, right: Image, tolerance := 0.0) -> int:
	if left.get_size() != right.get_size():
		return maxi(left.get_data_size(), right.get_data_size())
	var a := left.get_data().to_float32_array()
	var b := right.get_data().to_float32_array()
	var count := 0
	for index in a.size():
		count += int(absf(a[index] - b[index]) > tolerance)
	return count


## Receivers below the value.
static func count_darker(mask: Image, value := 0.5) -> int:
	var count := 0
	for visibility in mask.get_data().to_float32_array():
		count += int(visibility >= 0.0 and visibility < value)
	return count
