@tool
class_name LightImages
extends RefCounted
## Stores the images of one view that are needed to compare the shadow of a light's GnomonShadow3D with the reference.

const SETTLED_FRAMES := 12


## Stores linear float32 images of the red channel, rows from the top: NAME_shadow.f32, NAME_lit.f32 without the shadow, NAME_dark.f32
## without the light. NAME.gltf is the scene with a camera ViewCamera that sees what the view does.
static func store(name: String, viewport: Viewport, scene: Node, light: Light3D) -> void:
	viewport.use_hdr_2d = true
	await _store_image(name + "_shadow", viewport)
	light.shadow_enabled = false
	await _store_image(name + "_lit", viewport)
	light.visible = false
	await _store_image(name + "_dark", viewport)
	light.visible = true
	light.shadow_enabled = true
	viewport.use_hdr_2d = false
	await _settle(viewport)
	var copy := scene.duplicate(0)  # includes unsaved changes; 0: no signals, groups or scripts
	var seen := viewport.get_camera_3d()
	var camera := Camera3D.new()
	camera.name = "ViewCamera"
	camera.fov = seen.fov
	camera.near = seen.near
	camera.far = seen.far
	camera.transform = seen.global_transform
	viewport.add_child(copy)
	copy.add_child(camera)
	for node in copy.find_children("*", "", true, false):
		node.owner = copy  # nodes without an owner are not exported
	print("SIZE %s %d %d" % [name, viewport.size.x, viewport.size.y])
	GltfExport.save(copy, "res://%s.gltf" % name)
	copy.free()


## Waits for process frames, because the editor draws only when something changes.
static func _settle(viewport: Viewport) -> void:
	for frame in SETTLED_FRAMES:
		await viewport.get_tree().process_frame


static func _store_image(name: String, viewport: Viewport) -> void:
	await _settle(viewport)
	var image := viewport.get_texture().get_image()
	image.convert(Image.FORMAT_RF)
	FileAccess.open("res://%s.f32" % name, FileAccess.WRITE).store_buffer(image.get_data())
