extends Node
## Shows the scene that the editor saved: prints its nodes, stores its image.


func _ready() -> void:
	DisplayServer.window_set_size(Vector2i(320, 240))
	var scene: Node = load("res://lamp.tscn").instantiate()
	add_child(scene)
	for node: Node in [scene] + scene.find_children("*", "", true, false):
		print("NODE ", scene.get_path_to(node))
	for frame in 10:
		await RenderingServer.frame_post_draw
	get_viewport().get_texture().get_image().save_png("res://%s.png" % OS.get_cmdline_user_args()[0])
	get_tree().quit()
