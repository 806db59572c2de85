extends Node
## Measures room/room.tscn with Gnomon's shadows and with Godot's own:
##   godot --path demo_project/godot res://study/measure_room.tscn -- out=DIR size=800 frames=20
## Images at TIME_S, float32 RGB, linear, rows from the top: room_MODE.f32 with all lights (off: without shadows),
## room_dark.f32 without lights, room_only_LIGHT.f32 with one light and no shadow. room.gltf is the scene at that time.
## room.json has the lights' names, and by number of lights and mode the median time in milliseconds of a frame in which
## everything moves.

const TIME_S := 2.0  # of the images
const STEP_S := 1.0 / 30.0  # between the timed frames
const SETTLE_FRAMES := 3  # drawn after a change, before the image is read
const MAX_TEXTURE_FRAMES := 600

var _options := StudyOptions.new({"out": "res://out", "size": "800", "frames": "20"})
var _room: Room


func _ready() -> void:
	if not _options.read():
		get_tree().quit(2)
		return
	get_viewport().use_hdr_2d = true  # linear images
	_room = load("res://room/room.tscn").instantiate()
	_room.is_moving = false
	add_child(_room)
	var lights := _room.get_lights()
	await _wait_for_textures()
	var times := {}
	for count: int in [1, lights.size()]:
		times[str(count)] = await _measure(lights, count)
	ShadowModes.apply(lights, "off")
	_show(lights, [])
	await _store("dark")
	var names := PackedStringArray()
	for light in lights:
		_show(lights, [light])
		await _store("only_" + light.name)
		names.append(light.name)
	_show(lights, lights)
	ShadowModes.apply(lights, "gnomon")  # makes all nodes visible, as the export needs
	GltfExport.save(_room, _options.path("room.gltf"))
	_options.store_text("room.json", JSON.stringify({"lights": names, "times": times}, "\t"))
	get_tree().quit()


## Measures the frame times of each mode with the first `count` lights. With all lights it also stores images.
func _measure(lights: Array[Light3D], count: int) -> Dictionary:
	_show(lights, lights.slice(0, count))
	var times := {}
	for mode in ShadowModes.ALL:
		ShadowModes.apply(lights, mode)
		times[mode] = await FrameTimes.measure(int(_options.text("frames")), func(frame: int) -> void:
			_room.show_time(TIME_S + STEP_S * (frame + 1)))
		if count == lights.size():
			await _store(mode)
	return times


func _show(lights: Array[Light3D], shown: Array[Light3D]) -> void:
	for light in lights:
		light.visible = light in shown


## Waits for the noise textures, which Godot generates on other threads.
func _wait_for_textures() -> void:
	for frame in MAX_TEXTURE_FRAMES:
		await RenderingServer.frame_post_draw
		if _room.has_textures():
			return
	printerr("ERROR: the room's textures are not complete after %d frames; its images may be wrong." % MAX_TEXTURE_FRAMES)


func _store(what: String) -> void:
	_room.show_time(TIME_S)
	for frame in SETTLE_FRAMES:
		await RenderingServer.frame_post_draw
	var image := get_viewport().get_texture().get_image()
	image.convert(Image.FORMAT_RGBF)
	_options.store_bytes("room_%s.f32" % what, image.get_data())
