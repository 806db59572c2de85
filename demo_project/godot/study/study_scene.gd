class_name StudyScene
extends Node3D
## The scene in which Gnomon's and Godot's shadows are compared: a plane, one caster, one light, a camera.

const LIGHTS: Array[String] = ["omni", "spot", "directional"]
const CASTERS: Array[String] = ["box", "post", "sphere", "torus"]
const LIGHT_POSITION := Vector3(-1.5, 5, 1)
const LIGHT_TARGET := Vector3(0, 0.3, 0)

var light: Light3D
var shadow: Node3D
var caster: MeshInstance3D
var camera: Camera3D


static func create(light_kind: String, caster_kind: String) -> StudyScene:
	var scene := StudyScene.new()
	scene.name = "Study"
	scene.add_child(make_darkness())
	scene.add_mesh("Ground", _make_plane(), Transform3D())
	scene.caster = scene.add_mesh("Caster", _make_caster(caster_kind), _make_caster_transform(caster_kind))
	scene.add_light(light_kind)
	scene.camera = Camera3D.new()
	scene.camera.name = "Camera"
	scene.camera.fov = 45.0
	scene.add_child(scene.camera)
	scene.camera.look_at_from_position(Vector3(0, 4.5, 6.5), Vector3(0, 0.4, 0))
	return scene


static func _make_plane() -> Mesh:
	var plane := PlaneMesh.new()
	plane.size = Vector2(24, 24)
	return plane


static func _make_caster(kind: String) -> Mesh:
	match kind:
		"post":
			var post := BoxMesh.new()
			post.size = Vector3(0.25, 2, 0.25)
			return post
		"sphere":
			var sphere := SphereMesh.new()
			sphere.radius = 0.6
			sphere.height = 1.2
			sphere.radial_segments = 64
			sphere.rings = 32
			return sphere
		"torus":
			var torus := TorusMesh.new()
			torus.inner_radius = 0.35
			torus.outer_radius = 0.85
			torus.rings = 64
			torus.ring_segments = 32
			return torus
	return BoxMesh.new()


static func _make_caster_transform(kind: String) -> Transform3D:
	match kind:
		"torus":
			return Transform3D(Basis(Vector3.RIGHT, deg_to_rad(25)), Vector3(0, 1.1, 0))
		"box":
			return Transform3D(Basis(Vector3.UP, deg_to_rad(30)), Vector3(0, 1, 0))
	return Transform3D(Basis(), Vector3(0, 1, 0))


## Returns a black background without ambient light or tone mapping, so that all light in the image comes from the lights.
static func make_darkness() -> WorldEnvironment:
	var environment := Environment.new()
	environment.background_mode = Environment.BG_COLOR
	environment.background_color = Color.BLACK
	environment.ambient_light_source = Environment.AMBIENT_SOURCE_DISABLED
	environment.tonemap_mode = Environment.TONE_MAPPER_LINEAR
	var node := WorldEnvironment.new()
	node.environment = environment
	return node


## Adds a mesh that casts and receives shadows.
func add_mesh(node_name: String, mesh: Mesh, mesh_transform: Transform3D) -> MeshInstance3D:
	var node := MeshInstance3D.new()
	node.name = node_name
	node.mesh = mesh
	node.transform = mesh_transform
	add_child(node)
	return node


## Adds a light with a GnomonShadow3D, and sets `light` and `shadow` to them. Attenuation 0: light falls off only towards
## the light's range.
func add_light(kind: String) -> void:
	match kind:
		"omni":
			var omni := OmniLight3D.new()
			omni.omni_range = 12.0
			omni.omni_attenuation = 0.0
			omni.light_size = 0.5
			light = omni
		"spot":
			var spot := SpotLight3D.new()
			spot.spot_range = 12.0
			spot.spot_attenuation = 0.0
			spot.spot_angle = 40.0
			spot.light_size = 0.5
			light = spot
		_:
			light = DirectionalLight3D.new()
			light.light_angular_distance = 3.0
	light.name = "Light"
	light.shadow_enabled = true
	add_child(light)
	light.look_at_from_position(LIGHT_POSITION, LIGHT_TARGET)
	shadow = ClassDB.instantiate("GnomonShadow3D")
	shadow.name = "Shadow"
	light.add_child(shadow)
