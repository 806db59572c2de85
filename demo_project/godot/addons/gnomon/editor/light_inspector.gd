@tool
extends EditorInspectorPlugin
## Adds a checkbox to the inspector of lights, below Light3D, which adds a GnomonShadow3D to the light or removes it.

const CLASS := "GnomonShadow3D"

var undo_redo: EditorUndoRedoManager


func _can_handle(object: Object) -> bool:
	return object is OmniLight3D or object is SpotLight3D or object is DirectionalLight3D


func _parse_category(object: Object, category: String) -> void:
	if category == "Light3D":
		var editor := ShadowCheckBox.new()
		editor.light = object
		editor.undo_redo = undo_redo
		editor.label = "Gnomon Shadow"
		add_property_editor_for_multiple_properties("", PackedStringArray(), editor) # without a property, so that it has no revert button


class ShadowCheckBox:
	extends EditorProperty
	var light: Light3D
	var undo_redo: EditorUndoRedoManager
	var _box := CheckBox.new()

	func _init() -> void:
		_box.text = "On"
		_box.tooltip_text = "Gives the light a soft shadow of Gnomon: adds a GnomonShadow3D below it, or removes it."
		_box.pressed.connect(_toggle)
		add_child(_box)
		add_focusable(_box)

	func _enter_tree() -> void:
		light.child_order_changed.connect(_update_property)
		_update_property()

	func _exit_tree() -> void:
		light.child_order_changed.disconnect(_update_property)

	func _update_property() -> void:
		_box.set_pressed_no_signal(_find_shadow() != null)

	func _find_shadow() -> Node:
		for child in light.get_children():
			if child.is_class(CLASS):
				return child
		return null

	func _toggle() -> void:
		var shadow := _find_shadow()
		if shadow:
			undo_redo.create_action("Remove Gnomon Shadow")
			undo_redo.add_do_method(light, "remove_child", shadow)
			undo_redo.add_undo_method(light, "add_child", shadow, true)
			undo_redo.add_undo_method(shadow, "set_owner", shadow.owner)
			undo_redo.add_undo_reference(shadow)
		else:
			shadow = ClassDB.instantiate(CLASS)
			shadow.name = CLASS
			undo_redo.create_action("Add Gnomon Shadow")
			undo_redo.add_do_method(light, "add_child", shadow, true)
			undo_redo.add_do_method(shadow, "set_owner", EditorInterface.get_edited_scene_root())
			undo_redo.add_do_reference(shadow)
			undo_redo.add_undo_method(light, "remove_child", shadow)
			undo_redo.add_do_property(light, "shadow_enabled", true) # without it the light has no shadow at all
			undo_redo.add_undo_property(light, "shadow_enabled", light.shadow_enabled)
		undo_redo.add_do_method(light, "update_gizmos")
		undo_redo.add_undo_method(light, "update_gizmos")
		undo_redo.commit_action()
