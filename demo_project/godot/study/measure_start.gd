extends Node
## Measures the first frames of room/room.tscn, in which shaders are compiled:
##   godot --path demo_project/godot res://study/measure_start.tscn -- mode=gnomon gradual=1 frames=100 size=400
## mode: gnomon, low or ultra for Godot's own shadows, off. gradual: the project setting gradual_compilation, 1 or 0. Prints the
## longest frames, "FRAME:MILLISECONDS", and the median. For a first start, remove the caches of Godot and of the driver before.

const LISTED_FRAMES := 8

var _options := StudyOptions.new({"out": "user://", "gradual": "1", "mode": "gnomon", "frames": "100", "size": "400"})


func _ready() -> void:
	if not _options.read():
		get_tree().quit(2)
		return
	ProjectSettings.set_setting("rendering/gnomon/gradual_compilation", _options.text("gradual") == "1")
	var room: Room = load("res://room/room.tscn").instantiate()
	room.is_moving = false
	add_child(room)
	ShadowModes.apply(room.get_lights(), _options.text("mode"))
	var times: Array[float] = []
	var before := Time.get_ticks_usec()
	for frame in int(_options.text("frames")):
		room.show_time(frame / 30.0)
		await RenderingServer.frame_post_draw
		var now := Time.get_ticks_usec()
		times.append((now - before) / 1000.0)
		before = now
	var longest := range(times.size())
	longest.sort_custom(func(left: int, right: int) -> bool: return times[left] > times[right])
	var listed := PackedStringArray()
	for frame: int in longest.slice(0, LISTED_FRAMES):
		listed.append("%d:%.0f" % [frame, times[frame]])
	print("longest frames ", " ".join(listed), ", median %.0f ms" % times[longest[longest.size() / 2]])
	get_tree().quit()
