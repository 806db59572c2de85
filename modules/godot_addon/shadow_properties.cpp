#include "modules/godot_addon/shadow_properties.h"

#include "modules/core/text.h"
#include "modules/scene/nodes.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

namespace {

/// Returns the techniques that are offered in Godot: no examples for developers, and none that
/// needs planar receivers, because Godot's nodes cannot be declared planar.
std::vector<const ShadowTechniqueInfo *> find_offered() {
	std::vector<const ShadowTechniqueInfo *> found;
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		if (!info.is_example && !info.needs_planar_receivers) {
			found.push_back(&info);
		}
	}
	return found;
}

PropertyInfo make_default_technique_setting() {
	PropertyInfo info;
	info.name = "rendering/gnomon/default_technique";
	info.type = PropertyType::ENUM;
	for (const ShadowTechniqueInfo *offered : find_offered()) {
		info.hint += (info.hint.empty() ? "" : ",") + offered->id;
		info.choice_tooltips.push_back(
				text(offered->name, offered->source.empty() ? "" : ": ", offered->source, "."));
	}
	const ShadowTechniqueInfo *default_info = ShadowRegistry::find_default();
	info.default_value = default_info ? default_info->id : std::string();
	return info;
}

PropertyInfo make_technique_property() {
	const PropertyInfo &setting = get_default_technique_setting();
	PropertyInfo info = setting;
	info.name = TECHNIQUE_PROPERTY;
	info.hint = text(DEFAULT_TECHNIQUE, ",", setting.hint);
	info.choice_tooltips = { text("the one that the project setting ", setting.name, " names.") };
	for (const std::string &tooltip : setting.choice_tooltips) {
		info.choice_tooltips.push_back(tooltip);
	}
	info.default_value = std::string(DEFAULT_TECHNIQUE);
	info.tooltip = "How the shadow is computed.";
	return info;
}

std::string escape_xml(const std::string &p_text) {
	std::string escaped;
	for (const char letter : p_text) {
		escaped += letter == '&' ? "&amp;"
				: letter == '<'	 ? "&lt;"
				: letter == '>'	 ? "&gt;"
				: letter == '"'	 ? "&quot;"
								 : std::string(1, letter);
	}
	return escaped;
}

const char *get_godot_type(PropertyType p_type) {
	switch (p_type) {
		case PropertyType::BOOL:
			return "bool";
		case PropertyType::INT:
			return "int";
		case PropertyType::FLOAT:
			return "float";
		case PropertyType::VECTOR3:
			return "Vector3";
		default:
			return "String";
	}
}

std::string write_member(const ShadowProperty &p_property) {
	const PropertyInfo &info = p_property.info;
	std::string description = info.tooltip;
	const std::vector<std::string> choices = get_choices(info);
	for (size_t index = 0; index < choices.size() && index < info.choice_tooltips.size(); ++index) {
		description += text("[br][b]", choices[index], "[/b]: ", info.choice_tooltips[index]);
	}
	if (info.type != PropertyType::BOOL && choices.empty()) {
		// The range of a number already ends with its unit.
		description += text(" Allowed: ", describe_range(info),
				info.unit.empty() || describe_range(info).ends_with(info.unit) ? "" : " ",
				describe_range(info).ends_with(info.unit) ? "" : info.unit, ".");
	}
	if (!p_property.technique.empty()) {
		description += text(" Of the technique [code]", p_property.technique, "[/code].");
	}
	return text("\t\t<member name=\"", info.name, "\" type=\"", get_godot_type(info.type),
			"\" setter=\"\" getter=\"\" default=\"",
			escape_xml(format_property(info.default_value)), "\">\n\t\t\t", escape_xml(description),
			"\n\t\t</member>\n");
}

std::vector<ShadowProperty> make_properties() {
	std::vector<ShadowProperty> properties;
	properties.push_back({ make_technique_property(), "" });
	for (const char *name : { "penumbra_outer_width", "penumbra_inner_width" }) {
		properties.push_back({ *Light3D::get_property_list().find(name), "" });
		properties.back().info.group.clear(); // shown above all groups
	}
	PropertyInfo back_faces;
	back_faces.name = BACK_FACES_PROPERTY;
	back_faces.type = PropertyType::BOOL;
	back_faces.default_value = false;
	back_faces.tooltip = "Surfaces cast with all of their faces, as they hide light. Off: the cull "
						 "mode of a material and the light's shadow_reverse_cull_face decide which "
						 "faces cast, as in Godot's own shadow: of single-sided walls those that "
						 "face the light.";
	properties.push_back({ back_faces, "" });
	for (const ShadowTechniqueInfo *technique : find_offered()) {
		for (const PropertyInfo &info :
				ShadowRegistry::get_light_properties(technique->id).get_properties()) {
			properties.push_back({ info, technique->id });
			properties.back().info.group = technique->name;
		}
	}
	PropertyInfo show_mask;
	show_mask.name = SHOW_MASK_PROPERTY;
	show_mask.type = PropertyType::BOOL;
	show_mask.default_value = false;
	show_mask.tooltip = "Draws this light's mask over the image of every viewport that shows it: "
						"white is lit, black is in shadow or facing away from the light.";
	show_mask.group = "Debug";
	properties.push_back({ show_mask, "" });
	return properties;
}

} // namespace

const PropertyInfo &get_default_technique_setting() {
	static const PropertyInfo info = make_default_technique_setting();
	return info;
}

const std::vector<ShadowProperty> &get_shadow_properties() {
	static const std::vector<ShadowProperty> properties = make_properties();
	return properties;
}

std::string write_class_documentation() {
	std::string members;
	for (const ShadowProperty &property : get_shadow_properties()) {
		members += write_member(property);
	}
	return text(
			"<class name=\"GnomonShadow3D\" inherits=\"Node3D\" version=\"4.5\">\n"
			"\t<brief_description>\n\t\tGives its parent, a light, a soft shadow made by Gnomon.\n"
			"\t</brief_description>\n\t<description>\n"
			"\t\tAdd it as a child of an [OmniLight3D], a [SpotLight3D] or a [DirectionalLight3D]. "
			"It needs the renderer Forward+. It makes the light's shadow mask, the fraction of its "
			"light at each pixel of a viewport, before that viewport's opaque objects are drawn, "
			"and "
			"materials read it instead of Godot's shadow of that light. The size "
			"of the light is its own [member Light3D.light_size] or [member "
			"Light3D.light_angular_distance]. While this node is hidden it makes none.\n"
			"\t</description>\n\t<methods>\n"
			"\t\t<method name=\"read_masks\">\n\t\t\t<return type=\"void\" />\n"
			"\t\t\t<param index=\"0\" name=\"callback\" type=\"Callable\" />\n"
			"\t\t\t<description>\n\t\t\t\tCalls [param callback] once for each view that draws "
			"this "
			"light in the next frame, with the mask, an [Image] of [constant Image.FORMAT_RF] in "
			"which -1 marks pixels without a receiver, and with the [Transform3D] of the camera. "
			"It waits for the GPU: for tests and tools.\n\t\t\t</description>\n\t\t</method>\n"
			"\t\t<method name=\"get_warning\">\n\t\t\t<return type=\"String\" />\n"
			"\t\t\t<description>\n\t\t\t\tReturns the node's warnings, one per line; empty if none."
			"\n\t\t\t</description>\n\t\t</method>\n"
			"\t\t<method name=\"count_pending_casters\">\n\t\t\t<return type=\"int\" />\n"
			"\t\t\t<description>\n\t\t\t\tHow many casters of this node's world have a mesh whose "
			"edges are not computed yet, in the last frame drawn. They cast no shadow until then."
			"\n\t\t\t</description>\n\t\t</method>\n"
			"\t\t<method name=\"makes_mask\">\n\t\t\t<return type=\"bool\" />\n"
			"\t\t\t<description>\n\t\t\t\tWhether the last frame made this light's mask. It makes "
			"none where no surface in the light's reach reads masks.\n"
			"\t\t\t</description>\n\t\t</method>\n"
			"\t</methods>\n\t<members>\n",
			members, "\t</members>\n</class>\n");
}

} // namespace gnomon
