extends Node
## Measures images with Gnomon's shadows and with Godot's own in the study scenes:
##   godot --path demo_project/godot res://study/measure.tscn -- out=DIR size=800 frames=20
## Of each light and caster LIGHT_CASTER_MODE.f32, the share of the light that the shadow leaves (image with shadow / image
## without; -1 where the light does not shine), with mode gnomon, and low and ultra for Godot's own; LIGHT_CASTER.gltf, and in
## times.json the milliseconds of a frame in which the light moves (medians), by mode.

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
	for mode in ShadowModes.ALL:
		ShadowModes.apply([scene.light], mode)
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


## The median of a frame's milliseconds.
func _time_moving(scene: StudyScene) -> float:
	var place := scene.light.transform
	var time := await FrameTimes.measure(int(_options.text("frames")), func(frame: int) -> void:
		scene.light.transform = place.translated(Vector3(0.01 * (frame % 7), 0, 0)).rotated_local(Vector3.UP, 0.002 * (frame % 5)))
	scene.light.transform = place
	return time


func _divide(image: Image, lit: Image) -> PackedByteArray:
	var shadowed := image.get_data().to_float32_array()
	var all := lit.get_data().to_float32_array()
	for index in all.size():
		shadowed[index] = clampf(shadowed[index] / all[index], 0.0, 1.0) if all[index] > 1e-4 else -1.0
	return shadowed.to_byte_array()
