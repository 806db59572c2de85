// Loads the add-on's library as Godot does, and uses everything that needs no frame: all
// initialisation levels, the classes, a node and its properties. Prints what it saw. The output
// must be the same on every system and processor (tests/godot/host/test_host.py).
//
//     godot_host LIBRARY
//
// Exit code: 0; 1: the library does not load, or lacks the entry point.

#include "tests/godot/host/host_library.h"
#include "tests/godot/host/host_objects.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace {

const char ENTRY_NAME[] = "gnomon_addon_init";
const char NODE_CLASS[] = "GnomonShadow3D";
const char SERVER_CLASS[] = "GnomonServer";
// Constants of Godot.
const uint32_t HINT_RANGE = 1;
const uint32_t HINT_ENUM = 2;
const int32_t NOTIFICATION_ENTER_TREE = 10;
const int32_t NOTIFICATION_EXIT_TREE = 11;

int function_count = 0;

GDExtensionInterfaceFunctionPtr get_function(const char *p_name) {
	GDExtensionInterfaceFunctionPtr function = find_value_function(p_name);
	if (!function) {
		function = find_object_function(p_name);
	}
	if (!function) {
		print_line("unknown function", p_name);
	}
	++function_count;
	return function;
}

void print_classes() {
	for (const auto &[name, registered] : get_state().classes) {
		print_line("class", name + ", a " + registered.parent);
		for (const HostMethod &method : registered.methods) {
			std::string line = name + "." + method.name;
			for (const std::string &argument : method.arguments) {
				line += ", " + argument;
			}
			print_line("method", line);
		}
		for (const std::string &group : registered.groups) {
			print_line("group", group);
		}
		for (const HostProperty &property : registered.properties) {
			print_line("property",
					property.name + ", type " + std::to_string(property.type) + ", hint " +
							std::to_string(property.hint) + " \"" + property.hint_string + "\"");
		}
	}
}

std::vector<std::string> split(const std::string &p_list) {
	std::vector<std::string> items;
	std::istringstream stream(p_list);
	for (std::string item; std::getline(stream, item, ',');) {
		items.push_back(item);
	}
	return items;
}

/// Returns an allowed value that is not the default.
HostValue choose_value(const HostProperty &p_property, const HostValue &p_default) {
	const std::vector<std::string> items = split(p_property.hint_string);
	if (p_property.hint == HINT_ENUM) {
		return make_text(GDEXTENSION_VARIANT_TYPE_STRING,
				items.back() == p_default.text ? items.front() : items.back());
	}
	if (p_property.hint == HINT_RANGE) {
		const double minimum = std::strtod(items[0].c_str(), nullptr);
		const double maximum = std::strtod(items[1].c_str(), nullptr);
		const double value = to_number(p_default) == maximum ? minimum : maximum;
		return p_property.type == GDEXTENSION_VARIANT_TYPE_INT
				? make_int(static_cast<int64_t>(value))
				: make_float(value);
	}
	return make_bool(to_number(p_default) == 0.0);
}

void set_property(HostObject &p_node, const HostProperty &p_property, const HostValue &p_value) {
	call_method(p_node, p_property.setter, { make_int(p_property.index), p_value });
}

HostValue get_property(HostObject &p_node, const HostProperty &p_property) {
	return call_method(p_node, p_property.getter, { make_int(p_property.index) });
}

/// Returns the usage flags that the node gives a property.
uint32_t validate(HostObject &p_node, const HostProperty &p_property) {
	const HostClass &registered = get_state().classes.at(p_node.class_name);
	HostArgument name(make_text(GDEXTENSION_VARIANT_TYPE_STRING_NAME, p_property.name),
			GDEXTENSION_VARIANT_TYPE_STRING_NAME);
	GDExtensionPropertyInfo info = {};
	info.name = name.get();
	info.usage = 6; // stored and shown
	registered.info.validate_property_func(p_node.instance, &info);
	return info.usage;
}

void use_properties(HostObject &p_node) {
	const HostClass &registered = get_state().classes.at(p_node.class_name);
	for (const HostProperty &property : registered.properties) {
		const HostValue before = get_property(p_node, property);
		const HostValue value = choose_value(property, before);
		set_property(p_node, property, value);
		const HostValue after = get_property(p_node, property);
		print_line("value",
				property.name + " was " + describe(before) + ", is set to " + describe(value) +
						", is " + describe(after) + ", usage " +
						std::to_string(validate(p_node, property)));
		if (property.hint == HINT_RANGE) {
			// Whole numbers are outside of every range too, and fit into an integer.
			const bool is_int = property.type == GDEXTENSION_VARIANT_TYPE_INT;
			for (const int64_t sign : { 1, -1 }) {
				set_property(p_node, property,
						is_int ? make_int(sign << 40) : make_float(1e30 * double(sign)));
			}
		} else if (property.hint == HINT_ENUM) {
			set_property(
					p_node, property, make_text(GDEXTENSION_VARIANT_TYPE_STRING, "gn\xc3\xb6mon"));
		}
	}
}

void print_configuration_warnings(HostObject &p_node) {
	const HostClass &registered = get_state().classes.at(p_node.class_name);
	HostArgument name(
			make_text(GDEXTENSION_VARIANT_TYPE_STRING_NAME, "_get_configuration_warnings"),
			GDEXTENSION_VARIANT_TYPE_STRING_NAME);
	const GDExtensionClassCallVirtual function = registered.info.get_virtual_func(
			registered.info.class_userdata, name.get(), /*hash=*/0);
	const GDExtensionVariantType type = GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY;
	HostArgument warnings({}, type);
	function(p_node.instance, nullptr, warnings.get());
	for (const HostValue &warning : warnings.load().items) {
		print_line("configuration warning", describe(warning));
	}
}

void use_node() {
	HostObject *node = create_object(NODE_CLASS);
	const auto notify = [node](int32_t p_what) {
		get_state()
				.classes.at(NODE_CLASS)
				.info.notification_func(node->instance, p_what, /*reversed=*/false);
	};
	notify(NOTIFICATION_ENTER_TREE);
	use_properties(*node);
	print_configuration_warnings(*node);
	for (const char *method : { "get_warning", "makes_mask", "count_pending_casters" }) {
		print_line(method, describe(call_method(*node, method, {})));
	}
	print_line("typed result",
			describe(call_typed(*node, "get_warning", GDEXTENSION_VARIANT_TYPE_STRING)));
	call_method(*node, "get_warning", { make_int(1) });
	// An exception inside the library, in a thread that ends afterwards.
	std::thread([node] {
		set_property(*node, get_state().classes.at(NODE_CLASS).properties[1], make_float(1e30));
	}).join();
	notify(NOTIFICATION_EXIT_TREE);
	destroy_object(node);
}

void use_server() {
	HostObject *server = create_object(SERVER_CLASS);
	HostValue transform;
	transform.type = GDEXTENSION_VARIANT_TYPE_TRANSFORM3D;
	HostValue rid;
	rid.type = GDEXTENSION_VARIANT_TYPE_RID;
	call_method(*server, "add_caster", { rid, rid, transform, make_int(1), rid });
	call_method(*server, "move_caster", { rid, transform });
	call_method(*server, "remove_caster", { rid });
	print_line("count_casters", describe(call_method(*server, "count_casters", {})));
	destroy_object(server);
}

void run(const std::string &p_path) {
	const HostLibrary library(p_path);
	const auto entry =
			reinterpret_cast<GDExtensionInitializationFunction>(library.find_symbol(ENTRY_NAME));
	GDExtensionInitialization initialization = {};
	int handle = 0; // the library only passes its address back
	const bool is_loaded = entry(
			&get_function, reinterpret_cast<GDExtensionClassLibraryPtr>(&handle), &initialization);
	print_line("entry", is_loaded ? "succeeded" : "failed");
	print_line("functions", std::to_string(function_count));
	if (!is_loaded) {
		return;
	}
	const int minimum = initialization.minimum_initialization_level;
	for (int level = minimum; level < GDEXTENSION_MAX_INITIALIZATION_LEVEL; ++level) {
		print_line("initialize", std::to_string(level));
		initialization.initialize(
				initialization.userdata, static_cast<GDExtensionInitializationLevel>(level));
	}
	print_classes();
	get_state().callbacks.startup_func();
	use_node();
	use_server();
	get_state().callbacks.shutdown_func();
	for (int level = GDEXTENSION_MAX_INITIALIZATION_LEVEL - 1; level >= minimum; --level) {
		print_line("deinitialize", std::to_string(level));
		initialization.deinitialize(
				initialization.userdata, static_cast<GDExtensionInitializationLevel>(level));
	}
	for (const auto &[name, count] : get_state().method_calls) {
		print_line("called", name + " " + std::to_string(count) + " times");
	}
}

} // namespace

int main(int p_count, char **p_arguments) {
	if (p_count < 2) {
		std::fprintf(stderr, "Usage: godot_host LIBRARY [CLASS.METHOD=RESULT]...\n");
		return 2;
	}
	for (int index = 2; index < p_count; ++index) {
		const std::string argument = p_arguments[index];
		const size_t separator = std::min(argument.find('='), argument.size());
		get_state().results[argument.substr(0, separator)] =
				argument.substr(std::min(separator + 1, argument.size()));
	}
	make_output_binary();
	std::setvbuf(stdout, nullptr, _IONBF, 0); // what was printed before a crash is shown
	run(p_arguments[1]);
	print_line("unloaded",
			std::to_string(get_state().object_count) + " objects and " +
					std::to_string(count_values()) + " values are left");
	return 0;
}
