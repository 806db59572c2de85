#include "modules/core/command_registry.h"
#include "modules/masks/register_types.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[CommandRegistry] a module adds its command, and removes it when uninitialized") {
	CHECK(CommandRegistry::find("compare") != nullptr);
	uninitialize_masks_module(ModuleLevel::FEATURES);
	CHECK(CommandRegistry::find("compare") == nullptr);
	initialize_masks_module(ModuleLevel::FEATURES);
	REQUIRE(CommandRegistry::find("compare") != nullptr);
	CHECK(CommandRegistry::find("compare")->help_order == CommandInfo::LAST); // the default
}
