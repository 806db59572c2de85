class_name ShadowModes
extends RefCounted
## The shadows that measurements compare: none ("off"), Godot's own of two qualities, and Gnomon's.

## Godot's default, Soft Low, and its best, Soft Ultra: RenderingServer.SHADOW_QUALITY_*.
const QUALITIES := {"low": RenderingServer.SHADOW_QUALITY_SOFT_LOW, "ultra": RenderingServer.SHADOW_QUALITY_SOFT_ULTRA}
const ALL: Array[String] = ["off", "low", "ultra", "gnomon"]  # "off" first: the other images are divided by its image


## Sets the mode of lights that each have a GnomonShadow3D.
static func apply(lights: Array[Light3D], mode: String) -> void:
	for light in lights:
		find_shadow(light).visible = mode == "gnomon"
		light.shadow_enabled = mode != "off"
	if QUALITIES.has(mode):
		RenderingServer.positional_soft_shadow_filter_set_quality(QUALITIES[mode])
		RenderingServer.directional_soft_shadow_filter_set_quality(QUALITIES[mode])


static func find_shadow(light: Light3D) -> Node3D:
	for child in light.get_children():
		if child.is_class("GnomonShadow3D"):
			return child
	return null
