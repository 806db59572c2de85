#pragma once

#include "modules/rendering_device/resource_types.h"
#include "modules/shadow_edge_count/tests/count_scene.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <bit>
#include <vector>

namespace gnomon {

/// A scene's faces, edges and light as the shaders read them.
struct CountArrays {
	std::vector<shader::CountEdgeRecord> edges;
	std::vector<shader::CountFaceRecord> faces;
	/// Of the faces, then two for each edge: face indices in `edges` are indices of these planes.
	std::vector<glm::vec4> planes;
	shader::CountLightConstants light = {};
	std::vector<SpecializationConstant> pipeline_constants;

	static glm::uvec4 pack(const glm::dvec3 &p_point, uint32_t p_word) {
		return { std::bit_cast<uint32_t>(float(p_point.x)),
			std::bit_cast<uint32_t>(float(p_point.y)), std::bit_cast<uint32_t>(float(p_point.z)),
			p_word };
	}

	explicit CountArrays(const CountScene &p_scene) {
		const float FAR = 3e38f; // the faces exist for receivers at all distances
		for (const CountFace &face : p_scene.get_faces()) {
			faces.push_back(
					{ pack(face.corners[0], face.is_double_sided ? EDGE_COUNT_DOUBLE_SIDED : 0u),
							pack(face.corners[1], std::bit_cast<uint32_t>(-FAR)),
							pack(face.corners[2], std::bit_cast<uint32_t>(FAR)) });
			planes.emplace_back(face.plane);
		}
		for (const CountEdge &edge : p_scene.get_edges()) {
			const uint32_t plane = uint32_t(planes.size());
			planes.emplace_back(edge.plane0);
			planes.emplace_back(edge.plane1);
			edges.push_back(
					{ pack(edge.a, plane | (edge.is_double_sided ? EDGE_COUNT_DOUBLE_SIDED : 0u)),
							pack(edge.b, edge.has_face1 ? plane + 1 : EDGE_COUNT_NO_FACE) });
		}
		const CountSpace &space = p_scene.get_space();
		pipeline_constants = { { EDGE_COUNT_CONSTANT_IS_DIRECTIONAL,
				space.is_directional ? 1u : 0u } };
		light.disc_radius = float(space.disc_radius);
		// Beyond all receivers; warp() in test_count_cull.cpp uses the same depth.
		light.depth_far_m = 3.0f * float(space.scene_size_m);
		light.nearer_tolerance = float(space.nearer_tolerance);
		light.face_count = uint32_t(faces.size());
	}
};

} // namespace gnomon
