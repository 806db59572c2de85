#pragma once

#include "modules/core/tests/temporary_folder.h"
#include "modules/renderer/renderer.h"
#include "modules/renderer/shadow_registry.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/scene/box_mesh.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

// Small scenes in memory and a device under validation, for the tests of the renderer and of every
// technique.

namespace gnomon {

inline MeshInstance3D &add_mesh(Scene &r_scene, const std::string &p_name,
		const std::shared_ptr<const Mesh> &p_mesh, const glm::dvec3 &p_position) {
	auto node = std::make_unique<MeshInstance3D>();
	node->name = p_name;
	node->parent_from_node = glm::translate(glm::dmat4(1.0), p_position);
	node->surfaces.push_back({ p_mesh, std::make_shared<const Material>() });
	return static_cast<MeshInstance3D &>(*r_scene.root->add_child(std::move(node)));
}

/// Node transform of something at p_from that looks or shines along -Z towards p_to.
inline glm::dmat4 look_at(const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
	return glm::inverse(glm::lookAt(p_from, p_to, glm::dvec3(0.1, 1.0, 0.07)));
}

/// A box above a ground plate that is declared to be flat, one light of the given type, a camera
/// that sees the shadow. All lengths are multiplied by p_scale and everything is moved by p_origin.
struct SmallScene {
	Scene scene;
	Camera3D *camera = nullptr;
	Light3D *light = nullptr;
	MeshInstance3D *ground = nullptr;
	MeshInstance3D *box = nullptr;

	explicit SmallScene(LightType p_type = LightType::SPOT, double p_scale = 1.0,
			const glm::dvec3 &p_origin = glm::dvec3(0.0)) {
		const float scale = static_cast<float>(p_scale);
		scene.scene_size_m = 4.0 * p_scale;
		ground = &add_mesh(scene, "Ground",
				make_box_mesh("ground", scale * glm::vec3(3.0f, 0.2f, 3.0f)),
				p_origin + p_scale * glm::dvec3(0, -0.2, 0));
		ground->is_planar_receiver = true;
		box = &add_mesh(scene, "Box", make_box_mesh("box", scale * glm::vec3(0.5f, 0.3f, 0.4f)),
				p_origin + p_scale * glm::dvec3(0, 1.0, 0));
		auto new_camera = std::make_unique<Camera3D>();
		new_camera->name = "Camera";
		new_camera->near_m = 0.05f * scale;
		new_camera->parent_from_node = look_at(p_origin + p_scale * glm::dvec3(-2.4, 3.6, 3.4),
				p_origin + p_scale * glm::dvec3(-0.2, 0.3, -0.1));
		camera = static_cast<Camera3D *>(scene.root->add_child(std::move(new_camera)));
		light = &add_light("Light", p_type, p_origin + p_scale * glm::dvec3(1.2, 4.0, 0.8),
				p_origin + p_scale * glm::dvec3(0, 0.3, 0), p_scale);
	}

	Light3D &add_light(const std::string &p_name, LightType p_type, const glm::dvec3 &p_from,
			const glm::dvec3 &p_to, double p_scale = 1.0) {
		auto node = std::make_unique<Light3D>();
		node->name = p_name;
		node->type = p_type;
		node->intensity = static_cast<float>(100.0 * p_scale * p_scale);
		node->outer_cone_rad = 0.8f;
		node->parent_from_node = look_at(p_from, p_to);
		node->properties["light_size"] = 0.2 * p_scale;
		node->properties["light_angular_distance"] = 6.0;
		return static_cast<Light3D &>(*scene.root->add_child(std::move(node)));
	}

	std::shared_ptr<const SceneSnapshot> snap() const { return build_snapshot(scene, *camera); }
};

/// A device and a renderer under validation, with a cache folder of their own.
struct RenderFixture {
	TemporaryCache cache;
	std::unique_ptr<RenderingDevice> device;
	std::unique_ptr<Renderer> renderer;

	/// p_device: as DeviceOptions::device.
	explicit RenderFixture(
			const std::string &p_device = "", const DeviceOptions::Without &p_without = {}) {
		DeviceOptions options;
		options.without = p_without;
		options.validation = true;
		options.device = p_device;
		device = RenderingDevice::create(options);
		renderer = std::make_unique<Renderer>(*device);
	}

	RenderResult render_mask(const SmallScene &p_scene, const std::string &p_technique,
			glm::uvec2 p_size_px = glm::uvec2(64), bool p_may_leave_out = true) {
		RenderRequest request;
		request.scene = p_scene.snap();
		request.size_px = p_size_px;
		request.technique_override = p_technique;
		request.mask_light = p_scene.light->name;
		request.wants_mask = true;
		request.may_leave_out = p_may_leave_out;
		return renderer->render(request);
	}
	RenderResult render_picture(const SmallScene &p_scene, const std::string &p_technique = "",
			bool p_may_leave_out = true) {
		RenderRequest request;
		request.scene = p_scene.snap();
		request.size_px = glm::uvec2(64);
		request.technique_override = p_technique;
		request.wants_image = true;
		request.may_leave_out = p_may_leave_out;
		return renderer->render(request);
	}
};

/// Mean of |a - b| over the pixels that receive in both; 1 when the receivers differ widely.
inline double compute_mask_difference(const RenderResult &p_left, const RenderResult &p_right) {
	double sum = 0;
	size_t count = 0;
	size_t unequal_count = 0;
	for (size_t index = 0; index < p_left.visibility.size(); ++index) {
		const bool both = p_left.receiver[index] > 0 && p_right.receiver[index] > 0;
		unequal_count += p_left.receiver[index] != p_right.receiver[index];
		count += both;
		sum += both ? std::abs(p_left.visibility[index] - p_right.visibility[index]) : 0.0f;
	}
	return count == 0 || unequal_count > p_left.visibility.size() / 50 ? 1.0 : sum / double(count);
}

/// True when every value is finite and in 0..1, and 0 where there is no receiver.
inline bool is_valid_mask(const RenderResult &p_result) {
	for (size_t index = 0; index < p_result.visibility.size(); ++index) {
		const float value = p_result.visibility[index];
		if (!(value >= 0.0f && value <= 1.0f) ||
				(p_result.receiver[index] == 0.0f && value != 0.0f)) {
			return false;
		}
	}
	return !p_result.visibility.empty();
}

inline size_t count_receivers(const RenderResult &p_result) {
	size_t count = 0;
	for (float receiver : p_result.receiver) {
		count += receiver > 0;
	}
	return count;
}

} // namespace gnomon
