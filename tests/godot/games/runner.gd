extends Node
## Plays one game. Arguments: its name, and a folder for images. In each frame of COMPARED the game is frozen, and Gnomon's image is
## compared with Godot's. Prints "PASS check" or "FAIL check: text" for each of CHECKS, "MEASURED ..." with the numbers of pixels of
## each compared frame, and "GROWTH ..." with Godot's counts every LOOP_FRAMES.
##
## no_black: Gnomon's image has no black pixel that Godot's shadow leaves lit.
## ambient_light: it is nowhere darker than the image without the lights. no_leak: it is nowhere brighter than without shadows.
## no_false_shadow, no_missing_shadow: the lights' share of each pixel is between those that pixels near it have with Godot's shadow.
## as_godot: the reverse, so that a shadow of Gnomon that is too soft or too coarse also fails.
## stands_still: two images of one moment are equal. moves_without_lag: so are the frame in motion and the frozen one.
## has_shadow: the main light's mask has lit pixels and pixels in shadow.

const GAMES: Dictionary[String, GDScript] = {
	"platformer": preload("res://tests/platformer.gd"),
	"city": preload("res://tests/city.gd"),
	"third_person": preload("res://tests/third_person.gd"),
	"particles": preload("res://tests/particles.gd"),
	"forest": preload("res://tests/forest.gd"),
}
const SIZE := Vector2i(240, 135)
const FRAMES := 300
const COMPARED: Array[int] = [50, 130, 210, 290]  # at four steps of the loop of 100 frames; the first before counts are compared

const ROUNDING := 2  # of 255: one step for each of two images
const BLACK := 6  # of 255: below the ambient light on every material of the games
const LIT := 40  # of 255
const SHARE_TOLERANCE := 0.25
const LEAST_SHADOW_PX := 100  # of 32,400
const LEAST_FLAT_PX := 8000
const MOST_GODOT_PX := 160  # in which Godot's shadow may be darker or lighter; 65 were measured
const CHECKS: Array[String] = [
	"no_black", "ambient_light", "no_leak", "no_false_shadow", "no_missing_shadow", "as_godot", "stands_still", "moves_without_lag", "has_shadow",
]

var _failures: Dictionary[String, String] = {}
var _game: Game
var _name: String


func _ready() -> void:
	var arguments := OS.get_cmdline_user_args()
	_name = arguments[0]
	DisplayServer.window_set_size(SIZE)
	RenderingServer.directional_shadow_atlas_set_size(2048, true)  # the default 4096 costs a software driver too much
	_game = GAMES[_name].new()
	_game.name = "Game"
	add_child(_game)
	while _game.frame < FRAMES:
		await RenderingServer.frame_post_draw
		if _game.frame in COMPARED:
			await _compare(arguments[1])
		if _game.frame % Game.LOOP_FRAMES == 0:
			_print_counts()
	for check in CHECKS:
		print("FAIL %s: %s" % [check, _failures[check]] if check in _failures else "PASS " + check)
	get_tree().quit()


func _compare(folder: String) -> void:
	var frame := _game.frame
	var moment := await FrozenMoment.draw(_game)
	var godot := ImageChecks.compute_shares(moment.godot, moment.unlit, moment.unshadowed)
	var gnomon := ImageChecks.compute_shares(moment.gnomon, moment.unlit, moment.unshadowed)
	var path := folder.path_join("%s_%03d" % [_name, frame])
	moment.save(path)
	ImageChecks.make_share_image(godot, SIZE.x).save_png(path + "_share_godot.png")
	ImageChecks.make_share_image(gnomon, SIZE.x).save_png(path + "_share_gnomon.png")
	var black := ImageChecks.count_black(moment.gnomon, moment.godot, BLACK, LIT)
	var dark := ImageChecks.count_darker(moment.gnomon, moment.unlit, ROUNDING)
	var bright := ImageChecks.count_darker(moment.unshadowed, moment.gnomon, ROUNDING)
	var flat := ImageChecks.count_flat(godot, SIZE.x)
	var outside := ImageChecks.count_outside(gnomon, godot, SIZE.x, SHARE_TOLERANCE)
	var outside_gnomon := ImageChecks.count_outside(godot, gnomon, SIZE.x, SHARE_TOLERANCE)
	var unsteady := ImageChecks.count_different(moment.gnomon, moment.gnomon_again, 0)
	var late := ImageChecks.count_different(moment.moving, moment.gnomon, 0)
	var shadow := _count_mask(moment.mask, 0.0, 0.1)
	var lit := _count_mask(moment.mask, 0.9, 1.0)
	print(("MEASURED frame %d: black %d, below ambient %d, above unshadowed %d, flat %d, Gnomon's darker %d and lighter %d, "
			+ "Godot's darker %d and lighter %d, unsteady %d, late %d, shadow %d, lit %d") % [
		frame, black, dark, bright, flat, outside.x, outside.y, outside_gnomon.x, outside_gnomon.y, unsteady, late, shadow, lit])
	_check("no_black", frame, black == 0, "%d pixels are black that Godot lights" % black)
	_check("ambient_light", frame, dark == 0, "%d pixels are darker than without the lights" % dark)
	_check("no_leak", frame, bright == 0, "%d pixels are brighter than without shadows" % bright)
	_check("as_godot", frame, flat > LEAST_FLAT_PX, "only %d pixels are far from edges" % flat)
	_check("no_false_shadow", frame, outside.x <= _game.most_other_px, "%d pixels are darker than all near them with Godot's shadow" % outside.x)
	_check("no_missing_shadow", frame, outside.y <= _game.most_other_px, "%d pixels are lighter than all near them with Godot's shadow" % outside.y)
	_check("as_godot", frame, outside_gnomon.x + outside_gnomon.y <= MOST_GODOT_PX,
			"%d pixels with Godot's shadow are darker and %d lighter than all near them with Gnomon's" % [outside_gnomon.x, outside_gnomon.y])
	_check("stands_still", frame, unsteady == 0, "%d pixels differ between two images of one moment" % unsteady)
	_check("moves_without_lag", frame, late == 0, "%d pixels differ between the frame in motion and the same moment frozen" % late)
	_check("has_shadow", frame, mini(shadow, lit) > LEAST_SHADOW_PX, "%d pixels of the mask are in shadow, %d are lit" % [shadow, lit])


## Notes a failure of a check; the first one of each check is printed.
func _check(check: String, frame: int, condition: bool, what: String) -> void:
	if not condition and check not in _failures:
		_failures[check] = "frame %d: %s" % [frame, what]


static func _count_mask(mask: Image, lowest: float, highest: float) -> int:
	var count := 0
	for visibility in mask.get_data().to_float32_array():
		count += int(visibility >= lowest and visibility <= highest)
	return count


func _print_counts() -> void:
	var device := RenderingServer.get_rendering_device()
	print("GROWTH %d %d %d %d %d %d %d %d" % [
		_game.frame,
		Performance.get_monitor(Performance.OBJECT_COUNT),
		Performance.get_monitor(Performance.OBJECT_NODE_COUNT),
		Performance.get_monitor(Performance.OBJECT_ORPHAN_NODE_COUNT),
		Performance.get_monitor(Performance.OBJECT_RESOURCE_COUNT),
		Performance.get_monitor(Performance.MEMORY_STATIC),
		device.get_memory_usage(RenderingDevice.MEMORY_TEXTURES),
		device.get_memory_usage(RenderingDevice.MEMORY_BUFFERS),
	])
