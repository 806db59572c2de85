extends AddonTest
## Skeletons and blend shapes: the masks equal those of static meshes whose vertices are where Godot draws the deformed ones.

const HEIGHT := 2.0  # of the column, m
const SUBDIVISIONS := 12  # of the column's height: 13 rows of quads
const TOLERANCE := 2.0 / 255.0


## Rotates a bone after all poses are set.
class Bend:
	extends SkeletonModifier3D

	func _process_modification_with_delta(_delta: float) -> void:
		get_skeleton().set_bone_pose_rotation(1, Quaternion(Vector3.BACK, 1.2))


## Returns the arrays of a closed column from y = 0 to HEIGHT, moved by `offset`. Its bones change with the height.
func _make_arrays(influences := 4, offset := Vector3.ZERO) -> Array:
	var box := BoxMesh.new()
	box.size = Vector3(0.5, HEIGHT, 0.3)
	box.subdivide_height = SUBDIVISIONS
	box.subdivide_width = 2
	var arrays := box.get_mesh_arrays()
	var positions: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var bones := PackedInt32Array()
	var weights := PackedFloat32Array()
	for index in positions.size():
		positions[index].y += 0.5 * HEIGHT
		positions[index] = positions[index].snapped(Vector3.ONE / 1024.0)  # adjacent faces have exactly the same positions
		var blend := smoothstep(0.3, 1.7, positions[index].y)
		# With eight influences, half of the weight of the tip's bone (2) is among the last four.
		var of_vertex := [0, 1, 2, 0, 1, 2, 2, 0].slice(0, influences)
		var tip := maxf(blend - 0.5, 0.0) * 0.8
		var values := [1.0 - blend, blend - 2.0 * tip, tip, 0.0, 0.0, tip, 0.0, 0.0].slice(0, influences)
		if influences == 4:
			values[2] *= 2.0
		bones.append_array(PackedInt32Array(of_vertex))
		weights.append_array(PackedFloat32Array(values))
		positions[index] += offset
	arrays[Mesh.ARRAY_VERTEX] = positions
	arrays[Mesh.ARRAY_BONES] = bones
	arrays[Mesh.ARRAY_WEIGHTS] = weights
	return arrays


func _make_mesh(influences := 4, offset := Vector3.ZERO) -> ArrayMesh:
	var mesh := ArrayMesh.new()
	var flags := Mesh.ARRAY_FLAG_USE_8_BONE_WEIGHTS if influences == 8 else 0
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, _make_arrays(influences, offset), [], {}, flags)
	return mesh


func _make_skeleton() -> Skeleton3D:
	var skeleton := Skeleton3D.new()
	skeleton.name = "Skeleton"
	for bone in 3:
		skeleton.add_bone("Bone %d" % bone)
		skeleton.set_bone_parent(bone, bone - 1)
		skeleton.set_bone_rest(bone, Transform3D(Basis(), Vector3(0, 0.6 * float(bone > 0), 0)))
		skeleton.reset_bone_pose(bone)
	skeleton.transform = Transform3D(Basis(Vector3.UP, 0.4), Vector3(0.3, 0.1, 0))
	return skeleton


func _bend(skeleton: Skeleton3D, angle: float) -> void:
	skeleton.set_bone_pose_rotation(1, Quaternion(Vector3.BACK, angle))
	skeleton.set_bone_pose_rotation(2, Quaternion(Vector3.RIGHT, 0.5 * angle))


## Makes the caster of a study scene a bent column. The caster and its skeleton have different transforms.
func _skin_caster(scene: StudyScene, mesh: Mesh, angle := 0.8) -> Skeleton3D:
	var skeleton := _make_skeleton()
	scene.add_child(skeleton)
	scene.caster.mesh = mesh
	scene.caster.transform = Transform3D(Basis(Vector3.UP, 0.5).scaled(Vector3(1.2, 0.8, 1.0)), Vector3(-0.4, 0.1, 0.3))
	scene.caster.skin = skeleton.create_skin_from_rest_transforms()
	scene.caster.skeleton = scene.caster.get_path_to(skeleton)
	_bend(skeleton, angle)
	return skeleton


## Returns the arrays of a skinned mesh with its vertices where Godot's shader moves them. Godot's own baking rounds weights differently.
func _bake_arrays(node: MeshInstance3D) -> Array:
	var skeleton := node.get_skin_reference().get_skeleton()
	var arrays := node.mesh.surface_get_arrays(0)
	var positions: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var bones: PackedInt32Array = arrays[Mesh.ARRAY_BONES]
	var weights: PackedFloat32Array = arrays[Mesh.ARRAY_WEIGHTS]
	var influences := bones.size() / positions.size()
	for vertex in positions.size():
		var moved := Vector3.ZERO
		for index in range(vertex * influences, (vertex + 1) * influences):
			moved += weights[index] * (RenderingServer.skeleton_bone_get_transform(skeleton, bones[index]) * positions[vertex])
		positions[vertex] = moved
	arrays[Mesh.ARRAY_VERTEX] = positions
	arrays[Mesh.ARRAY_BONES] = null
	arrays[Mesh.ARRAY_WEIGHTS] = null
	return arrays


func _bake_skeleton(node: MeshInstance3D, levels := {}) -> ArrayMesh:
	var baked := ArrayMesh.new()
	baked.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, _bake_arrays(node), [], levels)
	return baked


## Checks that the mask equals that of the static mesh that `bake` makes of the drawn caster.
func _check_as_baked(scene: StudyScene, bake: Callable, what: String) -> void:
	var found := await read_settled(scene)
	var material := scene.caster.get_active_material(0)
	var baked: ArrayMesh = bake.call()
	scene.caster.skin = null
	scene.caster.skeleton = NodePath()
	scene.caster.mesh = baked
	scene.caster.material_override = material
	var expected := await read_settled(scene)
	var different := count_different(expected, found, TOLERANCE)
	check(count_darker(expected) > 300, what + " casts a shadow")
	check(different < 20, "%s: %d pixels differ from the baked mesh's" % [what, different])
	remove(scene)


func _check_skeleton(scene: StudyScene, what: String) -> void:
	await _check_as_baked(scene, func() -> ArrayMesh: return _bake_skeleton(scene.caster), what)


func test_a_skinned_mesh_casts_where_it_is_drawn() -> void:
	for light in StudyScene.LIGHTS:
		for technique in ["edge_count", "pcss", "shadow_volume", "penumbra_fins"]:
			var scene := add_study(light)
			_skin_caster(scene, _make_mesh())
			scene.shadow.technique = technique
			await _check_skeleton(scene, "a bent column, %s, %s" % [light, technique])


func test_all_eight_bones_of_a_vertex_are_used() -> void:
	var scene := add_study()
	_skin_caster(scene, _make_mesh(8))
	await _check_skeleton(scene, "eight bones")


func test_skeleton_modifiers_are_applied() -> void:
	var scene := add_study()
	var skeleton := _skin_caster(scene, _make_mesh(), 0.0)
	var straight := await read_settled(scene)
	var modifier := Bend.new()
	skeleton.add_child(modifier)
	var bent := await read_settled(scene)
	check(count_different(straight, bent) > 200, "a modifier changes the mask")
	await _check_skeleton(scene, "with a modifier")


func test_a_pose_changes_the_mask_in_the_same_frame() -> void:
	for technique in ["edge_count", "pcss", "shadow_volume"]:
		var scene := add_study("spot")
		var skeleton := _skin_caster(scene, _make_mesh(), 0.1)
		scene.shadow.technique = technique
		var before := await read_settled(scene)
		_bend(skeleton, 1.0)
		var first := await read(scene)
		var settled := await read_settled(scene)
		check(count_different(before, settled) > 100, technique + ": a pose changes the mask")
		check(count_different(first, settled) == 0, technique + ": its first frame equals the settled one")
		remove(scene)


func test_a_figure_that_rests_outside_of_all_views_casts() -> void:
	for light in StudyScene.LIGHTS:
		var scene := add_study(light)
		var far := Vector3(300, 0, 40)
		var skeleton := _skin_caster(scene, _make_mesh(4, far))
		for bind in scene.caster.skin.get_bind_count():
			scene.caster.skin.set_bind_pose(bind, scene.caster.skin.get_bind_pose(bind).translated_local(-far))
		_bend(skeleton, 0.7)
		await _check_skeleton(scene, "a figure at rest far away, " + light)


## Far away it becomes visible that the weights of a vertex, rounded down to 16 bits, do not add up to 1.
func test_a_figure_far_from_its_node_casts_where_it_is_drawn() -> void:
	var scene := add_study()
	var skeleton := _skin_caster(scene, _make_mesh(), 0.7)
	skeleton.set_bone_pose_position(0, Vector3(120, 0, 0))
	scene.caster.transform = scene.caster.transform.translated_local(Vector3(-120, 0, 0))
	await _check_skeleton(scene, "a figure that its root moves")


func _make_blended(mode: Mesh.BlendShapeMode, has_bones := false) -> ArrayMesh:
	var arrays := _make_arrays()
	if not has_bones:
		arrays[Mesh.ARRAY_BONES] = null
		arrays[Mesh.ARRAY_WEIGHTS] = null
	var mesh := ArrayMesh.new()
	mesh.blend_shape_mode = mode
	var shapes: Array[Array] = []
	for shape in 2:
		mesh.add_blend_shape("Shape %d" % shape)
		var of_shape := []
		of_shape.resize(Mesh.ARRAY_MAX)
		var positions := (arrays[Mesh.ARRAY_VERTEX] as PackedVector3Array).duplicate()
		for index in positions.size():
			var height := positions[index].y
			var moved := Vector3(0.6 * height * height, 0, 0) if shape == 0 else Vector3(0, 0, sin(2.0 * height))
			positions[index] = moved if mode == Mesh.BLEND_SHAPE_MODE_RELATIVE else positions[index] + moved
		of_shape[Mesh.ARRAY_VERTEX] = positions
		of_shape[Mesh.ARRAY_NORMAL] = arrays[Mesh.ARRAY_NORMAL]
		of_shape[Mesh.ARRAY_TANGENT] = arrays[Mesh.ARRAY_TANGENT]
		shapes.append(of_shape)
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays, shapes)
	return mesh


func test_blend_shapes_cast_where_they_are_drawn() -> void:
	for mode: Mesh.BlendShapeMode in [Mesh.BLEND_SHAPE_MODE_NORMALIZED, Mesh.BLEND_SHAPE_MODE_RELATIVE]:
		var scene := add_study()
		scene.caster.mesh = _make_blended(mode)
		scene.caster.transform = Transform3D(Basis(), Vector3(0, 0.2, 0))
		var straight := await read_settled(scene)
		scene.caster.set_blend_shape_value(0, 0.4)
		scene.caster.set_blend_shape_value(1, -0.3)
		var first := await read(scene)
		var settled := await read_settled(scene)
		check(count_different(straight, settled) > 200, "mode %d: weights change the mask" % mode)
		check(count_different(first, settled) == 0, "mode %d: in their frame" % mode)
		var bake := func() -> ArrayMesh: return scene.caster.bake_mesh_from_current_blend_shape_mix()
		await _check_as_baked(scene, bake, "blend shapes, mode %d" % mode)


func test_blend_shapes_come_before_bones() -> void:
	var scene := add_study()
	var skeleton := _skin_caster(scene, _make_blended(Mesh.BLEND_SHAPE_MODE_NORMALIZED, true))
	scene.caster.set_blend_shape_value(0, 0.5)
	var found := await read_settled(scene)
	# The same shape as a mesh without blend shapes, with the same bones.
	var arrays := _make_arrays()
	var positions: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	for index in positions.size():
		positions[index].x += 0.3 * positions[index].y * positions[index].y
	arrays[Mesh.ARRAY_VERTEX] = positions
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	scene.caster.mesh = mesh
	var expected := await read_settled(scene)
	check(count_darker(expected) > 300 and skeleton.get_bone_count() == 3, "it casts a shadow")
	check(count_different(expected, found, TOLERANCE) < 20, "%d pixels differ" % count_different(expected, found, TOLERANCE))
	remove(scene)


func test_holes_follow_the_bones() -> void:
	for technique in ["edge_count", "pcss"]:
		var scene := add_study()
		var skeleton := _skin_caster(scene, _make_mesh(), 0.0)
		var image := Image.create_empty(64, 64, false, Image.FORMAT_RGBA8)
		for x in 64:
			for y in 64:
				image.set_pixel(x, y, Color(1, 1, 1, float(y / 8 % 2)))
		var material := StandardMaterial3D.new()
		material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR
		material.cull_mode = BaseMaterial3D.CULL_DISABLED
		material.albedo_texture = ImageTexture.create_from_image(image)
		scene.caster.mesh.surface_set_material(0, material)
		scene.shadow.technique = technique
		var straight := await read_settled(scene)
		_bend(skeleton, 0.9)
		var first := await read(scene)
		check(count_different(straight, first) > 100, technique + ": holes move")
		check(count_different(first, await read_settled(scene)) == 0, technique + ": in that frame")
		await _check_skeleton(scene, "a column with holes, " + technique)


## Godot draws the column with fewer triangles, and its mask equals that of the baked mesh with the same levels.
func test_levels_of_detail_are_posed() -> void:
	var arrays := _make_arrays()
	var indices: PackedInt32Array = arrays[Mesh.ARRAY_INDEX]
	var levels := {0.2: indices.slice(indices.size() / 9 * 3)}  # edge length: indices. Without a third of the triangles; any other subset would do
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays, [], levels)
	var scene := add_study()
	_skin_caster(scene, mesh)
	var full := await read_settled(scene)
	get_viewport().mesh_lod_threshold = 50.0
	var bake := func() -> ArrayMesh: return _bake_skeleton(scene.caster, levels)
	var reduced := await read_settled(scene)
	check(count_different(full, reduced, TOLERANCE) > 20, "it is drawn with other outlines")
	await _check_as_baked(scene, bake, "a reduced column")
	get_viewport().mesh_lod_threshold = 1.0


func test_instances_of_one_skin_have_poses_of_their_own() -> void:
	var scene := add_study()
	var mesh := _make_mesh()
	_skin_caster(scene, mesh, 0.9)
	var skeleton := _make_skeleton()
	scene.add_child(skeleton)
	var other := scene.add_mesh("Other", mesh, Transform3D(Basis(), Vector3(1.6, 0, 0)))
	other.skin = scene.caster.skin
	other.skeleton = other.get_path_to(skeleton)
	_bend(skeleton, -0.6)
	var both := await read_settled(scene)
	other.mesh = _bake_skeleton(other)
	other.skin = null
	other.skeleton = NodePath()
	check(count_different(both, await read_settled(scene), TOLERANCE) < 20, "the second instance has its own pose")
	await _check_skeleton(scene, "the first instance")
