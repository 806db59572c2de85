class_name GltfImport
extends RefCounted
## Loads glTF files that `gnomon` reads while the project runs. Their lights get the size that their extras define, and a
## GnomonShadow3D.


static func load_scene(path: String) -> Node3D:
	var document := GLTFDocument.new()
	var state := GLTFState.new()
	if document.append_from_file(path, state) != OK:
		return null
	var root: Node3D = document.generate_scene(state)
	_finish_textures(root, path.get_file().get_basename())
	var described: Array = state.json.extensions.KHR_lights_punctual.lights
	for node: Dictionary in state.json.nodes:
		var reference: Dictionary = node.get("extensions", {}).get("KHR_lights_punctual", {})
		if not reference.is_empty():
			_add_shadow(root.find_child(node.name, true, false), described[int(reference.light)])
	return root


## Poses the scene, which must be in the tree, with its only animation at a time in seconds, and pauses it there.
static func show_time(root: Node3D, seconds: float) -> void:
	var player: AnimationPlayer = root.find_children("*", "AnimationPlayer", true, false)[0]
	player.play(player.get_animation_list()[0])
	player.seek(seconds, true)
	player.pause()


## Adds mip levels to textures, which GLTFDocument does not do. Without them Godot cuts out other pixels of leaves than `gnomon`.
## Also makes the names of textures unique: GLTFDocument only numbers them, so exports of two scenes to one folder would
## overwrite each other's images.
static func _finish_textures(root: Node3D, stem: String) -> void:
	var finished: Array[ImageTexture] = []
	for node: MeshInstance3D in root.find_children("*", "MeshInstance3D", true, false):
		for surface in node.mesh.get_surface_count():
			var material := node.mesh.surface_get_material(surface) as BaseMaterial3D
			var texture := material.albedo_texture as ImageTexture if material != null else null
			if texture != null and texture not in finished:
				finished.append(texture)
				texture.resource_name = "%s_%s" % [stem, texture.resource_name]
				var image := texture.get_image()
				image.generate_mipmaps()
				texture.set_image(image)


## Sets the light's size, by default that of `gnomon`, and adds a GnomonShadow3D.
static func _add_shadow(light: Light3D, described: Dictionary) -> void:
	var extras: Dictionary = described.get("extras", {})
	if light is DirectionalLight3D:
		light.light_angular_distance = extras.get("light_angular_distance", 0.5)
	else:
		light.light_size = extras.get("light_size", 0.1)
	light.shadow_enabled = true
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	shadow.name = "Shadow"
	shadow.cast_back_faces = true # as in `gnomon`
	light.add_child(shadow)
