#include "modules/godot_addon/vertex_motion.h"

#include "modules/core/text.h"

namespace gnomon {

namespace {

using godot::BaseMaterial3D;

const char DRAWN_AS_POINTS[] = "is drawn as points";
const char UNKNOWN_MOTION[] = "moves its vertices in a way that is not read";

} // namespace

VertexMotion read_vertex_motion(const BaseMaterial3D &p_material) {
	VertexMotion motion;
	for (const int64_t flag : { int64_t(BaseMaterial3D::FLAG_FIXED_SIZE),
				 int64_t(BaseMaterial3D::FLAG_PARTICLE_TRAILS_MODE),
				 int64_t(BaseMaterial3D::FLAG_USE_Z_CLIP_SCALE),
				 int64_t(BaseMaterial3D::FLAG_USE_FOV_OVERRIDE) }) {
		if (p_material.get_flag(flag)) {
			motion.unknown_reason = UNKNOWN_MOTION;
		}
	}
	if (p_material.get_flag(BaseMaterial3D::FLAG_USE_POINT_SIZE)) {
		motion.unknown_reason = DRAWN_AS_POINTS;
	}
	if (p_material.is_grow_enabled()) {
		motion.grow_m = static_cast<float>(p_material.get_grow());
	}
	switch (p_material.get_billboard_mode()) {
		case BaseMaterial3D::BILLBOARD_ENABLED:
			motion.billboard = VertexMotion::Billboard::FACING;
			break;
		case BaseMaterial3D::BILLBOARD_FIXED_Y:
			motion.billboard = VertexMotion::Billboard::UPRIGHT;
			break;
		case BaseMaterial3D::BILLBOARD_PARTICLES:
			motion.unknown_reason = UNKNOWN_MOTION;
			break;
		default:
			break;
	}
	motion.keeps_scale = p_material.get_flag(BaseMaterial3D::FLAG_BILLBOARD_KEEP_SCALE);
	return motion;
}

VertexMotion read_vertex_motion(const ShaderText &p_shader) {
	VertexMotion motion;
	if (p_shader.may_assign("vertex", "VERTEX")) {
		motion.function = make_vertex_function(p_shader, motion.unknown_reason);
	}
	for (const char *built_in : { "POSITION", "MODELVIEW_MATRIX", "PROJECTION_MATRIX",
				 "BONE_INDICES", "BONE_WEIGHTS", "INSTANCE_CUSTOM" }) {
		if (p_shader.may_assign("vertex", built_in)) {
			motion.unknown_reason = text("moves its vertices in vertex() by ", built_in);
		}
	}
	for (const char *mode : { "skip_vertex_transform", "particle_trails" }) {
		if (p_shader.has_word(mode)) {
			motion.unknown_reason = UNKNOWN_MOTION;
		}
	}
	if (p_shader.may_assign("vertex", "POINT_SIZE")) {
		motion.unknown_reason = DRAWN_AS_POINTS;
	}
	if (p_shader.may_assign("fragment", "DEPTH")) {
		motion.unknown_reason = "writes DEPTH";
	}
	return motion;
}

glm::dmat4 turn_to_camera(const VertexMotion &p_motion, const glm::dmat4 &p_world_from_mesh,
		const glm::dmat4 &p_world_from_camera) {
	const glm::dvec3 up(0, 1, 0);
	glm::dmat4 turned = p_world_from_camera;
	if (p_motion.billboard == VertexMotion::Billboard::UPRIGHT) {
		turned[0] = glm::dvec4(glm::normalize(glm::cross(up, glm::dvec3(turned[2]))), 0);
		turned[1] = glm::dvec4(up, 0);
		turned[2] =
				glm::dvec4(glm::normalize(glm::cross(glm::dvec3(p_world_from_camera[0]), up)), 0);
	}
	for (int axis = 0; axis < 3 && p_motion.keeps_scale; ++axis) {
		turned[axis] *= glm::length(glm::dvec3(p_world_from_mesh[axis]));
	}
	turned[3] = p_world_from_mesh[3];
	return turned;
}

} // namespace gnomon
