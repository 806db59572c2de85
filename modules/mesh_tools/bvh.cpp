#include "modules/mesh_tools/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace gnomon {

namespace {

constexpr uint32_t LEAF_SIZE = 4; // maximum number of items
constexpr int BIN_COUNT = 16;	  // of split_by_area
/// Nodes at this depth or deeper are split in halves instead of by the surface area heuristic. That
/// bounds the depth, and so the stack of a traversal, to 64: halving 2^32 boxes takes 32 levels.
/// The heuristic may split off a single box at each level, for example if their sizes double.
constexpr int MAX_SAH_DEPTH = 32;

double get_half_area(const Bounds &p_bounds) {
	if (p_bounds.is_empty()) {
		return 0;
	}
	const glm::dvec3 size = p_bounds.maximum - p_bounds.minimum;
	return size.x * size.y + size.y * size.z + size.z * size.x;
}

bool is_valid(const Bounds &p_box) {
	// Written so that NaN fails.
	return p_box.minimum.x <= p_box.maximum.x && p_box.minimum.y <= p_box.maximum.y &&
			p_box.minimum.z <= p_box.maximum.z;
}

/// Returns the centre. Boxes are clamped far beyond any scene, so that it is finite for infinite
/// ones too.
glm::dvec3 get_centre(const Bounds &p_box) {
	const glm::dvec3 limit(1e150);
	return 0.5 * glm::clamp(p_box.minimum, -limit, limit) +
			0.5 * glm::clamp(p_box.maximum, -limit, limit);
}

struct BuildItem {
	Bounds box;
	glm::dvec3 centre;
	uint32_t index = 0;
};

int find_bin(double p_centre, double p_minimum, double p_maximum) {
	const double position = (p_centre - p_minimum) / (p_maximum - p_minimum);
	return std::clamp(static_cast<int>(position * BIN_COUNT), 0, BIN_COUNT - 1);
}

/// Splits the items by the surface area heuristic over bins of the given axis (Wald 2007). Reorders
/// them and returns the number of items on the left; 0 if no split separates them.
size_t split_by_area(std::span<BuildItem> p_items, int p_axis, double p_minimum, double p_maximum) {
	std::array<Bounds, BIN_COUNT> bin_bounds;
	std::array<size_t, BIN_COUNT> bin_counts{};
	for (const BuildItem &item : p_items) {
		const int bin = find_bin(item.centre[p_axis], p_minimum, p_maximum);
		bin_bounds[bin].add(item.box);
		++bin_counts[bin];
	}
	std::array<double, BIN_COUNT> cost_right{};
	Bounds right;
	size_t right_count = 0;
	for (int bin = BIN_COUNT - 1; bin > 0; --bin) {
		right.add(bin_bounds[bin]);
		right_count += bin_counts[bin];
		cost_right[bin] = get_half_area(right) * static_cast<double>(right_count);
	}
	Bounds left;
	size_t left_count = 0;
	size_t best_count = 0;
	int best_bin = 0;
	double best_cost = INFINITY;
	for (int bin = 1; bin < BIN_COUNT; ++bin) {
		left.add(bin_bounds[bin - 1]);
		left_count += bin_counts[bin - 1];
		const double cost = get_half_area(left) * static_cast<double>(left_count) + cost_right[bin];
		if (left_count > 0 && left_count < p_items.size() && cost < best_cost) {
			best_cost = cost;
			best_bin = bin;
			best_count = left_count;
		}
	}
	if (best_count > 0) {
		std::partition(p_items.begin(), p_items.end(), [&](const BuildItem &p_item) {
			return find_bin(p_item.centre[p_axis], p_minimum, p_maximum) < best_bin;
		});
	}
	return best_count;
}

/// Splits the items at the median of their centres. Returns the number of items on the left.
size_t split_in_halves(std::span<BuildItem> p_items, int p_axis) {
	const size_t half = p_items.size() / 2;
	std::nth_element(p_items.begin(), p_items.begin() + static_cast<ptrdiff_t>(half), p_items.end(),
			[&](const BuildItem &p_left, const BuildItem &p_right) {
				return p_left.centre[p_axis] < p_right.centre[p_axis];
			});
	return half;
}

size_t split(std::span<BuildItem> p_items, int p_depth) {
	Bounds centres;
	for (const BuildItem &item : p_items) {
		centres.add(item.centre);
	}
	const glm::dvec3 size = centres.maximum - centres.minimum;
	const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
	size_t left_count = 0;
	if (p_depth < MAX_SAH_DEPTH && size[axis] > 0) {
		left_count = split_by_area(p_items, axis, centres.minimum[axis], centres.maximum[axis]);
	}
	return left_count > 0 ? left_count : split_in_halves(p_items, axis);
}

} // namespace

Bvh::Bvh(std::span<const Bounds> p_boxes) {
	std::vector<BuildItem> build;
	build.reserve(p_boxes.size());
	for (size_t i = 0; i < p_boxes.size(); ++i) {
		if (is_valid(p_boxes[i])) {
			build.push_back({ p_boxes[i], get_centre(p_boxes[i]), static_cast<uint32_t>(i) });
		}
	}
	if (build.empty()) {
		return;
	}
	struct Work {
		size_t node;
		size_t begin;
		size_t end;
		int depth;
	};
	nodes.reserve(2 * build.size());
	nodes.emplace_back();
	std::vector<Work> stack{ { 0, 0, build.size(), 0 } };
	while (!stack.empty()) {
		const Work work = stack.back();
		stack.pop_back();
		const std::span<BuildItem> range(build.data() + work.begin, work.end - work.begin);
		for (const BuildItem &item : range) {
			nodes[work.node].bounds.add(item.box);
		}
		if (range.size() <= LEAF_SIZE) {
			nodes[work.node].first = static_cast<uint32_t>(work.begin);
			nodes[work.node].item_count = static_cast<uint32_t>(range.size());
			continue;
		}
		const size_t middle = work.begin + split(range, work.depth);
		const size_t left = nodes.size();
		nodes[work.node].first = static_cast<uint32_t>(left);
		nodes.resize(left + 2);
		stack.push_back({ left + 1, middle, work.end, work.depth + 1 });
		stack.push_back({ left, work.begin, middle, work.depth + 1 });
	}
	items.reserve(build.size());
	for (const BuildItem &item : build) {
		items.push_back(item.index);
	}
}

} // namespace gnomon
