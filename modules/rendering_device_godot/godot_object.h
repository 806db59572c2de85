#pragma once

#include "modules/rendering_device_godot/godot_values.h"

#include <tuple>
#include <type_traits>
#include <utility>

namespace gnomon::godot {

/// An object of Godot that somebody else owns; empty: none.
class ObjectHandle {
public:
	ObjectHandle() = default;
	explicit ObjectHandle(void *p_owner) : owner(p_owner) {}
	void *get_owner() const { return owner; }
	explicit operator bool() const { return owner != nullptr; }

protected:
	void *owner = nullptr;
};

/// Makes an object of a class of Godot; its error names the class.
void *create_object(const char *p_class);
void *find_singleton(const char *p_class);
/// The object that has this id; null: it is gone. On the thread that may free it.
void *get_instance(uint64_t p_id);
uint64_t get_instance_id(void *p_object);
/// Null: this Godot has no such class.
void *find_class_tag(const char *p_class);
void *cast_object(void *p_object, void *p_class_tag);
/// Empty where the object is none or of another class.
template <typename T> T cast(const ObjectHandle &p_object) {
	static void *const tag = find_class_tag(T::CLASS_NAME);
	return T(cast_object(p_object.get_owner(), tag));
}
/// Counts the owners of an object that is a RefCounted of Godot.
void add_owner(void *p_object);
void drop_owner(void *p_object); // frees it with the last one

/// An object that is freed with its last owner.
template <typename T> class Ref : public T {
public:
	Ref() = default;
	/// Takes over one owner, as results of methods have it.
	explicit Ref(void *p_owner) : T(p_owner) {}
	Ref(const Ref &p_other) : T(p_other.owner) {
		if (this->owner) {
			add_owner(this->owner);
		}
	}
	Ref(Ref &&p_other) noexcept : T(std::exchange(p_other.owner, nullptr)) {}
	Ref &operator=(Ref p_other) noexcept {
		std::swap(this->owner, p_other.owner);
		return *this;
	}
	~Ref() {
		if (this->owner) {
			drop_owner(this->owner);
		}
	}
	static Ref create() { return Ref(create_object(T::CLASS_NAME)); }
	/// One owner more of an object that somebody else owns too, or empty.
	static Ref share(const ObjectHandle &p_object) {
		const T found = cast<T>(p_object);
		if (found) {
			add_owner(found.get_owner());
		}
		return Ref(found.get_owner());
	}
};

/// A method of a class, found when it is first called. One that this Godot does not have is an
/// Error that names it.
class MethodBind {
public:
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
			void *owner = nullptr;
			call_raw(p_object, pointers, &owner);
			return Result(owner);
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
	/// Points at a value that lives elsewhere.
	struct Pointer {
		const void *value;
	};
	template <typename T> static auto encode(const T &p_value) {
		if constexpr (std::is_same_v<T, bool>) {
			return uint8_t(p_value);
		} else if constexpr (std::is_base_of_v<ObjectHandle, T>) {
			return p_value.get_owner();
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
