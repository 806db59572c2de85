class_name MaskReader
extends RefCounted
## Waits for the mask of a GnomonShadow3D that one view shows.

var camera: Transform3D
var _shadow: Node3D
var _mask: Image


func _init(shadow: Node3D) -> void:
	_shadow = shadow


## Of a frame that is drawn from now on.
func read() -> Image:
	_mask = null
	_shadow.read_masks(_keep)
	while _mask == null:
		await RenderingServer.frame_post_draw
	return _mask


func _keep(mask: Image, from: Transform3D) -> void:
	_mask = mask
	camera = from
