extends SmallScene
## Surfaces whose shader moves their vertices in vertex(). With Gnomon's shadow, an image must equal that of the same mesh whose
## vertices are moved on the CPU.

const TOLERANCE := 0.03
const MAX_DIFFERENT := 0.002 # of the pixels: rounding at outlines

const WAVES := """
uniform float amplitude : hint_range(0.0, 1.0) = 0.2;
uniform vec2 direction = vec2(1.0, 0.5);
uniform float phases[2];
uniform int count = 2;
uniform bool is_on = true;
varying vec3 position;
const float SLOPES[2] = {2.0, 3.5};
struct Wave { float slope; float phase; };
// names that GLSL reserves
float sample(Wave input, vec2 at) { return sin(input.slope * dot(at, direction) + input.phase); }
void vertex() {
	float filter = 0.0;
	for (int i = 0; i < count; i++) {
		Wave wave;
		wave.slope = SLOPES[i];
		wave.phase = phases[i];
		filter += sample(wave, VERTEX.xz);
	}
	if (is_on) {
		VERTEX.y += amplitude * filter; /* sets the normal too */
	}
	position = VERTEX;
}
void fragment() { ALBEDO = vec3(0.5 + 0.1 * dFdx(position.x)); }
"""


## Returns a mesh of a subdivided plane or box, with vertex colours that grow with the height.
func _make_mesh(primitive: PrimitiveMesh) -> ArrayMesh:
	var arrays := primitive.get_mesh_arrays()
	var colors := PackedColorArray()
	for vertex: Vector3 in arrays[Mesh.ARRAY_VERTEX]:
		colors.append(Color(clampf(vertex.y + 0.5, 0.0, 1.0), 0.5, 0.25))
	arrays[Mesh.ARRAY_COLOR] = colors
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh


func _make_plane() -> ArrayMesh:
	var plane := PlaneMesh.new()
	plane.size = Vector2(3, 3)
	plane.subdivide_width = 20
	plane.subdivide_depth = 20
	return _make_mesh(plane)


func _make_box() -> ArrayMesh:
	var box := BoxMesh.new()
	box.size = Vector3(0.6, 1.0, 0.6)
	box.subdivide_height = 6
	return _make_mesh(box)


## Moves each vertex on the CPU. move: position, normal, UV, colour -> position.
func _move(mesh: ArrayMesh, move: Callable) -> ArrayMesh:
	var arrays := mesh.surface_get_arrays(0)
	var vertices: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	for index in vertices.size():
		vertices[index] = move.call(vertices[index], arrays[Mesh.ARRAY_NORMAL][index], arrays[Mesh.ARRAY_TEX_UV][index], arrays[Mesh.ARRAY_COLOR][index])
	arrays[Mesh.ARRAY_VERTEX] = vertices
	var moved := ArrayMesh.new()
	moved.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return moved


func _plain() -> ShaderMaterial:
	return _make_shader("void fragment() { ALBEDO = vec3(0.5); }")


func _add_shadow(light: Light3D) -> Node3D:
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	light.add_child(shadow)
	return shadow


## Draws scenes that two functions build, with Gnomon's shadows, and compares the images.
func _check_same(label: String, add_moved: Callable, add_expected: Callable) -> void:
	var images: Array[Image] = []
	for add: Callable in [add_moved, add_expected]:
		_begin()
		_camera.look_at_from_position(Vector3(0, 2.6, 3.6), Vector3(0, 0.5, 0))
		var shadow := _add_shadow(_sun)
		add.call()
		images.append(await _take())
		check(shadow.makes_mask(), label + ": a mask is made")
		images.back().save_png("user://moved_%s_%d.png" % [label.replace(" ", "_"), images.size()])
		await _end()
	var different := 0
	for y in SIZE.y:
		for x in SIZE.x:
			different += int(absf(images[0].get_pixel(x, y).get_luminance() - images[1].get_pixel(x, y).get_luminance()) > TOLERANCE)
	var part := float(different) / (SIZE.x * SIZE.y)
	check(part <= MAX_DIFFERENT, "%s: %.4f of the pixels differ" % [label, part])


## The same for one node with the mesh and the material.
func _check_moved(label: String, mesh: ArrayMesh, material: ShaderMaterial, move: Callable, at := Vector3(0, 1, 0)) -> void:
	await _check_same(label, func() -> void: _add(mesh, at, material), func() -> void: _add(_move(mesh, move), at, _plain()))


func test_waves_of_a_shader_cast_as_they_are_drawn() -> void:
	var material := _make_shader(WAVES)
	material.set_shader_parameter("phases", PackedFloat32Array([0.5, 1.5]))
	await _check_moved("waves", _make_plane(), material, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3:
		var slope := at.x + 0.5 * at.z
		return at + Vector3(0, 0.2 * (sin(2.0 * slope + 0.5) + sin(3.5 * slope + 1.5)), 0))
	material.set_shader_parameter("is_on", false)
	await _check_moved("waves off", _make_plane(), material, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return at)


func test_attributes_of_vertices_move_them() -> void:
	await _check_moved("normal", _make_box(), _make_shader("void vertex() { VERTEX += 0.2 * NORMAL; }\nvoid fragment() { ALBEDO = vec3(0.5); }"),
		func(at: Vector3, normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return at + 0.2 * normal)
	await _check_moved("colour", _make_box(), _make_shader("uniform vec3 lean;\nvoid vertex() { VERTEX += COLOR.r * COLOR.r * lean; }\nvoid fragment() { ALBEDO = vec3(0.5); }"),
		func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return at)
	var leaning := _make_shader("uniform vec3 lean = vec3(0.8, 0.0, 0.3);\nvoid vertex() { VERTEX += COLOR.r * COLOR.r * lean; }\nvoid fragment() { ALBEDO = vec3(0.5); }")
	await _check_moved("colour by default", _make_box(), leaning,
		func(at: Vector3, _normal: Vector3, _uv: Vector2, color: Color) -> Vector3: return at + color.r * color.r * Vector3(0.8, 0.0, 0.3))
	await _check_moved("far", _make_box(), _make_shader("void vertex() { VERTEX.x += 2.5 + 0.3 * COLOR.r; }\nvoid fragment() { ALBEDO = vec3(0.5); }"),
		func(at: Vector3, _normal: Vector3, _uv: Vector2, color: Color) -> Vector3: return at + Vector3(2.5 + 0.3 * color.r, 0, 0), Vector3(-2.5, 0.8, 0))
	await _check_moved("coordinates", _make_plane(), _make_shader("void vertex() { VERTEX.y += UV.x * UV.y; }\nvoid fragment() { ALBEDO = vec3(0.5); }"),
		func(at: Vector3, _normal: Vector3, uv: Vector2, _color: Color) -> Vector3: return at + Vector3(0, uv.x * uv.y, 0))


func test_a_texture_moves_vertices() -> void:
	var heights := Image.create(4, 4, false, Image.FORMAT_RF)
	for y in 4:
		for x in 4:
			heights.set_pixel(x, y, Color(0.5 * ((x * 7 + y * 3) % 5) / 4.0, 0, 0))
	var material := _make_shader("uniform sampler2D heights : filter_nearest, repeat_disable;\nvoid vertex() { VERTEX.y += texture(heights, UV).r; }\nvoid fragment() { ALBEDO = vec3(0.5); }")
	material.set_shader_parameter("heights", ImageTexture.create_from_image(heights))
	# The vertices are not on borders of texels.
	await _check_moved("heights", _make_plane(), material, func(at: Vector3, _normal: Vector3, uv: Vector2, _color: Color) -> Vector3:
		var texel := Vector2i((uv * 4.0).clamp(Vector2.ZERO, Vector2(3.99, 3.99)))
		return at + Vector3(0, heights.get_pixelv(texel).r, 0))
	var empty := _make_shader("uniform sampler2D missing : hint_default_black;\nuniform sampler2D white;\nvoid vertex() { VERTEX.y += texture(missing, UV).r + 0.5 * texture(white, UV).g; }\nvoid fragment() { ALBEDO = vec3(0.5); }")
	await _check_moved("textures by default", _make_plane(), empty, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return at + Vector3(0, 0.5, 0))


func test_functions_of_included_files_move_vertices() -> void:
	var turning := ShaderInclude.new()
	turning.code = "mat3 turn_around_z(float angle) {\n\tfloat c = cos(angle);\n\tfloat s = sin(angle);\n\treturn mat3(vec3(c, -s, 0), vec3(s, c, 0), vec3(0, 0, 1));\n}"
	turning.take_over_path("res://turning.gdshaderinc")
	var stretching := ShaderInclude.new()
	stretching.code = "uniform float length_factor = 1.5;\n#include \"res://turning.gdshaderinc\"\nvec3 stretch(vec3 at) { return vec3(at.x, length_factor * at.y, at.z); }\n"
	stretching.take_over_path("res://stretching.gdshaderinc")
	var material := _make_shader("#include \"res://stretching.gdshaderinc\"\nvoid vertex() { VERTEX = stretch(VERTEX) * turn_around_z(0.7); }\nvoid fragment() { ALBEDO = vec3(0.5); }")
	await _check_moved("includes", _make_box(), material, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3:
		return Vector3(at.x, 1.5 * at.y, at.z).rotated(Vector3.BACK, 0.7))


func test_the_place_of_a_node_moves_its_vertices() -> void:
	const CODE := "instance uniform float strength = 0.5;\nvoid vertex() { VERTEX.x += strength * sin(3.0 * NODE_POSITION_WORLD.x) * (VERTEX.y + 0.5); }\nvoid fragment() { ALBEDO = vec3(0.5); }"
	const PLACES: Array[float] = [-2.0, -0.6, 1.2]
	var mesh := _make_box()
	var strength := func(x: float) -> float: return 0.9 if x > 1.0 else 0.5
	var lean := func(at: Vector3, x: float) -> Vector3: return at + Vector3(strength.call(x) * sin(3.0 * x) * (at.y + 0.5), 0, 0)
	await _check_same("places", func() -> void:
		var material := _make_shader(CODE)
		for x in PLACES:
			var node := _add(mesh, Vector3(x, 0.5, 0), material)
			if x > 1.0:
				node.set_instance_shader_parameter("strength", 0.9),
		func() -> void:
			for x in PLACES:
				_add(_move(mesh, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return lean.call(at, x)), Vector3(x, 0.5, 0), _plain()))
	await _check_same("world", func() -> void:
		var node := _add(mesh, Vector3(-0.5, 0.7, 0), _make_shader("render_mode world_vertex_coords;\nvoid vertex() { VERTEX.x += 0.6 * VERTEX.y * VERTEX.y; }\nvoid fragment() { ALBEDO = vec3(0.5); }"))
		node.rotation_degrees.z = 90.0
		node.scale = Vector3(1, 1.5, 1),
		func() -> void:
			var basis := Basis.from_euler(Vector3(0, 0, PI / 2.0)).scaled_local(Vector3(1, 1.5, 1))
			var at_node := Transform3D(basis, Vector3(-0.5, 0.7, 0))
			var moved := _move(mesh, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3:
				var world := at_node * at
				return at_node.affine_inverse() * (world + Vector3(0.6 * world.y * world.y, 0, 0)))
			_add(moved, Vector3.ZERO, _plain()).transform = at_node)


func test_instances_of_a_multi_mesh_are_moved_each() -> void:
	var mesh := _make_box()
	var multi_mesh := MultiMesh.new()
	multi_mesh.transform_format = MultiMesh.TRANSFORM_3D
	multi_mesh.mesh = mesh
	multi_mesh.instance_count = 6
	for index in 6:
		multi_mesh.set_instance_transform(index, Transform3D(Basis(), Vector3(1.1 * index - 2.8, 0.5, 0.3 * (index % 2))))
	await _check_same("instances", func() -> void:
		var node := MultiMeshInstance3D.new()
		node.multimesh = multi_mesh
		node.material_override = _make_shader("void vertex() { VERTEX.x += 0.4 * sin(2.0 * MODEL_MATRIX[3].x) * (VERTEX.y + 0.5); }\nvoid fragment() { ALBEDO = vec3(0.5); }")
		_root.add_child(node),
		func() -> void:
			for index in 6:
				var place := multi_mesh.get_instance_transform(index).origin
				_add(_move(mesh, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return at + Vector3(0.4 * sin(2.0 * place.x) * (at.y + 0.5), 0, 0)), place, _plain()))


## Instances that are moved alike share one pose, also if a GridMap has several meshes.
func test_cells_of_a_grid_map_are_moved_alike() -> void:
	const CODE := "void vertex() { VERTEX.x += 0.3 * VERTEX.y * VERTEX.y; }\nvoid fragment() { ALBEDO = vec3(0.5); }"
	var meshes: Array[ArrayMesh] = [_make_box(), _make_plane()]
	var lean := func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return at + Vector3(0.3 * at.y * at.y, 0, 0)
	const CELLS: Array[Vector2i] = [Vector2i(-2, 0), Vector2i(0, 1), Vector2i(1, 0), Vector2i(2, 0)] # x, item
	await _check_same("grid map", func() -> void:
		var library := MeshLibrary.new()
		for item in 2:
			library.create_item(item)
			var mesh: ArrayMesh = meshes[item].duplicate()
			mesh.surface_set_material(0, _make_shader(CODE))
			library.set_item_mesh(item, mesh)
		var grid := GridMap.new()
		grid.mesh_library = library
		grid.cell_size = Vector3.ONE
		for cell in CELLS:
			grid.set_cell_item(Vector3i(cell.x, 0, 0), cell.y)
		_root.add_child(grid),
		func() -> void:
			for cell in CELLS:
				_add(_move(meshes[cell.y], lean), Vector3(cell.x + 0.5, 0.5, 0.5), _plain()))


## A texture may be replaced, and its former one freed, at any time.
func test_a_texture_that_moves_vertices_is_replaced() -> void:
	_begin()
	var shadow := _add_shadow(_sun)
	var material := _make_shader("uniform sampler2D heights;\nvoid vertex() { VERTEX.y += texture(heights, UV).r; }\nvoid fragment() { ALBEDO = vec3(0.5); }")
	_add(_make_plane(), Vector3(0, 0.5, 0), material)
	var masks: Array[Image] = []
	for step in 40:
		var image := Image.create(2, 2, false, Image.FORMAT_RF)
		image.fill(Color(float(step % 2), 0, 0))
		material.set_shader_parameter("heights", ImageTexture.create_from_image(image) if step % 5 < 4 else null)
		await draw_frames(4 if step > 37 else 1)
		if step > 37:
			masks.append(await MaskReader.new(shadow).read())
	material.set_shader_parameter("heights", null)
	await draw_frames(130) # until textures that are not used are forgotten
	check(count_different(masks[0], masks[1], 0.5) > 100, "the heights of the last texture are used")
	await _end()


func test_blend_shapes_and_a_shader_move_vertices() -> void:
	var box := _make_box()
	var arrays := box.surface_get_arrays(0)
	var shape := []
	shape.resize(Mesh.ARRAY_MAX)
	var wide := PackedVector3Array()
	for vertex: Vector3 in arrays[Mesh.ARRAY_VERTEX]:
		wide.append(Vector3(vertex.x, 0, 0)) # offsets
	shape[Mesh.ARRAY_VERTEX] = wide
	shape[Mesh.ARRAY_NORMAL] = arrays[Mesh.ARRAY_NORMAL]
	var sources := []
	sources.resize(Mesh.ARRAY_MAX)
	sources[Mesh.ARRAY_VERTEX] = arrays[Mesh.ARRAY_VERTEX]
	sources[Mesh.ARRAY_NORMAL] = arrays[Mesh.ARRAY_NORMAL]
	sources[Mesh.ARRAY_INDEX] = arrays[Mesh.ARRAY_INDEX]
	var mesh := ArrayMesh.new()
	mesh.add_blend_shape("wide")
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, sources, [shape])
	await _check_same("blend shape", func() -> void:
		var node := _add(mesh, Vector3(0, 0.6, 0), _make_shader("void vertex() { VERTEX.y += 0.3 * VERTEX.x; }\nvoid fragment() { ALBEDO = vec3(0.5); }"))
		node.set_blend_shape_value(0, 1.0),
		func() -> void:
			_add(_move(box, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return Vector3(2.0 * at.x, at.y + 0.6 * at.x, at.z)), Vector3(0, 0.6, 0), _plain()))


## Leaves in the wind: cut out by alpha, and moved.
func test_cut_outs_that_a_shader_moves_cast_as_they_are_drawn() -> void:
	var image := Image.create(64, 64, false, Image.FORMAT_RGBA8)
	for y in 64:
		for x in 64:
			var distance := Vector2(x - 31.5, y - 31.5).length()
			image.set_pixel(x, y, Color(0.5, 0.5, 0.5, 1.0 if distance < 26.0 and distance > 9.0 else 0.0))
	var leaf := ImageTexture.create_from_image(image)
	const CUT := "render_mode cull_disabled;\nuniform sampler2D leaf : source_color, repeat_disable;\nuniform float wind = 0.0;\nvoid vertex() { VERTEX.y += wind * VERTEX.x * VERTEX.x; }\nvoid fragment() { vec4 c = texture(leaf, UV); ALBEDO = c.rgb; ALPHA = c.a; ALPHA_SCISSOR_THRESHOLD = 0.5; }"
	var moved := _make_shader(CUT)
	moved.set_shader_parameter("leaf", leaf)
	moved.set_shader_parameter("wind", 0.4)
	var still := _make_shader(CUT.replace("VERTEX.y += wind * VERTEX.x * VERTEX.x;", ""))
	still.set_shader_parameter("leaf", leaf)
	var mesh := _make_plane()
	await _check_same("leaf", func() -> void: _add(mesh, Vector3(0, 0.6, 0), moved), func() -> void:
		_add(_move(mesh, func(at: Vector3, _normal: Vector3, _uv: Vector2, _color: Color) -> Vector3: return at + Vector3(0, 0.4 * at.x * at.x, 0)), Vector3(0, 0.6, 0), still))


## The plate moves several times its distance to its shadow in each frame, so a TIME of another frame would darken it, or move its
## shadow off its place.
func test_time_is_that_of_the_frame() -> void:
	_begin()
	var shadow := _add_shadow(_sun)
	var plane := PlaneMesh.new()
	plane.size = Vector2(30, 30)
	_add(plane, Vector3(0, 1, 0), _make_shader("void vertex() { VERTEX.y += 0.8 * sin(900.0 * TIME); }\nvoid fragment() { ALBEDO = vec3(0.5); }")).extra_cull_margin = 2.0
	_camera.look_at_from_position(Vector3(0, 6, 4), Vector3(0, 0, 0))
	await draw_frames(5)
	var reader := MaskReader.new(shadow)
	for frame in 6:
		var mask := await reader.read()
		check(count_darker(mask, 0.9) < 20, "frame %d: %d pixels of the lit plate are dark" % [frame, count_darker(mask, 0.9)])
		Engine.time_scale = 0.37 if frame == 2 else 1.0
	await _end()


func test_motion_that_is_not_read_keeps_the_shadow_of_godot() -> void:
	for built_in: String in ["CAMERA_POSITION_WORLD.x", "VIEW_MATRIX[3].x", "float(VIEWPORT_SIZE.x)", "CUSTOM0.x"]:
		_begin()
		var shadow := _add_shadow(_sun)
		_add(_make_plane(), Vector3(0, 1, 0), _make_shader("void vertex() { VERTEX.y += 0.001 * %s; }" % built_in))
		var before := await _take()
		shadow.visible = false
		var after := await _take()
		var pixel := Vector2i(_camera.unproject_position(Vector3(0, 1, 0)))
		check(absf(before.get_pixelv(pixel).get_luminance() - after.get_pixelv(pixel).get_luminance()) < TOLERANCE, built_in + " keeps the light of Godot")
		await _end()
