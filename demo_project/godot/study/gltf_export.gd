class_name GltfExport
extends RefCounted
## Writes a scene as glTF that `gnomon` reads: Godot's own export, and in each light's extras what glTF has no word for.


static func save(root: Node, path: String) -> Error:
	var document := GLTFDocument.new()
	var state := GLTFState.new()
	var error := document.append_from_scene(root, state)
	if error == OK:
		error = document.write_to_filesystem(state, path)
	if error != OK:
		return error
	var gltf: Dictionary = JSON.parse_string(FileAccess.get_file_as_string(path))
	_describe_lights(gltf, root)
	_place_exactly(gltf, root)
	var file := FileAccess.open(path, FileAccess.WRITE)
	file.store_string(JSON.stringify(gltf, "\t", false, true))
	return OK


static func _describe_lights(gltf: Dictionary, root: Node) -> void:
	var lights: Array = gltf.extensions.KHR_lights_punctual.lights
	for node: Dictionary in gltf.nodes:
		var reference: Dictionary = node.get("extensions", {}).get("KHR_lights_punctual", {})
		if reference.is_empty():
			continue
		var light: Light3D = root.find_child(node.name, true, false)
		var described: Dictionary = lights[int(reference.light)]
		described["name"] = node.name
		if light is DirectionalLight3D:
			described["extras"] = {"light_angular_distance": light.light_angular_distance}
		else:
			described["extras"] = {"light_size": light.light_size}
			described["range"] = light.get_param(Light3D.PARAM_RANGE)


## Godot's export rounds a basis to a quaternion, and an angle is no projection: what Godot itself draws with.
static func _place_exactly(gltf: Dictionary, root: Node) -> void:
	for described: Dictionary in gltf.nodes:
		var node := root.find_child(described.name, true, false) as Node3D
		if node == null:
			continue
		for part: String in ["translation", "rotation", "scale"]:
			described.erase(part)
		var basis := node.basis.orthonormalized() if node is Light3D else node.basis  # as Godot places lights
		var columns: Array[Vector3] = [basis.x, basis.y, basis.z, node.position]
		var matrix: Array[float] = []
		for index in 4:
			var column := columns[index]
			matrix.append_array([column.x, column.y, column.z, 1.0 if index == 3 else 0.0])
		described["matrix"] = matrix
		if node is Camera3D:
			var projection := (node as Camera3D).get_camera_projection()
			gltf.cameras[int(described.camera)].perspective.yfov = 2.0 * atan(1.0 / projection.y.y)
