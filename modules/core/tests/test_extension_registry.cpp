#include "modules/core/extension_registry.h"

#include <doctest/doctest.h>

#include <string>

using namespace gnomon;

namespace {

struct Fruit {
	std::string id;
	int seed_count = 0;
};
class FruitRegistry : public ExtensionRegistry<Fruit> {};

} // namespace

TEST_CASE("[ExtensionRegistry] an added entry is found by its id until it is removed") {
	FruitRegistry::add({ "fig", 1000 });
	FruitRegistry::add({ "date", 1 });
	REQUIRE(FruitRegistry::get_all().size() == 2);
	CHECK(FruitRegistry::get_all()[0].id == "fig"); // in the order of addition
	REQUIRE(FruitRegistry::find("date") != nullptr);
	CHECK(FruitRegistry::find("date")->seed_count == 1);
	FruitRegistry::remove("fig");
	FruitRegistry::remove("plum"); // an unknown id is ignored
	CHECK(FruitRegistry::find("fig") == nullptr);
	FruitRegistry::remove("date");
	CHECK(FruitRegistry::get_all().empty());
}
