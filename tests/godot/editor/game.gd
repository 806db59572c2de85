extends Node
## Shows the scene that the editor saved: prints its nodes and stores its image as NAME.png in the folder FOLDER. For the
## name "game" it also stores the images of LightImages. Arguments: NAME FOLDER.


func _ready() -> void:
	DisplayServer.window_set_size(Vector2i(320, 240))
	var scene: Node = load("res://lamp.tscn").instantiate()
	add_child(scene)
	for node: Node in [scene] + scene.find_children("*", "", true, false):
		print("NODE ", scene.get_path_to(node))
	for frame in 10:
		await RenderingServer.frame_post_draw
	var arguments := OS.get_cmdline_user_args()
	get_viewport().get_texture().get_image().save_png(arguments[1].path_join(arguments[0] + ".png"))
	if arguments[0] == "game":
		await LightImages.store("game", get_viewport(), scene, scene.get_node("Light"))
	get_tree().quit()
