@tool
class_name StoreJpeg
extends RefCounted
## Saves images of the store page as JPEG files that are small enough for the repository.

const SIZE_PX := Vector2i(1280, 720)  # of all images: 16:9, as the store requires of thumbnails
const MAX_BYTES := 78 * 1024  # of a file; tests/docs allow 80 KiB


## Saves the image in the best quality that has at most MAX_BYTES, as FOLDER/godot_store_NAME.jpg.
static func save(image: Image, folder: String, image_name: String) -> void:
	image.convert(Image.FORMAT_RGB8)
	var quality := 0.95
	var bytes := image.save_jpg_to_buffer(quality)
	while bytes.size() > MAX_BYTES:
		quality -= 0.02
		bytes = image.save_jpg_to_buffer(quality)
	var file_name := "godot_store_%s.jpg" % image_name
	FileAccess.open(folder.path_join(file_name), FileAccess.WRITE).store_buffer(bytes)
	print("%s: %d bytes, quality %.2f" % [file_name, bytes.size(), quality])
