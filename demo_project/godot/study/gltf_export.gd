@tool
class_name GltfExport
extends RefCounted
## Writes a scene as glTF that `gnomon` reads: Godot's own export, corrected where it is not exact, with extras for what glTF
## lacks: the sizes of lights, and whether a mesh casts shadows.


static func save(root: Node, path: String) -> Error:
	var document := GLTFDocument.new()
	var state := GLTFState.new()
	var error := document.append_from_scene(root, state)
	if error == OK:
		error = document.write_to_filesystem(state, path)
	if error != OK:
		return error
	var gltf: Dictionary = JSON.parse_string(FileAccess.get_file_as_string(path))
	for index in (gltf.nodes as Array).size():
		_describe_node(gltf, gltf.nodes[index], state.get_scene_node(index) as Node3D)
	var file := FileAccess.open(path, FileAccess.WRITE)
	file.store_string(JSON.stringify(gltf, "\t", false, true))  # unsorted keys, full precision
	return OK


## Writes the transform, and for cameras the field of view, with which Godot itself draws. Godot's export rounds a basis to a
## quaternion, and its field of view does not give exactly the same projection.
static func _describe_node(gltf: Dictionary, described: Dictionary, node: Node3D) -> void:
	if node == null:
		return
	for part: String in ["translation", "rotation", "scale"]:
		described.erase(part)
	var basis := node.basis.orthonormalized() if node is Light3D else node.basis  # Godot ignores the scale of lights
	var columns: Array[Vector3] = [basis.x, basis.y, basis.z, node.position]
	var matrix: Array[float] = []
	for index in 4:
		var column := columns[index]
		matrix.append_array([column.x, column.y, column.z, 1.0 if index == 3 else 0.0])
	described["matrix"] = matrix
	if node is Light3D:
		_describe_light(gltf, described, node)
	elif node is Camera3D:
		var projection := (node as Camera3D).get_camera_projection()
		gltf.cameras[int(described.camera)].perspective.yfov = 2.0 * atan(1.0 / projection.y.y)
	elif node is GeometryInstance3D:
		var setting := (node as GeometryInstance3D).cast_shadow
		described["extras"] = {"casts_shadow": setting != GeometryInstance3D.SHADOW_CASTING_SETTING_OFF}


static func _describe_light(gltf: Dictionary, described: Dictionary, light: Light3D) -> void:
	var in_file: Dictionary = gltf.extensions.KHR_lights_punctual.lights[int(described.extensions.KHR_lights_punctual.light)]
	in_file["name"] = described.name
	if light is DirectionalLight3D:
		in_file["extras"] = {"light_angular_distance": light.light_angular_distance}
	else:
		in_file["extras"] = {"light_size": light.light_size}
		in_file["range"] = light.get_param(Light3D.PARAM_RANGE)
