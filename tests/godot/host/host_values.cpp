#include "tests/godot/host/host_values.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace {

int64_t value_count = 0;

const char *const TYPE_NAMES[] = { "nil", "bool", "int", "float", "String", "Vector2", "Vector2i",
	"Rect2", "Rect2i", "Vector3", "Vector3i", "Transform2D", "Vector4", "Vector4i", "Plane",
	"Quaternion", "AABB", "Basis", "Transform3D", "Projection", "Color", "StringName", "NodePath",
	"RID", "Object", "Callable", "Signal", "Dictionary", "Array" };

/// Returns the size of a value in the memory of ptrcalls; 0 for types that are allocated.
size_t get_plain_size(GDExtensionVariantType p_type) {
	switch (p_type) {
		case GDEXTENSION_VARIANT_TYPE_BOOL:
			return 1;
		case GDEXTENSION_VARIANT_TYPE_INT:
		case GDEXTENSION_VARIANT_TYPE_FLOAT:
		case GDEXTENSION_VARIANT_TYPE_RID:
		case GDEXTENSION_VARIANT_TYPE_OBJECT:
		case GDEXTENSION_VARIANT_TYPE_VECTOR2:
		case GDEXTENSION_VARIANT_TYPE_VECTOR2I:
			return 8;
		case GDEXTENSION_VARIANT_TYPE_VECTOR3:
		case GDEXTENSION_VARIANT_TYPE_VECTOR3I:
			return 12;
		case GDEXTENSION_VARIANT_TYPE_VECTOR4:
		case GDEXTENSION_VARIANT_TYPE_COLOR:
			return 16;
		case GDEXTENSION_VARIANT_TYPE_TRANSFORM3D:
			return 48;
		case GDEXTENSION_VARIANT_TYPE_PROJECTION:
			return 64;
		default:
			return 0;
	}
}

bool is_text(GDExtensionVariantType p_type) {
	return p_type == GDEXTENSION_VARIANT_TYPE_STRING ||
			p_type == GDEXTENSION_VARIANT_TYPE_STRING_NAME ||
			p_type == GDEXTENSION_VARIANT_TYPE_NODE_PATH;
}

size_t get_element_size(GDExtensionVariantType p_type) {
	switch (p_type) {
		case GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY:
			return 1;
		case GDEXTENSION_VARIANT_TYPE_PACKED_INT32_ARRAY:
		case GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY:
			return 4;
		case GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR3_ARRAY:
			return 12;
		case GDEXTENSION_VARIANT_TYPE_PACKED_COLOR_ARRAY:
			return 16;
		default:
			return 8; // 64-bit integers, Vector2
	}
}

HostValue *&get_pointer(const void *p_address) {
	return *static_cast<HostValue **>(const_cast<void *>(p_address));
}

/// Returns the allocated value at an address, and creates it if it is empty.
HostValue &get_allocated(GDExtensionVariantType p_type, void *r_address) {
	HostValue *&pointer = get_pointer(r_address);
	if (!pointer) {
		pointer = new HostValue();
		pointer->type = p_type;
	}
	return *pointer;
}

} // namespace

HostValue::HostValue() {
	++value_count;
}

HostValue::HostValue(const HostValue &p_other) :
		type(p_other.type), plain(p_other.plain), text(p_other.text), packed(p_other.packed),
		items(p_other.items) {
	++value_count;
}

HostValue::~HostValue() {
	--value_count;
}

int64_t count_values() {
	return value_count;
}

HostValue make_text(GDExtensionVariantType p_type, const std::string &p_text) {
	HostValue value;
	value.type = p_type;
	value.text = p_text;
	return value;
}

HostValue make_int(int64_t p_value) {
	return load_value(GDEXTENSION_VARIANT_TYPE_INT, &p_value);
}

HostValue make_float(double p_value) {
	return load_value(GDEXTENSION_VARIANT_TYPE_FLOAT, &p_value);
}

HostValue make_bool(bool p_value) {
	return load_value(GDEXTENSION_VARIANT_TYPE_BOOL, &p_value);
}

double to_number(const HostValue &p_value) {
	if (p_value.type == GDEXTENSION_VARIANT_TYPE_BOOL) {
		return p_value.plain[0];
	}
	if (p_value.type == GDEXTENSION_VARIANT_TYPE_INT) {
		int64_t number = 0;
		std::memcpy(&number, p_value.plain.data(), sizeof(number));
		return static_cast<double>(number);
	}
	double number = 0.0;
	if (p_value.type == GDEXTENSION_VARIANT_TYPE_FLOAT) {
		std::memcpy(&number, p_value.plain.data(), sizeof(number));
	}
	return number;
}

std::string describe(const HostValue &p_value) {
	if (is_text(p_value.type)) {
		return "\"" + p_value.text + "\"";
	}
	if (p_value.type == GDEXTENSION_VARIANT_TYPE_VECTOR3) {
		std::array<float, 3> numbers = {};
		std::memcpy(numbers.data(), p_value.plain.data(), sizeof(numbers));
		char digits[96];
		std::snprintf(digits, sizeof(digits), "(%.9g, %.9g, %.9g)", double(numbers[0]),
				double(numbers[1]), double(numbers[2]));
		return digits;
	}
	if (p_value.type <= GDEXTENSION_VARIANT_TYPE_FLOAT) {
		char digits[32];
		std::snprintf(digits, sizeof(digits), "%.17g", to_number(p_value));
		return std::string(TYPE_NAMES[p_value.type]) + " " + digits;
	}
	return p_value.type <= GDEXTENSION_VARIANT_TYPE_ARRAY ? TYPE_NAMES[p_value.type]
														  : "packed array";
}

HostValue load_value(GDExtensionVariantType p_type, const void *p_address) {
	const size_t size = get_plain_size(p_type);
	if (size == 0 && get_pointer(p_address)) {
		return *get_pointer(p_address);
	}
	HostValue value;
	value.type = p_type;
	if (size > 0) {
		std::memcpy(value.plain.data(), p_address, size);
	}
	return value;
}

void store_value(const HostValue &p_value, GDExtensionVariantType p_type, void *r_address) {
	const bool is_number =
			p_type >= GDEXTENSION_VARIANT_TYPE_BOOL && p_type <= GDEXTENSION_VARIANT_TYPE_FLOAT;
	if (is_number && p_value.type != p_type) { // as Godot converts numbers
		const double number = to_number(p_value);
		const HostValue converted = p_type == GDEXTENSION_VARIANT_TYPE_FLOAT ? make_float(number)
				: p_type == GDEXTENSION_VARIANT_TYPE_INT ? make_int(static_cast<int64_t>(number))
														 : make_bool(number != 0.0);
		std::memcpy(r_address, converted.plain.data(), get_plain_size(p_type));
	} else if (const size_t size = get_plain_size(p_type)) {
		std::memcpy(r_address, p_value.plain.data(), size);
	} else {
		HostValue *stored = new HostValue(p_value);
		if (p_type != GDEXTENSION_VARIANT_TYPE_NIL) { // a Variant keeps the type of its value
			stored->type = p_type;
		}
		get_pointer(r_address) = stored;
	}
}

void destroy_value(GDExtensionVariantType p_type, void *r_address) {
	if (get_plain_size(p_type) > 0) {
		return;
	}
	HostValue *&pointer = get_pointer(r_address);
	if (pointer && pointer->callable.free_func) {
		pointer->callable.free_func(pointer->callable.callable_userdata);
	}
	delete pointer;
	pointer = nullptr;
}

std::string load_text(const void *p_address) {
	const HostValue *value = get_pointer(p_address);
	return value ? value->text : std::string();
}

// The functions of the interface. The library gets pointers to functions without a context, so
// there is one function for each type.

namespace {

template <int TYPE> struct TypeFunctions {
	static constexpr GDExtensionVariantType type = static_cast<GDExtensionVariantType>(TYPE);

	static void variant_from_type(void *r_variant, void *p_value) {
		store_value(load_value(type, p_value), GDEXTENSION_VARIANT_TYPE_NIL, r_variant);
	}
	static void type_from_variant(void *r_value, void *p_variant) {
		store_value(load_value(GDEXTENSION_VARIANT_TYPE_NIL, p_variant), type, r_value);
	}
	static void construct_empty(void *r_value, const GDExtensionConstTypePtr *) {
		// As in Godot, an empty value owns no memory, so that it can be constructed over.
		const size_t size = get_plain_size(type);
		std::memset(r_value, 0, size > 0 ? size : sizeof(HostValue *));
	}
	static void construct_copy(void *r_value, const GDExtensionConstTypePtr *p_arguments) {
		store_value(load_value(type, p_arguments[0]), type, r_value);
	}
	static void destroy(void *r_value) { destroy_value(type, r_value); }
	static void get_size(void *p_array, const GDExtensionConstTypePtr *, void *r_result, int) {
		const HostValue &value = get_allocated(type, p_array);
		const int64_t size = type == GDEXTENSION_VARIANT_TYPE_ARRAY
				? static_cast<int64_t>(value.items.size())
				: static_cast<int64_t>(value.packed.size() / get_element_size(type));
		std::memcpy(r_result, &size, sizeof(size));
	}
	static void resize(void *p_array, const GDExtensionConstTypePtr *p_arguments, void *, int) {
		int64_t size = 0;
		std::memcpy(&size, p_arguments[0], sizeof(size));
		get_allocated(type, p_array)
				.packed.resize(static_cast<size_t>(size) * get_element_size(type));
	}
	static void append(void *p_array, const GDExtensionConstTypePtr *p_arguments, void *, int) {
		const bool is_array = type == GDEXTENSION_VARIANT_TYPE_ARRAY;
		get_allocated(type, p_array)
				.items.push_back(load_value(
						is_array ? GDEXTENSION_VARIANT_TYPE_NIL : GDEXTENSION_VARIANT_TYPE_STRING,
						p_arguments[0]));
	}
	template <typename T> static T *get_element(void *p_array, GDExtensionInt p_index) {
		return reinterpret_cast<T *>(get_allocated(type, p_array).packed.data() +
				static_cast<size_t>(p_index) * get_element_size(type));
	}
};

/// Calls p_use with the TypeFunctions of a type.
template <int TYPE = 0, typename Use> auto with_type(int p_type, Use p_use) {
	if constexpr (TYPE + 1 < GDEXTENSION_VARIANT_TYPE_VARIANT_MAX) {
		if (p_type != TYPE) {
			return with_type<TYPE + 1>(p_type, p_use);
		}
	}
	return p_use(TypeFunctions<TYPE>());
}

void variant_new_nil(void *r_variant) {
	get_pointer(r_variant) = nullptr;
}

void variant_new_copy(void *r_variant, const void *p_source) {
	store_value(load_value(GDEXTENSION_VARIANT_TYPE_NIL, p_source), GDEXTENSION_VARIANT_TYPE_NIL,
			r_variant);
}

void variant_destroy(void *r_variant) {
	destroy_value(GDEXTENSION_VARIANT_TYPE_NIL, r_variant);
}

GDExtensionVariantType variant_get_type(const void *p_variant) {
	return load_value(GDEXTENSION_VARIANT_TYPE_NIL, p_variant).type;
}

void variant_get_keyed(const void *, const void *, void *r_value, GDExtensionBool *r_is_valid) {
	variant_new_nil(r_value);
	*r_is_valid = 0;
}

void variant_call(void *, const void *, const GDExtensionConstVariantPtr *, GDExtensionInt,
		void *r_result, GDExtensionCallError *r_error) {
	variant_new_nil(r_result);
	r_error->error = GDEXTENSION_CALL_ERROR_INVALID_METHOD;
}

GDExtensionVariantFromTypeConstructorFunc get_variant_from_type_constructor(
		GDExtensionVariantType p_type) {
	return with_type(p_type, [](auto p_functions) { return &p_functions.variant_from_type; });
}

GDExtensionTypeFromVariantConstructorFunc get_variant_to_type_constructor(
		GDExtensionVariantType p_type) {
	return with_type(p_type, [](auto p_functions) { return &p_functions.type_from_variant; });
}

GDExtensionPtrConstructor variant_get_ptr_constructor(
		GDExtensionVariantType p_type, int32_t p_constructor) {
	return with_type(p_type, [p_constructor](auto p_functions) {
		return p_constructor == 0 ? &p_functions.construct_empty : &p_functions.construct_copy;
	});
}

GDExtensionPtrDestructor variant_get_ptr_destructor(GDExtensionVariantType p_type) {
	return with_type(p_type, [](auto p_functions) { return &p_functions.destroy; });
}

GDExtensionPtrBuiltInMethod variant_get_ptr_builtin_method(
		GDExtensionVariantType p_type, GDExtensionConstStringNamePtr p_name, GDExtensionInt) {
	const std::string name = load_text(p_name);
	return with_type(p_type, [&name](auto p_functions) -> GDExtensionPtrBuiltInMethod {
		return name == "size"	   ? &p_functions.get_size
				: name == "resize" ? &p_functions.resize
				: name == "append" ? &p_functions.append
								   : nullptr;
	});
}

void string_new(void *r_string, const char *p_text, GDExtensionInt p_size) {
	store_value(make_text(GDEXTENSION_VARIANT_TYPE_STRING,
						std::string(p_text, static_cast<size_t>(p_size))),
			GDEXTENSION_VARIANT_TYPE_STRING, r_string);
}

GDExtensionInt string_to_utf8(const void *p_string, char *r_text, GDExtensionInt p_max) {
	const std::string text = load_text(p_string);
	if (r_text) {
		std::memcpy(r_text, text.data(), std::min(text.size(), static_cast<size_t>(p_max)));
	}
	return static_cast<GDExtensionInt>(text.size());
}

void string_name_new(void *r_name, const char *p_text) {
	store_value(make_text(GDEXTENSION_VARIANT_TYPE_STRING_NAME, p_text),
			GDEXTENSION_VARIANT_TYPE_STRING_NAME, r_name);
}

void *array_index(const void *, GDExtensionInt) {
	return nullptr; // the host passes no arrays
}

void callable_create(void *r_callable, GDExtensionCallableCustomInfo2 *p_info) {
	get_pointer(r_callable) = nullptr;
	get_allocated(GDEXTENSION_VARIANT_TYPE_CALLABLE, r_callable).callable = *p_info;
}

/// Returns the function that gets an element of a packed array.
template <typename T, int TYPE> GDExtensionInterfaceFunctionPtr get_index_function() {
	return reinterpret_cast<GDExtensionInterfaceFunctionPtr>(
			&TypeFunctions<TYPE>::template get_element<T>);
}

} // namespace

GDExtensionInterfaceFunctionPtr find_value_function(const std::string &p_name) {
	static const struct {
		const char *name;
		GDExtensionInterfaceFunctionPtr function;
	} FUNCTIONS[] = {
#define FUNCTION(m_name, m_function)                                                               \
	{ m_name, reinterpret_cast<GDExtensionInterfaceFunctionPtr>(&m_function) }
		FUNCTION("variant_new_nil", variant_new_nil),
		FUNCTION("variant_new_copy", variant_new_copy),
		FUNCTION("variant_destroy", variant_destroy),
		FUNCTION("variant_get_type", variant_get_type),
		FUNCTION("variant_get_keyed", variant_get_keyed),
		FUNCTION("variant_call", variant_call),
		FUNCTION("get_variant_from_type_constructor", get_variant_from_type_constructor),
		FUNCTION("get_variant_to_type_constructor", get_variant_to_type_constructor),
		FUNCTION("variant_get_ptr_constructor", variant_get_ptr_constructor),
		FUNCTION("variant_get_ptr_destructor", variant_get_ptr_destructor),
		FUNCTION("variant_get_ptr_builtin_method", variant_get_ptr_builtin_method),
		FUNCTION("string_new_with_utf8_chars_and_len", string_new),
		FUNCTION("string_to_utf8_chars", string_to_utf8),
		FUNCTION("string_name_new_with_utf8_chars", string_name_new),
		FUNCTION("array_operator_index_const", array_index),
		FUNCTION("callable_custom_create2", callable_create),
#undef FUNCTION
		{ "packed_byte_array_operator_index",
				get_index_function<uint8_t, GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY>() },
		{ "packed_color_array_operator_index",
				get_index_function<void, GDEXTENSION_VARIANT_TYPE_PACKED_COLOR_ARRAY>() },
		{ "packed_float32_array_operator_index",
				get_index_function<float, GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY>() },
		{ "packed_int32_array_operator_index",
				get_index_function<int32_t, GDEXTENSION_VARIANT_TYPE_PACKED_INT32_ARRAY>() },
		{ "packed_int64_array_operator_index",
				get_index_function<int64_t, GDEXTENSION_VARIANT_TYPE_PACKED_INT64_ARRAY>() },
		{ "packed_vector2_array_operator_index",
				get_index_function<void, GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY>() },
		{ "packed_vector3_array_operator_index",
				get_index_function<void, GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR3_ARRAY>() },
	};
	for (const auto &entry : FUNCTIONS) {
		if (p_name == entry.name) {
			return entry.function;
		}
	}
	return nullptr;
}
