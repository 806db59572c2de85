#pragma once

#include "modules/core/text.h"
#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/renderer/tests/hard_truth.h"

#include <doctest/doctest.h>

#include <map>

namespace gnomon {

using VolumeWishes = std::map<std::string, PropertyValue>;

inline RenderResult render_volumes(RenderFixture &r_fixture, SmallScene &r_scene,
		const VolumeWishes &p_wishes = {}, const std::string &p_id = "shadow_volume",
		glm::uvec2 p_size_px = glm::uvec2(128), bool p_may_leave_out = true) {
	const auto before = r_scene.light->properties;
	for (const auto &[name, value] : p_wishes) {
		r_scene.light->properties[p_id + "_" + name] = value;
	}
	RenderRequest request;
	request.scene = r_scene.snap();
	request.size_px = p_size_px;
	request.technique_override = p_id;
	request.mask_light = r_scene.light->name;
	request.wants_mask = true;
	request.wants_surfaces = true;
	request.may_leave_out = p_may_leave_out;
	RenderResult result = r_fixture.renderer->render(request);
	CHECK(is_valid_mask(result));
	r_scene.light->properties = before;
	return result;
}

/// A mesh of test_meshes as the scene holds it.
inline std::shared_ptr<const Mesh> share_mesh(const std::string &p_name, const Mesh &p_mesh) {
	return make_mesh(p_name, p_mesh.positions_node, {}, p_mesh.indices);
}

} // namespace gnomon
