// The work groups of the passes over casters: each item is in one, with the casters that it may
// belong to.

#include "modules/shadow_edge_count/work_groups.h"

#include "tests/test_random.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// The items of casters of 1 to 200 items; every third has none.
std::vector<CasterItems> make_caster_items(uint32_t p_count) {
	TestRandom random;
	std::vector<CasterItems> all;
	uint32_t first = 0;
	for (uint32_t index = 0; index < p_count; ++index) {
		const uint32_t count = index % 3 == 0 ? 0 : uint32_t(random.next(1.0, 200.0));
		all.push_back({ first, count });
		first += count;
	}
	return all;
}

std::vector<shader::CountWorkGroup> make_groups(const std::vector<CasterItems> &p_items) {
	std::vector<shader::CountWorkGroup> groups;
	for (uint32_t caster = 0; caster < p_items.size(); ++caster) {
		add_work_items(caster, p_items[caster], groups);
	}
	return groups;
}

/// Whether the group's casters include p_caster.
bool has_caster(const shader::CountWorkGroup &p_group, uint32_t p_caster) {
	return p_caster >= p_group.first_caster && p_caster <= p_group.last_caster;
}

} // namespace

TEST_CASE("[EdgeCount] work groups cover all items of all casters, in order") {
	const std::vector<CasterItems> all = make_caster_items(500);
	const std::vector<shader::CountWorkGroup> groups = make_groups(all);
	const uint32_t item_count = all.back().first + all.back().count;
	REQUIRE(groups.size() == (item_count + FIND_GROUP_SIZE - 1) / FIND_GROUP_SIZE);
	for (uint32_t index = 0; index < groups.size(); ++index) {
		CHECK(groups[index].index == index);
	}
	bool is_covered = true;
	for (uint32_t caster = 0; caster < all.size(); ++caster) {
		const CasterItems &items = all[caster];
		for (uint32_t item = items.first; item < items.first + items.count; ++item) {
			is_covered = is_covered && has_caster(groups[item / FIND_GROUP_SIZE], caster);
		}
	}
	CHECK(is_covered);
}

TEST_CASE("[EdgeCount] only work groups with items of moved casters run again") {
	const std::vector<CasterItems> all = make_caster_items(500);
	const std::vector<shader::CountWorkGroup> groups = make_groups(all);
	TestRandom random;
	for (const double share : { 0.0, 0.02, 0.3, 1.0 }) {
		std::vector<CasterItems> moved;
		std::vector<bool> is_needed(groups.size());
		for (const CasterItems &items : all) {
			if (random.next() >= share) {
				continue;
			}
			moved.push_back(items);
			for (uint32_t item = items.first; item < items.first + items.count; ++item) {
				is_needed[item / FIND_GROUP_SIZE] = true;
			}
		}
		std::vector<uint32_t> expected;
		for (uint32_t index = 0; index < groups.size(); ++index) {
			if (is_needed[index]) {
				expected.push_back(index);
			}
		}
		std::vector<uint32_t> found;
		for (const shader::CountWorkGroup &group : select_work_groups(groups, moved)) {
			found.push_back(group.index);
			CHECK(group.first_caster == groups[group.index].first_caster);
			CHECK(group.last_caster == groups[group.index].last_caster);
		}
		CHECK(found == expected);
		CHECK((share == 1.0) == (found.size() == groups.size()));
	}
}

TEST_CASE("[EdgeCount] casters without items need no work groups") {
	CHECK(make_groups({ { 0, 0 }, { 0, 0 } }).empty());
	CHECK(select_work_groups({}, std::vector<CasterItems>{ { 0, 0 } }).empty());
}
