@tool
extends EditorPlugin
## The add-on's editor plugin: project settings, a checkbox in the inspector of lights, and a gizmo for their size. The
## shadows themselves are made by the add-on's library, in the editor and in games.

# As in gnomon.gdextension.
const PLATFORMS := "Windows x86_64, Linux x86_64 and Linux arm64"
const ENABLED := "rendering/gnomon/enabled"
# Names, defaults and ranges as in modules/godot_addon/addon_settings.cpp, which checks the values.
const SETTINGS: Array[Dictionary] = [
	{"name": ENABLED, "type": TYPE_BOOL, "value": true},
	{"name": "rendering/gnomon/most_lights", "type": TYPE_INT, "value": 16, "hint": PROPERTY_HINT_RANGE, "hint_string": "1,63"},
	{"name": "rendering/gnomon/default_technique", "type": TYPE_STRING, "value": "edge_count", "hint": PROPERTY_HINT_ENUM},
	{"name": "rendering/gnomon/keep_godot_shadows", "type": TYPE_STRING, "value": "auto", "hint": PROPERTY_HINT_ENUM, "hint_string": "auto,always,never"},
	{"name": "rendering/gnomon/gradual_compilation", "type": TYPE_BOOL, "value": true},
	{"name": "rendering/gnomon/other_drivers", "type": TYPE_BOOL, "value": false},
	{"name": "rendering/gnomon/mask_resolution_scale", "type": TYPE_FLOAT, "value": 1.0, "hint": PROPERTY_HINT_RANGE, "hint_string": "0.25,1,0.01"},
]

var _inspector: EditorInspectorPlugin
var _gizmo: EditorNode3DGizmoPlugin


func _enter_tree() -> void:
	if not ClassDB.class_exists("GnomonShadow3D"):
		push_error("Gnomon: its library did not load on %s %s. It is built for %s, and Godot 4.5 or later; see the messages above, and restart the editor after copying the add-on." % [OS.get_name(), Engine.get_architecture_name(), PLATFORMS])
		return
	for setting: Dictionary in SETTINGS.duplicate(true):
		if setting.name.ends_with("default_technique"):
			setting["hint_string"] = _list_techniques()
		if not ProjectSettings.has_setting(setting.name):
			ProjectSettings.set_setting(setting.name, setting.value)
		ProjectSettings.set_initial_value(setting.name, setting.value)
		ProjectSettings.add_property_info(setting)
	_inspector = preload("editor/light_inspector.gd").new()
	_inspector.undo_redo = get_undo_redo()
	add_inspector_plugin(_inspector)
	_gizmo = preload("editor/shadow_gizmo.gd").new()
	_gizmo.undo_redo = get_undo_redo()
	add_node_3d_gizmo_plugin(_gizmo)
	_make_gizmos.call_deferred()
	EditorInterface.get_inspector().property_edited.connect(_on_property_edited)
	get_undo_redo().version_changed.connect(_update_gizmos)


func _list_techniques() -> String:
	for property in ClassDB.class_get_property_list("GnomonShadow3D", true):
		if property.name == "technique":
			return property.hint_string.trim_prefix("default,")
	return ""


func _exit_tree() -> void:
	if _inspector:
		_make_gizmos.call_deferred()
		remove_inspector_plugin(_inspector)
		remove_node_3d_gizmo_plugin(_gizmo)
		EditorInterface.get_inspector().property_edited.disconnect(_on_property_edited)
		get_undo_redo().version_changed.disconnect(_update_gizmos)


func _enable_plugin() -> void:
	_set_enabled(true)


## Gives all lights Godot's shadows back, in the editor and in games.
func _disable_plugin() -> void:
	_set_enabled(false)


func _set_enabled(is_enabled: bool) -> void:
	ProjectSettings.set_setting(ENABLED, is_enabled)
	ProjectSettings.save()
	# Without this the editor draws only when the scene changes. false: the buffers are not swapped.
	RenderingServer.force_draw.call_deferred(false)


## Makes the gizmos of lights in the scene that is open already. Once the gizmo plugin is removed, clears them.
func _make_gizmos() -> void:
	var root := EditorInterface.get_edited_scene_root()
	if root:
		# Recursive, and also without owner: lights that scripts have added.
		for light: Light3D in root.find_children("*", "Light3D", true, false):
			light.clear_gizmos()
			light.update_gizmos()


func _on_property_edited(_property: String) -> void:
	_update_gizmos()


func _update_gizmos() -> void:
	for node in EditorInterface.get_selection().get_selected_nodes():
		if node is Light3D:
			node.update_gizmos()
