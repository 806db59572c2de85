#include "modules/shadow_edge_count/caster_order.h"

#include "modules/shadow_edge_count/hilbert_curve.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace gnomon {

namespace {

constexpr uint32_t WORLD_CURVE_BITS = 20; // cells of 2 mm in a world of 2 km
constexpr uint32_t EDGES_PER_GROUP = EDGE_COUNT_CLUSTER_SIZE * 32;
// Growth of the groups' area since the last sort at which casters are sorted again.
constexpr double MAX_GROWTH = 1.5;
constexpr size_t MEASURED_PER_MOVED = 16; // so that a few that move cost less than all

glm::dvec3 compute_center(const Bounds &p_bounds) {
	return 0.5 * (p_bounds.minimum + p_bounds.maximum);
}

double compute_area(const Bounds &p_bounds) {
	if (p_bounds.is_empty()) {
		return 0;
	}
	const glm::dvec3 size = p_bounds.maximum - p_bounds.minimum;
	return 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

std::vector<uint32_t> sort_casters(std::span<const OrderedCaster> p_casters) {
	Bounds centers;
	for (const OrderedCaster &caster : p_casters) {
		centers.add(compute_center(caster.bounds_world));
	}
	const HilbertCurve curve(centers.minimum, centers.maximum, WORLD_CURVE_BITS);
	std::vector<std::pair<uint64_t, uint32_t>> keys;
	keys.reserve(p_casters.size());
	for (uint32_t index = 0; index < p_casters.size(); ++index) {
		keys.emplace_back(
				curve.find_position(compute_center(p_casters[index].bounds_world)), index);
	}
	std::sort(keys.begin(), keys.end());
	std::vector<uint32_t> order;
	order.reserve(keys.size());
	for (const auto &[position, index] : keys) {
		order.push_back(index);
	}
	return order;
}

} // namespace

double sum_group_areas(
		std::span<const OrderedCaster> p_casters, std::span<const uint32_t> p_order) {
	double sum = 0;
	Bounds group;
	uint32_t edge_count = 0;
	for (const uint32_t index : p_order) {
		group.add(p_casters[index].bounds_world);
		edge_count += p_casters[index].edge_count;
		if (edge_count >= EDGES_PER_GROUP) {
			sum += compute_area(group);
			group = {};
			edge_count = 0;
		}
	}
	return sum + compute_area(group);
}

bool CasterOrder::has_grown() const {
	return casters.size() > MAX_UNSORTED &&
			sum_group_areas(casters, order) > MAX_GROWTH * sorted_area_m2;
}

const std::vector<uint32_t> &CasterOrder::update(
		std::vector<OrderedCaster> p_casters, bool p_may_reuse) {
	moved_count = 0;
	const bool has_order = p_may_reuse && order.size() == p_casters.size();
	casters = std::move(p_casters);
	if (casters.size() <= MAX_UNSORTED) {
		order.resize(casters.size());
		std::iota(order.begin(), order.end(), 0u);
		sorted_area_m2 = 0;
	} else if (!has_order || has_grown()) {
		order = sort_casters(casters);
		sorted_area_m2 = sum_group_areas(casters, order);
		++sort_count;
	}
	return order;
}

bool CasterOrder::move(std::span<const std::pair<uint32_t, Bounds>> p_moved) {
	for (const auto &[index, bounds_world] : p_moved) {
		casters[index].bounds_world = bounds_world;
	}
	moved_count += p_moved.size();
	if (moved_count * MEASURED_PER_MOVED < casters.size()) {
		return true;
	}
	moved_count = 0;
	return !has_grown();
}

} // namespace gnomon
