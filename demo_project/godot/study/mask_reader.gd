class_name MaskReader
extends RefCounted
## Reads the mask of a GnomonShadow3D that is visible in exactly one view.

var camera: Transform3D
var _shadow: Node3D
var _mask: Image


func _init(shadow: Node3D) -> void:
	_shadow = shadow


## Returns the mask of a frame that is drawn after the call, and sets `camera` to that frame's camera.
func read() -> Image:
	_mask = null
	_shadow.read_masks(_on_mask_read)
	while _mask == null:
		await RenderingServer.frame_post_draw
	return _mask


func _on_mask_read(mask: Image, from: Transform3D) -> void:
	_mask = mask
	camera = from
