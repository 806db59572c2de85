extends AddonTest
## Which nodes cast shadows, and which do not.


## Returns the mask of a study scene after `change` has modified it.
func _render(change: Callable) -> Image:
	var scene := add_study()
	change.call(scene)
	var mask := await read_settled(scene)
	remove(scene)
	return mask


func _render_without_caster() -> Image:
	return await _render(func(scene: StudyScene) -> void: scene.caster.visible = false)


func _render_with_caster() -> Image:
	return await _render(func(_scene: StudyScene) -> void: pass)


## Checks that the mask after `change` equals that of the unchanged scene or, if no shadow is expected, of the scene without its caster.
func _check_same(change: Callable, what: String, expects_shadow := true) -> void:
	var expected: Image
	if expects_shadow:
		expected = await _render_with_caster()
	else:
		expected = await _render_without_caster()
	var found := await _render(change)
	var count := 0
	var a := expected.get_data().to_float32_array()
	var b := found.get_data().to_float32_array()
	for index in a.size():
		# Pixels that only one mask has as receivers, those on the caster itself, are not compared.
		count += int(a[index] >= 0.0 and b[index] >= 0.0 and absf(a[index] - b[index]) > 1.0 / 255.0)
	check(count < 50, "%s: %d pixels differ" % [what, count])
	if expects_shadow:
		check(count_darker(found) > 500, what + " casts a shadow")


func test_hidden_and_switched_off_casters_cast_nothing() -> void:
	check(count_darker(await _render_with_caster()) > 500, "a box casts a shadow")
	check(count_darker(await _render_without_caster()) == 0, "a hidden one casts none")
	var off := func(scene: StudyScene) -> void: scene.caster.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	await _check_same(off, "cast_shadow off", false)


func test_shadows_only_and_double_sided_casters_cast() -> void:
	var both := func(scene: StudyScene) -> void: scene.caster.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_DOUBLE_SIDED
	await _check_same(both, "double-sided")
	# Seen from a camera that does not draw the caster, both look the same.
	var hide_from_camera := func(scene: StudyScene) -> void:
		scene.caster.layers = 2  # a bit mask, like cull_mask: no common layer
		scene.camera.cull_mask = 1
	var only := func(scene: StudyScene) -> void: scene.caster.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_SHADOWS_ONLY
	var expected := await _render(hide_from_camera)
	check(count_darker(expected) > 500, "a caster that the camera does not draw casts")
	check(count_different(expected, await _render(only)) == 0, "shadows only")


func test_the_shadow_caster_mask_selects_casters_by_layer() -> void:
	var other := func(scene: StudyScene) -> void:
		scene.light.shadow_caster_mask = 1
		scene.caster.layers = 2
	await _check_same(other, "a caster on another layer", false)
	var both := func(scene: StudyScene) -> void:
		scene.light.shadow_caster_mask = 3
		scene.caster.layers = 2
	await _check_same(both, "a caster on a chosen layer")


## Makes a texture with these alphas, one per column.
func _make_alpha_texture(columns: Array[float]) -> ImageTexture:
	var image := Image.create_empty(columns.size(), 4, false, Image.FORMAT_RGBA8)
	for x in columns.size():
		for y in 4:
			image.set_pixel(x, y, Color(1.0, 1.0, 1.0, columns[x]))
	return ImageTexture.create_from_image(image)


func _make_cut_out(columns: Array[float], kind := BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.transparency = kind
	material.albedo_texture = _make_alpha_texture(columns)
	return material


func test_holes_of_cut_out_materials_cast_nothing() -> void:
	for kind: BaseMaterial3D.Transparency in [BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR, BaseMaterial3D.TRANSPARENCY_ALPHA_HASH]:
		var use := func(columns: Array[float]) -> Callable:
			return func(scene: StudyScene) -> void: scene.caster.material_override = _make_cut_out(columns, kind)
		await _check_same(use.call([1.0, 1.0] as Array[float]), "opaque everywhere, kind %d" % kind)
		await _check_same(use.call([0.0, 0.1] as Array[float]), "opaque nowhere, kind %d" % kind, false)
	var stripes: Array[float] = []
	for column in 64:
		stripes.append(float(column / 4 % 2))
	var whole := count_darker(await _render_with_caster())
	var striped := count_darker(await _render(func(scene: StudyScene) -> void: scene.caster.material_override = _make_cut_out(stripes)))
	check(striped > 100 and striped != whole, "%d darker pixels with stripes, %d of the whole box" % [striped, whole])


func test_changes_of_cut_out_materials_update_the_mask() -> void:
	var scene := add_study()
	var material := _make_cut_out([0.4, 0.4] as Array[float])
	scene.caster.material_override = material
	check(count_darker(await read_settled(scene)) == 0, "0.4 is below the threshold of 0.5")
	material.alpha_scissor_threshold = 0.3
	check(count_darker(await read_settled(scene)) > 500, "0.4 is above the threshold of 0.3")
	material.albedo_color.a = 0.5
	check(count_darker(await read_settled(scene)) == 0, "the colour's alpha multiplies it")
	material.albedo_texture = _make_alpha_texture([1.0, 1.0] as Array[float])
	check(count_darker(await read_settled(scene)) > 500, "an opaque texture casts a shadow")
	(material.albedo_texture as ImageTexture).update(_make_alpha_texture([0.1, 0.1] as Array[float]).get_image())
	check(count_darker(await read_settled(scene)) == 0, "changed texels below the threshold cast none")
	remove(scene)


## test_addon.py checks the warning.
func test_shaders_that_cut_out_nothing_cast_whole() -> void:
	const FORMS: Array[String] = [
		"void fragment() { ALPHA = 0.9; ALPHA_SCISSOR_THRESHOLD = 0.5; }",
		# Uniforms without a value are 0, and samplers without a texture white.
		"uniform vec4 tint : source_color;\nuniform float limit;\nuniform sampler2D leaf : source_color;\nvoid fragment() { ALPHA = tint.a * texture(leaf, UV).a; ALPHA_SCISSOR_THRESHOLD = limit; }",
		"uniform sampler2D leaf : repeat_disable;\nvoid fragment() { if (texture(leaf, 2.0 * UV).r < 0.5) { discard; } }",
		"uniform sampler2D leaf : hint_default_black;\nvoid fragment() { ALPHA = 1.0 - texture(leaf, UV).g; ALPHA_SCISSOR_THRESHOLD = 0.5; }",
	]
	for form in FORMS:
		var shader := func(scene: StudyScene) -> void:
			var material := ShaderMaterial.new()
			material.shader = Shader.new()
			material.shader.code = "shader_type spatial;\n" + form
			scene.caster.material_override = material
		await _check_same(shader, form)


func test_blended_materials_cast_nothing() -> void:
	var blend := func(scene: StudyScene) -> void:
		var material := StandardMaterial3D.new()
		material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
		scene.caster.material_override = material
	await _check_same(blend, "alpha", false)
	var shader := func(scene: StudyScene) -> void:
		var material := ShaderMaterial.new()
		material.shader = Shader.new()
		material.shader.code = "shader_type spatial;\nvoid fragment() { ALPHA = 0.5; }"
		scene.caster.material_override = material
	await _check_same(shader, "a shader that writes ALPHA", false)
	var comment := func(scene: StudyScene) -> void:
		var material := ShaderMaterial.new()
		material.shader = Shader.new()
		material.shader.code = "shader_type spatial;\n// no ALPHA\nvoid fragment() { ALBEDO = vec3(1.0); }"
		scene.caster.material_override = material
	await _check_same(comment, "a shader that names ALPHA in a comment")


func test_a_multimesh_casts_as_its_meshes_do() -> void:
	var single := func(scene: StudyScene) -> void:
		for offset in [Vector3(0, 0.2, 0), Vector3(-1.5, 0, 0.5)]:
			scene.add_mesh("Box", scene.caster.mesh, scene.caster.transform.translated(offset))
		scene.caster.visible = false
	var multi := func(scene: StudyScene) -> void:
		var node := MultiMeshInstance3D.new()
		node.multimesh = MultiMesh.new()
		node.multimesh.transform_format = MultiMesh.TRANSFORM_3D
		node.multimesh.use_colors = true
		node.multimesh.mesh = scene.caster.mesh
		node.multimesh.instance_count = 3
		node.multimesh.visible_instance_count = 2
		node.multimesh.set_instance_transform(0, scene.caster.transform.translated(Vector3(0, 0.2, 0)))
		node.multimesh.set_instance_transform(1, scene.caster.transform.translated(Vector3(-1.5, 0, 0.5)))
		scene.add_child(node)
		scene.caster.visible = false
	var expected := await _render(single)
	var found := await _render(multi)
	check(count_darker(expected) > 1000, "two boxes cast shadows")
	check(count_different(expected, found) == 0, "a MultiMesh of two gives the same mask")


func test_csg_and_grid_maps_cast() -> void:
	var csg := func(scene: StudyScene) -> void:
		var box := CSGBox3D.new()
		box.transform = scene.caster.transform
		scene.add_child(box)
		scene.caster.visible = false
	await _check_same(csg, "a CSGBox3D")
	var grid := func(scene: StudyScene) -> void:
		var library := MeshLibrary.new()
		library.create_item(0)
		library.set_item_mesh(0, scene.caster.mesh)
		var map := GridMap.new()
		map.mesh_library = library
		map.cell_size = Vector3.ONE
		map.transform = scene.caster.transform.translated_local(Vector3(-0.5, -0.5, -0.5))
		map.set_cell_item(Vector3i.ZERO, 0)
		scene.add_child(map)
		scene.caster.visible = false
	await _check_same(grid, "a GridMap of one cell")


func test_triangle_strips_cast() -> void:
	var strip := func(scene: StudyScene) -> void:
		var arrays := []
		arrays.resize(Mesh.ARRAY_MAX)
		arrays[Mesh.ARRAY_VERTEX] = PackedVector3Array([Vector3(-1, 0, -1), Vector3(1, 0, -1), Vector3(-1, 0, 1), Vector3(1, 0, 1)])
		var mesh := ArrayMesh.new()
		mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLE_STRIP, arrays)
		scene.caster.mesh = mesh
	var plane := func(scene: StudyScene) -> void:
		scene.caster.mesh = PlaneMesh.new()
	var expected := await _render(plane)
	check(count_darker(expected) > 500, "a plane casts a shadow")
	check(count_different(expected, await _render(strip), 1.0 / 255.0) < 50, "a strip casts the same")


func test_large_meshes_cast_once_their_edges_are_found() -> void:
	var scene := add_study()
	var sphere := SphereMesh.new()
	sphere.radial_segments = 256
	sphere.rings = 128
	scene.caster.mesh = sphere
	await draw_frames(1)
	while scene.shadow.count_pending_casters() > 0:
		await draw_frames(1)
	check(count_darker(await read(scene)) > 500, "a mesh of 66,048 triangles casts")
