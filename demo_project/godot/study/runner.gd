extends Node
## Renders study cases and stores what came out, for measurements outside:
##   godot --path demo_project/godot res://study/runner.tscn -- out=DIR size=800 cases=omni/box/edge_count,...
## Of each case: LIGHT_CASTER_TECHNIQUE.f32, the mask (float32, rows from the top, -1: no receiver), and once for each
## light and caster the scene as LIGHT_CASTER.gltf. Without cases: all.

const TECHNIQUES: Array[String] = ["edge_count", "pcss", "penumbra_fins", "shadow_volume"]

var _options := {"out": "res://out", "size": "800", "cases": ""}
var _mask: Image


func _ready() -> void:
	for argument in OS.get_cmdline_user_args():
		var parts := argument.split("=", true, 1)
		if parts.size() != 2 or not _options.has(parts[0]):
			printerr("ERROR: %s: must be out=DIR, size=PIXELS or cases=LIGHT/CASTER/TECHNIQUE,..." % argument)
			get_tree().quit(2)
			return
		_options[parts[0]] = parts[1]
	DirAccess.make_dir_recursive_absolute(_options.out)
	var size := int(_options.size)
	DisplayServer.window_set_size(Vector2i(size, size))
	for case in _list_cases():
		await _run_case(case)
	get_tree().quit()


func _list_cases() -> PackedStringArray:
	if not _options.cases.is_empty():
		return _options.cases.split(",")
	var cases := PackedStringArray()
	for light in StudyScene.LIGHTS:
		for caster in StudyScene.CASTERS:
			for technique in TECHNIQUES:
				cases.append("%s/%s/%s" % [light, caster, technique])
	return cases


func _run_case(case: String) -> void:
	var parts := case.split("/")
	var scene := StudyScene.create(parts[0], parts[1])
	add_child(scene)
	scene.shadow.technique = parts[2]
	var mask := await _read_mask(scene)
	var file := FileAccess.open("%s/%s.f32" % [_options.out, "_".join(parts)], FileAccess.WRITE)
	file.store_buffer(mask.get_data())
	var gltf := "%s/%s_%s.gltf" % [_options.out, parts[0], parts[1]]
	if not FileAccess.file_exists(gltf):
		GltfExport.save(scene, gltf)
	scene.queue_free()
	await get_tree().process_frame


func _read_mask(scene: StudyScene) -> Image:
	_mask = null
	scene.shadow.read_masks(_keep_mask)
	while _mask == null:
		await RenderingServer.frame_post_draw
	return _mask


func _keep_mask(mask: Image, _camera: Transform3D) -> void:
	_mask = mask
