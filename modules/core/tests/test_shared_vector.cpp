#include "modules/core/shared_vector.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace gnomon;

namespace {

SharedVector<int> make_items(int p_count) {
	SharedVector<int> items;
	for (int item = 0; item < p_count; ++item) {
		items.push_back(item);
	}
	return items;
}

} // namespace

TEST_CASE("[SharedVector] copies share their items until one of them is edited") {
	SharedVector<int> first;
	CHECK(first.empty());
	first.push_back(1);
	first.push_back(2);
	SharedVector<int> second = first;
	CHECK(second.shares_items_with(first));
	CHECK(&second[1] == &first[1]);
	second.edit(1) = 3;
	CHECK_FALSE(second.shares_items_with(first));
	CHECK(first[1] == 2);
	CHECK(second[1] == 3);
	const int *item = &second[1];
	second.edit(0) = 4; // shared by no other, so edited in place
	CHECK(&second[1] == item);
	const SharedVector<int> moved = std::move(second);
	CHECK(moved.size() == 2);
	CHECK(second.size() == 2); // NOLINT: a moved vector still has its items
}

TEST_CASE("[SharedVector] an edit copies one page, and the pages that differ are found") {
	constexpr int PAGE = int(SharedVector<int>::PAGE_SIZE);
	const SharedVector<int> first = make_items(3 * PAGE + 1);
	REQUIRE(first.get_page_count() == 4);
	CHECK(first.get_page(3).size() == 1);
	CHECK(first.get_page(2)[1] == 2 * PAGE + 1);
	CHECK(first.back() == 3 * PAGE);
	CHECK(std::accumulate(first.begin(), first.end(), 0) == 3 * PAGE * (3 * PAGE + 1) / 2);

	SharedVector<int> second = first;
	CHECK(second.find_changed_pages(first).empty());
	second.edit(size_t(PAGE)) = -1;
	second.edit_back() = -2;
	CHECK(second.find_changed_pages(first) == std::vector<uint32_t>{ 1, 3 });
	CHECK(&second[0] == &first[0]);
	CHECK(&second[size_t(PAGE) + 1] != &first[size_t(PAGE) + 1]);
	CHECK(first[size_t(PAGE)] == PAGE);
	second.share_page(1, first);
	CHECK(second.find_changed_pages(first) == std::vector<uint32_t>{ 3 });

	second.edit_all([](int &r_item) { r_item *= 2; });
	CHECK(second[2] == 4);
	CHECK(second.back() == -4);
	CHECK(second.find_changed_pages(first).size() == 4);

	// Items of another number are at other places, even if the first pages are shared.
	SharedVector<int> longer = first;
	longer.push_back(0);
	CHECK(longer.find_changed_pages(first) == std::vector<uint32_t>{ 0, 1, 2, 3 });
}
