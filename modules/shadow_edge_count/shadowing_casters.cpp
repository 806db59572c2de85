#include "modules/shadow_edge_count/shadowing_casters.h"

#include "modules/core/error.h"
#include "modules/mesh_tools/topology.h"
#include "modules/scene/mesh.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/caster_pass.h"
#include "modules/shadows/scene_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>

namespace gnomon {

namespace {

/// The greatest distance along the light of the receivers in each cell of a grid across the light.
class ReceiverGrid {
public:
	ReceiverGrid(const LightView &p_view, std::span<const VisibleReceiver> p_receivers) {
		std::vector<Bounds> boxes;
		for (const VisibleReceiver &receiver : p_receivers) {
			boxes.push_back(transform_bounds(receiver.bounds_world, p_view.view_from_world));
			all.add(boxes.back());
		}
		for (const Bounds &box : boxes) {
			any_cell(glm::dvec2(box.minimum), glm::dvec2(box.maximum), [&](size_t p_cell) {
				farthest_m[p_cell] = std::max(farthest_m[p_cell], double(box.maximum.z));
				return false;
			});
		}
	}

	/// Whether a box in the light's view, grown across the light, is nearer to the light than the
	/// farthest receiver in some cell that it overlaps.
	bool may_shadow(const Bounds &p_box, double p_disc_radius, double p_margin_m) const {
		if (all.is_empty() || p_box.is_empty()) {
			return false;
		}
		const double depth_m = std::max(double(all.maximum.z) - p_box.minimum.z, 0.0);
		const double reach_m = p_disc_radius * depth_m + p_margin_m;
		const glm::dvec2 low = glm::dvec2(p_box.minimum) - reach_m;
		const glm::dvec2 high = glm::dvec2(p_box.maximum) + reach_m;
		const bool is_outside = glm::any(glm::greaterThan(low, glm::dvec2(all.maximum))) ||
				glm::any(glm::lessThan(high, glm::dvec2(all.minimum)));
		return !is_outside && any_cell(low, high, [&](size_t p_cell) {
			return farthest_m[p_cell] + p_margin_m >= p_box.minimum.z;
		});
	}

private:
	static constexpr int SIDE = 128; // cells

	int find_line(double p_value, int p_axis) const {
		const double size = std::max(all.maximum[p_axis] - all.minimum[p_axis], 1e-300);
		const double line = std::floor((p_value - all.minimum[p_axis]) / size * SIDE);
		return static_cast<int>(std::clamp(line, 0.0, double(SIDE - 1)));
	}
	/// Whether the function returns true for some cell that the rectangle overlaps. What is outside
	/// counts as in the nearest cell.
	template <typename Function>
	bool any_cell(const glm::dvec2 &p_low, const glm::dvec2 &p_high, Function p_function) const {
		for (int y = find_line(p_low.y, 1); y <= find_line(p_high.y, 1); ++y) {
			for (int x = find_line(p_low.x, 0); x <= find_line(p_high.x, 0); ++x) {
				if (p_function(static_cast<size_t>(y * SIDE + x))) {
					return true;
				}
			}
		}
		return false;
	}

	Bounds all;
	std::vector<double> farthest_m =
			std::vector<double>(SIDE * SIDE, -std::numeric_limits<double>::infinity());
};

/// True if the box and all its shadow are outside one plane of the camera's view. p_direction: of
/// the light. p_disc_radius: how far the shadow may deviate from it, a tangent.
bool is_shadow_outside(const ViewPlanes &p_planes, const Bounds &p_box,
		const glm::dvec3 &p_direction, double p_disc_radius, double p_margin_m) {
	const glm::dvec3 centre = 0.5 * (p_box.minimum + p_box.maximum);
	const glm::dvec3 half_size = 0.5 * (p_box.maximum - p_box.minimum);
	return std::any_of(p_planes.begin(), p_planes.end(), [&](const ViewPlane &p_plane) {
		const double length = glm::length(p_plane.normal);
		const double highest =
				p_plane.compute_side(centre) + glm::dot(glm::abs(p_plane.normal), half_size);
		const double approach = glm::dot(p_plane.normal, p_direction) + p_disc_radius * length;
		return approach <= 0 && highest < -p_margin_m * length;
	});
}

constexpr uint64_t MAX_EDGES_PER_FACE = 3;

bool do_fit(const SceneSnapshot &p_scene, const std::vector<uint32_t> &p_indices,
		const CasterLimits &p_limits) {
	uint64_t face_count = 0;
	for (const uint32_t index : p_indices) {
		face_count += p_scene.instances[index].caster_mesh->get_triangle_count();
	}
	if (face_count > p_limits.face_count ||
			face_count * MAX_EDGES_PER_FACE <= p_limits.edge_count) {
		return face_count <= p_limits.face_count;
	}
	// Triangles that share no edges have twice as many as closed meshes.
	std::map<const Mesh *, uint64_t> edge_counts;
	uint64_t edge_count = 0;
	for (const uint32_t index : p_indices) {
		const std::shared_ptr<const Mesh> &mesh = p_scene.instances[index].caster_mesh;
		const auto [entry, is_new] = edge_counts.try_emplace(mesh.get());
		if (is_new) {
			entry->second = get_topology(mesh)->edges.size();
		}
		edge_count += entry->second;
	}
	return edge_count <= p_limits.edge_count;
}

} // namespace

std::vector<uint32_t> find_shadowing_casters(const SceneSnapshot &p_scene,
		const ShadowedView &p_view, const std::vector<uint32_t> &p_indices, double p_margin_m) {
	const glm::dmat4 &view_from_world = p_view.light.view_from_world;
	GNOMON_ASSERT(p_view.light.is_orthographic, "find_shadowing_casters is for directional lights");
	const ReceiverGrid grid(p_view.light, p_view.receivers);
	const ViewPlanes planes = find_view_planes(p_view.camera);
	const glm::dvec3 direction = glm::transpose(glm::dmat3(view_from_world))[2];
	// Positions on the GPU are rounded to float, and receivers are moved off their surfaces.
	const double ROUNDING_SIZES = 1e-5;
	const double margin_m =
			p_margin_m + (ROUNDING_SIZES + 2 * MAX_RECEIVER_OFFSET) * p_scene.scene_size_m;
	std::vector<uint32_t> shadowing;
	for (const uint32_t index : p_indices) {
		const Bounds &bounds = p_scene.instances[index].bounds_world;
		if (!is_shadow_outside(planes, bounds, direction, p_view.disc_radius, margin_m) &&
				grid.may_shadow(
						transform_bounds(bounds, view_from_world), p_view.disc_radius, margin_m)) {
			shadowing.push_back(index);
		}
	}
	return shadowing;
}

void ChosenCasters::update(const ShadowTechnique::Inputs &p_inputs, double p_disc_radius,
		uint64_t p_hash, const CasterLimits &p_limits) {
	const bool has_changed = revision == 0 || hash != p_hash;
	if (!has_changed && skipped_count == 0) {
		return;
	}
	std::vector<uint32_t> views(p_inputs.views.size());
	std::iota(views.begin(), views.end(), 0u);
	std::vector<uint32_t> all = collect_casters(p_inputs, views);
	const uint64_t triangle_count = p_inputs.summary.get_whole().caster_triangle_count;
	const bool fits_whole = triangle_count <= p_limits.face_count &&
			triangle_count * MAX_EDGES_PER_FACE <= p_limits.edge_count;
	const auto fits = [&](const std::vector<uint32_t> &p_indices) {
		return fits_whole || do_fit(p_inputs.scene, p_indices, p_limits);
	};
	const size_t all_count = all.size();
	const bool has_all = !p_inputs.may_skip || !p_inputs.views.front().is_orthographic || fits(all);
	if (has_all) {
		indices = std::move(all);
	} else {
		const ShadowedView view = { p_inputs.views.front(), p_disc_radius, p_inputs.lit_receivers,
			make_shifted_camera_view(p_inputs.scene.camera, p_inputs.size_px) };
		const auto find = [&](double p_margin_m) {
			return find_shadowing_casters(p_inputs.scene, view, all, p_margin_m);
		};
		std::vector<uint32_t> needed = find(0);
		if (!has_changed &&
				std::includes(indices.begin(), indices.end(), needed.begin(), needed.end())) {
			return;
		}
		const double MARGIN_SIZES = 0.02;
		indices = find(MARGIN_SIZES * p_inputs.scene.scene_size_m);
		if (!fits(indices)) {
			indices = std::move(needed);
		}
	}
	skipped_count = all_count - indices.size();
	hash = p_hash;
	++revision;
}

} // namespace gnomon
