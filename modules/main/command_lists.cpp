// The commands `gnomon techniques`, `filters`, `modules` and `info`. Each prints a list as text or
// JSON.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/module_registry.h"
#include "modules/core/operating_system.h"
#include "modules/core/property.h"
#include "modules/main/commands.h"
#include "modules/shadows/mask_filter.h"
#include "modules/shadows/shadow_registry.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <thread>

namespace gnomon {

namespace {

using Json = nlohmann::ordered_json;

const char *get_type_name(PropertyType p_type) {
	// In the order of PropertyType.
	static const char *const NAMES[] = { "bool", "int", "float", "enum", "string", "vector3" };
	return NAMES[static_cast<int>(p_type)];
}

Json describe_properties(const PropertyList &p_list) {
	Json properties = Json::array();
	for (const PropertyInfo &info : p_list.get_properties()) {
		Json value = property_to_json<Json>(info.default_value);
		properties.push_back({ { "name", info.name }, { "type", get_type_name(info.type) },
				{ "default", value }, { "range", describe_range(info) }, { "unit", info.unit },
				{ "tooltip", info.tooltip } });
	}
	return properties;
}

/// Returns the list without the settings that only tests and comparisons use.
PropertyList omit_test_settings(const PropertyList &p_list) {
	PropertyList list;
	for (const PropertyInfo &info : p_list.get_properties()) {
		if (info.group != TEST_SETTINGS_GROUP) {
			list.add(info);
		}
	}
	return list;
}

void print_properties(const PropertyList &p_list, const std::string &p_prefix = {}) {
	for (const PropertyInfo &info : p_list.get_properties()) {
		std::printf("    %s%s = %s (%s): %s\n", p_prefix.c_str(), info.name.c_str(),
				format_property(info.default_value).c_str(), describe_range(info).c_str(),
				info.tooltip.c_str());
	}
}

Json list_techniques(bool p_as_text, const CommonOptions & /*p_common*/) {
	Json list = Json::array();
	const ShadowTechniqueInfo *chosen = ShadowRegistry::find_default();
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		const PropertyList &properties = ShadowRegistry::get_light_properties(info.id);
		const PropertyList settings = omit_test_settings(ShadowRegistry::get_settings(info.id));
		list.push_back({ { "id", info.id }, { "name", info.name }, { "source", info.source },
				{ "is_default", &info == chosen }, { "is_fallback", info.is_fallback },
				{ "is_reference", info.is_reference }, { "is_example", info.is_example },
				{ "derived_widths",
						{ { "outer_per_size", info.derived_widths.outer_per_size },
								{ "inner_per_size", info.derived_widths.inner_per_size } } },
				{ "properties", describe_properties(properties) },
				{ "settings", describe_properties(settings) } });
		if (p_as_text && !info.is_example) {
			std::printf("%s%s\n    %s. Source: %s\n", info.id.c_str(),
					&info == chosen ? " (default)" : "", info.name.c_str(), info.source.c_str());
			print_properties(properties);
			print_properties(settings, "technique." + info.id + ".");
		}
	}
	if (p_as_text) {
		std::printf("every light\n");
		print_properties(Light3D::get_property_list());
	}
	return list;
}

Json list_filters(bool p_as_text, const CommonOptions & /*p_common*/) {
	Json list = Json::array();
	for (const MaskFilterInfo &info : MaskFilterRegistry::get_all()) {
		const PropertyList &properties = MaskFilterRegistry::get_light_properties(info.id);
		list.push_back({ { "id", info.id }, { "name", info.name }, { "source", info.source },
				{ "properties", describe_properties(properties) } });
		if (p_as_text) {
			std::printf("%s\n    %s. Source: %s\n", info.id.c_str(), info.name.c_str(),
					info.source.c_str());
			print_properties(properties);
		}
	}
	return list;
}

Json list_modules(bool p_as_text, const CommonOptions & /*p_common*/) {
	Json list = Json::array();
	for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
		list.push_back({ { "name", module.name }, { "description", module.description },
				{ "source", module.source }, { "version", module.version }, { "doc", module.doc },
				{ "layer", module.layer }, { "can_disable", module.can_disable },
				{ "is_example", module.is_example }, { "is_enabled", module.is_enabled },
				{ "dependencies", module.dependencies } });
		if (p_as_text && !module.is_example) {
			std::printf("%-20s %s%s\n", module.name.c_str(), module.description.c_str(),
					module.is_enabled ? "" : " (disabled)");
		}
	}
	return list;
}

Json list_info(bool p_as_text, const CommonOptions &p_common) {
	const std::vector<DeviceInfo> devices = find_rendering_devices();
	// Creates the device that other commands would use, to mark it in the list. Throws an Error
	// with the reason if no device is usable.
	const std::unique_ptr<RenderingDevice> device = create_device(p_common);
	const uint32_t chosen = device->get_info().index;
	Json list = Json::array();
	for (const DeviceInfo &info : devices) {
		list.push_back({ { "index", info.index }, { "name", info.name }, { "driver", info.driver },
				{ "type", info.type }, { "api_version", info.api_version },
				{ "memory_bytes", info.memory_bytes }, { "is_usable", info.is_usable },
				{ "refusal", info.refusal } });
		if (p_as_text) {
			std::printf("%s%u: %s (%s), %s, Vulkan %s, %llu MiB%s%s\n",
					info.index == chosen ? "* " : "  ", info.index, info.name.c_str(),
					info.type.c_str(), info.driver.c_str(), info.api_version.c_str(),
					static_cast<unsigned long long>(info.memory_bytes >> 20),
					info.is_usable ? "" : "; not usable: ", info.refusal.c_str());
		}
	}
	const unsigned threads = std::thread::hardware_concurrency();
	if (p_as_text) {
		std::printf("CPU: %s, %u threads\nCache: %s\n", find_cpu_name().c_str(), threads,
				get_cache_folder().string().c_str());
	}
	return { { "version", PROGRAM_VERSION }, { "devices", list }, { "chosen", chosen },
		{ "cpu", find_cpu_name() }, { "threads", threads },
		{ "cache", get_cache_folder().string() } };
}

struct ListCommand {
	const char *id;
	const char *description;
	Json (*list)(
			bool p_as_text, const CommonOptions &p_common); // also prints the list if p_as_text
};
const ListCommand LIST_COMMANDS[] = {
	{ "techniques", "Shadow techniques and their properties", &list_techniques },
	{ "filters", "Mask filters, which run after every technique, and their properties",
			&list_filters },
	{ "modules", "Modules of this build", &list_modules },
	{ "info", "Devices, CPU, cache", &list_info },
};

void add_list_command(const ListCommand &p_list, CLI::App &r_app, CommonOptions &r_common) {
	static bool as_json = false;
	CLI::App *command = r_app.add_subcommand(p_list.id, p_list.description);
	command->add_flag("--json", as_json, "As JSON");
	command->add_option("--device", r_common.device, "Index or part of the name");
	command->add_flag("--validation", r_common.validation, "Validation layers on");
	command->callback([&p_list, &r_common] {
		const Json json = p_list.list(!as_json, r_common);
		if (as_json) {
			std::printf("%s\n", json.dump(2).c_str());
		}
	});
}

} // namespace

void register_list_commands() {
	int help_order = 0; // that of `run`; these commands follow it
	for (const ListCommand &list : LIST_COMMANDS) {
		CommandRegistry::add({ list.id,
				[&list](CLI::App &r_app, CommonOptions &r_common) {
					add_list_command(list, r_app, r_common);
				},
				++help_order });
	}
}

void unregister_list_commands() {
	for (const ListCommand &list : LIST_COMMANDS) {
		CommandRegistry::remove(list.id);
	}
}

} // namespace gnomon
