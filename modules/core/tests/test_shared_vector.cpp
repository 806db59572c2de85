#include "modules/core/shared_vector.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[SharedVector] copies share their items until one of them is edited") {
	SharedVector<int> first;
	CHECK(first.empty());
	first.push_back(1);
	first.push_back(2);
	SharedVector<int> second = first;
	CHECK(second.shares_items_with(first));
	CHECK(&second[1] == &first[1]);
	second.edit()[1] = 3;
	CHECK_FALSE(second.shares_items_with(first));
	CHECK(first[1] == 2);
	CHECK(second[1] == 3);
	const int *item = &second[1];
	second.edit()[0] = 4; // shared by no other, so edited in place
	CHECK(&second[1] == item);
	const SharedVector<int> moved = std::move(second);
	CHECK(moved.size() == 2);
	CHECK(second.size() == 2); // NOLINT: a moved vector still has its items
}
