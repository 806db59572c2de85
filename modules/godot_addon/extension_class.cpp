#include "modules/godot_addon/extension_class.h"

namespace gnomon {

namespace {

using godot::BuiltInType;
using godot::get_interface;
using godot::StringName;
using godot::Variant;

// Constants of Godot. The generated API has no global enums.
const uint32_t USAGE_DEFAULT = 6; // stored and shown
const uint32_t USAGE_NIL_IS_VARIANT = 131072;

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
	Variant result;
	log_failures([&] {
		std::vector<Variant> arguments;
		for (GDExtensionInt index = 0; index < p_count; ++index) {
			arguments.push_back(Variant::copy_of(p_arguments[index]));
		}
		result = entry.method(p_instance, arguments);
	});
	godot::copy_built_in(BuiltInType::VARIANT, r_result, result.get());
}

void call_method_typed(void *p_entry, void *p_instance, const GDExtensionConstTypePtr *p_arguments,
		void *r_result) {
	const MethodEntry &entry = *static_cast<const MethodEntry *>(p_entry);
	log_failures([&] {
		std::vector<Variant> arguments;
		for (size_t index = 0; index < entry.arguments.size(); ++index) {
			arguments.push_back(Variant::of_type(entry.arguments[index].type, p_arguments[index]));
		}
		const Variant result = entry.method(p_instance, arguments);
		if (entry.result) {
			result.store(*entry.result, r_result);
		}
	});
}

} // namespace

PropertyTexts::PropertyTexts(const char *p_name, const std::string &p_hint) :
		name(p_name), hint(p_hint) {}

GDExtensionPropertyInfo PropertyTexts::make_info(BuiltInType p_type, uint32_t p_hint) const {
	const uint32_t usage =
			p_type == BuiltInType::VARIANT ? USAGE_DEFAULT | USAGE_NIL_IS_VARIANT : USAGE_DEFAULT;
	return { static_cast<GDExtensionVariantType>(p_type), name.get(), class_name.get(), p_hint,
		hint.get(), usage };
}

void register_method(const StringName &p_class, const MethodEntry &p_entry) {
	const StringName name(p_entry.name);
	std::vector<PropertyTexts> texts;
	for (const MethodArgument &argument : p_entry.arguments) {
		texts.emplace_back(argument.name);
	}
	std::vector<GDExtensionPropertyInfo> arguments;
	for (size_t index = 0; index < texts.size(); ++index) {
		arguments.push_back(texts[index].make_info(p_entry.arguments[index].type));
	}
	std::vector<GDExtensionClassMethodArgumentMetadata> metadata(arguments.size());
	const PropertyTexts result_texts("");
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

} // namespace gnomon
