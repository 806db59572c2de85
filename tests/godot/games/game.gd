class_name Game
extends Node3D
## Base class of the games: small moving scenes whose content is generated. Everything that a game adds while it runs repeats
## after LOOP_FRAMES, so that counts of objects can be compared. A game is deterministic: it counts frames of a fixed time step.

const LOOP_FRAMES := 100
const FRAMES_PER_S := 30.0

## The light whose mask must have lit and shadowed pixels in each compared frame.
var main_light: Light3D
var camera: Camera3D
var environment: Environment
## Nodes that cast no shadow of Gnomon by its documentation (doc/godot.md, "What casts a shadow") but one of Godot. While Godot's image
## for the comparison is drawn, they cast none either.
var documented_without_shadow: Array[GeometryInstance3D] = []
## Largest number of pixels, of 32,400, that may be darker, or lighter, than all near them with Godot's shadow. Godot's shadow maps lack
## thin shadows, so that a game has about two thirds of this number in a correct image.
var most_other_px := 20
## Frames drawn since the start.
var frame := 0


func _process(_delta: float) -> void:
	frame += 1
	_play(frame % LOOP_FRAMES)


## Called once per frame of the game, and not while it is frozen. step: 0 to LOOP_FRAMES - 1.
func _play(_step: int) -> void:
	pass


## Returns the lights that have a GnomonShadow3D.
func find_lights() -> Array[Light3D]:
	var lights: Array[Light3D] = []
	for light: Light3D in find_children("*", "Light3D", true, false):
		if ShadowModes.find_shadow(light) != null:
			lights.append(light)
	return lights


func add_environment(background: Color, ambient: Color) -> void:
	environment = Environment.new()
	environment.background_mode = Environment.BG_COLOR
	environment.background_color = background
	environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	environment.ambient_light_color = ambient
	environment.tonemap_mode = Environment.TONE_MAPPER_LINEAR
	var node := WorldEnvironment.new()
	node.environment = environment
	add_child(node)


func add_camera(from: Vector3, to: Vector3) -> void:
	camera = Camera3D.new()
	add_child(camera)
	camera.look_at_from_position(from, to)


## Adds a sun with a GnomonShadow3D. diameter_deg: its angular size.
func add_sun(rotation_deg: Vector3, diameter_deg: float, energy := 1.0) -> DirectionalLight3D:
	var sun := DirectionalLight3D.new()
	sun.rotation_degrees = rotation_deg
	sun.light_angular_distance = diameter_deg
	sun.light_energy = energy
	# The sky must not change while the lights are off.
	sun.sky_mode = DirectionalLight3D.SKY_MODE_LIGHT_ONLY
	add_light(sun, self)
	return sun


func add_light(light: Light3D, parent: Node) -> void:
	light.shadow_enabled = true
	light.add_child(ClassDB.instantiate("GnomonShadow3D"))
	parent.add_child(light)


func add_mesh(mesh: Mesh, at: Vector3, material: Material, parent: Node3D = self) -> MeshInstance3D:
	var node := MeshInstance3D.new()
	node.mesh = mesh
	node.position = at
	node.material_override = material
	parent.add_child(node)
	return node


func add_box(size: Vector3, at: Vector3, material: Material, parent: Node3D = self) -> MeshInstance3D:
	return add_mesh(make_box(size), at, material, parent)


func add_floor(size: Vector2, material: Material) -> MeshInstance3D:
	var plane := PlaneMesh.new()
	plane.size = size
	return add_mesh(plane, Vector3.ZERO, material)


## Adds instances of a mesh as one MultiMeshInstance3D.
func add_instances(mesh: Mesh, transforms: Array[Transform3D], material: Material) -> MultiMeshInstance3D:
	var node := MultiMeshInstance3D.new()
	node.multimesh = MultiMesh.new()
	node.multimesh.transform_format = MultiMesh.TRANSFORM_3D
	node.multimesh.mesh = mesh
	node.multimesh.instance_count = transforms.size()
	for index in transforms.size():
		node.multimesh.set_instance_transform(index, transforms[index])
	node.material_override = material
	add_child(node)
	return node


static func make_box(size: Vector3) -> BoxMesh:
	var box := BoxMesh.new()
	box.size = size
	return box


static func make_cylinder(bottom: float, top: float, height: float, segments := 12) -> CylinderMesh:
	var cylinder := CylinderMesh.new()
	cylinder.bottom_radius = bottom
	cylinder.top_radius = top
	cylinder.height = height
	cylinder.radial_segments = segments
	cylinder.rings = 1
	return cylinder


static func make_sphere(radius: float, segments := 16) -> SphereMesh:
	var sphere := SphereMesh.new()
	sphere.radius = radius
	sphere.height = 2 * radius
	sphere.radial_segments = segments
	@warning_ignore("integer_division")
	sphere.rings = segments / 2
	return sphere


static func make_material(color: Color, roughness := 0.8, metallic := 0.0) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.albedo_color = color
	material.roughness = roughness
	material.metallic = metallic
	return material


static func make_shader_material(code: String) -> ShaderMaterial:
	var material := ShaderMaterial.new()
	material.shader = Shader.new()
	material.shader.code = "shader_type spatial;\n" + code
	return material


## Returns a checkered texture of 16 x 16 fields, with mip levels.
static func make_checker(light: Color, dark: Color) -> ImageTexture:
	var image := Image.create_empty(64, 64, false, Image.FORMAT_RGBA8)
	for y in 64:
		for x in 64:
			@warning_ignore("integer_division")
			image.set_pixel(x, y, light if (x / 4 + y / 4) % 2 == 0 else dark)
	image.generate_mipmaps()
	return ImageTexture.create_from_image(image)


## Returns a texture of leaves: ellipses that are opaque, on a transparent ground of the same colour.
static func make_leaves(color: Color, count: int) -> ImageTexture:
	const SIZE := 64
	var random := RandomNumberGenerator.new()
	random.seed = 5
	var image := Image.create_empty(SIZE, SIZE, false, Image.FORMAT_RGBA8)
	image.fill(Color(color, 0.0))
	for leaf in count:
		var centre := Vector2(random.randf_range(8, SIZE - 8), random.randf_range(8, SIZE - 8))
		var turn := random.randf_range(0, TAU)
		for y in range(int(centre.y) - 8, int(centre.y) + 8):
			for x in range(int(centre.x) - 8, int(centre.x) + 8):
				var offset := (Vector2(x, y) - centre).rotated(turn)
				if (offset / Vector2(7, 3.5)).length() < 1.0:
					image.set_pixel(x, y, color.darkened(0.1 * (leaf % 4)))
	image.generate_mipmaps()
	return ImageTexture.create_from_image(image)


## Returns the crown of a tree: quads that cross each other, `count` upright and one flat.
static func make_crossed_quads(size: Vector2, count: int, has_flat := true) -> ArrayMesh:
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	var bases: Array[Basis] = []
	for index in count:
		bases.append(Basis(Vector3.UP, PI * index / count))
	if has_flat:
		bases.append(Basis(Vector3.RIGHT, -0.5 * PI))
	const CORNERS: Array[Vector2] = [Vector2(0, 0), Vector2(0, 1), Vector2(1, 1), Vector2(0, 0), Vector2(1, 1), Vector2(1, 0)]
	for turned in bases:
		for corner in CORNERS:
			var offset := (corner - Vector2(0.5, 0.5)) * size
			tool.set_normal(turned.z)
			tool.set_uv(Vector2(corner.x, 1.0 - corner.y))
			tool.add_vertex(turned * Vector3(offset.x, offset.y, 0))
	return tool.commit()
