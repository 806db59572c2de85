#include "tests/godot/host/host_objects.h"

#include <cstdio>
#include <cstring>
#include <deque>
#include <memory>

namespace {

const int32_t NOTIFICATION_POSTINITIALIZE = 0;

/// A method of a stand-in for a class of Godot. It counts its calls.
struct StandInMethod {
	std::string name; // "Class.method"
	GDExtensionVariantType result_type = GDEXTENSION_VARIANT_TYPE_NIL;
	std::string result; // of methods that return a text
};

/// Objects of Godot's classes that exist once, by class.
std::map<std::string, std::unique_ptr<HostObject>> &get_singletons() {
	static std::map<std::string, std::unique_ptr<HostObject>> singletons;
	return singletons;
}

const char *const SINGLETONS[] = { "Engine", "ProjectSettings", "RenderingServer", "Time" };

std::string describe_argument(const GDExtensionPropertyInfo &p_info) {
	return load_text(p_info.name) + ": " + std::to_string(p_info.type);
}

} // namespace

const HostMethod &HostClass::find_method(const std::string &p_name) const {
	for (const HostMethod &method : methods) {
		if (method.name == p_name) {
			return method;
		}
	}
	std::fprintf(stderr, "ERROR: %s has no method %s\n", name.c_str(), p_name.c_str());
	std::exit(1);
}

HostState &get_state() {
	static HostState state;
	return state;
}

HostObject *create_object(const std::string &p_class) {
	const HostClass &found = get_state().classes.at(p_class);
	return static_cast<HostObject *>(
			found.info.create_instance_func(found.info.class_userdata, /*notifies=*/true));
}

void destroy_object(HostObject *p_object) {
	const auto found = get_state().classes.find(p_object->class_name);
	if (found != get_state().classes.end() && p_object->instance) {
		found->second.info.free_instance_func(
				found->second.info.class_userdata, p_object->instance);
	}
	--get_state().object_count;
	delete p_object;
}

HostValue call_method(HostObject &p_object, const std::string &p_method,
		const std::vector<HostValue> &p_arguments) {
	const HostMethod &method = get_state().classes.at(p_object.class_name).find_method(p_method);
	std::deque<HostArgument> values;
	std::vector<GDExtensionConstVariantPtr> pointers;
	for (const HostValue &argument : p_arguments) {
		pointers.push_back(values.emplace_back(argument, GDEXTENSION_VARIANT_TYPE_NIL).get());
	}
	HostArgument result({}, GDEXTENSION_VARIANT_TYPE_NIL);
	destroy_value(GDEXTENSION_VARIANT_TYPE_NIL, result.get()); // the library constructs it
	GDExtensionCallError error = {};
	method.info.call_func(method.info.method_userdata, p_object.instance, pointers.data(),
			static_cast<GDExtensionInt>(pointers.size()), result.get(), &error);
	if (error.error != GDEXTENSION_CALL_OK) {
		print_line("refused call",
				p_method + " with " + std::to_string(pointers.size()) + " arguments, " +
						std::to_string(error.expected) + " expected");
	}
	return result.load();
}

HostValue call_typed(
		HostObject &p_object, const std::string &p_method, GDExtensionVariantType p_result_type) {
	const HostMethod &method = get_state().classes.at(p_object.class_name).find_method(p_method);
	HostArgument result(make_text(p_result_type, {}), p_result_type);
	method.info.ptrcall_func(
			method.info.method_userdata, p_object.instance, /*arguments=*/nullptr, result.get());
	return result.load();
}

void print_line(const std::string &p_kind, const std::string &p_text) {
	std::printf("%s: %s\n", p_kind.c_str(), p_text.c_str());
}

// The functions of the interface.

namespace {

void *construct_object(const void *p_class) {
	++get_state().object_count;
	HostObject *object = new HostObject();
	object->class_name = load_text(p_class);
	return object;
}

void set_instance(void *p_object, const void *p_class, void *p_instance) {
	static_cast<HostObject *>(p_object)->class_name = load_text(p_class);
	static_cast<HostObject *>(p_object)->instance = p_instance;
}

void destroy(void *p_object) {
	destroy_object(static_cast<HostObject *>(p_object));
}

void *cast_to(const void *p_object, void *p_tag) {
	const std::string &tag = *static_cast<const std::string *>(p_tag);
	const std::string name = static_cast<const HostObject *>(p_object)->class_name;
	const auto found = get_state().classes.find(name);
	const bool is_parent = found != get_state().classes.end() && found->second.parent == tag;
	return name == tag || is_parent ? const_cast<void *>(p_object) : nullptr;
}

void *get_class_tag(const void *p_class) {
	static std::deque<std::string> tags; // their addresses stay the same
	const std::string name = load_text(p_class);
	for (std::string &tag : tags) {
		if (tag == name) {
			return &tag;
		}
	}
	return &tags.emplace_back(name);
}

void *get_instance_from_id(GDObjectInstanceID) {
	return nullptr;
}

GDObjectInstanceID get_instance_id(const void *) {
	return 1;
}

void *get_singleton(const void *p_name) {
	const std::string name = load_text(p_name);
	for (const char *singleton : SINGLETONS) {
		if (name == singleton) {
			std::unique_ptr<HostObject> &object = get_singletons()[name];
			if (!object) {
				object = std::make_unique<HostObject>();
				object->class_name = name;
			}
			return object.get();
		}
	}
	return nullptr;
}

const void *get_method_bind(const void *p_class, const void *p_method, GDExtensionInt) {
	static std::map<std::string, StandInMethod> methods;
	const std::string name = load_text(p_class) + "." + load_text(p_method);
	StandInMethod &method = methods[name];
	const auto result = get_state().results.find(name);
	if (result != get_state().results.end()) {
		method.result_type = GDEXTENSION_VARIANT_TYPE_STRING;
		method.result = result->second;
	}
	method.name = name;
	return &method;
}

void call_bind(GDExtensionMethodBindPtr p_bind, void *p_object,
		const GDExtensionConstTypePtr *p_arguments, void *r_result) {
	const StandInMethod &method = *static_cast<const StandInMethod *>(p_bind);
	++get_state().method_calls[method.name];
	if (method.name == "Object.notification") {
		const HostObject &object = *static_cast<HostObject *>(p_object);
		int64_t what = 0;
		std::memcpy(&what, p_arguments[0], sizeof(what));
		get_state()
				.classes.at(object.class_name)
				.info.notification_func(
						object.instance, static_cast<int32_t>(what), /*reversed=*/false);
		if (what != NOTIFICATION_POSTINITIALIZE) {
			print_line("notification", std::to_string(what));
		}
	} else if (method.result_type != GDEXTENSION_VARIANT_TYPE_NIL) {
		destroy_value(method.result_type, r_result);
		store_value(make_text(method.result_type, method.result), method.result_type, r_result);
	}
}

void register_class(void *, const void *p_name, const void *p_parent,
		const GDExtensionClassCreationInfo5 *p_info) {
	HostClass &added = get_state().classes[load_text(p_name)];
	added.name = load_text(p_name);
	added.parent = load_text(p_parent);
	added.info = *p_info;
}

void register_method(void *, const void *p_class, const GDExtensionClassMethodInfo *p_info) {
	HostMethod method;
	method.name = load_text(p_info->name);
	method.info = *p_info;
	for (uint32_t index = 0; index < p_info->argument_count; ++index) {
		method.arguments.push_back(describe_argument(p_info->arguments_info[index]));
	}
	if (p_info->has_return_value) {
		method.arguments.push_back("returns" + describe_argument(*p_info->return_value_info));
	}
	get_state().classes.at(load_text(p_class)).methods.push_back(method);
}

void register_property(void *, const void *p_class, const GDExtensionPropertyInfo *p_info,
		const void *p_setter, const void *p_getter, GDExtensionInt p_index) {
	get_state()
			.classes.at(load_text(p_class))
			.properties.push_back({ load_text(p_info->name), p_info->type, p_info->hint,
					load_text(p_info->hint_string), load_text(p_getter), load_text(p_setter),
					p_index });
}

void register_group(void *, const void *p_class, const void *p_name, const void *) {
	get_state().classes.at(load_text(p_class)).groups.push_back(load_text(p_name));
}

void unregister_class(void *, const void *p_class) {
	print_line("unregistered", load_text(p_class));
	get_state().classes.erase(load_text(p_class));
}

/// Prints the size of a documentation and a hash of its text (FNV-1a).
void load_documentation(const char *p_text, GDExtensionInt p_size) {
	uint64_t hash = 0xcbf29ce484222325u;
	for (GDExtensionInt index = 0; index < p_size; ++index) {
		hash = (hash ^ static_cast<uint8_t>(p_text[index])) * 0x100000001b3u;
	}
	char digits[32];
	std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(hash));
	print_line("documentation", std::to_string(p_size) + " bytes, hash " + digits);
}

void print_error(const char *p_text, const char *, const char *, int32_t, GDExtensionBool) {
	print_line("error", p_text);
}

void print_warning(const char *p_text, const char *, const char *, int32_t, GDExtensionBool) {
	print_line("warning", p_text);
}

void set_callbacks(void *, const GDExtensionMainLoopCallbacks *p_callbacks) {
	get_state().callbacks = *p_callbacks;
}

} // namespace

GDExtensionInterfaceFunctionPtr find_object_function(const std::string &p_name) {
	static const std::map<std::string, GDExtensionInterfaceFunctionPtr> functions = {
#define FUNCTION(m_name, m_function)                                                               \
	{ m_name, reinterpret_cast<GDExtensionInterfaceFunctionPtr>(&m_function) }
		FUNCTION("classdb_construct_object2", construct_object),
		FUNCTION("classdb_get_method_bind", get_method_bind),
		FUNCTION("classdb_get_class_tag", get_class_tag),
		FUNCTION("classdb_register_extension_class5", register_class),
		FUNCTION("classdb_register_extension_class_method", register_method),
		FUNCTION("classdb_register_extension_class_property_indexed", register_property),
		FUNCTION("classdb_register_extension_class_property_group", register_group),
		FUNCTION("classdb_unregister_extension_class", unregister_class),
		FUNCTION("object_method_bind_ptrcall", call_bind),
		FUNCTION("object_destroy", destroy),
		FUNCTION("object_cast_to", cast_to),
		FUNCTION("object_get_instance_from_id", get_instance_from_id),
		FUNCTION("object_get_instance_id", get_instance_id),
		FUNCTION("object_set_instance", set_instance),
		FUNCTION("global_get_singleton", get_singleton),
		FUNCTION("editor_help_load_xml_from_utf8_chars_and_len", load_documentation),
		FUNCTION("print_error", print_error),
		FUNCTION("print_warning", print_warning),
		FUNCTION("register_main_loop_callbacks", set_callbacks),
#undef FUNCTION
	};
	const auto found = functions.find(p_name);
	return found != functions.end() ? found->second : nullptr;
}
