extends Node
## Stores screenshots of three_lights.tscn: the image, and each light's mask.
##   godot --path demo_project/godot res://study/screenshots.tscn -- out=DIR size=512

const SETTLE_FRAMES := 3  # drawn after a change, before the image is read

var _options := StudyOptions.new({"out": "res://out", "size": "512"})


func _ready() -> void:
	if not _options.read():
		get_tree().quit(2)
		return
	var scene: Node3D = load("res://three_lights.tscn").instantiate()
	add_child(scene)
	var shadows := {}
	for light in ["Spot", "Omni", "Sun"]:
		shadows[light] = scene.get_node("Model/%s/Shadow" % light)
		shadows[light].show_mask = false
	await _store("three_lights.png")
	for light: String in shadows:
		shadows[light].show_mask = true
		await _store("three_lights_%s.png" % light.to_lower())
		shadows[light].show_mask = false
	get_tree().quit()


func _store(file_name: String) -> void:
	for frame in SETTLE_FRAMES:
		await RenderingServer.frame_post_draw
	get_viewport().get_texture().get_image().save_png(_options.path(file_name))
