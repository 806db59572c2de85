class_name Room
extends Node3D
## A room with eight lights, each with a GnomonShadow3D. Four lights and five things move.

## False: the room stays at the time that was shown last.
@export var is_moving := true

var _time_s := 0.0

@onready var _pendant: Node3D = $Pendant
@onready var _fan: Node3D = $Fan/Blades
@onready var _carousel: Node3D = $Carousel/Turning
@onready var _ball: Node3D = $Ball
@onready var _candle_light: OmniLight3D = $CandleLight
@onready var _orb: Node3D = $Orb
@onready var _track_light: SpotLight3D = $TrackLight


func _ready() -> void:
	show_time(0.0)


func _process(delta: float) -> void:
	if is_moving:
		show_time(_time_s + delta)


## Moves everything to where it is at a time in seconds.
func show_time(time_s: float) -> void:
	_time_s = time_s
	_pendant.rotation.z = 0.22 * sin(1.9 * time_s)
	_pendant.rotation.x = 0.1 * sin(2.3 * time_s)
	_fan.rotation.y = 1.4 * time_s
	_carousel.rotation.y = -0.8 * time_s
	_ball.position = Vector3(1.3 * cos(0.9 * time_s), 0.16, 1.7 + 0.5 * sin(0.9 * time_s))
	_ball.rotation.z = -7.0 * time_s
	_candle_light.position = Vector3(0.5, 1.08, -0.2) + 0.012 * Vector3(sin(9.0 * time_s), sin(13.0 * time_s), sin(11.0 * time_s))
	_orb.position = Vector3(-2.3 + 0.5 * cos(time_s), 1.2 + 0.25 * sin(1.7 * time_s), 0.9 + 0.5 * sin(time_s))
	_track_light.rotation.y = 0.25 * sin(0.7 * time_s) - 0.45


## Returns all lights, in the order of the scene.
func get_lights() -> Array[Light3D]:
	var lights: Array[Light3D] = []
	lights.assign(find_children("*", "Light3D"))
	return lights


## Whether the noise textures, which Godot generates on other threads, are complete.
func has_textures() -> bool:
	for node: MeshInstance3D in find_children("*", "MeshInstance3D"):
		var material := node.material_override as BaseMaterial3D
		for kind in BaseMaterial3D.TEXTURE_MAX:
			var texture := material.get_texture(kind)
			if texture != null and texture.get_image() == null:
				return false
	return true
