extends Node
## Runs the tests of the add-on: functions named test_* of the scripts below. Arguments: names of tests; none: all. Prints PASS or FAIL for each.

## Godot compiles each new material for all kinds of views and effects that were drawn before, so tests that draw many come last.
const CASES: Array[GDScript] = [
	preload("res://tests/frames.gd"),
	preload("res://tests/platforms.gd"),
	preload("res://tests/casters.gd"),
	preload("res://tests/skeletons.gd"),
	preload("res://tests/nodes.gd"),
	preload("res://tests/settings.gd"),
	preload("res://tests/lights.gd"),
	preload("res://tests/moved_vertices.gd"),
	preload("res://tests/likeness.gd"),
	preload("res://tests/materials.gd"),
	preload("res://tests/views.gd"),
	preload("res://tests/surroundings.gd"),
	preload("res://tests/multisampling.gd"),
]


func _ready() -> void:
	DisplayServer.window_set_size(Vector2i(200, 200))  # tests expect masks of this size
	var requested := OS.get_cmdline_user_args()
	for script in CASES:
		for method in script.get_script_method_list():
			if method.name.begins_with("test_") and (requested.is_empty() or method.name in requested):
				await _run(script, method.name)
	get_tree().quit()


func _run(script: GDScript, method: String) -> void:
	var case: AddonTest = script.new()
	add_child(case)
	var begin_ms := Time.get_ticks_msec()
	await case.call(method)
	print("TIME %s %.1f s" % [method, 1e-3 * (Time.get_ticks_msec() - begin_ms)])
	if case.failures.is_empty():
		print("PASS ", method)
	for failure in case.failures:
		print("FAIL %s: %s" % [method, failure])
	case.queue_free()
	await get_tree().process_frame
