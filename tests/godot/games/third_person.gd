extends Game
## A third-person game: a skinned figure with a toon shader that walks between 53 trees, seen by a camera on a SpringArm3D. Crowns are cut
## out by alpha scissor or by a shader's discard; the leaves of some move in the wind.

const TREES := 53
const LEAF_SHADER := "
	render_mode cull_disabled;
	uniform sampler2D leaves : source_color;
	void fragment() {
		vec4 leaf = texture(leaves, UV);
		if (leaf.a < 0.5) {
			discard;
		}
		ALBEDO = leaf.rgb;
		ROUGHNESS = 0.9;
	}"
const WINDY_SHADER := "
	render_mode cull_disabled;
	uniform sampler2D leaves : source_color;
	void vertex() {
		VERTEX.x += 0.12 * sin(3.0 * TIME + VERTEX.y);
	}
	void fragment() {
		vec4 leaf = texture(leaves, UV);
		ALBEDO = leaf.rgb;
		ALPHA = leaf.a;
		ALPHA_SCISSOR_THRESHOLD = 0.5;
	}"
const TOON_SHADER := "
	uniform vec3 color : source_color = vec3(0.9, 0.5, 0.2);
	void fragment() {
		ALBEDO = color;
	}
	void light() {
		float steps = floor(3.0 * clamp(dot(NORMAL, LIGHT), 0.0, 1.0) * ATTENUATION + 0.5) / 3.0;
		DIFFUSE_LIGHT += steps * LIGHT_COLOR / PI;
	}"
enum Bone { HIPS, SPINE, HEAD, LEFT_LEG, RIGHT_LEG, LEFT_ARM, RIGHT_ARM }

var _player: CharacterBody3D
var _skeleton: Skeleton3D


func _ready() -> void:
	most_other_px = 80  # leaves
	add_environment(Color.BLACK, Color.BLACK)
	environment.background_mode = Environment.BG_SKY
	environment.sky = Sky.new()
	environment.sky.radiance_size = Sky.RADIANCE_SIZE_32
	environment.sky.sky_material = ProceduralSkyMaterial.new()
	environment.ambient_light_source = Environment.AMBIENT_SOURCE_SKY
	main_light = add_sun(Vector3(-48, -130, 0), 0.5, 1.0)
	var ground := make_material(Color(1, 1, 1), 0.95)
	ground.albedo_texture = make_checker(Color(0.4, 0.5, 0.3), Color(0.36, 0.46, 0.27))
	ground.uv1_scale = Vector3(6, 6, 1)
	add_floor(Vector2(60, 60), ground)
	_add_trees()
	_add_player()


func _add_trees() -> void:
	var leaves := make_leaves(Color(0.3, 0.6, 0.2), 40)
	var scissor := make_material(Color.WHITE)
	scissor.albedo_texture = leaves
	scissor.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR
	scissor.cull_mode = BaseMaterial3D.CULL_DISABLED
	var discarding := make_shader_material(LEAF_SHADER)
	discarding.set_shader_parameter("leaves", leaves)
	var windy := make_shader_material(WINDY_SHADER)
	windy.set_shader_parameter("leaves", leaves)
	var bark := make_material(Color(0.45, 0.32, 0.22))
	var trunk := make_cylinder(0.28, 0.18, 2.6, 10)
	var crown := make_crossed_quads(Vector2(2.8, 2.8), 3)
	var random := RandomNumberGenerator.new()
	random.seed = 11
	for tree in TREES:
		var angle := 2.4 * tree
		var distance := 7.5 + 0.28 * tree
		var at := Vector3(distance * cos(angle), 0, distance * sin(angle))
		add_mesh(trunk, at + Vector3(0, 1.3, 0), bark)
		var material: Material = windy if tree % 9 == 4 else (scissor if tree % 2 == 0 else discarding)
		var top := add_mesh(crown, at + Vector3(0, 3.2, 0), material)
		top.rotation.y = random.randf_range(0, PI)
		top.scale = Vector3.ONE * random.randf_range(0.8, 1.1)


## Bones: origins in the rest pose, in model space; the parent of each but the hips.
func _make_skeleton() -> Skeleton3D:
	var skeleton := Skeleton3D.new()
	var origins: Array[Vector3] = [
		Vector3(0, 1.0, 0), Vector3(0, 1.15, 0), Vector3(0, 1.75, 0), Vector3(0.15, 0.95, 0), Vector3(-0.15, 0.95, 0),
		Vector3(0.36, 1.6, 0), Vector3(-0.36, 1.6, 0),
	]
	var parents: Array[int] = [-1, Bone.HIPS, Bone.SPINE, Bone.HIPS, Bone.HIPS, Bone.SPINE, Bone.SPINE]
	for bone in origins.size():
		skeleton.add_bone(Bone.keys()[bone])
		skeleton.set_bone_parent(bone, parents[bone])
		var from: Vector3 = origins[parents[bone]] if parents[bone] >= 0 else Vector3.ZERO
		skeleton.set_bone_rest(bone, Transform3D(Basis.IDENTITY, origins[bone] - from))
		skeleton.reset_bone_pose(bone)
	return skeleton


## Adds a closed shape to the mesh of the figure. Its weights blend from one bone to the other, from `low` to `high` (heights in model
## space).
func _append_part(tool: SurfaceTool, part: Mesh, at: Vector3, bones: Array[Bone], low: float, high: float) -> void:
	var arrays := part.surface_get_arrays(0)
	var positions: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var normals: PackedVector3Array = arrays[Mesh.ARRAY_NORMAL]
	for index: int in arrays[Mesh.ARRAY_INDEX]:
		var position := positions[index] + at
		var blend := smoothstep(low, high, position.y)
		tool.set_normal(normals[index])
		tool.set_bones(PackedInt32Array([bones[0], bones[1], 0, 0]))
		tool.set_weights(PackedFloat32Array([1.0 - blend, blend, 0, 0]))
		tool.add_vertex(position)


func _make_figure() -> ArrayMesh:
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	var torso := CapsuleMesh.new()
	torso.radius = 0.28
	torso.height = 0.9
	torso.radial_segments = 16
	_append_part(tool, torso, Vector3(0, 1.3, 0), [Bone.HIPS, Bone.SPINE], 0.95, 1.35)
	_append_part(tool, make_sphere(0.22), Vector3(0, 1.92, 0), [Bone.SPINE, Bone.HEAD], 1.6, 1.75)
	for side: float in [1.0, -1.0]:
		var limb := CapsuleMesh.new()
		limb.radius = 0.12
		limb.height = 1.0
		limb.radial_segments = 12
		var leg := Bone.LEFT_LEG if side > 0 else Bone.RIGHT_LEG
		_append_part(tool, limb, Vector3(0.15 * side, 0.5, 0), [leg, Bone.HIPS], 0.9, 1.0)
		var arm := Bone.LEFT_ARM if side > 0 else Bone.RIGHT_ARM
		var forearm: CapsuleMesh = limb.duplicate()
		forearm.radius = 0.09
		forearm.height = 0.75
		_append_part(tool, forearm, Vector3(0.36 * side, 1.3, 0), [arm, Bone.SPINE], 1.55, 1.65)
	tool.index()
	return tool.commit()


func _add_player() -> void:
	_player = CharacterBody3D.new()
	add_child(_player)
	_skeleton = _make_skeleton()
	_skeleton.name = "Skeleton"
	_player.add_child(_skeleton)
	var body := add_mesh(_make_figure(), Vector3.ZERO, make_shader_material(TOON_SHADER), _skeleton)
	body.skin = _skeleton.create_skin_from_rest_transforms()
	body.skeleton = NodePath("..")
	# What he carries: a sword at the hand, with a standard material.
	var hand := BoneAttachment3D.new()
	hand.bone_name = Bone.keys()[Bone.RIGHT_ARM]
	_skeleton.add_child(hand)
	add_box(Vector3(0.06, 0.06, 1.1), Vector3(0, -0.65, 0.5), make_material(Color(0.7, 0.7, 0.75), 0.3, 0.7), hand)
	var arm := SpringArm3D.new()
	arm.spring_length = 5.0
	arm.position = Vector3(0, 1.7, 0)
	arm.rotation_degrees = Vector3(-20, 150, 0)
	_player.add_child(arm)
	camera = Camera3D.new()
	arm.add_child(camera)


func _physics_process(_delta: float) -> void:
	var angle := TAU * (frame % LOOP_FRAMES) / LOOP_FRAMES
	var target := Vector3(4.0 * sin(angle), 0, 4.0 * cos(angle))
	_player.velocity = (target - _player.position) * 20.0
	_player.move_and_slide()
	_player.rotation.y = angle + PI / 2


func _play(step: int) -> void:
	var swing := 0.7 * sin(TAU * step / 25.0)
	_skeleton.set_bone_pose_rotation(Bone.LEFT_LEG, Quaternion(Vector3.RIGHT, swing))
	_skeleton.set_bone_pose_rotation(Bone.RIGHT_LEG, Quaternion(Vector3.RIGHT, -swing))
	_skeleton.set_bone_pose_rotation(Bone.LEFT_ARM, Quaternion(Vector3.RIGHT, -swing))
	_skeleton.set_bone_pose_rotation(Bone.RIGHT_ARM, Quaternion(Vector3.RIGHT, swing))
	_skeleton.set_bone_pose_rotation(Bone.SPINE, Quaternion(Vector3.UP, 0.3 * swing) * Quaternion(Vector3.RIGHT, 0.15))
