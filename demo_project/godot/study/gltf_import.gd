class_name GltfImport
extends RefCounted
## Loads glTF files of `gnomon` while the project runs: what their lights' extras say of the size, and a GnomonShadow3D for
## each.


static func load_scene(path: String) -> Node3D:
	var document := GLTFDocument.new()
	var state := GLTFState.new()
	if document.append_from_file(path, state) != OK:
		return null
	var root: Node3D = document.generate_scene(state)
	var described: Array = state.json.extensions.KHR_lights_punctual.lights
	for node: Dictionary in state.json.nodes:
		var reference: Dictionary = node.get("extensions", {}).get("KHR_lights_punctual", {})
		if not reference.is_empty():
			_add_shadow(root.find_child(node.name, true, false), described[int(reference.light)])
	return root


static func _add_shadow(light: Light3D, described: Dictionary) -> void:
	var extras: Dictionary = described.get("extras", {})
	if light is DirectionalLight3D:
		light.light_angular_distance = extras.get("light_angular_distance", 0.5)
	else:
		light.light_size = extras.get("light_size", 0.1)
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	shadow.name = "Shadow"
	light.add_child(shadow)
