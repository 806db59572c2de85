#include "modules/shadows/light_limits.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/mesh_tools/triangle_distance.h"
#include "modules/shadows/camera_view.h"

#include <algorithm>

namespace gnomon {

namespace {

// Maximum of S divided by the diagonal of the bounds of all casters but the largest. At this ratio
// even receivers right before the camera are moved off their surfaces by 1 % of that diagonal.
const double MAX_SIZE_PER_CASTERS = 0.01 / RECEIVER_OFFSET_ROUNDING;
// Maximum of the diagonal of the bounds of all casters divided by S. Above it, rounding causes
// visible false shadows.
const double MAX_CASTERS_PER_SIZE = 5e3;

const char *const LIMITS_DOC_HINT = "; doc/stability.md lists the limits of each technique.";

/// True when the whole box is behind the light by more than the light's radius, where a spot does
/// not shine.
bool is_behind(const Bounds &p_bounds, const LightSnapshot &p_light) {
	const glm::dvec3 direction = p_light.get_direction_world();
	const glm::dvec3 farthest = glm::mix(
			p_bounds.minimum, p_bounds.maximum, glm::greaterThan(direction, glm::dvec3(0.0)));
	return glm::dot(farthest - p_light.position_world, direction) < -double(p_light.light_size_m);
}

} // namespace

const InstanceSnapshot *LightLimits::find_near_caster(const SceneSnapshot &p_scene,
		const SceneSummary &p_summary, const LightSnapshot &p_light, double p_distance_m) {
	const uint64_t light_hash =
			p_light.compute_hash(compute_value_hash(p_distance_m, /*p_seed=*/1));
	std::vector<Search> current_searches;
	const InstanceSnapshot *found = nullptr;
	const auto may_be_near = [&](const Bounds &p_bounds) {
		return !p_bounds.is_empty() &&
				p_bounds.compute_distance(p_light.position_world) < p_distance_m &&
				!(p_light.type == LightType::SPOT && is_behind(p_bounds, p_light));
	};
	std::vector<const InstanceSnapshot *> candidates;
	for (size_t page = 0; page < p_scene.instances.get_page_count(); ++page) {
		if (!may_be_near(p_summary.get_pages()[page].caster_bounds_world)) {
			continue;
		}
		for (const InstanceSnapshot &instance : p_scene.instances.get_page(page)) {
			if (instance.casts_shadow && may_be_near(instance.bounds_world)) {
				candidates.push_back(&instance);
			}
		}
	}
	for (const InstanceSnapshot *candidate : candidates) {
		const InstanceSnapshot &instance = *candidate;
		const uint64_t hash = instance.compute_hash(light_hash);
		const auto before = std::find_if(searches.begin(), searches.end(),
				[&](const Search &p_search) { return p_search.hash == hash; });
		Search search = { hash, false };
		if (before != searches.end()) {
			search = *before;
		} else {
			++search_count;
			search.is_near = has_triangle_within(*instance.get_posed_caster_mesh(),
					instance.world_from_node, p_light.position_world, p_distance_m);
		}
		current_searches.push_back(search);
		if (search.is_near) {
			found = candidate;
			break;
		}
	}
	searches = std::move(current_searches);
	return found;
}

const std::vector<ExceededLimit> &LightLimits::find_exceeded(const SceneSnapshot &p_scene,
		const SceneSummary &p_summary, const LightSnapshot &p_light,
		const std::string &p_technique_id, const ShadowLimits &p_limits) {
	exceeded.clear();
	const std::string light = text("Light \"", p_light.name, "\": ");
	const std::string key = p_light.name + "/" + p_technique_id;
	if (p_light.type != LightType::DIRECTIONAL && p_light.light_size_m > 0) {
		const double radii = p_limits.min_caster_distance_radii;
		if (const InstanceSnapshot *caster = find_near_caster(
					p_scene, p_summary, p_light, radii * p_light.light_size_m)) {
			exceeded.push_back({ key + "/near_caster",
					text(light, "caster \"", caster->node_name,
							"\" comes nearer to the light's centre than ", radii,
							" x light_size = ", format_number(radii * p_light.light_size_m),
							" m, where the shadow of ", p_technique_id,
							" is wrong. Lower light_size, move the light or the caster, or set "
							"another shadow_technique",
							LIMITS_DOC_HINT) });
		}
	}
	const bool is_directional = p_light.type == LightType::DIRECTIONAL;
	const char *size_property = is_directional ? "light_angular_distance" : "light_size";
	const auto check_width = [&](const char *p_property, double p_width_m, bool p_is_derived,
									 double p_max_sizes) {
		const double max_m = p_max_sizes * p_scene.scene_size_m;
		if (p_width_m > max_m) {
			exceeded.push_back({ key + "/" + p_property,
					text(light, p_property, p_is_derived ? ", derived from " : "",
							p_is_derived ? size_property : "", p_is_derived ? "," : "", " is ",
							format_number(p_width_m), " m, and ", p_technique_id,
							" is wrong above ", format_number(max_m), " m (", p_max_sizes,
							" of the scene's size). Lower ", p_is_derived ? size_property : "it",
							", or set another shadow_technique", LIMITS_DOC_HINT) });
		}
	};
	check_width("penumbra_outer_width", p_light.penumbra_outer_width_m,
			p_light.is_outer_width_derived, p_limits.max_outer_width_sizes);
	check_width("penumbra_inner_width", p_light.penumbra_inner_width_m,
			p_light.is_inner_width_derived, p_limits.max_inner_width_sizes);
	return exceeded;
}

std::string describe_scene_size_problem(double p_scene_size_m, const SceneSummary &p_summary) {
	const SceneSummary::Page &whole = p_summary.get_whole();
	const double size_m = p_scene_size_m;
	const double others_m = whole.other_caster_bounds_world.get_diagonal();
	if (others_m > 0 && size_m > MAX_SIZE_PER_CASTERS * others_m) {
		return text("The scene's size is ", format_number(size_m), " m, and all casters but \"",
				whole.largest_caster->node_name, "\" are within ", format_number(others_m),
				" m: their shadows begin ", format_number(RECEIVER_OFFSET_ROUNDING * size_m),
				" m away from them. Set scene_size, in the scene's extras, to about ",
				format_number(others_m), ".");
	}
	const double all_m = whole.caster_bounds_world.get_diagonal();
	if (all_m > MAX_CASTERS_PER_SIZE * size_m) {
		return text("The scene's size is ", format_number(size_m),
				" m, and its casters reach over ", format_number(all_m),
				" m: rounding shows as false shadows. Set scene_size, in the "
				"scene's extras, to at least ",
				format_number(all_m / MAX_CASTERS_PER_SIZE), ".");
	}
	return {};
}

} // namespace gnomon
