#include "modules/rendering_device_godot/godot_interface.h"

#include "modules/core/error.h"

#include <godot_api.gen.h>
#include <godot_hashes.gen.h>

#include <cstring>

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

/// Index 0 makes an empty value, index 1 a copy: so of all types.
void construct(BuiltInType p_type, int p_index, void *r_value, const void *p_source) {
	const GDExtensionConstTypePtr arguments[] = { p_source };
	interface.variant_get_ptr_constructor(to_godot(p_type), p_index)(r_value, arguments);
}

class BuiltInMethod {
public:
	BuiltInMethod(BuiltInType p_type, const char *p_name, int64_t p_hash) {
		const StringName name(p_name);
		method = interface.variant_get_ptr_builtin_method(to_godot(p_type), name.get(), p_hash);
		if (!method) {
			fail("This Godot has no method \"", p_name, "\" of arrays as Gnomon knows it.");
		}
	}
	void call(void *p_base, const void *p_argument, void *r_result) const {
		const GDExtensionConstTypePtr arguments[] = { p_argument };
		method(p_base, arguments, r_result, p_argument ? 1 : 0);
	}

private:
	GDExtensionPtrBuiltInMethod method = nullptr;
};

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
	LOAD(packed_byte_array_operator_index);
	LOAD(packed_color_array_operator_index);
	LOAD(classdb_construct_object2);
	LOAD(classdb_get_method_bind);
	LOAD(object_method_bind_ptrcall);
	LOAD(object_destroy);
	LOAD(global_get_singleton);
	LOAD(callable_custom_create2);
	LOAD(register_main_loop_callbacks);
#undef LOAD
}

void construct_built_in(BuiltInType p_type, void *r_value) {
	if (p_type == BuiltInType::VARIANT) {
		interface.variant_new_nil(r_value);
	} else {
		construct(p_type, 0, r_value, nullptr);
	}
}

void copy_built_in(BuiltInType p_type, void *r_value, const void *p_source) {
	if (p_type == BuiltInType::VARIANT) {
		interface.variant_new_copy(r_value, p_source);
	} else {
		construct(p_type, 1, r_value, p_source);
	}
}

void destroy_built_in(BuiltInType p_type, void *r_value) {
	if (p_type == BuiltInType::VARIANT) {
		interface.variant_destroy(r_value);
	} else {
		interface.variant_get_ptr_destructor(to_godot(p_type))(r_value);
	}
}

String::String(std::string_view p_text) : BuiltIn(Empty::EMPTY) {
	interface.string_new_with_utf8_chars_and_len(
			bytes, p_text.data(), static_cast<GDExtensionInt>(p_text.size()));
}

std::string String::to_utf8() const {
	const GDExtensionInt length = interface.string_to_utf8_chars(bytes, nullptr, 0);
	std::string text(static_cast<size_t>(length), '\0');
	interface.string_to_utf8_chars(bytes, text.data(), length);
	return text;
}

StringName::StringName(const char *p_text) : BuiltIn(Empty::EMPTY) {
	interface.string_name_new_with_utf8_chars(bytes, p_text);
}

Variant::Variant(BuiltInType p_type, const void *p_value) : BuiltIn(Empty::EMPTY) {
	interface.get_variant_from_type_constructor(to_godot(p_type))(
			bytes, const_cast<void *>(p_value));
}

Variant::Variant(RID p_value) : Variant(BuiltInType::RID, &p_value) {}

Variant::Variant(int64_t p_value) : Variant(BuiltInType::INT, &p_value) {}

Variant::Variant(bool p_value) : BuiltIn(Empty::EMPTY) {
	const uint8_t value = p_value;
	interface.get_variant_from_type_constructor(GDEXTENSION_VARIANT_TYPE_BOOL)(
			bytes, const_cast<uint8_t *>(&value));
}

Variant::Variant(const PackedByteArray &p_value) :
		Variant(BuiltInType::PACKED_BYTE_ARRAY, p_value.get()) {}

Variant Variant::copy_of(const void *p_variant) {
	Variant copy(Empty::EMPTY);
	copy_built_in(BuiltInType::VARIANT, copy.bytes, p_variant);
	return copy;
}

Variant Variant::of_object(void *p_object) {
	return Variant(BuiltInType::OBJECT, &p_object);
}

void Array::append(const Variant &p_value) {
	static const BuiltInMethod method(BuiltInType::ARRAY, "append", HASH_ARRAY_APPEND);
	method.call(bytes, p_value.get(), nullptr);
}

PackedByteArray::PackedByteArray(std::span<const uint8_t> p_bytes) {
	static const BuiltInMethod resize(
			BuiltInType::PACKED_BYTE_ARRAY, "resize", HASH_PACKEDBYTEARRAY_RESIZE);
	if (p_bytes.empty()) {
		return;
	}
	const int64_t size = static_cast<int64_t>(p_bytes.size());
	int64_t result = 0;
	resize.call(bytes, &size, &result);
	std::memcpy(
			interface.packed_byte_array_operator_index(bytes, 0), p_bytes.data(), p_bytes.size());
}

PackedByteArray::PackedByteArray(const Variant &p_value) : BuiltIn(Empty::EMPTY) {
	interface.get_variant_to_type_constructor(to_godot(BuiltInType::PACKED_BYTE_ARRAY))(
			bytes, p_value.get());
}

std::span<const uint8_t> PackedByteArray::get_bytes() const {
	static const BuiltInMethod get_size(
			BuiltInType::PACKED_BYTE_ARRAY, "size", HASH_PACKEDBYTEARRAY_SIZE);
	int64_t size = 0;
	get_size.call(bytes, nullptr, &size);
	return size == 0 ? std::span<const uint8_t>()
					 : std::span<const uint8_t>(
							   interface.packed_byte_array_operator_index(bytes, 0), size_t(size));
}

PackedColorArray::PackedColorArray(std::span<const glm::vec4> p_colors) {
	static const BuiltInMethod resize(
			BuiltInType::PACKED_COLOR_ARRAY, "resize", HASH_PACKEDCOLORARRAY_RESIZE);
	const int64_t size = static_cast<int64_t>(p_colors.size());
	int64_t result = 0;
	resize.call(bytes, &size, &result);
	for (int64_t index = 0; index < size; ++index) {
		std::memcpy(interface.packed_color_array_operator_index(bytes, index),
				&p_colors[size_t(index)], sizeof(glm::vec4));
	}
}

Callable::Callable(std::function<void(const Variant &)> p_function) : BuiltIn(Empty::EMPTY) {
	using Function = std::function<void(const Variant &)>;
	GDExtensionCallableCustomInfo2 info = {};
	info.callable_userdata = new Function(std::move(p_function));
	info.token = interface.extension;
	info.call_func = [](void *p_userdata, const GDExtensionConstVariantPtr *p_arguments,
							 GDExtensionInt p_count, GDExtensionVariantPtr,
							 GDExtensionCallError *r_error) {
		r_error->error = GDEXTENSION_CALL_OK;
		if (p_count > 0) {
			(*static_cast<Function *>(p_userdata))(Variant::copy_of(p_arguments[0]));
		}
	};
	info.free_func = [](void *p_userdata) { delete static_cast<Function *>(p_userdata); };
	interface.callable_custom_create2(bytes, &info);
}

void *create_object(const char *p_class) {
	const StringName name(p_class);
	void *object = interface.classdb_construct_object2(name.get());
	GNOMON_ASSERT(object, "Godot makes no ", p_class);
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
				" as Gnomon knows it. Build the add-on with this Godot, see doc/godot.md.");
	}
}

void MethodBind::call_raw(void *p_object, const void **p_arguments, void *r_result) const {
	interface.object_method_bind_ptrcall(
			static_cast<GDExtensionMethodBindPtr>(bind), p_object, p_arguments, r_result);
}

} // namespace gnomon::godot
