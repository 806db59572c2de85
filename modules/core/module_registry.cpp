#include "modules/core/module_registry.h"

#include "modules/core/error.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace gnomon {

namespace {

std::vector<ModuleInfo> modules;
std::optional<ModuleLevel> reached_level;

const ModuleLevel LEVELS[] = { ModuleLevel::CORE, ModuleLevel::SERVERS, ModuleLevel::FEATURES,
	ModuleLevel::EDITOR };

ModuleInfo &find_module(const std::string &p_name) {
	for (ModuleInfo &module : modules) {
		if (module.name == p_name) {
			return module;
		}
	}
	fail("Module \"", p_name, "\" is not in this build. `gnomon modules` lists those that are.");
}

void start(ModuleInfo &p_module, ModuleLevel p_level) {
	if (p_module.initialize) {
		p_module.initialize(p_level);
	}
}

void stop_all_levels(ModuleInfo &p_module) {
	for (auto level = std::rbegin(LEVELS); level != std::rend(LEVELS); ++level) {
		if (p_module.uninitialize && *level <= *reached_level) {
			p_module.uninitialize(*level);
		}
	}
}

} // namespace

void ModuleRegistry::add(ModuleInfo p_info) {
	modules.push_back(std::move(p_info));
}

void ModuleRegistry::initialize(ModuleLevel p_level) {
	for (ModuleLevel level : LEVELS) {
		if (level > p_level || (reached_level && level <= *reached_level)) {
			continue;
		}
		for (ModuleInfo &module : modules) {
			if (module.is_enabled) {
				start(module, level);
			}
		}
		reached_level = level;
	}
}

void ModuleRegistry::uninitialize() {
	if (reached_level) {
		for (auto module = modules.rbegin(); module != modules.rend(); ++module) {
			if (module->is_enabled) {
				stop_all_levels(*module);
			}
		}
	}
	reached_level.reset();
	modules.clear();
}

void ModuleRegistry::set_enabled(const std::string &p_name, bool p_is_enabled) {
	ModuleInfo &module = find_module(p_name);
	if (module.is_enabled == p_is_enabled) {
		return;
	}
	if (!p_is_enabled && !module.can_disable) {
		std::string names;
		for (const ModuleInfo &candidate : modules) {
			if (candidate.can_disable) {
				names += (names.empty() ? "" : ", ") + candidate.name;
			}
		}
		fail("Module \"", p_name,
				"\" cannot be disabled while the program runs. These can: ", names, ".");
	}
	if (!p_is_enabled) {
		for (const ModuleInfo &other : modules) {
			const auto &needs = other.dependencies;
			if (other.is_enabled && std::find(needs.begin(), needs.end(), p_name) != needs.end()) {
				set_enabled(other.name, false);
			}
		}
		module.is_enabled = false;
		if (reached_level) {
			stop_all_levels(module);
		}
		return;
	}
	for (const std::string &dependency : module.dependencies) {
		set_enabled(dependency, true);
	}
	module.is_enabled = true;
	if (reached_level) {
		for (ModuleLevel level : LEVELS) {
			if (level <= *reached_level) {
				start(module, level);
			}
		}
	}
}

bool ModuleRegistry::is_enabled(const std::string &p_name) {
	return std::any_of(modules.begin(), modules.end(), [&](const ModuleInfo &p_module) {
		return p_module.name == p_name && p_module.is_enabled;
	});
}

const std::vector<ModuleInfo> &ModuleRegistry::get_modules() {
	return modules;
}

} // namespace gnomon
