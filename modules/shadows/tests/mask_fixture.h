#pragma once

#include "modules/core/tests/temporary_folder.h"
#include "modules/render_graph/read_back.h"
#include "modules/render_graph/transient_pool.h"
#include "modules/rendering_device/tests/device_pool.h"
#include "modules/rendering_device/tests/testing.h"
#include "modules/scene/box_mesh.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/surface_points.h"
#include "modules/shadows/tests/surface_host.h"

#include <doctest/doctest.h>
#include <glm/gtc/packing.hpp>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

// Small scenes in memory and a device with validation enabled, for the tests of the shadow system,
// the techniques and the renderer.

namespace gnomon {

inline MeshInstance3D &add_mesh(Scene &r_scene, const std::string &p_name,
		const std::shared_ptr<const Mesh> &p_mesh, const glm::dvec3 &p_position) {
	auto node = std::make_unique<MeshInstance3D>();
	node->name = p_name;
	node->parent_from_node = glm::translate(glm::dmat4(1.0), p_position);
	node->surfaces.push_back({ p_mesh, std::make_shared<const Material>() });
	return static_cast<MeshInstance3D &>(*r_scene.root->add_child(std::move(node)));
}

/// Transform of a camera or light at p_from whose -Z axis points towards p_to. The up direction is
/// tilted, so that p_from may be straight above p_to.
inline glm::dmat4 look_at(const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
	return glm::inverse(glm::lookAt(p_from, p_to, glm::dvec3(0.1, 1.0, 0.07)));
}

inline constexpr LightType ALL_TYPES[] = { LightType::SPOT, LightType::DIRECTIONAL,
	LightType::OMNI };

/// A box above a ground plate that is declared planar, one light of type p_type, and a camera that
/// sees the shadow. All lengths are multiplied by p_scale, and everything is moved by p_origin.
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

/// Inputs of MaskFixture::render.
struct MaskRequest {
	std::shared_ptr<const SceneSnapshot> scene;
	glm::uvec2 size_px = glm::uvec2(64);
	std::string technique_override;
	/// Empty: all lights; the result's own values are those of the last one.
	std::string light;
	/// Debug view of that light's technique, in R16_SFLOAT; an Error when there is none.
	std::string debug_view;
	bool wants_surfaces = false;
	bool may_skip = true;
	bool may_reuse = true;
	bool wants_explanation = false; // ShadowSystem::explain will be called
	/// False: the host does not provide normals, or materials.
	bool has_normals = true;
	bool has_materials = true;
	/// True: a pass that reads the mask fails when it is recorded, so that no command of the frame
	/// is executed.
	bool fails = false;
};

struct MaskResult : MaskValues {
	FramePlan plan;
	std::vector<PassTiming> timings;
	CommandCounts commands;
	float standard_error = 0;
	std::map<std::string, MaskValues> masks; // by the light's name
	std::vector<SurfacePoint> surfaces;		 // one per pixel
	std::vector<float> debug_values;		 // of the debug view, one per texel
};

/// A device with validation enabled, a minimal host and a temporary cache folder.
struct MaskFixture {
	TemporaryCache cache;
	TestDevice device;
	std::unique_ptr<TransientPool> transients;
	std::unique_ptr<ShadowSystem> shadows;

	/// p_device: as DeviceOptions::device. p_denied: optional features that are disabled.
	explicit MaskFixture(const std::string &p_device = "", const FeatureList &p_denied = {},
			DeviceChoice p_choice = DeviceChoice::ANY) :
			device(create_test_device(p_choice, p_device, p_denied)) {
		transients = std::make_unique<TransientPool>(*device);
		shadows = std::make_unique<ShadowSystem>(*device);
	}

	MaskResult render(const MaskRequest &p_request) {
		MaskResult result;
		const CommandCounts before = device->get_command_counts();
		RenderGraph graph(*device, *transients);
		ShadowFrame frame(*shadows, graph, result.plan, p_request.scene, p_request.size_px,
				{ p_request.technique_override, p_request.may_skip, p_request.may_reuse,
						p_request.wants_explanation });
		const HostSurfaces drawn = add_surface_pass(graph, *shadows, *p_request.scene,
				p_request.size_px, frame.get_constants(), p_request.has_normals);
		frame.set_surfaces({ drawn.depth, drawn.geometric_normal,
				p_request.has_materials ? drawn.material : RGTexture() });
		const HostSurfaces &surfaces = frame.get_surfaces();
		std::map<std::string, MaskReadback> readbacks;
		std::vector<uint8_t> debug_texels;
		for (const LightSnapshot &light : p_request.scene->lights) {
			if (p_request.light.empty() || light.name == p_request.light) {
				const LightShadow shadow = frame.add_light(light, !p_request.debug_view.empty());
				if (p_request.fails) {
					graph.add_pass("failing")
							.reads(shadow.mask, Access::SHADER_READ_COMPUTE)
							.keep()
							.execute([](PassContext &) { fail("as requested"); });
				}
				readbacks[light.name].add(graph, shadow.mask, shadow.receivers);
				add_debug_readback(graph, p_request, shadow, debug_texels);
			}
		}
		std::vector<uint8_t> texels[3]; // depth, normals, materials
		if (p_request.wants_surfaces) {
			add_readback(graph, surfaces.depth, texels[0]);
			add_readback(graph, surfaces.geometric_normal, texels[1]);
			add_readback(graph, drawn.material, texels[2]);
		}
		graph.execute(RenderGraph::Mode::WAIT);
		frame.end();
		for (const LightSnapshot &light : p_request.scene->lights) {
			if (const auto found = readbacks.find(light.name); found != readbacks.end()) {
				static_cast<MaskValues &>(result) = result.masks[light.name] =
						found->second.get_values();
				result.standard_error = shadows->get_standard_error(light.name);
			}
		}
		if (p_request.wants_surfaces) {
			result.surfaces = read_surfaces(
					compute_frame_constants(*p_request.scene, p_request.size_px), p_request.size_px,
					{ texels[0].data(), texels[1].data(), texels[2].data() });
		}
		for (size_t index = 0; index < debug_texels.size(); index += 2) {
			uint16_t half = 0;
			std::memcpy(&half, &debug_texels[index], sizeof(half));
			result.debug_values.push_back(glm::unpackHalf1x16(half));
		}
		result.timings = graph.get_timings();
		result.commands = device->get_command_counts() - before;
		return result;
	}

	MaskResult render_mask(const SmallScene &p_scene, const std::string &p_technique,
			glm::uvec2 p_size_px = glm::uvec2(64), bool p_may_skip = true) {
		MaskRequest request;
		request.scene = p_scene.snap();
		request.size_px = p_size_px;
		request.technique_override = p_technique;
		request.light = p_scene.light->name;
		request.may_skip = p_may_skip;
		return render(request);
	}

private:
	static void add_debug_readback(RenderGraph &r_graph, const MaskRequest &p_request,
			const LightShadow &p_shadow, std::vector<uint8_t> &r_texels) {
		if (p_request.debug_view.empty()) {
			return;
		}
		for (const ShadowTechnique::DebugView &view : p_shadow.debug_views) {
			if (view.id == p_request.debug_view) {
				REQUIRE(r_graph.get_desc(view.texture).format == Format::R16_SFLOAT);
				add_readback(r_graph, view.texture, r_texels, view.layer);
				return;
			}
		}
		fail("no debug view ", p_request.debug_view);
	}
};

/// Mean of |left - right| over the pixels that are receivers in both masks. 1 when there are none,
/// or when more than 2 % of the pixels are receivers in only one mask.
inline double compute_mask_difference(const MaskValues &p_left, const MaskValues &p_right) {
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

/// True when every value is finite and in 0..1, and 0 where there is no receiver. False for a mask
/// without pixels.
inline bool is_valid_mask(const MaskValues &p_result) {
	for (size_t index = 0; index < p_result.visibility.size(); ++index) {
		const float value = p_result.visibility[index];
		if (!(value >= 0.0f && value <= 1.0f) ||
				(p_result.receiver[index] == 0.0f && value != 0.0f)) {
			return false;
		}
	}
	return !p_result.visibility.empty();
}

inline size_t count_receivers(const MaskValues &p_result) {
	size_t count = 0;
	for (float receiver : p_result.receiver) {
		count += receiver > 0;
	}
	return count;
}

} // namespace gnomon
