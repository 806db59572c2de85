extends AddonTest
## Materials that read masks look as without the add-on where the masks are 1.

const COLUMNS := 8
const CELL_PX := 80
const LIGHTS: Array[String] = ["sun", "sun_with_size", "omni", "omni_with_size", "spot", "spot_with_size"]
const TOLERANCE := 1.0 / 255.0  # one step of an 8-bit image
const METAL_TOLERANCE := 2.0 / 255.0
const SPHERE_RADIUS := 0.4  # in cells
const MAX_IGNORED_FRACTION := 0.005 # of a material's pixels may differ by more

var _looks: Array[String] = MaterialLooks.READS_MASKS + MaterialLooks.STAYS
var _viewport: SubViewport
var _light: Light3D


func test_materials_look_the_same_without_shadows() -> void:
	_add_spheres()
	_add_soft_lights()
	var originals := await _draw_all(false)
	var patched := await _draw_all(true)
	var restored := await _draw_all(false)
	for light in LIGHTS:
		_compare(light, originals[light], patched[light])
		check(restored[light].get_data() == originals[light].get_data(), light + ": without nodes the image is not the original")
	_viewport.free()


## Returns light -> image. Shaders are patched only once, not for each light.
func _draw_all(has_shadow: bool) -> Dictionary[String, Image]:
	var images: Dictionary[String, Image] = {}
	var shadow: Node3D
	if has_shadow:
		shadow = ClassDB.instantiate("GnomonShadow3D")
		_viewport.add_child(shadow)
	for light in LIGHTS:
		_add_light(light)
		if has_shadow:
			shadow.reparent(_light)
		await draw_frames(4)
		images[light] = _viewport.get_texture().get_image()
		if has_shadow:
			shadow.reparent(_viewport)
		_light.free()
	if has_shadow:
		shadow.free()
		await draw_frames(2)
	return images


func _add_spheres() -> void:
	_viewport = SubViewport.new()
	@warning_ignore("integer_division")
	var rows := (_looks.size() + COLUMNS - 1) / COLUMNS
	_viewport.size = Vector2i(COLUMNS, rows) * CELL_PX
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	add_child(_viewport)
	var camera := Camera3D.new()
	camera.fov = rad_to_deg(2 * atan(rows / 40.0))  # `rows` high at a distance of 20
	_viewport.add_child(camera)
	camera.look_at_from_position(Vector3(COLUMNS / 2.0, -rows / 2.0, 20), Vector3(COLUMNS / 2.0, -rows / 2.0, 0))
	for index in _looks.size():
		var sphere := MeshInstance3D.new()
		sphere.mesh = SphereMesh.new()
		sphere.mesh.radius = SPHERE_RADIUS
		sphere.mesh.height = 2 * SPHERE_RADIUS
		sphere.material_override = MaterialLooks.make(_looks[index])
		@warning_ignore("integer_division")
		sphere.position = Vector3(index % COLUMNS + 0.5, -(index / COLUMNS) - 0.5, 0)
		_viewport.add_child(sphere)


## Adds dim lights with a size. Godot compiles each material again when the first light of a view has one, for each kind of light.
func _add_soft_lights() -> void:
	for light: String in ["sun_with_size", "omni_with_size"]:
		_add_light(light)
		_light.light_energy = 0.2


func _add_light(light: String) -> void:
	match light.get_slice("_", 0):
		"sun":
			_light = DirectionalLight3D.new()
		"omni":
			_light = OmniLight3D.new()
			_light.omni_range = 20
			_light.omni_attenuation = 0.5
		"spot":
			_light = SpotLight3D.new()
			_light.spot_range = 20
			_light.spot_angle = 40
			_light.spot_attenuation = 0.5
	var has_size := light.ends_with("size")
	if light.begins_with("sun"):
		_light.light_angular_distance = 3 if has_size else 0
	else:
		_light.light_size = 0.4 if has_size else 0.0
	_light.shadow_enabled = true
	_light.light_energy = 2
	_light.light_specular = 0.7
	_light.light_color = Color(1, 0.9, 0.7)
	_light.shadow_caster_mask = 0  # nothing casts a shadow: all masks are 1
	_viewport.add_child(_light)
	_light.look_at_from_position(Vector3(7, -1, 5), Vector3(4, -2.5, 0))


func _compare(light: String, original: Image, patched: Image) -> void:
	for index in _looks.size():
		@warning_ignore("integer_division")
		var cell := Rect2i(Vector2i(index % COLUMNS, index / COLUMNS) * CELL_PX, Vector2i(CELL_PX, CELL_PX))
		var difference := _compare_cell(original.get_region(cell), patched.get_region(cell))
		var tolerance := METAL_TOLERANCE if "metal" in _looks[index] else TOLERANCE
		check(difference <= tolerance, "%s, %s: differs by %.1f / 255" % [_looks[index], light, difference * 255])


## Returns the largest difference in the sphere's pixels, after the fraction MAX_IGNORED_FRACTION of the worst ones is ignored.
func _compare_cell(original: Image, patched: Image) -> float:
	var differences: Array[float] = []
	for y in CELL_PX:
		for x in CELL_PX:
			var offset := Vector2(x + 0.5, y + 0.5) / CELL_PX - Vector2(0.5, 0.5)
			if offset.length() < SPHERE_RADIUS:
				var a := original.get_pixel(x, y)
				var b := patched.get_pixel(x, y)
				differences.append(maxf(absf(a.r - b.r), maxf(absf(a.g - b.g), absf(a.b - b.b))))
	differences.sort()
	return differences[int(differences.size() * (1 - MAX_IGNORED_FRACTION))]
