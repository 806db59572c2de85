#include "modules/core/error.h"
#include "modules/core/module_registry.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

TEST_CASE("[ModuleRegistry] every module comes after its dependencies and has a description") {
	std::vector<std::string> seen;
	for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
		for (const std::string &dependency : module.dependencies) {
			CHECK_MESSAGE(std::find(seen.begin(), seen.end(), dependency) != seen.end(),
					module.name, " needs ", dependency);
		}
		CHECK_FALSE(module.description.empty());
		seen.push_back(module.name);
	}
}

TEST_CASE("[ModuleRegistry] disabling an unknown module or one the engine needs is an error") {
	CHECK_THROWS_AS(ModuleRegistry::set_enabled("no_such_module", false), Error);
	CHECK_THROWS_AS(ModuleRegistry::set_enabled("core", false), Error);
	CHECK(ModuleRegistry::is_enabled("core"));
}
