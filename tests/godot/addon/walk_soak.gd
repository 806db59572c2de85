extends Node
## Draws an animated glTF file. Arguments: number of frames, path of the file. Prints Godot's resource counts every 100 frames.

const FRAMES_PER_S := 30.0


func _ready() -> void:
	var scene := GltfImport.load_scene(OS.get_cmdline_user_args()[1])
	add_child(scene)
	var player: AnimationPlayer = scene.find_children("*", "AnimationPlayer", true, false)[0]
	var walk := player.get_animation_list()[0]
	player.get_animation(walk).loop_mode = Animation.LOOP_LINEAR
	player.callback_mode_process = AnimationMixer.ANIMATION_CALLBACK_MODE_PROCESS_MANUAL
	player.play(walk)
	for frame in int(OS.get_cmdline_user_args()[0]):
		player.advance(1.0 / FRAMES_PER_S)  # a fixed time step, whatever the frame rate
		await RenderingServer.frame_post_draw
		if frame % 100 == 99:
			SoakReport.print_line(frame + 1)
	get_tree().quit()
