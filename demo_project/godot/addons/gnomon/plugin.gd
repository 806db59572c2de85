@tool
extends EditorPlugin
## Tells whoever enables the add-on where its library did not load. All else is in the library.


func _enter_tree() -> void:
	if not ClassDB.class_exists("GnomonShadow3D"):
		push_error("Gnomon: its library did not load. It is built for Linux on x86_64 and Godot 4.5 or later; see the messages above, and restart the editor after copying the add-on.")
