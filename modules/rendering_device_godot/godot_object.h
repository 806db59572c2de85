#pragma once

#include "modules/rendering_device_godot/godot_values.h"

#include <tuple>
#include <type_traits>
#include <utility>

namespace gnomon::godot {

/// A non-owning handle of a Godot object; empty: none.
class ObjectHandle {
public:
	ObjectHandle() = default;
	explicit ObjectHandle(void *p_object) : object(p_object) {}
	void *get_object() const { return object; } // Godot's Object *
	explicit operator bool() const { return object != nullptr; }

protected:
	void *object = nullptr;
};

/// Creates an object of a Godot class that inherits RefCounted, with one reference. A class that
/// Godot cannot create is an assertion.
void *create_object(const char *p_class);
/// Returns the only object of the class; a singleton that Godot lacks is an assertion.
void *find_singleton(const char *p_class);
/// Returns the object with this id; null: it was freed. Call it on the thread that may free it.
void *get_instance(uint64_t p_id);
uint64_t get_instance_id(void *p_object);
/// Returns the tag of a class; null: this version of Godot has no such class.
void *find_class_tag(const char *p_class);
/// Returns null if the object or the tag is null, or the object is of another class.
void *cast_object(void *p_object, void *p_class_tag);
/// Casts an object; the result is empty if it is null or of another class.
template <typename T> T cast(const ObjectHandle &p_object) {
	static void *const tag = find_class_tag(T::CLASS_NAME);
	return T(cast_object(p_object.get_object(), tag));
}
/// Increments the reference count of a RefCounted object.
void add_owner(void *p_object);
void drop_owner(void *p_object); // decrements the reference count and frees the object at 0

/// A reference-counted handle: the object is freed with its last reference.
template <typename T> class Ref : public T {
public:
	Ref() = default;
	/// Adopts one reference. Objects that methods return come with one.
	explicit Ref(void *p_object) : T(p_object) {}
	Ref(const Ref &p_other) : T(p_other.object) {
		if (this->object) {
			add_owner(this->object);
		}
	}
	Ref(Ref &&p_other) noexcept : T(std::exchange(p_other.object, nullptr)) {}
	Ref &operator=(Ref p_other) noexcept {
		std::swap(this->object, p_other.object);
		return *this;
	}
	~Ref() {
		if (this->object) {
			drop_owner(this->object);
		}
	}
	static Ref create() { return Ref(create_object(T::CLASS_NAME)); }
	/// Adds a reference to an object that others hold too. The result is empty if p_object is
	/// empty or of another class.
	static Ref share(const ObjectHandle &p_object) {
		const T found = cast<T>(p_object);
		if (found) {
			add_owner(found.get_object());
		}
		return Ref(found.get_object());
	}
};

/// A method of a Godot class. The generated classes look it up at its first call. If this version
/// of Godot lacks it, that is an Error that names the method.
class MethodBind {
public:
	/// p_hash: Godot's hash of the method's signature.
	MethodBind(const char *p_class, const char *p_method, int64_t p_hash);

	template <typename Result, typename... Arguments>
	Result call(void *p_object, const Arguments &...p_arguments) const {
		const auto values = std::make_tuple(encode(p_arguments)...);
		const void *pointers[sizeof...(Arguments) + 1] = {};
		std::apply(
				[&](const auto &...p_values) {
					size_t index = 0;
					((pointers[index++] = get_pointer(p_values)), ...);
				},
				values);
		if constexpr (std::is_void_v<Result>) {
			call_raw(p_object, pointers, nullptr);
		} else if constexpr (std::is_base_of_v<ObjectHandle, Result>) {
			void *object = nullptr;
			call_raw(p_object, pointers, &object);
			return Result(object);
		} else if constexpr (std::is_same_v<Result, bool>) {
			uint8_t result = 0;
			call_raw(p_object, pointers, &result);
			return result != 0;
		} else if constexpr (IsBuiltIn<Result>) {
			Result result;
			call_raw(p_object, pointers, result.get());
			return result;
		} else {
			Result result = {};
			call_raw(p_object, pointers, &result);
			return result;
		}
	}

private:
	/// Points at a value that is stored elsewhere.
	struct Pointer {
		const void *value;
	};
	/// Converts an argument to what a ptrcall reads: get_pointer of the result is its address.
	template <typename T> static auto encode(const T &p_value) {
		if constexpr (std::is_same_v<T, bool>) {
			return uint8_t(p_value);
		} else if constexpr (std::is_base_of_v<ObjectHandle, T>) {
			return p_value.get_object();
		} else if constexpr (IsBuiltIn<T>) {
			return Pointer{ p_value.get() };
		} else {
			return p_value;
		}
	}
	template <typename T> static const void *get_pointer(const T &p_value) {
		if constexpr (std::is_same_v<T, Pointer>) {
			return p_value.value;
		} else {
			return &p_value;
		}
	}
	void call_raw(void *p_object, const void **p_arguments, void *r_result) const;

	void *bind = nullptr;
};

} // namespace gnomon::godot
