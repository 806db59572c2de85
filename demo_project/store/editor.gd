@tool
extends EditorPlugin
## Opens the scene of the store page's thumbnail in Godot's editor, selects its light, and saves the window as an image.

const SCENE := "res://store/cage.tscn"
const SETTLE_FRAMES := 40


func _enter_tree() -> void:
	_run.call_deferred()


func _run() -> void:
	while EditorInterface.get_resource_filesystem().is_scanning():
		await get_tree().process_frame
	var window := get_tree().root
	window.mode = Window.MODE_WINDOWED
	window.size = StoreJpeg.SIZE_PX
	EditorInterface.set_main_screen_editor("3D")
	EditorInterface.open_scene_from_path(SCENE)
	await _wait()
	var light := EditorInterface.get_edited_scene_root().get_node("Spot")
	EditorInterface.get_selection().clear()
	EditorInterface.get_selection().add_node(light)
	EditorInterface.edit_node(light)
	await _wait()
	StoreJpeg.save(window.get_texture().get_image(), "res://out", "editor")
	get_tree().quit()


func _wait() -> void:
	for frame in SETTLE_FRAMES:
		await get_tree().process_frame
