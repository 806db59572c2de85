@tool
extends EditorNode3DGizmoPlugin
## Draws the size of a light with a GnomonShadow3D, with a handle that changes it: a sphere of radius light_size, or the cone
## of light_angular_distance.

const CLASS := "GnomonShadow3D"
const SIZE := "light_size"
const ANGLE := "light_angular_distance"
const CIRCLE_POINTS := 48
const CONE_LENGTH := 2.0 # of a directional light's cone, in metres
const HANDLE_DIRECTION := Vector3(0.7071068, -0.7071068, 0) # away from the axes of the editor's move gizmo
const MAX_HANDLE_DISTANCE := 1000.0 # in metres, to which the handle can be dragged
const MOUSE_RAY_LENGTH := 10000.0 # in metres

var undo_redo: EditorUndoRedoManager


func _init() -> void:
	create_material("lines", Color(1.0, 0.8, 0.3))
	create_handle_material("handles")


func _get_gizmo_name() -> String:
	return "GnomonShadow3D"


func _has_gizmo(node: Node3D) -> bool:
	return node is OmniLight3D or node is SpotLight3D or node is DirectionalLight3D


static func _has_shadow(light: Light3D) -> bool:
	return light.get_children().any(func(child: Node) -> bool: return child.is_class(CLASS))


static func _get_property(light: Light3D) -> String:
	return ANGLE if light is DirectionalLight3D else SIZE


func _redraw(gizmo: EditorNode3DGizmo) -> void:
	gizmo.clear()
	var light: Light3D = gizmo.get_node_3d()
	if not _has_shadow(light):
		return
	var lines := PackedVector3Array()
	var handle: Vector3
	if light is DirectionalLight3D:
		var radius := CONE_LENGTH * tan(deg_to_rad(light.light_angular_distance / 2))
		var rim := _make_circle(Vector3.RIGHT * radius, Vector3.UP * radius, Vector3.BACK * CONE_LENGTH)
		lines = rim
		for quarter in 4:
			@warning_ignore("integer_division")
			lines.append_array([Vector3.ZERO, rim[2 * quarter * (CIRCLE_POINTS / 4)]])
		handle = HANDLE_DIRECTION * radius + Vector3.BACK * CONE_LENGTH
	else:
		var size := light.light_size
		for axes: Array in [[Vector3.RIGHT, Vector3.UP], [Vector3.UP, Vector3.BACK], [Vector3.BACK, Vector3.RIGHT]]:
			lines.append_array(_make_circle(axes[0] * size, axes[1] * size, Vector3.ZERO))
		handle = HANDLE_DIRECTION * size
	gizmo.add_lines(lines, get_material("lines", gizmo))
	gizmo.add_handles(PackedVector3Array([handle]), get_material("handles", gizmo), [])


## Returns CIRCLE_POINTS line segments, each as two points. first, second: perpendicular radii of the circle.
static func _make_circle(first: Vector3, second: Vector3, center: Vector3) -> PackedVector3Array:
	var lines := PackedVector3Array()
	for point in CIRCLE_POINTS:
		for end in [point, point + 1]:
			var angle: float = TAU * end / CIRCLE_POINTS
			lines.append(center + first * cos(angle) + second * sin(angle))
	return lines


func _get_handle_name(gizmo: EditorNode3DGizmo, _handle: int, _secondary: bool) -> String:
	return _get_property(gizmo.get_node_3d())


func _get_handle_value(gizmo: EditorNode3DGizmo, _handle: int, _secondary: bool) -> Variant:
	var light: Light3D = gizmo.get_node_3d()
	return light.get(_get_property(light))


## Moves the handle along its line to the point closest to the mouse.
func _set_handle(gizmo: EditorNode3DGizmo, _handle: int, _secondary: bool, camera: Camera3D, mouse: Vector2) -> void:
	var light: Light3D = gizmo.get_node_3d()
	var pose := light.global_transform.orthonormalized()
	var ray := [camera.project_ray_origin(mouse), camera.project_ray_normal(mouse)]
	var is_sun := light is DirectionalLight3D
	var start := pose * Vector3(0, 0, CONE_LENGTH if is_sun else 0.0)
	var end := start + pose.basis * HANDLE_DIRECTION * MAX_HANDLE_DISTANCE
	var points := Geometry3D.get_closest_points_between_segments(start, end, ray[0], ray[0] + ray[1] * MOUSE_RAY_LENGTH)
	var radius := points[0].distance_to(start)
	# Rounded to the steps that Godot's inspector has for these properties.
	if is_sun:
		light.light_angular_distance = snappedf(clampf(rad_to_deg(2 * atan(radius / CONE_LENGTH)), 0, 90), 0.01)
	else:
		light.light_size = snappedf(radius, 0.001)
	light.update_gizmos()


func _commit_handle(gizmo: EditorNode3DGizmo, _handle: int, _secondary: bool, before: Variant, is_cancelled: bool) -> void:
	var light: Light3D = gizmo.get_node_3d()
	var property := _get_property(light)
	if is_cancelled:
		light.set(property, before)
	else:
		undo_redo.create_action("Set " + property)
		undo_redo.add_do_property(light, property, light.get(property))
		undo_redo.add_undo_property(light, property, before)
		undo_redo.add_do_method(light, "update_gizmos")
		undo_redo.add_undo_method(light, "update_gizmos")
		undo_redo.commit_action()
	light.update_gizmos()
