#include "modules/scene/box_mesh.h"

namespace gnomon {

std::shared_ptr<const Mesh> make_box_mesh(
		const std::string &p_name, const glm::vec3 &p_half_size_m) {
	std::vector<glm::vec3> positions;
	std::vector<glm::vec3> normals;
	std::vector<uint32_t> indices;
	for (int axis = 0; axis < 3; ++axis) {
		for (float side : { -1.0f, 1.0f }) {
			glm::vec3 normal(0.0f);
			normal[axis] = side;
			glm::vec3 u(0.0f);
			u[(axis + 1) % 3] = 1.0f;
			const glm::vec3 v = glm::cross(normal, u);
			const uint32_t first = static_cast<uint32_t>(positions.size());
			for (const glm::vec2 corner :
					{ glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1) }) {
				positions.push_back((normal + u * corner.x + v * corner.y) * p_half_size_m);
				normals.push_back(normal);
			}
			for (uint32_t offset : { 0u, 1u, 2u, 0u, 2u, 3u }) {
				indices.push_back(first + offset);
			}
		}
	}
	return make_mesh(p_name, positions, normals, indices);
}

} // namespace gnomon
