extends AddonTest
## How masks change the image: each light uses its own mask, together with Godot's own shadows.
## "ours": with masks of the add-on.

const SIZE := Vector2i(160, 120)
const ROUNDING := 0.004 # rounding error of half floats with values of 1 and more


## Adds a viewport that shows the scene in a world of its own, with linear values in its image.
func _add_linear(scene: StudyScene, size := SIZE) -> SubViewport:
	var viewport := SubViewport.new()
	viewport.size = size
	viewport.own_world_3d = true
	viewport.use_hdr_2d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	add_child(viewport)
	if scene.get_parent():
		scene.get_parent().remove_child(scene)
	viewport.add_child(scene)
	return viewport


func _draw(viewport: SubViewport, frames := 4) -> PackedFloat32Array:
	await draw_frames(frames)
	var image := viewport.get_texture().get_image()
	image.convert(Image.FORMAT_RGBF)
	return image.get_data().to_float32_array()


static func _find_largest_difference(left: PackedFloat32Array, right: PackedFloat32Array) -> float:
	var largest := 0.0
	for index in left.size():
		largest = maxf(largest, absf(left[index] - right[index]))
	return largest


static func _add(left: PackedFloat32Array, right: PackedFloat32Array) -> PackedFloat32Array:
	var sum := PackedFloat32Array()
	sum.resize(left.size())
	for index in left.size():
		sum[index] = left[index] + right[index]
	return sum


## Adds eight lights of all types. Two have the same position and some are on one line, so that neither position nor direction identifies one.
func _add_eight_lights(scene: StudyScene) -> Array[Light3D]:
	scene.light.free()
	var lights: Array[Light3D] = []
	for index in 8:
		scene.add_light(["omni", "spot", "omni", "directional", "spot", "omni", "omni", "directional"][index])
		scene.light.name = "Light%d" % index
		scene.light.light_color = Color.from_hsv(index / 8.0, 0.7, 1)
		scene.light.light_energy = 0.3
		var angle := TAU * index / 7.0
		var origin := Vector3(3 * cos(angle), 4, 3 * sin(angle))
		if index == 5:
			origin = lights[0].position
		elif index == 6:
			origin = lights[0].position * 1.3
		scene.light.look_at_from_position(origin, Vector3(0, 0.3, 0))
		lights.append(scene.light)
	return lights


func test_eight_lights_on_one_surface_add_up() -> void:
	var scene := StudyScene.create("omni", "torus")
	var lights := _add_eight_lights(scene)
	var viewport := _add_linear(scene)
	var together := await _draw(viewport)
	var sum := PackedFloat32Array()
	sum.resize(together.size())
	for light in lights:
		for other in lights:
			other.visible = other == light
		sum = _add(sum, await _draw(viewport))
	check(_find_largest_difference(together, sum) < ROUNDING, "the image of all lights is the sum of theirs: %f" % _find_largest_difference(together, sum))
	check(_find_largest_difference(together, await _draw(viewport)) > 0.1, "one light is not all")
	viewport.free()


func test_another_light_keeps_the_shadow_of_godot() -> void:
	var scene := StudyScene.create("spot", "box")
	var ours := scene.light
	scene.add_light("omni")
	scene.shadow.free()
	var other := scene.light
	other.position += Vector3(3, 0, 0)
	other.shadow_enabled = true
	var viewport := _add_linear(scene)
	var together := await _draw(viewport)
	for frame in 3: # the other light has a size, so the add-on replaces it by a stand-in light (stand_in_lights.h)
		check(_find_largest_difference(together, await _draw(viewport, 1)) < ROUNDING, "the image is the same in each frame")
	other.visible = false
	var first := await _draw(viewport)
	other.visible = true
	ours.visible = false
	ours.get_child(0).free()  # its GnomonShadow3D, the only one: now Godot draws alone
	var second := await _draw(viewport)
	check(_find_largest_difference(together, _add(first, second)) < 2 * ROUNDING, "the image of both lights is the sum of theirs: %f" % _find_largest_difference(together, _add(first, second)))
	viewport.free()


## The add-on cannot patch the shader of a material with a rim.
func test_an_unpatched_receiver_keeps_the_shadow_of_godot() -> void:
	for kind in ["omni", "spot", "directional"]:
		var scene := StudyScene.create(kind, "box")
		var rim := StandardMaterial3D.new()
		rim.resource_name = "Rim"
		rim.rim_enabled = true
		scene.get_node("Ground").material_override = rim
		scene.light.shadow_enabled = true
		scene.remove_child(scene.light)
		var viewport := _add_linear(scene)
		scene.add_child(scene.light)
		var shadow := scene.shadow
		scene.light.remove_child(shadow)
		var original := await _draw(viewport)
		scene.light.add_child(shadow)
		var mixed := await _draw(viewport)
		# In the second image only the box uses our mask. The ground keeps Godot's shadow.
		var differing := 0
		for pixel in range(0, original.size(), 3):
			differing += int(absf(original[pixel] - mixed[pixel]) > ROUNDING)
		var fraction := float(differing) / (SIZE.x * SIZE.y)
		check(fraction < 0.02, "%s: %f of the image differ" % [kind, fraction])
		# 1 and 0.5 are Godot's defaults.
		check(scene.light.shadow_enabled and scene.light.light_specular == (1.0 if kind == "directional" else 0.5), "the light's properties stay")
		viewport.free()


## The add-on makes no masks for orthogonal cameras.
func test_a_view_without_masks_has_the_shadow_of_godot() -> void:
	var scene := StudyScene.create("omni", "box")
	scene.light.shadow_enabled = true
	var shadow := scene.shadow
	scene.light.remove_child(shadow)
	scene.camera.set_orthogonal(6, 0.1, 50)
	var viewport := _add_linear(scene)
	var original := await _draw(viewport)
	scene.light.add_child(shadow)
	check(_find_largest_difference(await _draw(viewport), original) < 2 * ROUNDING, "the image is Godot's")
	scene.camera.set_perspective(45, 0.1, 50)
	check(_find_largest_difference(await _draw(viewport), original) > 0.1, "a perspective camera shows another image")
	scene.light.remove_child(shadow)
	var soft := await _draw(viewport)
	scene.light.add_child(shadow)
	check(_find_largest_difference(await _draw(viewport), soft) > 0.1, "its image has masks")
	viewport.free()


## A label is not shaded and needs no shadow; lit particles read masks. Only their own pixels change.
func test_particles_and_labels_change_nothing_else() -> void:
	var scene := StudyScene.create("omni", "box")
	scene.light.shadow_enabled = true
	var viewport := _add_linear(scene)
	var alone := await _draw(viewport)
	var label := Label3D.new()
	label.text = "A"
	label.position = Vector3(0, 1, -3)
	label.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	scene.add_child(label)
	var particles := CPUParticles3D.new()
	particles.mesh = BoxMesh.new()
	particles.mesh.size = Vector3.ONE * 0.3
	particles.amount = 1
	particles.lifetime = 1000
	particles.gravity = Vector3.ZERO
	particles.position = Vector3(2, 1, 1)
	particles.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	scene.add_child(particles)
	var together := await _draw(viewport)
	var differing := 0
	for index in alone.size():
		differing += int(absf(alone[index] - together[index]) > ROUNDING)
	check(differing > 0 and differing < alone.size() / 20, "%d of %d values differ" % [differing, alone.size()])
	viewport.free()


## The shader has a uniform with the name of one of the add-on's functions, so that it does not compile with them.
func test_a_shader_that_does_not_compile_with_ours_stays() -> void:
	var scene := StudyScene.create("directional", "box")
	var material := ShaderMaterial.new()
	material.shader = Shader.new()
	material.shader.code = "shader_type spatial; uniform float gno_light = 0.6; void fragment() { ALBEDO = vec3(gno_light); }"
	scene.get_node("Ground").material_override = material
	scene.light.shadow_enabled = true
	var shadow := scene.shadow
	scene.light.remove_child(shadow)
	var viewport := _add_linear(scene)
	var original := await _draw(viewport)
	scene.light.add_child(shadow)
	var drawn := await _draw(viewport)
	var differing := 0
	for index in original.size():
		differing += int(absf(original[index] - drawn[index]) > ROUNDING)
	check(differing < original.size() / 50, "%d of %d values differ" % [differing, original.size()])
	viewport.free()


func test_each_view_has_its_own_masks() -> void:
	var scene := StudyScene.create("omni", "torus")
	var viewport := _add_linear(scene)
	var alone := await _draw(viewport)
	var second := SubViewport.new()
	second.size = Vector2i(90, 130)
	second.use_hdr_2d = true
	second.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	scene.add_child(second)
	var camera := Camera3D.new()
	second.add_child(camera)
	camera.look_at_from_position(Vector3(3, 4, 5), Vector3.ZERO)
	var of_second := await _draw(second)
	check(_find_largest_difference(await _draw(viewport), alone) == 0.0, "the first view's image stays")
	viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	check(_find_largest_difference(await _draw(second), of_second) == 0.0, "the second's is the same alone")
	viewport.free()


func test_shadow_opacity_thins_the_shadow() -> void:
	var scene := StudyScene.create("directional", "box")
	var viewport := _add_linear(scene)
	var dark := await _draw(viewport)
	scene.light.shadow_opacity = 0.5
	var half := await _draw(viewport)
	scene.light.shadow_opacity = 0
	var none := await _draw(viewport)
	var middle := _add(dark, none)
	for index in middle.size():
		middle[index] *= 0.5
	check(_find_largest_difference(half, middle) < ROUNDING, "half as dark: %f" % _find_largest_difference(half, middle))
	check(_find_largest_difference(dark, none) > 0.1, "there is a shadow")
	viewport.free()


func test_a_shader_with_a_light_of_its_own_reads_masks() -> void:
	var scene := StudyScene.create("omni", "box")
	var viewport := _add_linear(scene)
	var code := "shader_type spatial;
render_mode specular_disabled;
uniform float specular = 0.5;
#include \"res://addons/gnomon/gnomon.gdshaderinc\"
void fragment() { ALBEDO = vec3(specular); }
void light() { DIFFUSE_LIGHT += LIGHT_COLOR * GNOMON_ATTENUATION * max(dot(NORMAL, LIGHT), 0.0) / PI; }
"
	var images: Array[PackedFloat32Array] = []
	var plain := code.get_slice("void light", 0).replace("#include", "//")
	for shader_code: String in [code, plain]: # with its own light(), and with the one that the add-on adds
		var material := ShaderMaterial.new()
		material.shader = Shader.new()
		material.shader.code = shader_code
		scene.get_node("Ground").material_override = material
		images.append(await _draw(viewport))
	check(_find_largest_difference(images[0], images[1]) < 2 * ROUNDING, "both shaders give the same image: %f" % _find_largest_difference(images[0], images[1]))
	viewport.free()
