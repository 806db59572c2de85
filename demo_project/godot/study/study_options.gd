class_name StudyOptions
extends RefCounted
## The options NAME=VALUE after -- on Godot's command line. Files are stored in the folder that the option `out` names.

var _values: Dictionary


func _init(defaults: Dictionary) -> void:
	_values = defaults


## Reads the command line, makes the output folder and sets the window's size. Returns false, with a message, after a wrong
## argument.
func read() -> bool:
	ProjectSettings.set_setting("rendering/gnomon/gradual_compilation", false)  # images and times are of complete shadows
	for argument in OS.get_cmdline_user_args():
		var parts := argument.split("=", true, 1)
		if parts.size() != 2 or not _values.has(parts[0]):
			printerr("ERROR: \"%s\": must be NAME=VALUE with one of these names: %s." % [argument, ", ".join(_values.keys())])
			return false
		_values[parts[0]] = parts[1]
	DirAccess.make_dir_recursive_absolute(text("out"))
	if _values.has("size"):
		DisplayServer.window_set_size(Vector2i(int(text("size")), int(text("size"))))
	return true


func text(option: String) -> String:
	return _values[option]


func path(file_name: String) -> String:
	return text("out").path_join(file_name)


func store_bytes(file_name: String, bytes: PackedByteArray) -> void:
	FileAccess.open(path(file_name), FileAccess.WRITE).store_buffer(bytes)


func store_text(file_name: String, content: String) -> void:
	FileAccess.open(path(file_name), FileAccess.WRITE).store_string(content)
