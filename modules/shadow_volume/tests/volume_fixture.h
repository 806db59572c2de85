#pragma once

#include "modules/core/text.h"
#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/shadows/tests/hard_reference.h"
#include "modules/shadows/tests/setting_scope.h"

#include <doctest/doctest.h>

#include <map>

namespace gnomon {

using VolumeSettingValues = std::map<std::string, PropertyValue>;

/// Renders the scene's mask. p_setting_values: values of the technique's settings, by name.
inline MaskResult render_volumes(MaskFixture &r_fixture, SmallScene &r_scene,
		const VolumeSettingValues &p_setting_values = {}, const std::string &p_id = "shadow_volume",
		glm::uvec2 p_size_px = glm::uvec2(128), bool p_may_skip = true) {
	std::vector<std::unique_ptr<SettingScope>> scopes;
	for (const auto &[name, value] : p_setting_values) {
		scopes.push_back(std::make_unique<SettingScope>(p_id, name, format_property(value)));
	}
	MaskRequest request;
	request.scene = r_scene.snap();
	request.size_px = p_size_px;
	request.technique_override = p_id;
	request.light = r_scene.light->name;
	request.wants_surfaces = true;
	request.may_skip = p_may_skip;
	MaskResult result = r_fixture.render(request);
	CHECK(is_valid_mask(result));
	return result;
}

/// Converts a mesh of test_meshes to a scene mesh.
inline std::shared_ptr<const Mesh> share_mesh(const std::string &p_name, const Mesh &p_mesh) {
	return make_mesh(p_name, p_mesh.positions_node, {}, p_mesh.indices);
}

/// Adds meshes of every class around the box. Some cast shadows on each other.
inline void add_meshes(SmallScene &r_scene) {
	const auto add = [&](const char *p_name, const Mesh &p_mesh, const glm::dvec3 &p_position,
							 double p_scale) {
		MeshInstance3D &node =
				add_mesh(r_scene.scene, p_name, share_mesh(p_name, p_mesh), p_position);
		node.parent_from_node = glm::rotate(
				glm::scale(node.parent_from_node, glm::dvec3(p_scale)), 0.7, { 0.3, 1, 0.2 });
	};
	add("sphere", test_meshes::make_sphere(3), { -0.9, 0.8, 0.4 }, 0.3);
	add("quad", test_meshes::make_quad(), { 0.9, 0.9, 0.3 }, 0.5);
	add("moebius", test_meshes::make_moebius(12), { 0.2, 1.8, -0.9 }, 0.4);
	add("soup", test_meshes::make_soup(5, 20, 24), { -0.6, 0.7, -0.8 }, 0.3);
	Mesh inside_out = test_meshes::make_cube();
	for (size_t first = 0; first < inside_out.indices.size(); first += 3) {
		std::swap(inside_out.indices[first], inside_out.indices[first + 1]);
	}
	add("inside out", inside_out, { -1.4, 0.5, -0.2 }, 0.2);
	// Closed, duplicate, inside-out and open parts of one mesh, which pierce each other.
	using namespace test_meshes;
	Mesh mixed = join(join(make_cube(), make_cube()), join(make_cube({ 2, 2, 0 }), make_quad()));
	for (glm::vec3 &position : inside_out.positions_node) {
		position = position * 0.7f + glm::vec3(0.0f, 2.2f, 0.3f);
	}
	mixed = join(mixed, join(inside_out, make_moebius(12)));
	for (size_t i = 24; i < 28; ++i) { // the quad's vertices, after three cubes of 8
		mixed.positions_node[i] = mixed.positions_node[i] * 4.0f - glm::vec3(1.9f, 1.7f, -0.4f);
	}
	add("mixed", mixed, { 0.6, 0.5, 1.1 }, 0.15);
}

inline MeshInstance3D &add_mirrored_box(SmallScene &r_scene) {
	MeshInstance3D &node = add_mesh(r_scene.scene, "Mirrored",
			make_box_mesh("mirrored", glm::vec3(0.2f, 0.3f, 0.25f)), { 0.9, 0.7, -0.5 });
	node.parent_from_node = glm::scale(node.parent_from_node, glm::dvec3(-1, 1, 1));
	return node;
}

/// Compares the mask with ray tracing. p_receivers_per_error: at most one in this many receivers
/// may be wrong, and only at a shadow's border.
inline void check_against_rays(
		const SmallScene &p_scene, const MaskResult &p_frame, size_t p_receivers_per_error = 1000) {
	const HardDifference difference = HardReference(p_scene).compare(p_frame);
	// The image must show receivers and shadows, or there is nothing to compare.
	CHECK(difference.receiver_count > 3000);
	CHECK(difference.hidden_count > 50);
	CHECK(difference.wrong_count <= difference.receiver_count / p_receivers_per_error);
	CHECK(difference.unexplained_count == 0);
}

} // namespace gnomon
