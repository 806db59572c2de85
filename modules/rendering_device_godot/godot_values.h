#pragma once

#include <glm/glm.hpp>

#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Values of Godot as its methods take them. Vectors and colours are glm's.

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

/// As in GDExtensionVariantType; VARIANT: one that holds any of them.
enum class BuiltInType : int {
	VARIANT = 0,
	BOOL = 1,
	INT = 2,
	STRING = 4,
	STRING_NAME = 21,
	RID = 23,
	OBJECT = 24,
	CALLABLE = 25,
	ARRAY = 28,
	PACKED_BYTE_ARRAY = 29,
	PACKED_INT64_ARRAY = 31,
	PACKED_COLOR_ARRAY = 37,
};

void construct_built_in(BuiltInType p_type, void *r_value);
void copy_built_in(BuiltInType p_type, void *r_value, const void *p_source);
void destroy_built_in(BuiltInType p_type, void *r_value);

/// A value whose memory Godot manages.
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
	void *get() const { return bytes; }

protected:
	/// The constructor of the derived class fills `bytes`.
	enum class Empty { EMPTY };
	explicit BuiltIn(Empty) {}

	alignas(8) mutable uint8_t bytes[BYTES] = {};
};
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
	void is_built_in() const {}
};

/// Any value, for arrays.
class Variant : public BuiltIn<BuiltInType::VARIANT, 24> {
public:
	Variant() = default;
	Variant(RID p_value);
	Variant(int64_t p_value);
	Variant(bool p_value);
	Variant(const class PackedByteArray &p_value);
	/// Of a RefCounted: another owner.
	static Variant of_object(void *p_object);
	/// Of one that Godot hands over by its address.
	static Variant copy_of(const void *p_variant);
	void is_built_in() const {}

private:
	explicit Variant(Empty) : BuiltIn(Empty::EMPTY) {}
	Variant(BuiltInType p_type, const void *p_value);
};

class Array : public BuiltIn<BuiltInType::ARRAY, 8> {
public:
	void append(const Variant &p_value);
	void is_built_in() const {}
};

class PackedByteArray : public BuiltIn<BuiltInType::PACKED_BYTE_ARRAY, 16> {
public:
	PackedByteArray() = default;
	PackedByteArray(std::span<const uint8_t> p_bytes);
	/// Empty where it holds another type.
	explicit PackedByteArray(const Variant &p_value);
	std::span<const uint8_t> get_bytes() const;
	void is_built_in() const {}
};

class PackedInt64Array : public BuiltIn<BuiltInType::PACKED_INT64_ARRAY, 16> {
public:
	void is_built_in() const {}
};

class PackedColorArray : public BuiltIn<BuiltInType::PACKED_COLOR_ARRAY, 16> {
public:
	PackedColorArray() = default;
	PackedColorArray(std::span<const glm::vec4> p_colors);
	void is_built_in() const {}
};

class Callable : public BuiltIn<BuiltInType::CALLABLE, 16> {
public:
	Callable() = default;
	/// Of one argument. It must not throw.
	explicit Callable(std::function<void(const Variant &)> p_function);
	void is_built_in() const {}
};

} // namespace gnomon::godot
