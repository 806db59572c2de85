extends Node
## Renders cases and stores their masks and scenes, which tests compare with those of `gnomon`:
##   godot --path demo_project/godot res://study/runner.tscn -- out=DIR size=800 cases=omni/box/edge_count,...
## A case is one of these:
##   LIGHT/CASTER/TECHNIQUE     a light and a caster of StudyScene
##   imported/LIGHT/TECHNIQUE   a light of three_lights.tscn
##   PATH.gltf/LIGHT/TECHNIQUE  a light of a glTF file; LIGHT@SECONDS poses the file's animation at that time
## It stores the mask LIGHT_CASTER_TECHNIQUE.f32 (float32, rows from the top, -1: no receiver) and the scene LIGHT_CASTER.gltf.
## Instead of LIGHT_CASTER, names begin with imported_LIGHT or FILE_LIGHT. Posed scenes are not stored.
## Without cases= it renders
##   all cases of StudyScene with each of TECHNIQUES
##   the lights of three_lights.tscn, and those of file_lights=PATH.gltf/LIGHT,..., with edge_count
##   the lights of cut_out_lights=PATH.gltf/LIGHT,... with each of CUT_OUT_TECHNIQUES

const IMPORTED := "imported"
const IMPORTED_LIGHTS: Array[String] = ["Spot", "Omni", "Sun"]
const TECHNIQUES: Array[String] = ["edge_count", "pcss", "penumbra_fins", "shadow_volume"]
const CUT_OUT_TECHNIQUES: Array[String] = ["edge_count", "pcss"]

var _options := StudyOptions.new({"out": "res://out", "size": "800", "cases": "", "file_lights": "", "cut_out_lights": ""})


func _ready() -> void:
	if not _options.read():
		get_tree().quit(2)
		return
	for case in _list_cases():
		await _run_case(case)
	get_tree().quit()


func _list_cases() -> PackedStringArray:
	if not _options.text("cases").is_empty():
		return _options.text("cases").split(",")
	var cases := PackedStringArray()
	for light in StudyScene.LIGHTS:
		for caster in StudyScene.CASTERS:
			for technique in TECHNIQUES:
				cases.append("%s/%s/%s" % [light, caster, technique])
	for light in IMPORTED_LIGHTS:
		cases.append("%s/%s/edge_count" % [IMPORTED, light])
	for light in _options.text("file_lights").split(",", false):
		cases.append("%s/edge_count" % light)
	for light in _options.text("cut_out_lights").split(",", false):
		for technique in CUT_OUT_TECHNIQUES:
			cases.append("%s/%s" % [light, technique])
	return cases


func _run_case(case: String) -> void:
	var parts := case.rsplit("/", true, 2)
	var stem := "%s_%s" % [parts[0].get_file().get_basename(), parts[1]]
	var scene: Node3D
	var shadow: Node3D
	if parts[0] == IMPORTED:
		scene = load("res://three_lights.tscn").instantiate()
		shadow = scene.get_node("Model/%s/Shadow" % parts[1])
	elif parts[0].ends_with(".gltf"):
		scene = GltfImport.load_scene(parts[0])
		shadow = scene.find_child(parts[1].get_slice("@", 0), true, false).find_child("Shadow", false, false)
	else:
		scene = StudyScene.create(parts[0], parts[1])
		shadow = scene.shadow
	add_child(scene)
	var is_posed := "@" in parts[1]
	if is_posed:
		GltfImport.show_time(scene, float(parts[1].get_slice("@", 1)))
	shadow.technique = parts[2]
	var shadows := scene.find_children("Shadow", "GnomonShadow3D", true, false)
	for other: Node3D in shadows:
		other.visible = other == shadow
	await _wait_for_casters(shadow)
	var reader := MaskReader.new(shadow)
	_options.store_bytes("%s_%s.f32" % [stem, parts[2]], (await reader.read()).get_data())
	for other: Node3D in shadows:
		other.visible = true  # `gnomon` does not read files with hidden nodes
	if not is_posed:  # a posed scene is compared with its own file
		GltfExport.save(scene, _options.path(stem + ".gltf"))
	scene.queue_free()
	await get_tree().process_frame


## Waits until all meshes cast shadows. Large ones do so some frames after they appear.
func _wait_for_casters(shadow: Node3D) -> void:
	await RenderingServer.frame_post_draw
	while shadow.count_pending_casters() > 0:
		await RenderingServer.frame_post_draw
