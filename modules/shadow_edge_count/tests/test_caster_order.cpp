// The order of a light's casters: groups of consecutive ones are compact, and it is cached while
// they are.

#include "modules/shadow_edge_count/caster_order.h"

#include "tests/test_random.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

using namespace gnomon;

namespace {

constexpr double EXTENT_M = 2000.0;

/// Small casters, evenly spread over a square in random order.
std::vector<OrderedCaster> make_ordered_casters(uint32_t p_count) {
	TestRandom random;
	std::vector<OrderedCaster> casters;
	for (uint32_t index = 0; index < p_count; ++index) {
		const glm::dvec3 corner(random.next(0.0, EXTENT_M), 0.0, random.next(0.0, EXTENT_M));
		casters.push_back({ { corner, corner + 4.0 }, /*edge_count=*/20 });
	}
	return casters;
}

std::vector<uint32_t> make_file_order(size_t p_count) {
	std::vector<uint32_t> order(p_count);
	std::iota(order.begin(), order.end(), 0u);
	return order;
}

void move(OrderedCaster &r_caster, const glm::dvec3 &p_offset) {
	r_caster.bounds_world.minimum += p_offset;
	r_caster.bounds_world.maximum += p_offset;
}

} // namespace

TEST_CASE("[EdgeCount] groups of casters in a large world are compact, whatever the file's order") {
	const std::vector<OrderedCaster> casters = make_ordered_casters(20'000);
	CasterOrder order;
	const std::vector<uint32_t> sorted = order.update(casters);
	std::vector<uint32_t> unique = sorted;
	std::sort(unique.begin(), unique.end());
	CHECK(unique == make_file_order(casters.size())); // each caster once
	const double before_m2 = sum_group_areas(casters, make_file_order(casters.size()));
	// In file order each group spans nearly the whole square.
	CHECK(before_m2 > 0.5 * 20'000 * 20 / 512 * EXTENT_M * EXTENT_M);
	CHECK(sum_group_areas(casters, sorted) < before_m2 / 200);
}

TEST_CASE("[EdgeCount] moving casters are sorted again only when their groups have grown by half") {
	std::vector<OrderedCaster> casters = make_ordered_casters(2000);
	CasterOrder order;
	const std::vector<uint32_t> sorted = order.update(casters);
	const double sorted_area_m2 = sum_group_areas(casters, sorted);
	TestRandom random;
	uint32_t frame_count = 0;
	while (order.get_sort_count() == 1 && frame_count < 1000) {
		for (OrderedCaster &caster : casters) {
			move(caster, { random.next(-10.0, 10.0), 0.0, random.next(-10.0, 10.0) });
		}
		const bool has_grown = sum_group_areas(casters, sorted) > 1.5 * sorted_area_m2;
		CHECK((order.update(casters) == sorted) != has_grown);
		CHECK(order.get_sort_count() == (has_grown ? 2 : 1));
		++frame_count;
	}
	CHECK(frame_count > 3);
	CHECK(frame_count < 1000);
	CHECK(sum_group_areas(casters, order.update(casters)) < 1.2 * sorted_area_m2);
}

TEST_CASE("[EdgeCount] one caster that crosses the world sorts the others two times at most") {
	std::vector<OrderedCaster> casters = make_ordered_casters(2000);
	CasterOrder order;
	order.update(casters);
	move(casters[50], -casters[50].bounds_world.minimum);
	order.update(casters);
	const uint32_t earlier_count = order.get_sort_count();
	for (int frame = 0; frame < 100; ++frame) {
		move(casters[50], { 0.01 * EXTENT_M, 0.0, 0.01 * EXTENT_M });
		order.update(casters);
	}
	CHECK(order.get_sort_count() <= earlier_count + 2);
}

TEST_CASE("[EdgeCount] casters that move one by one are measured, and sorted, like all at once") {
	std::vector<OrderedCaster> casters = make_ordered_casters(2000);
	CasterOrder order;
	order.update(casters);
	TestRandom random;
	uint32_t frame_count = 0;
	bool is_kept = true;
	while (is_kept && frame_count < 10'000) {
		std::vector<std::pair<uint32_t, Bounds>> moved;
		for (int count = 0; count < 20; ++count) {
			const auto index = static_cast<uint32_t>(random.next(0.0, 2000.0));
			move(casters[index], { random.next(-90.0, 90.0), 0.0, random.next(-90.0, 90.0) });
			moved.emplace_back(index, casters[index].bounds_world);
		}
		is_kept = order.move(moved);
		++frame_count;
	}
	CHECK(frame_count > 6); // before a sixteenth has moved, nothing is measured
	CHECK(frame_count < 10'000);
	CHECK(order.get_sort_count() == 1);
	order.update(casters);
	CHECK(order.get_sort_count() == 2);
	CHECK(order.move({}));
}

TEST_CASE("[EdgeCount] another number of casters, or no reuse, sorts them again") {
	std::vector<OrderedCaster> casters = make_ordered_casters(1000);
	CasterOrder order;
	order.update(casters);
	order.update(casters);
	CHECK(order.get_sort_count() == 1);
	casters.pop_back();
	CHECK(order.update(casters).size() == 999);
	CHECK(order.get_sort_count() == 2);
	order.update(casters, /*p_may_reuse=*/false);
	CHECK(order.get_sort_count() == 3);
}

TEST_CASE("[EdgeCount] few casters keep their order, and casters without extent have one") {
	CasterOrder order;
	CHECK(order.update({}).empty());
	const std::vector<OrderedCaster> few = make_ordered_casters(CasterOrder::MAX_UNSORTED);
	CHECK(order.update(few) == make_file_order(few.size()));
	const std::vector<OrderedCaster> same(
			1000, { { glm::dvec3(3.0), glm::dvec3(3.0) }, /*edge_count=*/1 });
	CHECK(order.update(same) == make_file_order(same.size()));
	CHECK(order.update(same) == make_file_order(same.size()));
	CHECK(order.get_sort_count() == 1);
	const std::vector<OrderedCaster> empty(1000);
	CHECK(order.update(empty).size() == 1000);
	CHECK(sum_group_areas(empty, make_file_order(1000)) == 0.0);
}
