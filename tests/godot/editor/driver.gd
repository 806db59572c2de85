@tool
extends EditorPlugin
## Drives the editor as a user would: ticks the box of a light, drags its size, undoes, saves, switches the add-on off and on. Prints PASS or
## FAIL for each check.

const SCENE := "res://lamp.tscn"
const SETTLED_FRAMES := 12
const SCENE_LAYERS := 0xfffff  # the 20 layers that a user can choose

var _light: OmniLight3D


func _enter_tree() -> void:
	_run.call_deferred()


func _run() -> void:
	while EditorInterface.get_resource_filesystem().is_scanning():
		await get_tree().process_frame
	EditorInterface.set_main_screen_editor("3D")
	EditorInterface.open_scene_from_path(SCENE)
	await _draw(30)
	_light = EditorInterface.get_edited_scene_root().get_node("Light")
	var before := await _select_and_look()
	await _click_box()
	var shadow := _light.get_child(0) if _light.get_child_count() > 0 else null
	_report("ticking_the_box_adds_the_node", shadow != null and shadow.is_class("GnomonShadow3D") and shadow.owner == EditorInterface.get_edited_scene_root())
	var ticked := await _look()
	ticked.save_png("res://ticked.png")
	await _store_view()
	_report("the_viewport_shows_the_shadow", _count_darker(before, ticked) > 500)
	await _drag_size()
	_undo()
	_report("undo_takes_the_size_back", is_equal_approx(_light.light_size, 0.2))  # as in lamp.tscn
	(await _look()).save_png("res://undone.png")
	_report("the_image_is_the_one_before", (await _look()).get_data() == ticked.get_data())
	_undo()
	_report("undo_removes_the_node", _light.get_child_count() == 0)
	await _draw(SETTLED_FRAMES)
	_report("without_it_all_is_as_before", (await _look()).get_data() == before.get_data())
	_redo()
	_report("redo_adds_it_again", _light.get_child_count() == 1)
	await _look()
	get_tree().root.get_texture().get_image().save_png("res://editor.png")
	EditorInterface.save_scene()
	_report_saved()
	EditorInterface.set_plugin_enabled("gnomon", false)
	await _draw(SETTLED_FRAMES)
	_report("switching_the_plugin_off_brings_godots_shadow_back", _count_darker(before, await _look()) > 500)
	_light.shadow_enabled = false
	var off := await _look()
	off.save_png("res://off.png")
	_report("switching_the_plugin_off_restores_all", _count_darker(before, off) == 0)
	_light.shadow_enabled = true
	EditorInterface.set_plugin_enabled("gnomon", true)
	await _draw(SETTLED_FRAMES)
	_report("switching_it_on_brings_it_back", _count_darker(before, await _look()) > 500)
	get_tree().quit()


## Stores the viewport's images without the editor's gizmos, which are on layers of their own.
func _store_view() -> void:
	var viewport := EditorInterface.get_editor_viewport_3d(0)
	var camera := viewport.get_camera_3d()
	var layers := camera.cull_mask
	camera.cull_mask = SCENE_LAYERS
	await LightImages.store("view", viewport, EditorInterface.get_edited_scene_root(), _light)
	camera.cull_mask = layers


func _draw(count: int) -> void:
	for frame in count:
		await get_tree().process_frame


func _report(what: String, holds: bool) -> void:
	print("PASS " if holds else "FAIL ", what)


func _select_and_look() -> Image:
	EditorInterface.get_selection().clear()
	EditorInterface.get_selection().add_node(_light)
	EditorInterface.edit_node(_light)
	return await _look()


## Returns the image of the 3D viewport, after moving the mouse away so that nothing is highlighted.
func _look() -> Image:
	_move(Vector2(2, 2))
	await _draw(SETTLED_FRAMES)
	return EditorInterface.get_editor_viewport_3d(0).get_texture().get_image()


func _count_darker(lit: Image, shadowed: Image) -> int:
	var count := 0
	for y in lit.get_height():
		for x in lit.get_width():
			count += int(shadowed.get_pixel(x, y).get_luminance() < lit.get_pixel(x, y).get_luminance() - 0.1)
	return count


func _click(point: Vector2, is_pressed: bool) -> void:
	var event := InputEventMouseButton.new()
	event.button_index = MOUSE_BUTTON_LEFT
	event.pressed = is_pressed
	event.position = point
	event.global_position = point
	event.button_mask = MOUSE_BUTTON_MASK_LEFT if is_pressed else 0
	get_tree().root.push_input(event)


func _move(point: Vector2, mask := 0) -> void:
	var event := InputEventMouseMotion.new()
	event.position = point
	event.global_position = point
	event.button_mask = mask
	get_tree().root.push_input(event)


func _click_box() -> void:
	var boxes := EditorInterface.get_inspector().find_children("*", "CheckBox", true, false).filter(
		func(box: CheckBox) -> bool: return "GnomonShadow3D" in box.tooltip_text)
	_report("the_inspector_has_the_box", boxes.size() == 1)
	if boxes.is_empty():
		return
	var box: CheckBox = boxes[0]
	var section := box.get_parent()
	while section != EditorInterface.get_inspector():
		if section.has_method("unfold"):
			section.unfold()
		section = section.get_parent()
	await _draw(4)
	EditorInterface.get_inspector().ensure_control_visible(box)
	await _draw(4)
	var point := box.get_global_rect().get_center()
	_move(point)
	await _draw(2)
	_click(point, true)
	await _draw(2)
	_click(point, false)
	await _draw(2)


func _drag_size() -> void:
	var viewport := EditorInterface.get_editor_viewport_3d(0)
	var camera := viewport.get_camera_3d()
	var container: Control = viewport.get_parent()
	var to_window := func(point: Vector3) -> Vector2: return container.get_global_rect().position + camera.unproject_position(point)
	var handle: Vector2 = to_window.call(_light.to_global(Vector3(1, -1, 0).normalized() * _light.light_size))
	var target: Vector2 = to_window.call(_light.to_global(Vector3(1, -1, 0).normalized() * 0.5))
	_move(handle)
	await _draw(2)
	_click(handle, true)
	await _draw(2)
	for step in 5:
		_move(handle.lerp(target, (step + 1) / 5.0), MOUSE_BUTTON_MASK_LEFT)
		await _draw(2)
	_click(target, false)
	await _draw(2)
	_report("dragging_the_handle_sets_the_size", absf(_light.light_size - 0.5) < 0.05)


func _undo() -> void:
	get_undo_redo().get_history_undo_redo(get_undo_redo().get_object_history_id(_light)).undo()


func _redo() -> void:
	get_undo_redo().get_history_undo_redo(get_undo_redo().get_object_history_id(_light)).redo()


func _report_saved() -> void:
	var saved := FileAccess.get_file_as_string(SCENE)
	_report("the_saved_scene_has_the_node", "type=\"GnomonShadow3D\" parent=\"Light\"" in saved)
	_report("the_saved_light_has_no_changes_of_the_addon", not "light_specular" in saved and "shadow_enabled = true" in saved and not "visible" in saved)
