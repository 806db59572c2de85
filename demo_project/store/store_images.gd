extends Node
## Draws images of the add-on's store page (doc/godot_store.md) and saves them as JPEG files:
##   godot --path PROJECT res://store/store_images.tscn -- out=DIR only=NAME
## godot_store_thumbnail.jpg is halved: left are Godot's own shadows of its best quality, Soft Ultra, right are Gnomon's. Also saves its scene,
## res://store/cage.tscn, for the editor. godot_store_details.jpg has two parts of the room, each with Godot's shadows and with Gnomon's, and
## godot_store_room.jpg the room with Gnomon's. Without only=, all are drawn.

const SIZE_PX := StoreJpeg.SIZE_PX
const SETTLE_FRAMES := 4  # drawn after a change, before the image is read
const ROOM_TIME_S := 2.0  # as in measure_room.gd
const ROOM_FOV_DEGREES := 40.0
## The camera's position and its target, of the room and of its parts.
const ROOM_VIEW: Array[Vector3] = [Vector3(0.2, 1.9, 6.3), Vector3(0.2, 1.15, 0)]
const DETAIL_VIEWS: Array[Array] = [
	[Vector3(-1.4, 1.3, 1.6), Vector3(-3.5, 0.75, -1.5)],
	[Vector3(0.5, 1.1, 3.3), Vector3(-0.4, 0.12, 1.4)],
]

var _options := StudyOptions.new({"out": "res://out", "only": ""})
var _viewport := SubViewport.new()


func _ready() -> void:
	if not _options.read():
		get_tree().quit(2)
		return
	_viewport.size = SIZE_PX
	_viewport.own_world_3d = true
	_viewport.msaa_3d = Viewport.MSAA_4X
	_viewport.positional_shadow_atlas_size = 4096  # as of a game's main viewport
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	add_child(_viewport)
	if _wants("thumbnail"):
		await _draw_thumbnail()
	if _wants("room") or _wants("details"):
		await _draw_room()
	get_tree().quit()


func _wants(image: String) -> bool:
	return _options.text("only") in ["", image]


func _draw_thumbnail() -> void:
	var scene := StoreCage.create()
	var packed := PackedScene.new()
	packed.pack(scene)
	ResourceSaver.save(packed, "res://store/cage.tscn")
	_viewport.add_child(scene)
	var lights: Array[Light3D] = [scene.get_node("Spot")]
	StoreJpeg.save(await _draw_halves(lights), _options.text("out"), "thumbnail")
	scene.free()


func _draw_room() -> void:
	var room: Room = load("res://room/room.tscn").instantiate()
	room.is_moving = false
	_viewport.add_child(room)
	while not room.has_textures():
		await RenderingServer.frame_post_draw
	room.show_time(ROOM_TIME_S)
	var camera := Camera3D.new()
	_viewport.add_child(camera)
	camera.make_current()
	camera.fov = ROOM_FOV_DEGREES
	var lights := room.get_lights()
	if _wants("room"):
		camera.look_at_from_position(ROOM_VIEW[0], ROOM_VIEW[1])
		ShadowModes.apply(lights, "gnomon")
		StoreJpeg.save(await _draw(), _options.text("out"), "room")
	if _wants("details"):
		StoreJpeg.save(await _draw_details(camera, lights), _options.text("out"), "details")
	camera.free()
	room.free()


## Draws each of DETAIL_VIEWS with Godot's own shadows, on the left, and with Gnomon's.
func _draw_details(camera: Camera3D, lights: Array[Light3D]) -> Image:
	var part := SIZE_PX / 2
	_viewport.size = part
	var image := Image.create_empty(SIZE_PX.x, SIZE_PX.y, false, Image.FORMAT_RGB8)
	for row in DETAIL_VIEWS.size():
		camera.look_at_from_position(DETAIL_VIEWS[row][0], DETAIL_VIEWS[row][1])
		for column in 2:
			ShadowModes.apply(lights, ["ultra", "gnomon"][column])
			image.blit_rect(await _draw(), Rect2i(Vector2i.ZERO, part), part * Vector2i(column, row))
	_viewport.size = SIZE_PX
	image.fill_rect(Rect2i(part.x - 1, 0, 2, SIZE_PX.y), Color.WHITE)
	image.fill_rect(Rect2i(0, part.y - 1, SIZE_PX.x, 2), Color.WHITE)
	return image


## Draws the scene with Godot's own shadows and with Gnomon's, and joins the left half of the first image and the right half of the second.
func _draw_halves(lights: Array[Light3D]) -> Image:
	ShadowModes.apply(lights, "ultra")
	var image := await _draw()
	ShadowModes.apply(lights, "gnomon")
	var gnomon := await _draw()
	var half := Vector2i(SIZE_PX.x / 2, 0)
	image.blit_rect(gnomon, Rect2i(half, SIZE_PX - half), half)
	image.fill_rect(Rect2i(half.x - 1, 0, 2, SIZE_PX.y), Color.WHITE)
	return image


func _draw() -> Image:
	for frame in SETTLE_FRAMES:
		await RenderingServer.frame_post_draw
	var image := _viewport.get_texture().get_image()
	image.convert(Image.FORMAT_RGB8)
	return image
