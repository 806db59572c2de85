#include "modules/godot_addon/light_choice.h"

#include "modules/godot_addon/scene_body.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const float CURRENT_FACTOR = 1.25f; // of the coverage of lights that have a mask
const float SIZE_RANK = 2.0f;		// above each coverage: lights without a size come last

float rank(const ShadowNode &p_node, std::span<const ViewDetail> p_views) {
	const godot::Light3D light = p_node.find_light();
	const float coverage =
			compute_coverage(light, p_views) * (p_node.makes_mask ? CURRENT_FACTOR : 1.0f);
	// Hard shadows are as good without a mask.
	const bool has_size = light.get_param(godot::Light3D::PARAM_SIZE) > 0;
	return coverage + (has_size ? SIZE_RANK : 0.0f);
}

} // namespace

float compute_coverage(const godot::Light3D &p_light, std::span<const ViewDetail> p_views) {
	if (godot::cast<godot::DirectionalLight3D>(p_light)) {
		return 1;
	}
	const glm::dvec3 center(get_drawn_transform(p_light).to_matrix()[3]);
	const double range_m = p_light.get_param(godot::Light3D::PARAM_RANGE);
	float coverage = 0;
	for (const ViewDetail &view : p_views) {
		const glm::dmat4 world_from_camera = view.camera.to_matrix();
		const glm::dvec3 offset = center - glm::dvec3(world_from_camera[3]);
		const double distance_m = glm::length(offset);
		if (distance_m <= range_m) {
			return 1;
		}
		const double half_angle = std::asin(range_m / distance_m);
		const double cosine = glm::dot(offset / distance_m, -glm::dvec3(world_from_camera[2]));
		const double away = std::acos(glm::clamp(cosine, -1.0, 1.0));
		if (away < half_angle + view.half_diagonal_rad) {
			const double fraction = std::tan(half_angle) / std::tan(view.half_diagonal_rad);
			coverage = std::max(coverage, static_cast<float>(std::min(fraction * fraction, 1.0)));
		}
	}
	return coverage;
}

void choose_lights(
		std::vector<ShadowNode *> &r_nodes, std::span<const ViewDetail> p_views, size_t p_count) {
	if (r_nodes.size() <= p_count) {
		return;
	}
	std::vector<std::pair<float, ShadowNode *>> ranked;
	for (ShadowNode *node : r_nodes) {
		ranked.emplace_back(rank(*node, p_views), node);
	}
	std::stable_sort(ranked.begin(), ranked.end(),
			[](const auto &p_left, const auto &p_right) { return p_left.first > p_right.first; });
	std::transform(ranked.begin(), ranked.end(), r_nodes.begin(),
			[](const auto &p_ranked) { return p_ranked.second; });
}

} // namespace gnomon
