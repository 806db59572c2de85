class_name FrozenMoment
extends RefCounted
## Images of one moment of a game, which stands still while they are drawn: time, physics, particles and shaders.

const SETTLE_FRAMES := 3  # drawn after a change, before the image is read

## The last frame that was drawn in motion, with Gnomon's shadows.
var moving: Image
## The same moment with Gnomon's shadows, drawn twice: before and after the other images.
var gnomon: Image
var gnomon_again: Image
## With Godot's own shadows.
var godot: Image
## With the lights, without a shadow: that of opacity 0, since Godot lights surfaces by a light's size only if it has a shadow.
var unshadowed: Image
## Without the lights: only ambient light, emission and what is unshaded.
var unlit: Image
## The main light's mask.
var mask: Image


## Draws all images. Call after a frame of the game was drawn.
static func draw(game: Game) -> FrozenMoment:
	var moment := FrozenMoment.new()
	var tree := game.get_tree()
	moment.moving = _read(game)
	tree.paused = true
	Engine.time_scale = 0.0  # stops TIME of shaders
	moment.gnomon = await _draw(game)
	moment.mask = await MaskReader.new(ShadowModes.find_shadow(game.main_light)).read()
	var lights := game.find_lights()
	var energies := lights.map(func(light: Light3D) -> float: return light.light_energy)
	var opacities := lights.map(func(light: Light3D) -> float: return light.shadow_opacity)
	var settings := game.documented_without_shadow.map(func(node: GeometryInstance3D) -> int: return node.cast_shadow)
	_show_shadows(lights, false)
	for node in game.documented_without_shadow:
		node.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	moment.godot = await _draw(game)
	for index in settings.size():
		game.documented_without_shadow[index].cast_shadow = settings[index]
	for light in lights:
		light.shadow_opacity = 0.0
	moment.unshadowed = await _draw(game)
	for light in lights:
		light.light_energy = 0.0
	moment.unlit = await _draw(game)
	for index in lights.size():
		lights[index].light_energy = energies[index]
		lights[index].shadow_opacity = opacities[index]
	_show_shadows(lights, true)
	moment.gnomon_again = await _draw(game)
	Engine.time_scale = 1.0
	tree.paused = false
	return moment


## Stores the images as PNG files whose names begin with `path`.
func save(path: String) -> void:
	godot.save_png(path + "_godot.png")
	gnomon.save_png(path + "_gnomon.png")
	unlit.save_png(path + "_unlit.png")
	unshadowed.save_png(path + "_unshadowed.png")
	var shown: Image = mask.duplicate()
	shown.convert(Image.FORMAT_L8)
	shown.save_png(path + "_mask.png")


static func _show_shadows(lights: Array[Light3D], is_visible: bool) -> void:
	for light in lights:
		ShadowModes.find_shadow(light).visible = is_visible


static func _draw(game: Game) -> Image:
	for frame in SETTLE_FRAMES:
		await RenderingServer.frame_post_draw
	return _read(game)


static func _read(game: Game) -> Image:
	var image := game.get_viewport().get_texture().get_image()
	image.convert(Image.FORMAT_RGB8)
	return image
