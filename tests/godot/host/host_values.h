#pragma once

#include <gdextension_interface.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

// The host's own values, in the memory that the library reserves for Godot's. What Godot allocates
// (strings, arrays, callables, Variants) is a pointer to a HostValue, or null for an empty value;
// numbers, vectors and objects are stored as Godot stores them.

struct HostValue {
	GDExtensionVariantType type = GDEXTENSION_VARIANT_TYPE_NIL;
	std::array<uint8_t, 64> plain = {};			  // numbers, vectors, objects
	std::string text;							  // String, StringName, NodePath
	std::vector<uint8_t> packed;				  // elements of packed arrays
	std::vector<HostValue> items;				  // elements of Array and PackedStringArray
	GDExtensionCallableCustomInfo2 callable = {}; // freed by destroy_value()

	HostValue();
	HostValue(const HostValue &p_other); // without the callable, which has one owner
	HostValue &operator=(const HostValue &) = delete;
	~HostValue();
};

/// Returns the number of HostValues that exist.
int64_t count_values();

HostValue make_text(GDExtensionVariantType p_type, const std::string &p_text);
HostValue make_int(int64_t p_value);
HostValue make_float(double p_value);
HostValue make_bool(bool p_value);
double to_number(const HostValue &p_value);
std::string describe(const HostValue &p_value);

/// Reads a value of that type at an address that the library passed.
HostValue load_value(GDExtensionVariantType p_type, const void *p_address);
/// Writes a value of that type to memory that holds none.
void store_value(const HostValue &p_value, GDExtensionVariantType p_type, void *r_address);
/// Frees what store_value() allocated.
void destroy_value(GDExtensionVariantType p_type, void *r_address);

/// Returns the text of a String or StringName of the library.
std::string load_text(const void *p_address);

/// A Variant, String or other allocated value for a call of the library.
class HostArgument {
public:
	HostArgument(const HostValue &p_value, GDExtensionVariantType p_type) : type(p_type) {
		store_value(p_value, p_type, &memory);
	}
	~HostArgument() { destroy_value(type, &memory); }
	HostArgument(const HostArgument &) = delete;
	HostArgument &operator=(const HostArgument &) = delete;
	void *get() { return &memory; }
	HostValue load() const { return load_value(type, &memory); }

private:
	GDExtensionVariantType type;
	alignas(8) uint8_t memory[64] = {};
};

/// Returns a function of the GDExtension interface that works on values; null: there is none of
/// that name.
GDExtensionInterfaceFunctionPtr find_value_function(const std::string &p_name);
