#pragma once

#include "modules/mesh_tools/ray_tree.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <functional>

// Compares hard shadows with traced rays.

namespace gnomon {

/// Counts of receivers at which a mask differs from rays to the light's centre.
struct HardDifference {
	size_t receiver_count = 0; // receivers compared
	size_t hidden_count = 0;   // of them: hidden, according to the rays
	size_t wrong_count = 0;	   // of them: the mask, rounded to 0 or 1, differs from the rays
	/// Wrong receivers that rounding does not explain: no probe point near the surface has the
	/// mask's visibility. Probes are up to two receiver offsets away along each axis, and shifted
	/// along the view ray by as much as the surface's depth changes over 1/64 of a pixel.
	size_t unexplained_count = 0;
};

/// Traces rays to the light's centre, in double precision. Images must be square.
class HardReference {
public:
	explicit HardReference(const SmallScene &p_scene) : scene(p_scene.snap()) {
		for (const InstanceSnapshot &instance : scene->instances) {
			if (instance.casts_shadow) {
				trees.push_back(
						{ RayTree(instance.caster_mesh), glm::inverse(instance.world_from_node) });
			}
		}
	}

	/// p_is_compared: returns whether a surface point is compared. Empty: all receivers are.
	HardDifference compare(const MaskResult &p_frame,
			const std::function<bool(const SurfacePoint &)> &p_is_compared = {}) const {
		HardDifference difference;
		for (size_t index = 0; index < p_frame.visibility.size(); ++index) {
			if (p_frame.receiver[index] <= 0) {
				continue;
			}
			const SurfacePoint &surface = p_frame.surfaces[index];
			if (p_is_compared && !p_is_compared(surface)) {
				continue;
			}
			const glm::dvec3 normal = glm::normalize(glm::dvec3(surface.geometric_normal));
			const double offset_m = surface.receiver_offset_m;
			const glm::dvec3 position_world =
					scene->camera.position_world + glm::dvec3(surface.position) + normal * offset_m;
			const bool is_hidden = is_light_hidden(position_world);
			const bool is_dark = p_frame.visibility[index] < 0.5f;
			++difference.receiver_count;
			difference.hidden_count += is_hidden ? 1 : 0;
			if (is_hidden == is_dark) {
				continue;
			}
			++difference.wrong_count;
			// Probe 3 points along the view ray, as far apart as the surface's depth changes over
			// 1/64 pixel (at most 10 pixel widths), and 27 around each.
			const double pixel_m = 2 * std::tan(0.5 * scene->camera.vertical_fov_rad) *
					glm::length(surface.position) / std::sqrt(double(p_frame.visibility.size()));
			const glm::dvec3 view = glm::normalize(glm::dvec3(surface.position));
			const double reach_m =
					std::min(pixel_m / 64 / std::max(-glm::dot(view, normal), 1e-6), 10 * pixel_m);
			bool is_explained = false;
			for (int probe = 0; probe < 81; ++probe) {
				const glm::dvec3 step(probe % 3 - 1, probe / 3 % 3 - 1, probe / 9 % 3 - 1);
				const glm::dvec3 along = view * (reach_m * (probe / 27 - 1));
				is_explained = is_explained ||
						is_light_hidden(position_world + along + step * (2 * offset_m)) == is_dark;
			}
			difference.unexplained_count += is_explained ? 0 : 1;
		}
		return difference;
	}

private:
	struct Tree {
		RayTree rays;
		glm::dmat4 node_from_world;
	};

	bool is_light_hidden(const glm::dvec3 &p_position_world) const {
		const LightSnapshot &light = scene->lights[0];
		const bool is_point = light.type != LightType::DIRECTIONAL;
		const glm::dvec3 ray =
				is_point ? light.position_world - p_position_world : -light.get_direction_world();
		for (const Tree &tree : trees) {
			const auto hit = tree.rays.find_nearest(
					glm::dvec3(tree.node_from_world * glm::dvec4(p_position_world, 1.0)),
					glm::dvec3(tree.node_from_world * glm::dvec4(ray, 0.0)));
			if (hit && (!is_point || *hit < 1.0)) {
				return true;
			}
		}
		return false;
	}

	std::shared_ptr<const SceneSnapshot> scene;
	std::vector<Tree> trees;
};

} // namespace gnomon
