extends Node
## Draws frames of room/room.tscn as a game does. First argument: number of frames. Prints Godot's resource counts every 100 frames.

const LOOP_FRAMES := 200  # after which the motion of the room starts again
const STEP_S := 0.1


func _ready() -> void:
	var room: Room = load("res://room/room.tscn").instantiate()
	room.is_moving = false
	add_child(room)
	for frame in int(OS.get_cmdline_user_args()[0]):
		room.show_time(STEP_S * (frame % LOOP_FRAMES))
		await RenderingServer.frame_post_draw
		if frame % 100 == 99:
			SoakReport.print_line(frame + 1)
	get_tree().quit()
