extends SmallScene
## Small scenes as games have them, in which Gnomon's shadow must be where Godot's is. Brightness is compared at points of the
## world that are well inside or outside of the shadow.


func test_billboards_cast_as_they_face_the_camera() -> void:
	for mode: BaseMaterial3D.BillboardMode in [BaseMaterial3D.BILLBOARD_ENABLED, BaseMaterial3D.BILLBOARD_FIXED_Y]:
		for keeps_scale: bool in [false, true]:
			_begin()
			var material := StandardMaterial3D.new()
			material.billboard_mode = mode
			material.billboard_keep_scale = keeps_scale
			var quad := _add(QuadMesh.new(), Vector3(-1, 1.2, 0), material)
			quad.scale = Vector3(1.5, 0.7, 1)
			quad.rotation_degrees = Vector3(0, 80, 20)
			var points: Array[Vector3] = [_floor_below(quad.position), _floor_below(quad.position + Vector3(0.3, 0.1, 0)), _floor_below(quad.position + Vector3(1.0, 0.6, 0))]
			for y: float in [-0.3, 0.0, 0.3]:
				points.append(quad.position + _camera.global_basis.y * y)
			await _compare("billboard %d %s" % [mode, keeps_scale], points)
			await _end()


func test_grown_meshes_cast_and_receive_as_they_are_drawn() -> void:
	for grow: float in [-0.2, 0.25]:
		_begin()
		var material := StandardMaterial3D.new()
		material.grow = true
		material.grow_amount = grow
		var sphere := _add(SphereMesh.new(), Vector3(-1, 1, 0), material)
		var radius := 0.5 + grow
		var points: Array[Vector3] = [sphere.position + _sun.global_basis.z * radius, sphere.position + Vector3.UP * radius, _floor_below(sphere.position)]
		for side: Vector3 in [_sun.global_basis.x, -_sun.global_basis.x, _sun.global_basis.y]:
			points.append(_floor_below(sphere.position + side * (radius - 0.1)))
			points.append(_floor_below(sphere.position + side * (radius + 0.1)))
		await _compare("grow %.2f" % grow, points)
		await _end()


func test_surfaces_that_a_shader_moves_do_not_shadow_themselves() -> void:
	const SHADERS: Array[String] = [
		"void vertex() { VERTEX.y -= 0.7; }\nvoid fragment() { ALBEDO = vec3(0.2, 0.5, 0.9); }",
		"void vertex() { VERTEX += vec3(0.0, -0.7 - 0.01 * sin(TIME), 0.0); }",
		"void vertex() { VERTEX = VERTEX - NORMAL * 0.7; }",
		"void sink(inout vec3 v) { v.y -= 0.7; }\nvoid vertex() { sink(VERTEX); }",
		"void vertex() { MODELVIEW_MATRIX = MODELVIEW_MATRIX * mat4(vec4(1,0,0,0), vec4(0,1,0,0), vec4(0,0,1,0), vec4(0,-0.7,0,1)); }",
		"render_mode world_vertex_coords;\nvoid vertex() { VERTEX[1] -= 0.7; }",
		"render_mode skip_vertex_transform;\nvoid vertex() { VERTEX = (MODELVIEW_MATRIX * vec4(VERTEX - vec3(0.0, 0.7, 0.0), 1.0)).xyz; NORMAL = normalize((MODELVIEW_MATRIX * vec4(NORMAL, 0.0)).xyz); }",
	]
	for index in SHADERS.size():
		_begin()
		var mesh := PlaneMesh.new()
		mesh.size = Vector2(3, 2)
		_add(mesh, Vector3(0, 1, 0), _make_shader(SHADERS[index]))
		var points: Array[Vector3] = [Vector3(-1, 0.3, 0), Vector3(0, 0.3, 0), Vector3(1, 0.3, 0), _floor_below(Vector3(-1.4, 1, -0.9))]
		await _compare("moved %d" % index, points)
		await _end()


## A vertex() that only computes values for fragment() changes nothing.
func test_surfaces_whose_shader_moves_no_vertex_cast() -> void:
	_begin()
	_add_box(Vector3(0, 0.5, 0), _make_shader("varying float height;\nvoid vertex() { height = VERTEX.y; UV = UV * 2.0; if (VERTEX.y == 1.0 && VERTEX.x <= 1.0) { height = 2.0; } }\nvoid fragment() { ALBEDO = vec3(0.3 + 0.1 * height); }"))
	var below := _floor_below(Vector3(-0.3, 0.8, -0.3))
	await _compare("shader box", [below, Vector3(0, 1, 0), Vector3(2, 0, 2)])
	check(_viewport.get_texture().get_image().get_pixelv(Vector2i(_camera.unproject_position(below))).get_luminance() < 0.5, "the floor is in its shadow")
	await _end()


func test_nodes_that_their_visibility_range_hides_cast_nothing() -> void:
	for range: Vector4 in [Vector4(0, 3, 0, 0), Vector4(12, 0, 0, 0), Vector4(0, 20, 0, 5), Vector4(2, 30, 1, 1)]:
		_begin()
		var box := _add_box(Vector3(0, 0.5, 0))
		box.visibility_range_begin = range.x
		box.visibility_range_end = range.y
		box.visibility_range_begin_margin = range.z
		box.visibility_range_end_margin = range.w
		await _compare("range %s" % range, [Vector3(0, 0, 0), Vector3(0, 1, 0), _floor_below(Vector3(-0.3, 0.8, -0.3))])
		await _end()


## A hierarchical level of detail: the parent replaces its children in the distance.
func test_children_of_a_visibility_parent_cast_where_they_are_drawn() -> void:
	for distance: float in [1.0, 2.5]:
		_begin()
		_camera.position *= distance
		var parent := _add_box(Vector3(-0.8, 0.5, 0))
		parent.visibility_range_begin = 10.0
		var child := _add_box(Vector3(0.8, 0.5, 0))
		child.visibility_parent = child.get_path_to(parent)
		await _compare("parent %.1f" % distance, [_floor_below(Vector3(-1.1, 0.8, -0.3)), _floor_below(Vector3(0.5, 0.8, -0.3)), parent.position + Vector3.UP * 0.5, child.position + Vector3.UP * 0.5])
		await _end()


func test_items_of_a_mesh_library_cast_as_they_are_set() -> void:
	for setting: RenderingServer.ShadowCastingSetting in [RenderingServer.SHADOW_CASTING_SETTING_OFF, RenderingServer.SHADOW_CASTING_SETTING_ON, RenderingServer.SHADOW_CASTING_SETTING_DOUBLE_SIDED, RenderingServer.SHADOW_CASTING_SETTING_SHADOWS_ONLY]:
		_begin()
		var items := MeshLibrary.new()
		var mesh := BoxMesh.new()
		for item in 3: # item 0 has no mesh, items 1 and 2 have the same one
			items.create_item(item)
			if item > 0:
				items.set_item_mesh(item, mesh)
		items.set_item_mesh_transform(1, Transform3D(Basis(), Vector3(0, 0.2, 0)))
		items.set_item_mesh_cast_shadow(1, setting)
		var grid := GridMap.new()
		grid.mesh_library = items
		grid.cell_size = Vector3.ONE
		_root.add_child(grid)
		grid.set_cell_item(Vector3i(-3, 0, 0), 0)
		grid.set_cell_item(Vector3i(-2, 0, 0), 1)
		grid.set_cell_item(Vector3i(1, 0, 0), 2)
		await _compare("grid %d" % setting, [_floor_below(Vector3(-1.8, 0.9, 0.2)), _floor_below(Vector3(1.2, 0.8, 0.2))])
		await _end()


func test_orthogonal_views_have_the_shadow_of_godot() -> void:
	_begin()
	_camera.projection = Camera3D.PROJECTION_ORTHOGONAL
	_camera.size = 6
	_add_box(Vector3(0, 0.5, 0))
	await _compare("orthogonal", [_floor_below(Vector3(-0.3, 0.8, -0.3)), Vector3(0, 1, 0), Vector3(2, 0, 1)])
	await _end()


func test_shadows_end_where_the_properties_of_the_light_end_them() -> void:
	const POINTS: Array[Vector3] = [Vector3(-0.3, 0.8, -0.3), Vector3(-0.2, 0.9, -0.3)]
	for distance: float in [5.0, 7.5, 9.0, 100.0]:  # the camera is about 7 m away
		for fade_start: float in [0.5, 1.0]:
			_begin()
			_sun.directional_shadow_max_distance = distance
			_sun.directional_shadow_fade_start = fade_start
			_add_box(Vector3(0, 0.5, 0))
			await _compare("max distance %.1f %.1f" % [distance, fade_start], [_floor_below(POINTS[0]), _floor_below(POINTS[1]), Vector3(2, 0, 2)])
			await _end()
	for values: Vector2 in [Vector2(3, 2), Vector2(6, 4), Vector2(20, 10)]:
		_begin()
		_sun.visible = false
		var lamp := OmniLight3D.new()
		lamp.position = Vector3(1.5, 3, 1)
		lamp.omni_range = 12
		lamp.light_size = 0.02
		lamp.light_energy = 8
		lamp.shadow_enabled = true
		lamp.distance_fade_enabled = true
		lamp.distance_fade_begin = 100
		lamp.distance_fade_shadow = values.x
		lamp.distance_fade_length = values.y
		_root.add_child(lamp)
		_add_box(Vector3(0, 0.5, 0))
		await _compare("distance fade %s" % values, [Vector3(-0.75, 0, -0.5), Vector3(-0.75, 0, 0), Vector3(2, 0, 2)])
		await _end()


func test_lights_without_shadow_have_no_mask() -> void:
	_begin()
	_add_box(Vector3(0, 0.5, 0))
	_sun.shadow_enabled = false
	await _compare("shadow_enabled", [_floor_below(Vector3(-0.3, 0.8, -0.3)), Vector3(2, 0, 2)])
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	_sun.add_child(shadow)
	await draw_frames(2)
	check(not shadow.makes_mask() and not shadow.get_warning().is_empty(), "no mask, and a warning")
	_sun.shadow_enabled = true
	await draw_frames(2)
	check(shadow.makes_mask() and shadow.get_warning().is_empty(), "a mask, and no warning")
	_sun.shadow_enabled = false
	await draw_frames(2)
	check(not shadow.makes_mask(), "no mask again")
	await _end()


## If there are more lights than masks, those that cover more of the view have one, and lights without a size come last.
func test_lights_that_cover_more_of_the_view_have_masks() -> void:
	_begin()
	ProjectSettings.set_setting("rendering/gnomon/most_lights", 3)
	var shadows: Array[Node3D] = []
	for position: Vector3 in [Vector3(0, 1, 60), Vector3(0, 1, -60), Vector3(-1, 2, 0), Vector3(1, 2, -4), Vector3(0, 2, 1)]:
		var lamp := OmniLight3D.new()
		lamp.position = position
		lamp.omni_range = 5
		lamp.light_size = 0.0 if position == Vector3(0, 2, 1) else 0.1
		lamp.shadow_enabled = true
		_root.add_child(lamp)
		shadows.append(ClassDB.instantiate("GnomonShadow3D"))
		lamp.add_child(shadows.back())
	var plane := PlaneMesh.new()
	plane.size = Vector2(200, 200)
	_add(plane, Vector3.ZERO)
	await draw_frames(3)
	var masked := shadows.map(func(shadow: Node3D) -> bool: return shadow.makes_mask())
	check(masked == [false, true, true, true, false], "masks: %s" % [masked])
	_camera.look_at_from_position(Vector3(0, 4, 0), Vector3(0, 0, 60))
	await draw_frames(3)
	masked = shadows.map(func(shadow: Node3D) -> bool: return shadow.makes_mask())
	check(masked == [true, false, true, true, false], "the camera turned round: %s" % [masked])
	ProjectSettings.set_setting("rendering/gnomon/most_lights", null)
	await _end()


## A card of which the middle quarter is opaque in the given channel of its texture.
func _add_card(shader: String, channel := 3, inverted := false, parameters := {}) -> MeshInstance3D:
	var image := Image.create(64, 64, false, Image.FORMAT_RGBA8)
	var other := Color(0.3, 0.8, 0.4, 1)
	var middle := other
	other[channel] = 1.0 if inverted else 0.0
	middle[channel] = 0.0 if inverted else 1.0
	image.fill(other)
	image.fill_rect(Rect2i(24, 0, 16, 64), middle)
	var mesh := PlaneMesh.new()
	mesh.size = Vector2(2, 2)
	var material := _make_shader("render_mode cull_disabled;\n" + shader)
	material.set_shader_parameter("leaf", ImageTexture.create_from_image(image))
	for parameter: String in parameters:
		material.set_shader_parameter(parameter, parameters[parameter])
	return _add(mesh, Vector3(0, 1, 0), material)


func _compare_card(label: String) -> void:
	var points: Array[Vector3] = []
	for x: float in [-0.8, -0.4, 0.4, 0.8]:
		points.append(_floor_below(Vector3(x, 1, 0)))
		points.append(Vector3(x, 0, 1))
	points.append(_floor_below(Vector3(0, 1, -0.4)))
	points.append(Vector3(0.1, 1, 0.3))
	await _compare(label, points)


func test_cards_cut_out_by_a_shader_cast_their_opaque_part() -> void:
	const LEAF := "uniform sampler2D leaf : source_color;\n"
	const FORMS := [
		["void fragment() { vec4 c = texture(leaf, UV); ALBEDO = c.rgb; ALPHA = c.a; ALPHA_SCISSOR_THRESHOLD = 0.5; }", 3],
		["void fragment() { ALPHA = texture(leaf, UV).a; ALPHA_SCISSOR_THRESHOLD = 0.3; }", 3],
		["const float LIMIT = 0.4; // of alpha\nvoid fragment() { if (texture(leaf, UV).a < LIMIT) { discard; } }", 3],
		["void fragment() { vec4 c = texture(leaf, UV); if (0.5 >= c.r) discard; ALBEDO = vec3(0.3); }", 0],
		["uniform float limit = 0.5;\nuniform vec4 tint : source_color = vec4(1.0);\nvoid fragment() { vec4 c = tint * texture(leaf, UV); ALBEDO = c.rgb; ALPHA = c.a; ALPHA_SCISSOR_THRESHOLD = limit; }", 3],
		["void fragment() { ALPHA = 1.0 - texture(leaf, UV).g; ALPHA_SCISSOR_THRESHOLD = 0.5; }", 1, true],
		["uniform vec2 size = vec2(2.0, 1.0);\nvarying vec2 base;\nvoid vertex() { UV = UV * size; base = UV; }\nvoid fragment() { vec2 uv = base / size; float a = texture(leaf, uv).a; ALPHA = clamp(a, 0.0, 1.0); ALPHA_SCISSOR_THRESHOLD = 0.5; }", 3],
		["void fragment() {\n// Texture:2\n\tvec4 n_out2p0 = texture(leaf, UV);\n\tfloat n_out2p4 = n_out2p0.a;\n\n// FloatConstant:3\n\tfloat n_out3p0 = 0.500000;\n\n\tALBEDO = vec3(n_out2p0.xyz);\n\tALPHA = n_out2p4;\n\tALPHA_SCISSOR_THRESHOLD = n_out3p0;\n}", 3],
		["uniform vec4 tint : source_color;\nuniform float limit;\nvoid fragment() { vec4 c = texture(leaf, UV); ALBEDO = c.rgb; ALPHA = c.a * (1.0 + tint.a) - 0.5; ALPHA_SCISSOR_THRESHOLD = limit; }", 3],
		["uniform bool dim = true;\nvoid fragment() { vec4 c = texture(leaf, UV); ALBEDO = c.rgb; if (dim) { ALBEDO *= 0.8; } for (int i = 0; i < 2; i++) { ROUGHNESS *= 0.9; } ALPHA = c.a; ALPHA_SCISSOR_THRESHOLD = 0.5; }", 3],
	]
	for index in FORMS.size():
		var form: Array = FORMS[index]
		_begin()
		_add_card(LEAF + form[0], form[1], form.size() > 2 and form[2])
		await _compare_card("cut out %d" % index)
		await _end()


func test_cards_cut_out_in_a_way_that_is_not_read_do_not_shadow_themselves() -> void:
	const FORMS: Array[String] = [
		"uniform sampler2D leaf;\nfloat wave(float x) { return sin(x); }\nvoid fragment() { ALPHA = wave(UV.x * 30.0); ALPHA_SCISSOR_THRESHOLD = 0.5; }",
		"void fragment() { if (fract(UV.x * 4.0) < 0.5) discard; }",
		"uniform sampler2D leaf;\nvoid fragment() { ALPHA = texture(leaf, UV).a * texture(leaf, UV.yx).a; ALPHA_SCISSOR_THRESHOLD = 0.5; }",
		"uniform sampler2D leaf;\nvoid fragment() { vec4 c = texture(leaf, UV); if (UV.x > 0.5) { c.a = 0.0; } ALPHA = c.a; ALPHA_SCISSOR_THRESHOLD = 0.5; }",
	]
	for index in FORMS.size():
		_begin()
		_add_card(FORMS[index])
		await _compare("not read %d" % index, [Vector3(0.125, 1, 0.3), Vector3(0.375, 1, -0.3), Vector3(0.375, 1, 0), Vector3(2, 0, 2)])
		await _end()


## Terrain and voxel add-ons draw through the RenderingServer. Their material may move the vertices by a height map.
func test_objects_that_are_no_nodes_keep_the_shadow_of_godot() -> void:
	for moves: bool in [false, true]:
		_begin()
		for floor_node in _root.find_children("*", "MeshInstance3D", true, false):
			floor_node.free()
		_add_box(Vector3(0, 0.5, 0))
		var tile := PlaneMesh.new()
		tile.size = Vector2(5, 5)
		if moves:
			tile.material = _make_shader("void vertex() { VERTEX.y = 0.0; }")
			tile.center_offset = Vector3(0, -0.5, 0)
		else:
			tile.material = StandardMaterial3D.new()
		var instances: Array[RID] = []
		for x in [-1, 0, 1]:
			for z in [-1, 0, 1]:
				instances.append(RenderingServer.instance_create2(tile.get_rid(), _viewport.find_world_3d().scenario))
				RenderingServer.instance_set_transform(instances.back(), Transform3D(Basis(), Vector3(5 * x, 0, 5 * z)))
		await _compare("terrain %s" % moves, [_floor_below(Vector3(-0.3, 0.8, -0.3)), Vector3(2, 0, 2), Vector3(0, 1, 0)])
		for instance in instances:
			RenderingServer.free_rid(instance)
		await _end()


func test_the_server_makes_objects_cast_that_are_no_nodes() -> void:
	_begin(false)
	var server: Object = Engine.get_singleton("GnomonServer")
	var mesh := BoxMesh.new()
	mesh.material = StandardMaterial3D.new()
	var at := Transform3D(Basis(), Vector3(0, 0.5, 0))
	var instance := RenderingServer.instance_create2(mesh.get_rid(), _viewport.find_world_3d().scenario)
	RenderingServer.instance_set_transform(instance, at)
	server.add_caster(instance, mesh.get_rid(), at, 1, RID())
	var points: Array[Vector3] = [_floor_below(Vector3(-0.3, 0.8, -0.3)), _floor_below(Vector3(1.7, 0.8, -0.3)), Vector3(2, 0, 2)]
	await _compare("server added", points)
	at.origin.x = 2
	RenderingServer.instance_set_transform(instance, at)
	server.move_caster(instance, at)
	await _compare("server moved", points)
	server.remove_caster(instance)
	RenderingServer.free_rid(instance)
	await _compare("server removed", points)
	check(server.count_casters() == 0, "no casters are left")
	await _end()


## A leaf whose material exists only on the RenderingServer.
func test_the_server_reads_cut_out_materials() -> void:
	_begin(false)
	var server: Object = Engine.get_singleton("GnomonServer")
	var image := Image.create(64, 64, false, Image.FORMAT_RGBA8)
	image.fill_rect(Rect2i(24, 0, 16, 64), Color.WHITE)
	var material := StandardMaterial3D.new()
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR
	material.albedo_texture = ImageTexture.create_from_image(image)
	material.cull_mode = BaseMaterial3D.CULL_DISABLED
	var mesh := PlaneMesh.new()
	var at := Transform3D(Basis(), Vector3(0, 1, 0))
	var instance := RenderingServer.instance_create2(mesh.get_rid(), _viewport.find_world_3d().scenario)
	RenderingServer.instance_set_transform(instance, at)
	RenderingServer.instance_geometry_set_material_override(instance, material.get_rid())
	server.add_caster(instance, mesh.get_rid(), at, 1, material.get_rid())
	await _compare_card("server leaf")
	server.remove_caster(instance)
	RenderingServer.free_rid(instance)
	await _end()


## test_addon.py counts the messages.
func test_the_server_refuses_what_it_cannot_cast() -> void:
	_begin(false)
	var server: Object = Engine.get_singleton("GnomonServer")
	var mesh := BoxMesh.new()
	var scenario := _viewport.find_world_3d().scenario
	var instance := RenderingServer.instance_create2(mesh.get_rid(), scenario)
	server.add_caster(RID(), mesh.get_rid(), Transform3D(), 1, RID())
	server.add_caster(instance, RID(), Transform3D(), 1, RID())
	var empty := RenderingServer.mesh_create()  # without surfaces
	server.add_caster(instance, empty, Transform3D(), 1, RID())
	RenderingServer.free_rid(empty)
	server.add_caster(instance, mesh.get_rid(), Transform3D(Basis(), Vector3(NAN, 0, 0)), 1, RID())
	server.add_caster(instance, mesh.get_rid(), Transform3D(), 0, RID())
	server.move_caster(instance, Transform3D())
	server.remove_caster(instance)
	check(server.count_casters() == 0, "nothing was added")
	server.add_caster(instance, mesh.get_rid(), Transform3D(), 1, RID())
	server.add_caster(instance, mesh.get_rid(), Transform3D(Basis(), Vector3(1, 0.5, 0)), 1, RID()) # replaces it
	check(server.count_casters() == 1, "one caster")
	RenderingServer.free_rid(instance)
	mesh = null  # the mesh is freed too, before its caster
	_sun.add_child(ClassDB.instantiate("GnomonShadow3D"))
	await draw_frames(3)
	server.remove_caster(instance)
	await draw_frames(2)
	await _end()


func test_the_server_takes_ten_thousand_calls_a_frame() -> void:
	_begin(false)
	var server: Object = Engine.get_singleton("GnomonServer")
	var mesh := BoxMesh.new()
	var instances: Array[RID] = []
	for index in 200:
		instances.append(RenderingServer.instance_create2(mesh.get_rid(), _viewport.find_world_3d().scenario))
		server.add_caster(instances.back(), mesh.get_rid(), Transform3D(Basis().scaled(Vector3.ONE * 0.1), Vector3(index % 20 * 0.3 - 3.0, 0.2, index / 20 * 0.3 - 2.0)), 1, RID())
	_sun.add_child(ClassDB.instantiate("GnomonShadow3D"))
	for frame in 3:
		for call in 10000:
			var index := call % 200
			server.move_caster(instances[index], Transform3D(Basis().scaled(Vector3.ONE * 0.1), Vector3(index % 20 * 0.3 - 3.0, 0.2 + 0.01 * frame, index / 20 * 0.3 - 2.0)))
		await draw_frames(1)
	for instance in instances:
		server.remove_caster(instance)
		RenderingServer.free_rid(instance)
	check(server.count_casters() == 0, "no casters are left")
	await _end()


## Single-sided faces that point away from the light: Godot culls them. A flipped box is a room of single-sided walls.
func test_the_cull_mode_decides_which_faces_cast() -> void:
	for culling: BaseMaterial3D.CullMode in [BaseMaterial3D.CULL_BACK, BaseMaterial3D.CULL_FRONT, BaseMaterial3D.CULL_DISABLED]:
		for reversed: bool in [false, true]:
			for double_sided: bool in [false, true]:
				_begin()
				_sun.shadow_reverse_cull_face = reversed
				var material := StandardMaterial3D.new()
				material.cull_mode = culling
				var plane := PlaneMesh.new()
				plane.size = Vector2(1.5, 1.5)
				var ceiling := _add(plane, Vector3(-2, 1, 0), material)
				ceiling.rotation_degrees.x = 180
				var roof := _add(plane, Vector3(2, 1, 0), material)
				var room := BoxMesh.new()
				room.flip_faces = true
				var walls := _add(room, Vector3(0, 0.5, -1.5), material)
				for node: MeshInstance3D in [ceiling, roof, walls]:
					node.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_DOUBLE_SIDED if double_sided else GeometryInstance3D.SHADOW_CASTING_SETTING_ON
				await _compare("cull %d %s %s" % [culling, reversed, double_sided], [_floor_below(ceiling.position), _floor_below(roof.position), _floor_below(Vector3(-0.3, 0.8, -1.7))])
				await _end()


func test_back_faces_cast_if_the_node_says_so() -> void:
	_begin()
	var plane := PlaneMesh.new()
	plane.size = Vector2(1.5, 1.5)
	_add(plane, Vector3(0, 1, 0)).rotation_degrees.x = 180
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	_sun.add_child(shadow)
	var pixel := Vector2i(_camera.unproject_position(_floor_below(Vector3(0, 1, 0))))
	check((await _take()).get_pixelv(pixel).get_luminance() > 0.6, "it is lit below the ceiling")
	shadow.cast_back_faces = true
	check((await _take()).get_pixelv(pixel).get_luminance() < 0.5, "it is dark below the ceiling")
	await _end()


## Faces that are turned away from the sun, with vertex normals that face it: grass whose normals point up, in the sun and under a roof.
func test_surfaces_with_normals_of_their_own_are_shadowed_by_what_is_above() -> void:
	for kind: String in ["mesh", "shader"]:
		_begin()
		_sun.rotation_degrees = Vector3(-50, 215, 0)
		var arrays := QuadMesh.new().get_mesh_arrays()
		if kind == "mesh":
			arrays[Mesh.ARRAY_NORMAL].fill(Vector3.UP)
		var blade := ArrayMesh.new()
		blade.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
		var material: Material
		if kind == "mesh":
			material = StandardMaterial3D.new()
			material.cull_mode = BaseMaterial3D.CULL_BACK
		else:
			material = _make_shader("void vertex() { NORMAL = vec3(0.0, 1.0, 0.0); }\nvoid fragment() { ALBEDO = vec3(0.8); }")
		for x: float in [-1.5, 1.5]:
			_add(blade, Vector3(x, 0.5, 0), material)
		var roof := BoxMesh.new()
		roof.size = Vector3(2.4, 0.1, 3.0)
		_add(roof, Vector3(1.5, 1.6, -1.0))
		await _compare("own normals of a " + kind, [Vector3(-1.5, 0.5, 0), Vector3(-1.5, 0.8, 0), Vector3(1.5, 0.5, 0), Vector3(1.3, 0.7, 0)])
		var image := _viewport.get_texture().get_image()
		var lit := image.get_pixelv(Vector2i(_camera.unproject_position(Vector3(-1.5, 0.5, 0)))).get_luminance()
		var dark := image.get_pixelv(Vector2i(_camera.unproject_position(Vector3(1.5, 0.5, 0)))).get_luminance()
		check(lit > dark + 0.2, "%s: in the sun %.2f, under the roof %.2f" % [kind, lit, dark])
		await _end()


## The faces of a box whose normals are those of a sphere: the upper part of a face that is turned away from the sun has normals that
## face it, but is in the shadow of the box. A sphere of few facets is lit up to its terminator.
func test_smooth_boxes_are_dark_in_their_own_shadow() -> void:
	_begin()
	_sun.rotation_degrees = Vector3(-50, 215, 0)
	var arrays := BoxMesh.new().get_mesh_arrays()
	for index: int in arrays[Mesh.ARRAY_VERTEX].size():
		arrays[Mesh.ARRAY_NORMAL][index] = arrays[Mesh.ARRAY_VERTEX][index].normalized()
	var smooth := ArrayMesh.new()
	smooth.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	_add(smooth, Vector3(-1.2, 0.5, 0))
	var sphere := SphereMesh.new()
	sphere.radial_segments = 16
	sphere.rings = 8
	_add(sphere, Vector3(1.2, 0.5, 0))
	var points: Array[Vector3] = [Vector3(-1.5, 0.85, 0.5), Vector3(-1.2, 0.85, 0.5), Vector3(-0.9, 0.85, 0.5), Vector3(-1.2, 0.3, 0.5)]
	for angle: float in [-30.0, -10.0, 20.0, 45.0]:  # from the terminator to the shadow
		points.append(Vector3(1.2, 0.5, 0) + 0.49 * _sun.global_basis.z.rotated(_sun.global_basis.x, deg_to_rad(90 + angle)))
	await _compare("smooth box", points)
	await _end()


## Triangles that are turned away from the sun but have normals that face it are lit as Godot lights them, up to the terminator.
func test_columns_of_few_facets_are_lit_by_their_normals() -> void:
	for segments: int in [10, 14, 24]:
		_begin()
		_sun.rotation_degrees = Vector3(-20, 90, 0)
		_camera.look_at_from_position(Vector3(0, 1.3, 2.0), Vector3(0, 1, 0))
		var column := CylinderMesh.new()
		column.radial_segments = segments
		column.rings = 0
		# A facet is turned away from the sun by more than half of its angle, but some of its normals face the sun.
		_add(column, Vector3(0, 1, 0)).rotation.y = 0.5 * TAU / segments
		_sun.rotation_degrees.y += 0.28 * 360.0 / segments
		var points: Array[Vector3] = []
		var towards_sun := Vector3(_sun.global_basis.z.x, 0, _sun.global_basis.z.z).normalized()
		for angle: float in range(50, 110, 2):
			points.append(Vector3(0, 1, 0) + 0.5 * towards_sun.rotated(Vector3.UP, -deg_to_rad(angle)))
		await _compare("column of %d facets" % segments, points)
		await _end()


## The box of particles is that of their property, not of their mesh.
func test_particles_are_in_the_shadow_of_a_roof() -> void:
	var cube := BoxMesh.new()
	cube.size = Vector3.ONE * 0.6
	cube.material = StandardMaterial3D.new()
	var process := ParticleProcessMaterial.new()
	process.gravity = Vector3.ZERO
	for is_simulated_on_gpu: bool in [true, false]:
		_begin()
		var particles: GeometryInstance3D
		if is_simulated_on_gpu:
			var simulated := GPUParticles3D.new()
			simulated.amount = 1
			simulated.lifetime = 1000
			simulated.process_material = process
			simulated.draw_pass_1 = cube
			particles = simulated
		else:
			var simulated := CPUParticles3D.new()
			simulated.amount = 1
			simulated.lifetime = 1000
			simulated.gravity = Vector3.ZERO
			simulated.mesh = cube
			particles = simulated
		particles.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
		particles.position = Vector3(0, 0.8, 0)
		_root.add_child(particles)
		var roof := BoxMesh.new()
		roof.size = Vector3(1.5, 0.1, 1.5)
		_add(roof, Vector3(0, 1.1, 0) + 1.5 * _sun.global_basis.z)
		await draw_frames(5)
		await _compare("particles %s" % is_simulated_on_gpu, [Vector3(0, 1.1, 0), Vector3(0, 0.9, 0.3), Vector3(2, 0, 1)])
		var image := _viewport.get_texture().get_image()
		var top := image.get_pixelv(Vector2i(_camera.unproject_position(Vector3(0, 1.1, 0)))).get_luminance()
		check(top < 0.4, "the roof darkens them: %.2f" % top)
		await _end()


## Godot draws a projector only with its own shadow. Gnomon's node is there from the first frame, so that Godot never drew its own light.
func test_projectors_show_their_texture() -> void:
	var pattern := Image.create(32, 32, false, Image.FORMAT_RGB8)
	pattern.fill(Color.WHITE)
	pattern.fill_rect(Rect2i(0, 0, 16, 32), Color.BLACK)
	var texture := ImageTexture.create_from_image(pattern)
	for light: Light3D in [OmniLight3D.new(), SpotLight3D.new()]:
		_begin()
		_sun.visible = false
		light.shadow_enabled = true
		light.light_energy = 6.0
		light.set_param(Light3D.PARAM_RANGE, 8.0)
		light.set_param(Light3D.PARAM_SPOT_ANGLE, 50.0)
		light.light_projector = texture
		light.position = Vector3(0.3, 3, 0.2)
		light.rotation_degrees.x = -90.0
		var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
		light.add_child(shadow)
		_root.add_child(light)
		_add_box(Vector3(0, 0.5, 0))
		await draw_frames(5)
		var gnomon := await _take()
		shadow.free()
		var godot := await _take()
		var is_dark := false
		var is_lit := false
		for point: Vector3 in [Vector3(-1.5, 0, 1), Vector3(1.8, 0, 1), Vector3(-1.5, 0, -1), Vector3(1.8, 0, -1), Vector3(0.2, 1, 0), Vector3(-0.3, 1, 0)]:
			var pixel := Vector2i(_camera.unproject_position(point))
			var expected := godot.get_pixelv(pixel).get_luminance()
			is_dark = is_dark or expected < 0.35
			is_lit = is_lit or expected > 0.5
			var found := gnomon.get_pixelv(pixel).get_luminance()
			check(absf(found - expected) < POINT_TOLERANCE, "%s at %s: %.3f, Godot %.3f" % [light.get_class(), point, found, expected])
		check(is_dark and is_lit, light.get_class() + ": the pattern has dark and lit parts")
		await _end()


## Godot draws the vertices of such a mesh, not its triangles.
func test_meshes_drawn_as_points_do_not_shadow_themselves() -> void:
	for has_shader: bool in [false, true]:
		_begin()
		var material: Material
		if has_shader:
			material = _make_shader("void vertex() { POINT_SIZE = 4.0; }\nvoid fragment() { ALBEDO = vec3(0.8); }")
		else:
			material = StandardMaterial3D.new()
			material.use_point_size = true
			material.point_size = 4.0
		_add(SphereMesh.new(), Vector3(0, 0.6, 0), material)
		_add_box(Vector3(1.6, 0.5, 0))
		await _compare("points %s" % has_shader, [Vector3(0, 1.0, 0.3), Vector3(0.1, 0.8, 0.46), Vector3(-0.3, 0.8, 0.35), Vector3(1.6, 1, 0), Vector3(-2, 0, 1)])
		await _end()


## Godot's shadow maps leave out faces that are seen from behind, so a lamp shines out of its bulb.
func test_a_lamp_inside_a_closed_mesh_shines_through_it() -> void:
	for mesh: PrimitiveMesh in [SphereMesh.new(), BoxMesh.new()]:
		for light: Light3D in [OmniLight3D.new(), SpotLight3D.new()]:
			_begin()
			_sun.visible = false
			light.shadow_enabled = true
			light.light_energy = 6.0
			light.set_param(Light3D.PARAM_SIZE, 0.1)
			light.position = Vector3(0, 1.2, 0)
			light.rotation_degrees.x = -90.0
			_root.add_child(light)
			_add(mesh, light.position)
			_add_box(Vector3(0.9, 0.5, 0.3))
			await _compare("lamp in %s of %s" % [mesh.get_class(), light.get_class()], [Vector3(0, 0, 1.3), Vector3(-0.6, 0, 0.3), Vector3(2.0, 0, 0.6)])
			await _end()


## The vertices of a soft body are moved by physics; its mesh as it was would shadow it.
func test_a_soft_body_casts_nothing_and_receives() -> void:
	_begin()
	var body := SoftBody3D.new()
	body.mesh = SphereMesh.new()
	body.position = Vector3(0, 1.5, 0)
	body.ray_pickable = false
	_root.add_child(body)
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	_sun.add_child(shadow)
	await draw_frames(4)
	check(count_darker(await MaskReader.new(shadow).read()) == 0, "nothing casts")
	await _end()
