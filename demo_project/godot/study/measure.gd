extends Node
## Measures images with Gnomon's shadows and with Godot's own in the study scenes, and in glTF files that `gnomon` reads:
##   godot --path demo_project/godot res://study/measure.tscn -- out=DIR size=800 frames=20 technique=edge_count cases=omni_box
##         scenes=A.gltf,B.gltf
## A case is a light and a caster, or a file and one of its lights. Modes are gnomon, and low and ultra for Godot's own shadows.
##   CASE_MODE.f32  image with shadow / image without (red channel), float32, rows from the top; -1 where the image without
##                  shadow is darker than MIN_LIT
##   CASE.gltf      the scene
##   cases.json     of each case the light's name, and for each mode and "off" (without shadows) the median frame time
##                  in ms while the light moves

const MIN_LIT := 1e-4  # linear

var _options := StudyOptions.new({"out": "res://out", "size": "800", "frames": "20", "cases": "", "scenes": "", "technique": "edge_count"})
var _cases := {}


func _ready() -> void:
	if not _options.read():
		get_tree().quit(2)
		return
	get_viewport().use_hdr_2d = true  # linear images
	for light in StudyScene.LIGHTS:
		for caster in StudyScene.CASTERS:
			var case := "%s_%s" % [light, caster]
			if _options.text("cases").is_empty() or case in _options.text("cases").split(","):
				await _measure_study(case, StudyScene.create(light, caster))
	for path in _options.text("scenes").split(",", false):
		await _measure_file(path)
	_options.store_text("cases.json", JSON.stringify(_cases, "\t"))
	get_tree().quit()


func _measure_study(case: String, scene: StudyScene) -> void:
	add_child(scene)
	await _measure(case, scene.light)
	GltfExport.save(scene, _options.path(case + ".gltf"))
	await _remove(scene)


## Measures each light of a file alone.
func _measure_file(path: String) -> void:
	var scene := GltfImport.load_scene(path)
	scene.add_child(StudyScene.make_darkness())
	add_child(scene)
	var lights := scene.find_children("*", "Light3D", true, false)
	for shown: Light3D in lights:
		for light: Light3D in lights:
			light.visible = light == shown
		var case := "%s_%s" % [path.get_file().get_basename(), shown.name]
		await _measure(case, shown)
		for light: Light3D in lights:
			light.visible = true  # `gnomon` does not read files with hidden nodes
		GltfExport.save(scene, _options.path(case + ".gltf"))
	await _remove(scene)


func _remove(scene: Node) -> void:
	scene.queue_free()
	await get_tree().process_frame


func _measure(case: String, light: Light3D) -> void:
	ShadowModes.find_shadow(light).technique = _options.text("technique")
	var times := {}
	var lit: Image
	for mode in ShadowModes.ALL:
		ShadowModes.apply([light], mode)
		times[mode] = await _time_moving(light)
		if mode == "off":
			# Godot lights surfaces by a light's size only if it has a shadow, so this shadow has no opacity.
			var opacity := light.shadow_opacity
			light.shadow_enabled = true
			light.shadow_opacity = 0.0
			lit = await _draw()
			light.shadow_enabled = false
			light.shadow_opacity = opacity
		else:
			_options.store_bytes("%s_%s.f32" % [case, mode], _divide(await _draw(), lit))
	_cases[case] = {"light": light.name, "times": times}


## Returns the median time in milliseconds of a frame in which the light moves: by up to 6 cm and 0.5 degrees, to and fro.
func _time_moving(light: Light3D) -> float:
	var original := light.transform
	var time := await FrameTimes.measure(int(_options.text("frames")), func(frame: int) -> void:
		light.transform = original.translated(Vector3(0.01 * (frame % 7), 0, 0)).rotated_local(Vector3.UP, 0.002 * (frame % 5)))
	light.transform = original
	return time


## Returns the red channel of a frame with the light at its original position.
func _draw() -> Image:
	await RenderingServer.frame_post_draw
	await RenderingServer.frame_post_draw
	var image := get_viewport().get_texture().get_image()
	image.convert(Image.FORMAT_RF)
	return image


func _divide(image: Image, lit: Image) -> PackedByteArray:
	var quotients := image.get_data().to_float32_array()
	var unshadowed := lit.get_data().to_float32_array()
	for index in unshadowed.size():
		quotients[index] = clampf(quotients[index] / unshadowed[index], 0.0, 1.0) if unshadowed[index] > MIN_LIT else -1.0
	return quotients.to_byte_array()
