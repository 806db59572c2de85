// The work groups of the passes over casters: each item is in one, with the casters that it may
// belong to.

#include "modules/shadow_edge_count/work_groups.h"

#include "tests/test_random.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Casters of 1 to 200 faces; every third has no edges.
CountCasters make_casters(uint32_t p_count) {
	TestRandom random;
	CountCasters casters;
	for (uint32_t index = 0; index < p_count; ++index) {
		CountCaster caster;
		caster.face_count = uint32_t(random.next(1.0, 200.0));
		caster.word_count = index % 3 == 0 ? 0 : uint32_t(random.next(1.0, 9.0));
		caster.record.first_face = casters.face_count;
		caster.record.first_word = casters.word_count;
		caster.is_moved = random.next() < 0.02;
		casters.face_count += caster.face_count;
		casters.word_count += caster.word_count;
		casters.casters.push_back(caster);
	}
	return casters;
}

/// Whether the group's casters include p_caster.
bool has_caster(const shader::CountWorkGroup &p_group, uint32_t p_caster) {
	return p_caster >= p_group.first_caster && p_caster <= p_group.last_caster;
}

} // namespace

TEST_CASE("[EdgeCount] work groups cover all items of all casters, in order") {
	const CountCasters casters = make_casters(500);
	for (const CasterItems items : { CasterItems::FACES, CasterItems::WORDS }) {
		const bool is_faces = items == CasterItems::FACES;
		const uint32_t item_count = is_faces ? casters.face_count : casters.word_count;
		const std::vector<shader::CountWorkGroup> groups =
				build_work_groups(casters, items, /*p_is_moved_only=*/false);
		REQUIRE(groups.size() == (item_count + FIND_GROUP_SIZE - 1) / FIND_GROUP_SIZE);
		for (uint32_t index = 0; index < groups.size(); ++index) {
			CHECK(groups[index].index == index);
		}
		bool is_covered = true;
		for (uint32_t index = 0; index < casters.casters.size(); ++index) {
			const CountCaster &caster = casters.casters[index];
			const uint32_t first = is_faces ? caster.record.first_face : caster.record.first_word;
			const uint32_t count = is_faces ? caster.face_count : caster.word_count;
			for (uint32_t item = first; item < first + count; ++item) {
				is_covered = is_covered && has_caster(groups[item / FIND_GROUP_SIZE], index);
			}
		}
		CHECK(is_covered);
	}
}

TEST_CASE("[EdgeCount] only work groups with items of moved casters run again") {
	const CountCasters casters = make_casters(500);
	for (const CasterItems items : { CasterItems::FACES, CasterItems::WORDS }) {
		const bool is_faces = items == CasterItems::FACES;
		const std::vector<shader::CountWorkGroup> all =
				build_work_groups(casters, items, /*p_is_moved_only=*/false);
		std::vector<bool> is_needed(all.size());
		for (const CountCaster &caster : casters.casters) {
			const uint32_t first = is_faces ? caster.record.first_face : caster.record.first_word;
			const uint32_t count = is_faces ? caster.face_count : caster.word_count;
			for (uint32_t item = first; caster.is_moved && item < first + count; ++item) {
				is_needed[item / FIND_GROUP_SIZE] = true;
			}
		}
		std::vector<uint32_t> expected;
		for (uint32_t index = 0; index < all.size(); ++index) {
			if (is_needed[index]) {
				expected.push_back(index);
			}
		}
		std::vector<uint32_t> found;
		for (const shader::CountWorkGroup &group :
				build_work_groups(casters, items, /*p_is_moved_only=*/true)) {
			found.push_back(group.index);
			CHECK(group.first_caster == all[group.index].first_caster);
			CHECK(group.last_caster == all[group.index].last_caster);
		}
		CHECK(found == expected);
		CHECK(found.size() < all.size());
	}
}

TEST_CASE("[EdgeCount] casters without edges, or no casters, need no work groups") {
	CountCasters casters = make_casters(1); // its only caster has no edges
	CHECK(build_work_groups(casters, CasterItems::WORDS, /*p_is_moved_only=*/false).empty());
	casters.casters[0].is_moved = false;
	CHECK(build_work_groups(casters, CasterItems::FACES, /*p_is_moved_only=*/true).empty());
	CHECK(build_work_groups({}, CasterItems::FACES, /*p_is_moved_only=*/false).empty());
}
