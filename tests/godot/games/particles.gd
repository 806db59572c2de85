extends Game
## Effects around a fire at night: debris, embers with trails, smoke, sparks, a ghost that fades, and a flickering omni light.

var _fire: OmniLight3D
var _ghost: MeshInstance3D
var _dissolving: StandardMaterial3D


func _ready() -> void:
	most_other_px = 30  # logs
	add_environment(Color(0.1, 0.12, 0.2), Color(0.3, 0.32, 0.45))
	environment.glow_enabled = true
	add_floor(Vector2(30, 30), make_material(Color(0.55, 0.5, 0.45)))
	_add_fire()
	add_sun(Vector3(-40, 60, 0), 0.8, 0.35)
	_add_ruins()
	_add_debris()
	_add_embers()
	_add_smoke()
	_add_sparks()
	add_camera(Vector3(0, 3.6, 4.8), Vector3(0, 0.7, 0))


func _add_fire() -> void:
	_fire = OmniLight3D.new()
	_fire.omni_range = 12.0
	_fire.light_color = Color(1.0, 0.7, 0.4)
	_fire.light_size = 0.2
	_fire.position = Vector3(0, 1.1, 0)
	add_light(_fire, self)
	main_light = _fire


func _add_ruins() -> void:
	var stone := make_material(Color(0.6, 0.58, 0.55))
	for index in 7:
		var angle := TAU * index / 7
		var height := 1.0 + 0.4 * (index % 3)
		add_mesh(make_cylinder(0.35, 0.3, height), Vector3(3.2 * cos(angle), height / 2, 3.2 * sin(angle)), stone)
	for index in 5:
		var stick := add_mesh(make_cylinder(0.1, 0.1, 1.2), Vector3(0, 0.12, 0), make_material(Color(0.3, 0.2, 0.15)))
		stick.rotation_degrees = Vector3(80, 72 * index, 0)
	_ghost = add_mesh(make_sphere(0.5), Vector3(-1.8, 0.9, 0.8), make_material(Color(0.7, 0.85, 0.9)))
	_dissolving = make_material(Color(0.8, 0.4, 0.8))
	_dissolving.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	add_box(Vector3.ONE * 0.9, Vector3(1.9, 0.6, 0.9), _dissolving)


func _make_process(speed: float, spread: float, gravity: float) -> ParticleProcessMaterial:
	var process := ParticleProcessMaterial.new()
	process.direction = Vector3.UP
	process.spread = spread
	process.initial_velocity_min = 0.5 * speed
	process.initial_velocity_max = speed
	process.gravity = Vector3(0, gravity, 0)
	return process


func _add_particles(mesh: Mesh, material: Material, count: int, process: ParticleProcessMaterial) -> GPUParticles3D:
	var node := GPUParticles3D.new()
	node.amount = count
	node.lifetime = 100.0 / 3.0 / FRAMES_PER_S  # a third of the loop
	node.use_fixed_seed = true
	node.seed = 17
	node.fixed_fps = 0
	node.process_material = process
	node.draw_pass_1 = mesh
	node.material_override = material
	node.visibility_aabb = AABB(Vector3(-4, -1, -4), Vector3(8, 8, 8))
	add_child(node)
	documented_without_shadow.append(node)
	return node


## Opaque pieces of stone, lit.
func _add_debris() -> void:
	var process := _make_process(5.0, 25.0, -9.8)
	process.angle_max = 360.0
	var debris := _add_particles(make_box(Vector3.ONE * 0.15), make_material(Color(0.5, 0.45, 0.4)), 24, process)
	debris.position = Vector3(-1.0, 0.1, -1.5)


## Glowing trails.
func _add_embers() -> void:
	var ribbon := RibbonTrailMesh.new()
	ribbon.size = 0.05
	ribbon.sections = 4
	ribbon.section_length = 0.1
	var glowing := make_material(Color(1, 0.6, 0.2))
	glowing.use_particle_trails = true
	glowing.emission_enabled = true
	glowing.emission = Color(1, 0.5, 0.1)
	glowing.cull_mode = BaseMaterial3D.CULL_DISABLED
	var embers := _add_particles(ribbon, glowing, 16, _make_process(3.5, 35.0, -2.0))
	embers.trail_enabled = true
	embers.trail_lifetime = 0.2


## Blended quads that face the camera, lit.
func _add_smoke() -> void:
	var grey := make_material(Color(0.5, 0.5, 0.5, 0.25))
	grey.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	grey.billboard_mode = BaseMaterial3D.BILLBOARD_PARTICLES
	var quad := QuadMesh.new()
	quad.size = Vector2.ONE * 0.8
	var smoke := _add_particles(quad, grey, 12, _make_process(2.0, 15.0, 0.5))
	smoke.position.y = 1.0


## Sparks of the CPU: additive quads, and balls with a lit material.
func _add_sparks() -> void:
	var additive := make_material(Color(1, 0.8, 0.4))
	additive.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	additive.blend_mode = BaseMaterial3D.BLEND_MODE_ADD
	additive.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	additive.billboard_mode = BaseMaterial3D.BILLBOARD_PARTICLES
	var quad := QuadMesh.new()
	quad.size = Vector2.ONE * 0.08
	for mesh: Mesh in [quad, make_sphere(0.1, 8)]:
		var node := CPUParticles3D.new()
		node.amount = 20
		node.lifetime = 100.0 / 3.0 / FRAMES_PER_S
		node.use_fixed_seed = true
		node.seed = 23
		node.fixed_fps = 0
		node.mesh = mesh
		node.direction = Vector3.UP
		node.spread = 40.0
		node.initial_velocity_min = 2.0
		node.initial_velocity_max = 4.0
		node.position = Vector3(1.0, 0.2, -1.5) if mesh == quad else Vector3(0.5, 0.2, 1.8)
		node.material_override = additive if mesh == quad else make_material(Color(0.7, 0.3, 0.3))
		add_child(node)
		documented_without_shadow.append(node)


func _play(step: int) -> void:
	var angle := TAU * step / LOOP_FRAMES
	_fire.light_energy = 2.2 + 0.5 * sin(11 * angle) + 0.3 * sin(23 * angle)
	_fire.omni_range = 12.0 + sin(7 * angle)
	_fire.position = Vector3(0.06 * sin(17 * angle), 1.1, 0.06 * cos(13 * angle))
	# Opaque in a part of the loop.
	_ghost.transparency = clampf(0.5 - 0.8 * cos(angle), 0.0, 1.0)
	_ghost.position.y = 0.9 + 0.2 * sin(2 * angle)
	_dissolving.albedo_color.a = clampf(0.5 + 0.6 * sin(angle), 0.0, 1.0)
	camera.look_at_from_position(Vector3(1.2 * sin(angle), 3.6, 4.8), Vector3(0, 0.7, 0))
