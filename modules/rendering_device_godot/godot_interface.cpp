#include "modules/rendering_device_godot/godot_interface.h"

#include "modules/core/error.h"
#include "modules/core/log_failures.h"

#include <godot_api.gen.h>
#include <godot_hashes.gen.h>

#include <cstring>
#include <map>
#include <vector>

namespace gnomon::godot {

namespace {

Interface interface;

template <typename T>
void load(GDExtensionInterfaceGetProcAddress p_get_address, const char *p_name, T &r_function) {
	r_function = reinterpret_cast<T>(p_get_address(p_name));
	if (!r_function) {
		fail("This Godot has no function \"", p_name, "\". Gnomon needs Godot 4.5 or later.");
	}
}

GDExtensionVariantType to_godot(BuiltInType p_type) {
	return static_cast<GDExtensionVariantType>(p_type);
}

// Indices of constructors, the same for all types.
constexpr int EMPTY_CONSTRUCTOR = 0;
constexpr int COPY_CONSTRUCTOR = 1;

void construct(BuiltInType p_type, int p_constructor, void *r_value, const void *p_source) {
	const GDExtensionConstTypePtr arguments[] = { p_source };
	interface.variant_get_ptr_constructor(to_godot(p_type), p_constructor)(r_value, arguments);
}

/// A method of a built-in type, with one argument or none. p_hash: Godot's hash of its signature.
class BuiltInMethod {
public:
	BuiltInMethod(BuiltInType p_type, const char *p_name, int64_t p_hash) {
		const StringName name(p_name);
		method = interface.variant_get_ptr_builtin_method(to_godot(p_type), name.get(), p_hash);
		if (!method) {
			fail("This Godot has no method \"", p_name,
					"\" of arrays with the signature that the add-on was built for. Build the "
					"add-on with this Godot, see doc/godot.md.");
		}
	}
	/// p_argument: null if the method has none.
	void call(void *p_base, const void *p_argument, void *r_result) const {
		const GDExtensionConstTypePtr arguments[] = { p_argument };
		method(p_base, arguments, r_result, p_argument ? 1 : 0);
	}

private:
	GDExtensionPtrBuiltInMethod method = nullptr;
};

void convert_to_godot_type(BuiltInType p_type, void *r_value, const void *p_variant) {
	interface.get_variant_to_type_constructor(to_godot(p_type))(
			r_value, const_cast<void *>(p_variant));
}

/// For types that do not allocate memory.
template <typename T> T convert(BuiltInType p_type, const void *p_variant) {
	T value = {};
	convert_to_godot_type(p_type, &value, p_variant);
	return value;
}

} // namespace

const Interface &get_interface() {
	return interface;
}

void load_interface(
		GDExtensionInterfaceGetProcAddress p_get_address, GDExtensionClassLibraryPtr p_library) {
	interface.extension = p_library;
#define LOAD(m_name) load(p_get_address, #m_name, interface.m_name)
	LOAD(variant_new_nil);
	LOAD(variant_new_copy);
	LOAD(variant_destroy);
	LOAD(get_variant_from_type_constructor);
	LOAD(get_variant_to_type_constructor);
	LOAD(variant_get_ptr_constructor);
	LOAD(variant_get_ptr_destructor);
	LOAD(variant_get_ptr_builtin_method);
	LOAD(string_new_with_utf8_chars_and_len);
	LOAD(string_to_utf8_chars);
	LOAD(string_name_new_with_utf8_chars);
	LOAD(variant_get_type);
	LOAD(variant_call);
	LOAD(variant_get_keyed);
	LOAD(array_operator_index_const);
	LOAD(packed_byte_array_operator_index);
	LOAD(packed_color_array_operator_index);
	LOAD(packed_float32_array_operator_index);
	LOAD(packed_int32_array_operator_index);
	LOAD(packed_int64_array_operator_index);
	LOAD(packed_vector2_array_operator_index);
	LOAD(packed_vector3_array_operator_index);
	LOAD(classdb_construct_object2);
	LOAD(classdb_get_method_bind);
	LOAD(object_method_bind_ptrcall);
	LOAD(object_destroy);
	LOAD(object_cast_to);
	LOAD(object_get_instance_from_id);
	LOAD(object_get_instance_id);
	LOAD(object_set_instance);
	LOAD(classdb_get_class_tag);
	LOAD(classdb_register_extension_class5);
	LOAD(classdb_register_extension_class_method);
	LOAD(classdb_register_extension_class_property_indexed);
	LOAD(classdb_register_extension_class_property_group);
	LOAD(classdb_unregister_extension_class);
	LOAD(editor_help_load_xml_from_utf8_chars_and_len);
	LOAD(print_error);
	LOAD(print_warning);
	LOAD(global_get_singleton);
	LOAD(callable_custom_create2);
	LOAD(register_main_loop_callbacks);
#undef LOAD
}

void construct_built_in(BuiltInType p_type, void *r_value) {
	if (p_type == BuiltInType::VARIANT) {
		interface.variant_new_nil(r_value);
	} else {
		construct(p_type, EMPTY_CONSTRUCTOR, r_value, nullptr);
	}
}

void copy_built_in(BuiltInType p_type, void *r_value, const void *p_source) {
	if (p_type == BuiltInType::VARIANT) {
		interface.variant_new_copy(r_value, p_source);
	} else {
		construct(p_type, COPY_CONSTRUCTOR, r_value, p_source);
	}
}

void destroy_built_in(BuiltInType p_type, void *r_value) {
	if (p_type == BuiltInType::VARIANT) {
		interface.variant_destroy(r_value);
	} else {
		interface.variant_get_ptr_destructor(to_godot(p_type))(r_value);
	}
}

String::String(std::string_view p_text) : BuiltIn(Uninitialized::UNINITIALIZED) {
	interface.string_new_with_utf8_chars_and_len(
			bytes, p_text.data(), static_cast<GDExtensionInt>(p_text.size()));
}

std::string String::to_utf8() const {
	const GDExtensionInt length = interface.string_to_utf8_chars(bytes, nullptr, 0);
	std::string text(static_cast<size_t>(length), '\0');
	interface.string_to_utf8_chars(bytes, text.data(), length);
	return text;
}

StringName::StringName(const char *p_text) : BuiltIn(Uninitialized::UNINITIALIZED) {
	interface.string_name_new_with_utf8_chars(bytes, p_text);
}

std::string NodePath::to_utf8() const {
	return Variant(BuiltInType::NODE_PATH, bytes).to_utf8();
}

Variant::Variant(BuiltInType p_type, const void *p_value) : BuiltIn(Uninitialized::UNINITIALIZED) {
	interface.get_variant_from_type_constructor(to_godot(p_type))(
			bytes, const_cast<void *>(p_value));
}

Variant::Variant(RID p_value) : Variant(BuiltInType::RID, &p_value) {}

Variant::Variant(int64_t p_value) : Variant(BuiltInType::INT, &p_value) {}

Variant::Variant(double p_value) : Variant(BuiltInType::FLOAT, &p_value) {}

Variant::Variant(bool p_value) : BuiltIn(Uninitialized::UNINITIALIZED) {
	const uint8_t value = p_value;
	interface.get_variant_from_type_constructor(GDEXTENSION_VARIANT_TYPE_BOOL)(
			bytes, const_cast<uint8_t *>(&value));
}

Variant::Variant(const char *p_value) : Variant(BuiltInType::STRING, String(p_value).get()) {}

Variant::Variant(const std::string &p_value) :
		Variant(BuiltInType::STRING, String(p_value).get()) {}

Variant::Variant(const glm::vec3 &p_value) : Variant(BuiltInType::VECTOR3, &p_value) {}

Variant::Variant(const Transform3D &p_value) : Variant(BuiltInType::TRANSFORM3D, &p_value) {}

Variant::Variant(const PackedByteArray &p_value) :
		Variant(BuiltInType::PACKED_BYTE_ARRAY, p_value.get()) {}

Variant Variant::copy_of(const void *p_variant) {
	Variant copy(Uninitialized::UNINITIALIZED);
	copy_built_in(BuiltInType::VARIANT, copy.bytes, p_variant);
	return copy;
}

Variant Variant::of_object(void *p_object) {
	return Variant(BuiltInType::OBJECT, &p_object);
}

Variant Variant::of_type(BuiltInType p_type, const void *p_value) {
	return p_type == BuiltInType::VARIANT ? copy_of(p_value) : Variant(p_type, p_value);
}

BuiltInType Variant::get_type() const {
	return static_cast<BuiltInType>(interface.variant_get_type(bytes));
}

bool Variant::to_bool() const {
	return to_int() != 0;
}

int64_t Variant::to_int() const {
	return convert<int64_t>(BuiltInType::INT, bytes);
}

double Variant::to_float() const {
	return convert<double>(BuiltInType::FLOAT, bytes);
}

std::string Variant::to_utf8() const {
	String value; // owns no memory while empty, so that it can be constructed over
	convert_to_godot_type(BuiltInType::STRING, value.get(), bytes);
	return value.to_utf8();
}

glm::vec3 Variant::to_vector3() const {
	return convert<glm::vec3>(BuiltInType::VECTOR3, bytes);
}

Transform3D Variant::to_transform() const {
	return convert<Transform3D>(BuiltInType::TRANSFORM3D, bytes);
}

RID Variant::to_rid() const {
	return convert<RID>(BuiltInType::RID, bytes);
}

void *Variant::to_object() const {
	return get_type() == BuiltInType::OBJECT ? convert<void *>(BuiltInType::OBJECT, bytes)
											 : nullptr;
}

void Variant::store(BuiltInType p_type, void *r_value) const {
	// The new value is constructed over the old one, so types with a destructor are destroyed
	// first. RID and OBJECT have none and must not be stored.
	if (p_type == BuiltInType::VARIANT || p_type >= BuiltInType::STRING_NAME ||
			p_type == BuiltInType::STRING) {
		destroy_built_in(p_type, r_value);
	}
	if (p_type == BuiltInType::VARIANT) {
		copy_built_in(p_type, r_value, bytes);
	} else {
		convert_to_godot_type(p_type, r_value, bytes);
	}
}

Variant Variant::get_keyed(const Variant &p_key) const {
	Variant empty;
	Variant found(Uninitialized::UNINITIALIZED);
	GDExtensionBool is_valid = 0;
	interface.variant_get_keyed(bytes, p_key.bytes, found.bytes, &is_valid);
	return is_valid ? found : empty;
}

Variant Variant::call(const char *p_method, std::span<const Variant> p_arguments) const {
	std::vector<GDExtensionConstVariantPtr> arguments;
	for (const Variant &argument : p_arguments) {
		arguments.push_back(argument.bytes);
	}
	Variant result(Uninitialized::UNINITIALIZED);
	GDExtensionCallError error = {};
	const StringName method(p_method);
	interface.variant_call(bytes, method.get(), arguments.data(),
			static_cast<GDExtensionInt>(arguments.size()), result.bytes, &error);
	if (error.error != GDEXTENSION_CALL_OK) {
		fail("Godot refused to call \"", p_method, "\" with ", p_arguments.size(),
				" arguments (GDExtensionCallErrorType ", int(error.error), ", argument ",
				error.argument, ").");
	}
	return result;
}

glm::dmat4 Transform3D::to_matrix() const {
	glm::dmat4 matrix(1.0);
	for (int row = 0; row < 3; ++row) {
		for (int column = 0; column < 3; ++column) {
			matrix[column][row] = rows[row][column];
		}
	}
	matrix[3] = glm::dvec4(origin, 1.0);
	return matrix;
}

Array::Array(const Variant &p_value) : BuiltIn(Uninitialized::UNINITIALIZED) {
	if (p_value.get_type() == BuiltInType::ARRAY) {
		interface.get_variant_to_type_constructor(GDEXTENSION_VARIANT_TYPE_ARRAY)(
				bytes, p_value.get());
	} else {
		construct_built_in(BuiltInType::ARRAY, bytes);
	}
}

void Array::append(const Variant &p_value) {
	static const BuiltInMethod method(BuiltInType::ARRAY, "append", HASH_ARRAY_APPEND);
	method.call(bytes, p_value.get(), nullptr);
}

int64_t Array::get_size() const {
	static const BuiltInMethod method(BuiltInType::ARRAY, "size", HASH_ARRAY_SIZE);
	int64_t size = 0;
	method.call(bytes, nullptr, &size);
	return size;
}

Variant Array::get_value(int64_t p_index) const {
	return Variant::copy_of(interface.array_operator_index_const(bytes, p_index));
}

Variant Dictionary::to_variant() const {
	return Variant(BuiltInType::DICTIONARY, bytes);
}

void PackedStringArray::append(const String &p_text) {
	static const BuiltInMethod method(
			BuiltInType::PACKED_STRING_ARRAY, "append", HASH_PACKEDSTRINGARRAY_APPEND);
	uint8_t has_failed = 0;
	method.call(bytes, p_text.get(), &has_failed);
}

namespace {

/// The functions that differ between packed arrays.
struct PackedType {
	BuiltInMethod get_size;
	BuiltInMethod resize;
	void *(*get_first)(void *p_array);
};

template <auto OPERATOR> void *get_first(void *p_array) {
	return (interface.*OPERATOR)(p_array, 0);
}

const PackedType &get_packed_type(BuiltInType p_type) {
#define PACKED(m_type, m_name, m_operator)                                                         \
	{                                                                                              \
		m_type, {                                                                                  \
			{ m_type, "size", HASH_##m_name##_SIZE },                                              \
					{ m_type, "resize", HASH_##m_name##_RESIZE },                                  \
					get_first<&Interface::m_operator>                                              \
		}                                                                                          \
	}
	static const std::map<BuiltInType, PackedType> types = {
		PACKED(BuiltInType::PACKED_BYTE_ARRAY, PACKEDBYTEARRAY, packed_byte_array_operator_index),
		PACKED(BuiltInType::PACKED_INT32_ARRAY, PACKEDINT32ARRAY,
				packed_int32_array_operator_index),
		PACKED(BuiltInType::PACKED_INT64_ARRAY, PACKEDINT64ARRAY,
				packed_int64_array_operator_index),
		PACKED(BuiltInType::PACKED_FLOAT32_ARRAY, PACKEDFLOAT32ARRAY,
				packed_float32_array_operator_index),
		PACKED(BuiltInType::PACKED_VECTOR2_ARRAY, PACKEDVECTOR2ARRAY,
				packed_vector2_array_operator_index),
		PACKED(BuiltInType::PACKED_VECTOR3_ARRAY, PACKEDVECTOR3ARRAY,
				packed_vector3_array_operator_index),
		PACKED(BuiltInType::PACKED_COLOR_ARRAY, PACKEDCOLORARRAY,
				packed_color_array_operator_index),
	};
#undef PACKED
	return types.at(p_type);
}

} // namespace

void *resize_packed(BuiltInType p_type, void *r_array, size_t p_size) {
	const PackedType &type = get_packed_type(p_type);
	const int64_t size = static_cast<int64_t>(p_size);
	int64_t result = 0;
	type.resize.call(r_array, &size, &result);
	return type.get_first(r_array);
}

const void *get_packed(BuiltInType p_type, const void *p_array, size_t &r_size) {
	const PackedType &type = get_packed_type(p_type);
	void *array = const_cast<void *>(p_array);
	int64_t size = 0;
	type.get_size.call(array, nullptr, &size);
	r_size = static_cast<size_t>(size);
	return size == 0 ? nullptr : type.get_first(array);
}

void convert_to_packed(BuiltInType p_type, void *r_array, const Variant &p_value) {
	if (p_value.get_type() == p_type) {
		interface.get_variant_to_type_constructor(to_godot(p_type))(r_array, p_value.get());
	} else {
		construct_built_in(p_type, r_array);
	}
}

Callable::Callable(Function p_function) : BuiltIn(Uninitialized::UNINITIALIZED) {
	GDExtensionCallableCustomInfo2 info = {};
	info.callable_userdata = new Function(std::move(p_function));
	info.token = interface.extension;
	info.call_func = [](void *p_userdata, const GDExtensionConstVariantPtr *p_arguments,
							 GDExtensionInt p_count, GDExtensionVariantPtr,
							 GDExtensionCallError *r_error) {
		r_error->error = GDEXTENSION_CALL_OK;
		log_failures([&] {
			std::vector<Variant> arguments;
			for (GDExtensionInt index = 0; index < p_count; ++index) {
				arguments.push_back(Variant::copy_of(p_arguments[index]));
			}
			(*static_cast<Function *>(p_userdata))(arguments);
		});
	};
	info.free_func = [](void *p_userdata) { delete static_cast<Function *>(p_userdata); };
	interface.callable_custom_create2(bytes, &info);
}

void *get_instance(uint64_t p_id) {
	return interface.object_get_instance_from_id(p_id);
}

uint64_t get_instance_id(void *p_object) {
	return interface.object_get_instance_id(p_object);
}

void *find_class_tag(const char *p_class) {
	const StringName name(p_class);
	return interface.classdb_get_class_tag(name.get());
}

void *cast_object(void *p_object, void *p_class_tag) {
	return p_object && p_class_tag ? interface.object_cast_to(p_object, p_class_tag) : nullptr;
}

void *create_object(const char *p_class) {
	const StringName name(p_class);
	void *object = interface.classdb_construct_object2(name.get());
	GNOMON_ASSERT(object, "Godot cannot create an object of class ", p_class);
	RefCounted(object).init_ref();
	return object;
}

void *find_singleton(const char *p_class) {
	const StringName name(p_class);
	void *object = interface.global_get_singleton(name.get());
	GNOMON_ASSERT(object, "Godot has no singleton ", p_class);
	return object;
}

void add_owner(void *p_object) {
	RefCounted(p_object).reference();
}

void drop_owner(void *p_object) {
	if (RefCounted(p_object).unreference()) {
		interface.object_destroy(p_object);
	}
}

MethodBind::MethodBind(const char *p_class, const char *p_method, int64_t p_hash) {
	const StringName class_name(p_class);
	const StringName method_name(p_method);
	bind = const_cast<void *>(
			interface.classdb_get_method_bind(class_name.get(), method_name.get(), p_hash));
	if (!bind) {
		fail("This Godot has no ", p_class, ".", p_method,
				" with the signature that the add-on was built for. Build the add-on with this "
				"Godot, see doc/godot.md.");
	}
}

void MethodBind::call_raw(void *p_object, const void **p_arguments, void *r_result) const {
	interface.object_method_bind_ptrcall(
			static_cast<GDExtensionMethodBindPtr>(bind), p_object, p_arguments, r_result);
}

} // namespace gnomon::godot
