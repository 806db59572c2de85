#pragma once

#include "tests/godot/host/host_values.h"

#include <map>
#include <string>
#include <vector>

// The host's classes and objects: those that the library registers, and stand-ins for Godot's.

struct HostProperty {
	std::string name;
	GDExtensionVariantType type = GDEXTENSION_VARIANT_TYPE_NIL;
	uint32_t hint = 0; // a PropertyHint of Godot
	std::string hint_string;
	std::string getter;
	std::string setter;
	int64_t index = 0;
};

struct HostMethod {
	std::string name;
	GDExtensionClassMethodInfo info = {};
	std::vector<std::string> arguments; // "name: type"
};

/// A class that the library registered.
struct HostClass {
	std::string name;
	std::string parent;
	GDExtensionClassCreationInfo5 info = {};
	std::vector<HostMethod> methods;
	std::vector<HostProperty> properties;
	std::vector<std::string> groups;

	const HostMethod &find_method(const std::string &p_name) const;
};

struct HostObject {
	std::string class_name;
	void *instance = nullptr; // the library's data
};

/// What the library has done so far.
struct HostState {
	std::map<std::string, HostClass> classes;
	std::map<std::string, int> method_calls; // of Godot's methods, by "Class.method"
	/// The texts that Godot's methods return, by "Class.method". All other results are 0, false and
	/// null.
	std::map<std::string, std::string> results = {
		{ "RenderingServer.get_current_rendering_method", "host" },
		{ "RenderingServer.get_current_rendering_driver_name", "host" },
	};
	GDExtensionMainLoopCallbacks callbacks = {};
	size_t object_count = 0;
};

HostState &get_state();

/// Creates an object of a class of the library, as Godot's scripts do.
HostObject *create_object(const std::string &p_class);
void destroy_object(HostObject *p_object);

/// Calls a method of the library with Variants. Prints an error of the call.
HostValue call_method(HostObject &p_object, const std::string &p_method,
		const std::vector<HostValue> &p_arguments);
/// Calls the same method with typed values, and discards the result unless it has this type.
HostValue call_typed(
		HostObject &p_object, const std::string &p_method, GDExtensionVariantType p_result_type);

/// Prints a line that starts with its kind, such as "warning: ".
void print_line(const std::string &p_kind, const std::string &p_text);

/// Returns a function of the GDExtension interface; null: there is none of that name.
GDExtensionInterfaceFunctionPtr find_object_function(const std::string &p_name);
