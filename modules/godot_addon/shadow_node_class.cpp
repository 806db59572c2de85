// Registers the class GnomonShadow3D, its properties and its methods with GDExtension.

#include "modules/godot_addon/extension_class.h"
#include "modules/godot_addon/shadow_node.h"
#include "modules/godot_addon/shadow_properties.h"

#include <algorithm>

namespace gnomon {

namespace {

using godot::BuiltInType;
using godot::get_interface;
using godot::String;
using godot::StringName;
using godot::Variant;

const char NODE_CLASS_NAME[] = "GnomonShadow3D";
const char NODE_BASE_NAME[] = "Node3D";
const char GETTER_NAME[] = "_get_value";
const char SETTER_NAME[] = "_set_value";
const char INSPECT_NAME[] = "_inspect_shader"; // called by Material.inspect_native_shader_code()
// Constants of Godot. The generated API has no global enums, such as PropertyHint.
const uint32_t HINT_NONE = 0;
const uint32_t HINT_RANGE = 1;
const uint32_t HINT_ENUM = 2;
const uint32_t USAGE_STORAGE = 2;
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

void *create_node_instance(void *, GDExtensionBool p_notifies) {
	void *object = nullptr;
	log_failures([&] {
		const StringName base(NODE_BASE_NAME);
		const StringName name(NODE_CLASS_NAME);
		auto node = std::make_unique<ShadowNode>(nullptr);
		object = get_interface().classdb_construct_object2(base.get());
		*node = ShadowNode(object);
		get_interface().object_set_instance(object, name.get(), node.release());
		if (p_notifies) {
			godot::Object(object).notification(NOTIFICATION_POSTINITIALIZE, /*reversed=*/false);
		}
	});
	return object;
}

void free_node_instance(void *, void *p_instance) {
	delete &to_node(p_instance);
}

void notify(void *p_instance, int32_t p_what, GDExtensionBool) {
	log_failures([&] {
		if (p_what == NOTIFICATION_ENTER_TREE) {
			nodes.push_back(&to_node(p_instance));
			call_listener(listener);
		} else if (p_what == NOTIFICATION_EXIT_TREE) {
			std::erase(nodes, &to_node(p_instance));
			if (nodes.empty()) {
				call_listener(last_listener);
			}
		}
	});
}

std::string read_name(const void *p_string_name) {
	return Variant::of_type(BuiltInType::STRING_NAME, p_string_name).to_utf8();
}

GDExtensionBool validate_property(void *p_instance, GDExtensionPropertyInfo *r_property) {
	log_failures([&] {
		const std::string name = read_name(r_property->name);
		const std::vector<ShadowProperty> &properties = get_shadow_properties();
		for (size_t index = 0; index < properties.size(); ++index) {
			if (properties[index].info.name == name && to_node(p_instance).is_hidden(index)) {
				r_property->usage = USAGE_STORAGE; // not shown, but saved with the scene
			}
		}
	});
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
	GDExtensionClassCallVirtual found = nullptr;
	log_failures([&] {
		found = read_name(p_name) == "_get_configuration_warnings" ? &call_get_warnings : nullptr;
	});
	return found;
}

Variant get_value(void *p_instance, std::span<const Variant> p_arguments) {
	return to_variant(to_node(p_instance).get_value(size_t(p_arguments[0].to_int())));
}

Variant set_value(void *p_instance, std::span<const Variant> p_arguments) {
	const size_t index = size_t(p_arguments[0].to_int());
	const PropertyInfo &info = get_shadow_properties()[index].info;
	ShadowNode &node = to_node(p_instance);
	node.set_value(index, to_property_value(info.type, p_arguments[1]));
	if (info.name == TECHNIQUE_PROPERTY) {
		node.get_node().notify_property_list_changed(); // to show the new technique's
	}
	return {};
}

Variant read_masks(void *p_instance, std::span<const Variant> p_arguments) {
	to_node(p_instance).read_masks(p_arguments[0]);
	return {};
}

Variant inspect_shader(void *, std::span<const Variant> p_arguments) {
	if (shader_listener) {
		shader_listener(p_arguments[0].to_rid());
	}
	return {};
}

Variant count_pending_casters(void *p_instance, std::span<const Variant>) {
	return to_node(p_instance).pending_caster_count;
}

Variant makes_mask(void *p_instance, std::span<const Variant>) {
	return to_node(p_instance).makes_mask;
}

Variant get_warning(void *p_instance, std::span<const Variant>) {
	std::string lines;
	for (const std::string &warning : to_node(p_instance).find_warnings()) {
		lines += (lines.empty() ? "" : "\n") + warning;
	}
	return lines;
}

const std::vector<MethodEntry> &get_node_methods() {
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

void register_property(const StringName &p_class, const PropertyInfo &p_info, size_t p_index) {
	const bool is_number = p_info.type == PropertyType::INT || p_info.type == PropertyType::FLOAT;
	const bool is_enum = p_info.type == PropertyType::ENUM;
	const PropertyTexts texts(p_info.name.c_str(),
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
	const StringName name(NODE_CLASS_NAME);
	const StringName base(NODE_BASE_NAME);
	GDExtensionClassCreationInfo5 info = {};
	info.is_exposed = true;
	info.validate_property_func = &validate_property;
	info.create_instance_func = &create_node_instance;
	info.free_instance_func = &free_node_instance;
	info.get_virtual_func = &get_virtual;
	info.notification_func = &notify;
	const godot::Interface &interface = get_interface();
	interface.classdb_register_extension_class5(interface.extension, name.get(), base.get(), &info);
	for (const MethodEntry &entry : get_node_methods()) {
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
	const StringName name(NODE_CLASS_NAME);
	get_interface().classdb_unregister_extension_class(get_interface().extension, name.get());
}

} // namespace gnomon
