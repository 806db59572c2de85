class_name StoreCage
extends RefCounted
## The scene of the store page's thumbnail: a cage of thin bars with a ball in it, on a floor, in front of a spot light with a size. Its
## shadows begin at the bars and get softer away from them.

const RADIUS_M := 0.62  # of the cage
const HEIGHT_M := 0.95  # of its bars
const BAR_COUNT := 16
const BAR_RADIUS_M := 0.017


## Returns the scene. All nodes belong to it, so that it can be saved.
static func create() -> Node3D:
	var scene := Node3D.new()
	scene.name = "Cage"
	_add(scene, _make_environment(), "Environment")
	var plane := PlaneMesh.new()
	plane.size = Vector2(40, 40)
	_add_mesh(scene, plane, "Floor", Vector3.ZERO, Color(0.78, 0.74, 0.68), 0.9)
	var ball := SphereMesh.new()
	ball.radius = 0.24
	ball.height = 0.48
	_add_mesh(scene, ball, "Ball", Vector3(0, 0.24, 0), Color(0.8, 0.16, 0.08), 0.3)
	_add_cage(scene)
	_add_spot(scene)
	_add_fill(scene)
	var camera := Camera3D.new()
	camera.fov = 36.0
	_add(scene, camera, "Camera")
	camera.look_at_from_position(Vector3(0, 1.9, 3.9), Vector3(0, 0.28, 0.5))
	return scene


static func _make_environment() -> WorldEnvironment:
	var node := WorldEnvironment.new()
	node.environment = Environment.new()
	node.environment.background_mode = Environment.BG_COLOR
	node.environment.background_color = Color(0.02, 0.025, 0.04)
	node.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	node.environment.ambient_light_color = Color(0.6, 0.75, 1.0)
	node.environment.ambient_light_energy = 0.1
	return node


static func _add_cage(scene: Node3D) -> void:
	var brass := Color(0.85, 0.6, 0.25)
	var bar := CylinderMesh.new()
	bar.top_radius = BAR_RADIUS_M
	bar.bottom_radius = BAR_RADIUS_M
	bar.height = HEIGHT_M
	bar.radial_segments = 16
	var bars := MultiMesh.new()
	bars.transform_format = MultiMesh.TRANSFORM_3D
	bars.mesh = bar
	bars.instance_count = BAR_COUNT
	for index in BAR_COUNT:
		var angle := TAU * (index + 0.5) / BAR_COUNT
		bars.set_instance_transform(index, Transform3D(Basis(), Vector3(RADIUS_M * sin(angle), 0.5 * HEIGHT_M, RADIUS_M * cos(angle))))
	var node := MultiMeshInstance3D.new()
	node.multimesh = bars
	node.material_override = _make_material(brass, 0.35)
	_add(scene, node, "Bars")
	for height: float in [0.02, 0.5 * HEIGHT_M, HEIGHT_M]:
		_add_mesh(scene, _make_ring(), "Ring%d" % roundi(100 * height), Vector3(0, height, 0), brass, 0.35)


static func _make_ring() -> Mesh:
	var ring := TorusMesh.new()
	ring.inner_radius = RADIUS_M - 1.4 * BAR_RADIUS_M
	ring.outer_radius = RADIUS_M + 1.4 * BAR_RADIUS_M
	ring.rings = 96
	ring.ring_segments = 16
	return ring


static func _add_spot(scene: Node3D) -> void:
	var light := SpotLight3D.new()
	light.light_color = Color(1.0, 0.87, 0.7)
	light.light_energy = 9.0
	light.light_specular = 0.15
	light.light_size = 0.18
	light.shadow_enabled = true
	light.spot_range = 12.0
	light.spot_angle = 44.0
	light.spot_attenuation = 0.6
	_add(scene, light, "Spot")
	light.look_at_from_position(Vector3(0, 2.2, -2.8), Vector3(0, 0.1, 0.4))
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	light.add_child(shadow)
	shadow.name = "GnomonShadow3D"
	shadow.owner = scene


## Adds a faint light without shadow, for the sides that face the camera.
static func _add_fill(scene: Node3D) -> void:
	var light := DirectionalLight3D.new()
	light.light_color = Color(0.75, 0.85, 1.0)
	light.light_energy = 0.22
	light.light_specular = 0.3
	_add(scene, light, "Fill")
	light.look_at_from_position(Vector3(1.5, 2, 4), Vector3.ZERO)


static func _add_mesh(scene: Node3D, mesh: Mesh, node_name: String, at: Vector3, color: Color, roughness: float) -> void:
	var node := MeshInstance3D.new()
	node.mesh = mesh
	node.position = at
	node.material_override = _make_material(color, roughness)
	_add(scene, node, node_name)


static func _make_material(color: Color, roughness: float) -> Material:
	var material := StandardMaterial3D.new()
	material.albedo_color = color
	material.roughness = roughness
	return material


static func _add(scene: Node3D, node: Node, node_name: String) -> void:
	node.name = node_name
	scene.add_child(node)
	node.owner = scene
