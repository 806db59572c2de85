extends Node
## Measures images with Gnomon's shadows and with Godot's own in the study scenes:
##   godot --path demo_project/godot res://study/measure.tscn -- out=DIR size=800 frames=20
## Of each light and caster LIGHT_CASTER_MODE.f32, the share of the light that the shadow leaves (image with shadow / image
## without; -1 where the light does not shine), with mode gnomon, and low and ultra for Godot's own; LIGHT_CASTER.gltf, and in
## times.json the milliseconds of a frame in which the light moves (medians), by mode.

const WARM_UP_FRAMES := 10
## RenderingServer.SHADOW_QUALITY_*; the size of the light counts from SOFT_LOW on.
const QUALITIES := {"low": RenderingServer.SHADOW_QUALITY_SOFT_LOW, "ultra": RenderingServer.SHADOW_QUALITY_SOFT_ULTRA}
const MODES: Array[String] = ["off", "low", "ultra", "gnomon"]

var _options := StudyOptions.new({"out": "res://out", "size": "800", "frames": "20", "cases": "", "technique": "edge_count"})
var _times := {}


func _ready() -> void:
	if not _options.read():
		get_tree().quit(2)
		return
	get_viewport().use_hdr_2d = true  # linear images
	for light in StudyScene.LIGHTS:
		for caster in StudyScene.CASTERS:
			var case := "%s_%s" % [light, caster]
			if _options.text("cases").is_empty() or case in _options.text("cases").split(","):
				await _measure(case, StudyScene.create(light, caster))
	_options.store_text("times.json", JSON.stringify(_times, "\t"))
	get_tree().quit()


func _measure(case: String, scene: StudyScene) -> void:
	add_child(scene)
	scene.shadow.technique = _options.text("technique")
	var times := {}
	var lit: Image
	for mode in MODES:
		_set_mode(scene, mode)
		times[mode] = await _time_moving(scene)
		await RenderingServer.frame_post_draw
		await RenderingServer.frame_post_draw
		var image := get_viewport().get_texture().get_image()
		image.convert(Image.FORMAT_RF)
		if mode == "off":
			lit = image
		else:
			_options.store_values("%s_%s.f32" % [case, mode], _divide(image, lit))
	_times[case] = times
	GltfExport.save(scene, _options.path(case + ".gltf"))
	scene.queue_free()
	await get_tree().process_frame


func _set_mode(scene: StudyScene, mode: String) -> void:
	scene.shadow.visible = mode == "gnomon"
	scene.light.shadow_enabled = QUALITIES.has(mode)
	if QUALITIES.has(mode):
		RenderingServer.positional_soft_shadow_filter_set_quality(QUALITIES[mode])
		RenderingServer.directional_soft_shadow_filter_set_quality(QUALITIES[mode])


## The median of a frame's milliseconds.
func _time_moving(scene: StudyScene) -> float:
	var place := scene.light.transform
	var samples: Array[float] = []
	var before := 0
	for frame in WARM_UP_FRAMES + int(_options.text("frames")) + 1:
		scene.light.transform = place.translated(Vector3(0.01 * (frame % 7), 0, 0)).rotated_local(Vector3.UP, 0.002 * (frame % 5))
		await RenderingServer.frame_post_draw
		var now := Time.get_ticks_usec()
		if frame > WARM_UP_FRAMES:
			samples.append((now - before) / 1000.0)
		before = now
	scene.light.transform = place
	samples.sort()
	return samples[samples.size() / 2]


func _divide(image: Image, lit: Image) -> PackedByteArray:
	var shadowed := image.get_data().to_float32_array()
	var all := lit.get_data().to_float32_array()
	for index in all.size():
		shadowed[index] = clampf(shadowed[index] / all[index], 0.0, 1.0) if all[index] > 1e-4 else -1.0
	return shadowed.to_byte_array()
