#include "modules/godot_addon/shadow_node.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/godot_addon/shadow_properties.h"

namespace gnomon {

namespace {

const PropertyInfo &get_info(size_t p_property) {
	return get_shadow_properties()[p_property].info;
}

std::string &get_default_technique() {
	static std::string technique =
			std::get<std::string>(get_default_technique_setting().default_value);
	return technique;
}

} // namespace

void set_default_technique(const std::string &p_technique) {
	get_default_technique() = p_technique;
}

std::string ShadowNode::get_path() const {
	return node.is_inside_tree() ? node.get_path().to_utf8() : "outside of the scene tree";
}

godot::Light3D ShadowNode::find_light() const {
	return godot::cast<godot::Light3D>(node.get_parent());
}

const std::string &ShadowNode::get_technique() const {
	const auto found = values.find(TECHNIQUE_PROPERTY);
	return found != values.end() ? std::get<std::string>(found->second) : get_default_technique();
}

bool ShadowNode::shows_mask() const {
	return values.contains(SHOW_MASK_PROPERTY); // only if it differs from the default, false
}

bool ShadowNode::casts_back_faces() const {
	return values.contains(BACK_FACES_PROPERTY);
}

PropertyValue ShadowNode::get_value(size_t p_property) const {
	const PropertyInfo &info = get_info(p_property);
	const auto found = values.find(info.name);
	return found != values.end() ? found->second : info.default_value;
}

void ShadowNode::set_value(size_t p_property, const PropertyValue &p_value) {
	const PropertyInfo &info = get_info(p_property);
	const std::string refusal = check_property(info, p_value);
	if (!refusal.empty()) {
		fail("GnomonShadow3D \"", get_path(), "\": ", info.name, " ", refusal, ". It stays ",
				format_property(get_value(p_property)), ".");
	}
	const PropertyValue value = convert_property(info, p_value);
	if (value == info.default_value) {
		values.erase(info.name);
	} else {
		values[info.name] = value;
	}
}

PropertyValues ShadowNode::make_light_properties(bool p_is_directional) const {
	PropertyValues properties;
	for (const ShadowProperty &property : get_shadow_properties()) {
		const auto found = values.find(property.info.name);
		if (found != values.end() &&
				(property.technique.empty() || property.technique == get_technique())) {
			properties.insert(*found);
		}
	}
	properties.erase(TECHNIQUE_PROPERTY);
	properties.erase(SHOW_MASK_PROPERTY);
	properties.erase(BACK_FACES_PROPERTY);
	properties["shadow_technique"] = get_technique();
	const double size = find_light().get_param(godot::Light3D::PARAM_SIZE);
	properties[p_is_directional ? "light_angular_distance" : "light_size"] = size;
	return properties;
}

bool ShadowNode::is_hidden(size_t p_property) const {
	const std::string &technique = get_shadow_properties()[p_property].technique;
	return !technique.empty() && technique != get_technique();
}

std::vector<std::string> ShadowNode::find_warnings() const {
	std::vector<std::string> warnings;
	const godot::Light3D light = find_light();
	if (!light) {
		warnings.push_back("It shadows nothing: its parent is not a light. Make it a child of an "
						   "OmniLight3D, a SpotLight3D or a DirectionalLight3D.");
		return warnings;
	}
	if (!light.has_shadow()) {
		warnings.push_back("The light has no shadow: its shadow_enabled is off. Turn it on.");
	}
	if (light.get_param(godot::Light3D::PARAM_SIZE) <= 0) {
		const bool is_directional = bool(godot::cast<godot::DirectionalLight3D>(light));
		warnings.push_back(text("The shadow is hard: ",
				is_directional ? "light_angular_distance of the light is 0 degrees. Set it to the "
								 "apparent diameter of the light; the sun's is 0.5."
							   : "light_size of the light is 0 m. Set it to the radius of the "
								 "lamp, such as 0.1."));
	}
	for (const ShadowNode *other : get_shadow_nodes()) {
		if (other == this) {
			break; // of several nodes the first counts
		}
		if (other->find_light().get_object() == light.get_object() &&
				other->node.is_visible_in_tree()) {
			warnings.push_back("The light has another GnomonShadow3D, which alone counts. Remove "
							   "one of the two.");
			break;
		}
	}
	return warnings;
}

void ShadowNode::update_warnings() {
	std::vector<std::string> warnings = find_warnings();
	if (warnings != shown_warnings) {
		shown_warnings = std::move(warnings);
		node.update_configuration_warnings();
	}
}

void ShadowNode::read_masks(const godot::Variant &p_callback) {
	callbacks.push_back(p_callback);
	if (!request) {
		request = std::make_shared<MaskRequest>();
	}
}

void ShadowNode::call_back() {
	std::vector<ReadMask> masks;
	if (request) {
		const std::lock_guard lock(request->mutex);
		masks = std::move(request->masks);
	}
	if (masks.empty()) {
		return;
	}
	request.reset();
	const std::vector<godot::Variant> called = std::move(callbacks);
	callbacks.clear();
	for (const ReadMask &mask : masks) {
		const std::span<const float> texels(mask.visibility);
		const godot::PackedByteArray bytes(
				std::span(reinterpret_cast<const uint8_t *>(texels.data()), texels.size_bytes()));
		const auto image = godot::Image::create_from_data(mask.size_px.x, mask.size_px.y,
				/*use_mipmaps=*/false, godot::Image::FORMAT_RF, bytes);
		for (const godot::Variant &callback : called) {
			const godot::Variant arguments[] = { godot::Variant::of_object(image.get_object()),
				godot::Variant(mask.camera) };
			callback.call("call", arguments);
		}
	}
}

} // namespace gnomon
