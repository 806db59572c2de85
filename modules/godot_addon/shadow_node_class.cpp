// Registers the class GnomonShadow3D, its properties and its methods with GDExtension.

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/godot_addon/shadow_node.h"
#include "modules/godot_addon/shadow_properties.h"
#include "modules/rendering_device_godot/godot_interface.h"

#include <algorithm>

namespace gnomon {

namespace {

using godot::BuiltInType;
using godot::get_interface;
using godot::String;
using godot::StringName;
using godot::Variant;

const char CLASS_NAME[] = "GnomonShadow3D";
const char BASE_NAME[] = "Node3D";
const char GETTER_NAME[] = "_get_value";
const char SETTER_NAME[] = "_set_value";
const char INSPECT_NAME[] = "_inspect_shader"; // called by Material.inspect_native_shader_code()
// Constants of Godot. The generated API has no global enums, such as PropertyHint.
const uint32_t HINT_NONE = 0;
const uint32_t HINT_RANGE = 1;
const uint32_t HINT_ENUM = 2;
const uint32_t USAGE_STORAGE = 2;
const uint32_t USAGE_DEFAULT = 6; // stored and shown
const uint32_t USAGE_NIL_IS_VARIANT = 131072;
const int32_t NOTIFICATION_POSTINITIALIZE = 0;
const int32_t NOTIFICATION_ENTER_TREE = 10;
const int32_t NOTIFICATION_EXIT_TREE = 11;

std::vector<ShadowNode *> nodes; // those in the scene tree
std::function<void()> listener;
std::function<void()> last_listener;
std::function<void(godot::RID)> shader_listener;

void call_listener(const std::function<void()> &p_listener) {
	if (const std::function<void()> called = p_listener) { // a copy: the call may replace it
		called();
	}
}

ShadowNode &to_node(void *p_instance) {
	return *static_cast<ShadowNode *>(p_instance);
}

/// Calls p_function and logs its exceptions, which must not reach Godot.
template <typename Function> void log_failures(Function p_function) {
	try {
		p_function();
	} catch (const std::exception &failure) {
		log_error(describe_failure(failure));
	}
}

Variant to_variant(const PropertyValue &p_value) {
	return std::visit(
			[](const auto &p_held) {
				if constexpr (std::is_same_v<std::decay_t<decltype(p_held)>, glm::dvec3>) {
					return Variant(glm::vec3(p_held));
				} else {
					return Variant(p_held);
				}
			},
			p_value);
}

PropertyValue to_property_value(PropertyType p_type, const Variant &p_value) {
	switch (p_type) {
		case PropertyType::BOOL:
			return p_value.to_bool();
		case PropertyType::INT:
			return p_value.to_int();
		case PropertyType::FLOAT:
			return p_value.to_float();
		case PropertyType::VECTOR3:
			return glm::dvec3(p_value.to_vector3());
		default:
			return p_value.to_utf8();
	}
}

BuiltInType to_godot_type(PropertyType p_type) {
	switch (p_type) {
		case PropertyType::BOOL:
			return BuiltInType::BOOL;
		case PropertyType::INT:
			return BuiltInType::INT;
		case PropertyType::FLOAT:
			return BuiltInType::FLOAT;
		case PropertyType::VECTOR3:
			return BuiltInType::VECTOR3;
		default:
			return BuiltInType::STRING;
	}
}

/// Returns a hint such as "-1,100,0.001,suffix:m". Its range includes PropertyInfo::special.
std::string make_range_hint(const PropertyInfo &p_info) {
	PropertyRange range = get_range(p_info);
	if (!p_info.special.empty()) {
		range.minimum = std::min(range.minimum, std::stod(p_info.special));
	}
	std::string hint = text(range.minimum, ",", range.maximum, ",", range.step);
	// A slider over so large a range is too coarse, so the editor shows a number field instead.
	hint += range.maximum > 1000 ? ",hide_slider" : "";
	return hint + (p_info.unit.empty() ? "" : ",suffix:" + p_info.unit);
}

void *create_instance(void *, GDExtensionBool p_notifies) {
	const StringName base(BASE_NAME);
	const StringName name(CLASS_NAME);
	void *object = get_interface().classdb_construct_object2(base.get());
	ShadowNode *node = new ShadowNode(object);
	get_interface().object_set_instance(object, name.get(), node);
	if (p_notifies) {
		godot::Object(object).notification(NOTIFICATION_POSTINITIALIZE, /*reversed=*/false);
	}
	return object;
}

void free_instance(void *, void *p_instance) {
	delete &to_node(p_instance);
}

void notify(void *p_instance, int32_t p_what, GDExtensionBool) {
	if (p_what == NOTIFICATION_ENTER_TREE) {
		nodes.push_back(&to_node(p_instance));
		call_listener(listener);
	} else if (p_what == NOTIFICATION_EXIT_TREE) {
		std::erase(nodes, &to_node(p_instance));
		if (nodes.empty()) {
			call_listener(last_listener);
		}
	}
}

std::string read_name(const void *p_string_name) {
	return Variant::of_type(BuiltInType::STRING_NAME, p_string_name).to_utf8();
}

GDExtensionBool validate_property(void *p_instance, GDExtensionPropertyInfo *r_property) {
	const std::string name = read_name(r_property->name);
	const std::vector<ShadowProperty> &properties = get_shadow_properties();
	for (size_t index = 0; index < properties.size(); ++index) {
		if (properties[index].info.name == name && to_node(p_instance).is_hidden(index)) {
			r_property->usage = USAGE_STORAGE; // not shown, but saved with the scene
		}
	}
	return true;
}

void call_get_warnings(void *p_instance, const GDExtensionConstTypePtr *, void *r_result) {
	log_failures([&] {
		godot::PackedStringArray warnings;
		for (const std::string &warning : to_node(p_instance).find_warnings()) {
			warnings.append(warning);
		}
		// r_result is an array that Godot has constructed.
		godot::destroy_built_in(BuiltInType::PACKED_STRING_ARRAY, r_result);
		godot::copy_built_in(BuiltInType::PACKED_STRING_ARRAY, r_result, warnings.get());
	});
}

GDExtensionClassCallVirtual get_virtual(void *, const void *p_name, uint32_t) {
	return read_name(p_name) == "_get_configuration_warnings" ? &call_get_warnings : nullptr;
}

/// A method of the class, with arguments and result as variants.
using Method = Variant (*)(ShadowNode &, std::span<const Variant>);

Variant get_value(ShadowNode &p_node, std::span<const Variant> p_arguments) {
	return to_variant(p_node.get_value(size_t(p_arguments[0].to_int())));
}

Variant set_value(ShadowNode &r_node, std::span<const Variant> p_arguments) {
	const size_t index = size_t(p_arguments[0].to_int());
	const PropertyInfo &info = get_shadow_properties()[index].info;
	r_node.set_value(index, to_property_value(info.type, p_arguments[1]));
	if (info.name == TECHNIQUE_PROPERTY) {
		r_node.get_node().notify_property_list_changed(); // to show the new technique's
	}
	return {};
}

Variant read_masks(ShadowNode &r_node, std::span<const Variant> p_arguments) {
	r_node.read_masks(p_arguments[0]);
	return {};
}

Variant inspect_shader(ShadowNode &, std::span<const Variant> p_arguments) {
	if (shader_listener) {
		shader_listener(p_arguments[0].to_rid());
	}
	return {};
}

Variant count_pending_casters(ShadowNode &p_node, std::span<const Variant>) {
	return p_node.pending_caster_count;
}

Variant makes_mask(ShadowNode &p_node, std::span<const Variant>) {
	return p_node.makes_mask;
}

Variant get_warning(ShadowNode &p_node, std::span<const Variant>) {
	std::string lines;
	for (const std::string &warning : p_node.find_warnings()) {
		lines += (lines.empty() ? "" : "\n") + warning;
	}
	return lines;
}

struct Argument {
	const char *name;
	BuiltInType type;
};
struct MethodEntry {
	const char *name;
	Method method;
	std::vector<Argument> arguments;
	std::optional<BuiltInType> result; // empty: it returns nothing
};

const std::vector<MethodEntry> &get_methods() {
	static const std::vector<MethodEntry> methods = {
		{ GETTER_NAME, &get_value, { { "index", BuiltInType::INT } }, BuiltInType::VARIANT },
		{ SETTER_NAME, &set_value,
				{ { "index", BuiltInType::INT }, { "value", BuiltInType::VARIANT } }, {} },
		{ INSPECT_NAME, &inspect_shader, { { "shader", BuiltInType::RID } }, {} },
		{ "read_masks", &read_masks, { { "callback", BuiltInType::CALLABLE } }, {} },
		{ "get_warning", &get_warning, {}, BuiltInType::STRING },
		{ "makes_mask", &makes_mask, {}, BuiltInType::BOOL },
		{ "count_pending_casters", &count_pending_casters, {}, BuiltInType::INT },
	};
	return methods;
}

void call_method(void *p_entry, void *p_instance, const GDExtensionConstVariantPtr *p_arguments,
		GDExtensionInt p_count, void *r_result, GDExtensionCallError *r_error) {
	const MethodEntry &entry = *static_cast<const MethodEntry *>(p_entry);
	const GDExtensionInt expected = static_cast<GDExtensionInt>(entry.arguments.size());
	r_error->error = p_count == expected ? GDEXTENSION_CALL_OK
			: p_count < expected		 ? GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS
										 : GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS;
	r_error->expected = static_cast<int32_t>(expected);
	if (p_count != expected) {
		return;
	}
	std::vector<Variant> arguments;
	for (GDExtensionInt index = 0; index < p_count; ++index) {
		arguments.push_back(Variant::copy_of(p_arguments[index]));
	}
	Variant result;
	log_failures([&] { result = entry.method(to_node(p_instance), arguments); });
	godot::copy_built_in(BuiltInType::VARIANT, r_result, result.get());
}

void call_method_typed(void *p_entry, void *p_instance, const GDExtensionConstTypePtr *p_arguments,
		void *r_result) {
	const MethodEntry &entry = *static_cast<const MethodEntry *>(p_entry);
	std::vector<Variant> arguments;
	for (size_t index = 0; index < entry.arguments.size(); ++index) {
		arguments.push_back(Variant::of_type(entry.arguments[index].type, p_arguments[index]));
	}
	log_failures([&] {
		const Variant result = entry.method(to_node(p_instance), arguments);
		if (entry.result) {
			result.store(*entry.result, r_result);
		}
	});
}

/// Owns the strings to which a GDExtensionPropertyInfo points.
struct PropertyTexts {
	StringName name;
	StringName class_name;
	String hint;

	explicit PropertyTexts(const char *p_name, const std::string &p_hint = {}) :
			name(p_name), hint(p_hint) {}
	GDExtensionPropertyInfo make_info(
			BuiltInType p_type, uint32_t p_hint = HINT_NONE, uint32_t p_usage = USAGE_DEFAULT) {
		return { static_cast<GDExtensionVariantType>(p_type), name.get(), class_name.get(), p_hint,
			hint.get(), p_type == BuiltInType::VARIANT ? p_usage | USAGE_NIL_IS_VARIANT : p_usage };
	}
};

void register_method(const StringName &p_class, const MethodEntry &p_entry) {
	const StringName name(p_entry.name);
	std::vector<PropertyTexts> texts;
	for (const Argument &argument : p_entry.arguments) {
		texts.emplace_back(argument.name);
	}
	std::vector<GDExtensionPropertyInfo> arguments;
	for (size_t index = 0; index < texts.size(); ++index) {
		arguments.push_back(texts[index].make_info(p_entry.arguments[index].type));
	}
	std::vector<GDExtensionClassMethodArgumentMetadata> metadata(arguments.size());
	PropertyTexts result_texts("");
	GDExtensionPropertyInfo result =
			result_texts.make_info(p_entry.result.value_or(BuiltInType::VARIANT));
	GDExtensionClassMethodInfo info = {};
	info.name = name.get();
	info.method_userdata = const_cast<MethodEntry *>(&p_entry);
	info.call_func = &call_method;
	info.ptrcall_func = &call_method_typed;
	info.method_flags = GDEXTENSION_METHOD_FLAGS_DEFAULT;
	info.has_return_value = p_entry.result.has_value();
	info.return_value_info = &result;
	info.argument_count = static_cast<uint32_t>(arguments.size());
	info.arguments_info = arguments.data();
	info.arguments_metadata = metadata.data();
	get_interface().classdb_register_extension_class_method(
			get_interface().extension, p_class.get(), &info);
}

void register_property(const StringName &p_class, const PropertyInfo &p_info, size_t p_index) {
	const bool is_number = p_info.type == PropertyType::INT || p_info.type == PropertyType::FLOAT;
	const bool is_enum = p_info.type == PropertyType::ENUM;
	PropertyTexts texts(p_info.name.c_str(),
			is_number && !p_info.hint.empty() ? make_range_hint(p_info)
					: is_enum				  ? p_info.hint
											  : std::string());
	const GDExtensionPropertyInfo info = texts.make_info(to_godot_type(p_info.type),
			is_number && !p_info.hint.empty() ? HINT_RANGE
					: is_enum				  ? HINT_ENUM
											  : HINT_NONE);
	const StringName setter(SETTER_NAME);
	const StringName getter(GETTER_NAME);
	get_interface().classdb_register_extension_class_property_indexed(get_interface().extension,
			p_class.get(), &info, setter.get(), getter.get(), static_cast<int64_t>(p_index));
}

} // namespace

void set_shadow_node_listener(std::function<void()> p_listener) {
	listener = std::move(p_listener);
	if (!nodes.empty()) {
		call_listener(listener);
	}
}

void set_last_shadow_node_listener(std::function<void()> p_listener) {
	last_listener = std::move(p_listener);
}

void set_shader_listener(std::function<void(godot::RID)> p_listener) {
	shader_listener = std::move(p_listener);
}

const std::vector<ShadowNode *> &get_shadow_nodes() {
	return nodes;
}

void register_shadow_node_class() {
	const StringName name(CLASS_NAME);
	const StringName base(BASE_NAME);
	GDExtensionClassCreationInfo5 info = {};
	info.is_exposed = true;
	info.validate_property_func = &validate_property;
	info.create_instance_func = &create_instance;
	info.free_instance_func = &free_instance;
	info.get_virtual_func = &get_virtual;
	info.notification_func = &notify;
	const godot::Interface &interface = get_interface();
	interface.classdb_register_extension_class5(interface.extension, name.get(), base.get(), &info);
	for (const MethodEntry &entry : get_methods()) {
		register_method(name, entry);
	}
	std::string group;
	const std::vector<ShadowProperty> &properties = get_shadow_properties();
	for (size_t index = 0; index < properties.size(); ++index) {
		if (properties[index].info.group != group) {
			group = properties[index].info.group;
			const String title(group);
			const String prefix;
			interface.classdb_register_extension_class_property_group(
					interface.extension, name.get(), title.get(), prefix.get());
		}
		register_property(name, properties[index].info, index);
	}
}

void unregister_shadow_node_class() {
	const StringName name(CLASS_NAME);
	get_interface().classdb_unregister_extension_class(get_interface().extension, name.get());
}

} // namespace gnomon
