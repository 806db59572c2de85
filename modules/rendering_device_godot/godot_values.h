#pragma once

#include <glm/glm.hpp>

#include <compare>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Godot's Variant built-ins in the memory layout that ptrcalls expect: 64-bit, single precision.
// Vectors and colours are glm types.

namespace gnomon::godot {

struct RID {
	uint64_t id = 0;
	explicit operator bool() const { return id != 0; }
	auto operator<=>(const RID &) const = default;
};
struct Rect2 {
	glm::vec2 position = glm::vec2(0.0f);
	glm::vec2 size = glm::vec2(0.0f);
};
struct AABB {
	glm::vec3 position = glm::vec3(0.0f);
	glm::vec3 size = glm::vec3(0.0f);
};
/// Godot stores the basis by rows.
struct Transform3D {
	glm::vec3 rows[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
	glm::vec3 origin = glm::vec3(0.0f);
	glm::dmat4 to_matrix() const;
	bool operator==(const Transform3D &) const = default;
};

/// Values of GDExtensionVariantType; VARIANT, which is NIL there, is a Variant of any type.
enum class BuiltInType : int {
	VARIANT = 0,
	BOOL = 1,
	INT = 2,
	FLOAT = 3,
	STRING = 4,
	VECTOR2 = 5,
	VECTOR2I = 6,
	VECTOR3 = 9,
	VECTOR3I = 10,
	VECTOR4 = 12,
	VECTOR4I = 13,
	BASIS = 17,
	TRANSFORM3D = 18,
	PROJECTION = 19,
	COLOR = 20,
	STRING_NAME = 21,
	NODE_PATH = 22,
	RID = 23,
	OBJECT = 24,
	CALLABLE = 25,
	DICTIONARY = 27,
	ARRAY = 28,
	PACKED_BYTE_ARRAY = 29,
	PACKED_INT32_ARRAY = 30,
	PACKED_INT64_ARRAY = 31,
	PACKED_FLOAT32_ARRAY = 32,
	PACKED_STRING_ARRAY = 34,
	PACKED_VECTOR2_ARRAY = 35,
	PACKED_VECTOR3_ARRAY = 36,
	PACKED_COLOR_ARRAY = 37,
};

void construct_built_in(BuiltInType p_type, void *r_value);
void copy_built_in(BuiltInType p_type, void *r_value, const void *p_source);
void destroy_built_in(BuiltInType p_type, void *r_value);

/// A value whose contents Godot allocates and frees.
template <BuiltInType TYPE, size_t BYTES> class BuiltIn {
public:
	BuiltIn() { construct_built_in(TYPE, bytes); }
	BuiltIn(const BuiltIn &p_other) { copy_built_in(TYPE, bytes, p_other.bytes); }
	BuiltIn &operator=(const BuiltIn &p_other) {
		if (this != &p_other) {
			destroy_built_in(TYPE, bytes);
			copy_built_in(TYPE, bytes, p_other.bytes);
		}
		return *this;
	}
	~BuiltIn() { destroy_built_in(TYPE, bytes); }
	void *get() const { return bytes; } // the address that Godot's calls take

protected:
	/// Leaves `bytes` without a valid value, for the constructor of the derived class to fill.
	enum class Uninitialized { UNINITIALIZED };
	explicit BuiltIn(Uninitialized) {}

	alignas(8) mutable uint8_t bytes[BYTES] = {};
};
/// The classes derived from BuiltIn, which is_built_in() marks; it does nothing.
template <typename T>
concept IsBuiltIn = requires(const T &p_value) {
	{ p_value.is_built_in() };
};

class String : public BuiltIn<BuiltInType::STRING, 8> {
public:
	String() = default;
	String(std::string_view p_text);
	String(const char *p_text) : String(std::string_view(p_text)) {}
	String(const std::string &p_text) : String(std::string_view(p_text)) {}
	std::string to_utf8() const;
	void is_built_in() const {}
};

class StringName : public BuiltIn<BuiltInType::STRING_NAME, 8> {
public:
	StringName() = default;
	StringName(const char *p_text);
	StringName(const std::string &p_text) : StringName(p_text.c_str()) {}
	void is_built_in() const {}
};

class NodePath : public BuiltIn<BuiltInType::NODE_PATH, 8> {
public:
	std::string to_utf8() const;
	void is_built_in() const {}
};

/// A Variant, which can store any type.
class Variant : public BuiltIn<BuiltInType::VARIANT, 24> {
public:
	Variant() = default;
	Variant(RID p_value);
	Variant(int64_t p_value);
	Variant(double p_value);
	Variant(bool p_value);
	Variant(const char *p_value);
	Variant(const std::string &p_value);
	Variant(const glm::vec3 &p_value);
	Variant(const Transform3D &p_value);
	Variant(const class PackedByteArray &p_value);
	/// Makes a Variant of a RefCounted object and adds a reference to it.
	static Variant of_object(void *p_object);
	/// Copies a Variant that Godot passes by address.
	static Variant copy_of(const void *p_variant);
	/// Makes a Variant from a value of that type, which Godot passes by address.
	static Variant of_type(BuiltInType p_type, const void *p_value);
	void is_built_in() const {}

	BuiltInType get_type() const;
	// Convert as Godot does: the result is 0 or empty if the stored value does not convert.
	bool to_bool() const;
	int64_t to_int() const;
	double to_float() const;
	std::string to_utf8() const;
	glm::vec3 to_vector3() const;
	Transform3D to_transform() const;
	RID to_rid() const;
	/// Returns null if no object is stored. Adds no reference: callers that keep a RefCounted must.
	void *to_object() const;
	/// Converts to p_type and assigns to an existing value of that type.
	void store(BuiltInType p_type, void *r_value) const;
	/// Looks up a key of a Dictionary; the result is empty if the key is absent.
	Variant get_keyed(const Variant &p_key) const;
	/// Calls a method of the stored object or value. If Godot rejects the call, an Error names it.
	Variant call(const char *p_method, std::span<const Variant> p_arguments) const;

private:
	friend class NodePath;
	friend class Dictionary;
	explicit Variant(Uninitialized) : BuiltIn(Uninitialized::UNINITIALIZED) {}
	Variant(BuiltInType p_type, const void *p_value);
};

class Array : public BuiltIn<BuiltInType::ARRAY, 8> {
public:
	Array() = default;
	/// The array is empty if the Variant stores another type.
	explicit Array(const Variant &p_value);
	void append(const Variant &p_value);
	int64_t get_size() const;
	Variant get_value(int64_t p_index) const;
	void is_built_in() const {}
};

class Dictionary : public BuiltIn<BuiltInType::DICTIONARY, 8> {
public:
	Variant to_variant() const;
	void is_built_in() const {}
};

// Resize, read or construct the packed array of that type at r_array or p_array. resize_packed and
// get_packed return the address of its first element; get_packed returns null if it is empty.
void *resize_packed(BuiltInType p_type, void *r_array, size_t p_size);
const void *get_packed(BuiltInType p_type, const void *p_array, size_t &r_size);
void convert_to_packed(BuiltInType p_type, void *r_array, const Variant &p_value);

/// A packed array: contiguous numbers or vectors.
template <typename T, BuiltInType TYPE> class PackedArray : public BuiltIn<TYPE, 16> {
public:
	PackedArray() = default;
	PackedArray(std::span<const T> p_values) {
		if (!p_values.empty()) {
			std::memcpy(resize_packed(TYPE, this->bytes, p_values.size()), p_values.data(),
					p_values.size_bytes());
		}
	}
	/// The array is empty if the Variant stores another type.
	explicit PackedArray(const Variant &p_value) :
			BuiltIn<TYPE, 16>(BuiltIn<TYPE, 16>::Uninitialized::UNINITIALIZED) {
		convert_to_packed(TYPE, this->bytes, p_value);
	}
	std::span<const T> get_values() const {
		size_t size = 0;
		const void *first = get_packed(TYPE, this->bytes, size);
		return { static_cast<const T *>(first), size };
	}
	void is_built_in() const {}
};

class PackedByteArray : public PackedArray<uint8_t, BuiltInType::PACKED_BYTE_ARRAY> {
public:
	using PackedArray::PackedArray;
};
using PackedInt32Array = PackedArray<int32_t, BuiltInType::PACKED_INT32_ARRAY>;
using PackedInt64Array = PackedArray<int64_t, BuiltInType::PACKED_INT64_ARRAY>;
using PackedFloat32Array = PackedArray<float, BuiltInType::PACKED_FLOAT32_ARRAY>;
using PackedVector2Array = PackedArray<glm::vec2, BuiltInType::PACKED_VECTOR2_ARRAY>;
using PackedVector3Array = PackedArray<glm::vec3, BuiltInType::PACKED_VECTOR3_ARRAY>;
using PackedColorArray = PackedArray<glm::vec4, BuiltInType::PACKED_COLOR_ARRAY>;

class PackedStringArray : public BuiltIn<BuiltInType::PACKED_STRING_ARRAY, 16> {
public:
	void append(const String &p_text);
	void is_built_in() const {}
};

class Callable : public BuiltIn<BuiltInType::CALLABLE, 16> {
public:
	/// Exceptions of the function are logged.
	using Function = std::function<void(std::span<const Variant>)>;
	Callable() = default;
	explicit Callable(Function p_function);
	void is_built_in() const {}
};

} // namespace gnomon::godot
