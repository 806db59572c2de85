// The panel "Inspector": the properties of the selected node.

#include "modules/core/error.h"
#include "modules/core/text.h"
#include "modules/editor/editor_context.h"
#include "modules/scene/node_properties.h"

#include <imgui.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace gnomon {

namespace {

/// The widget of one property. The user edits r_value with it.
class PropertyEditor {
public:
	PropertyEditor(EditorContext &r_context, const PropertyInfo &p_info, PropertyValue &r_value) :
			context(r_context), info(p_info), value(r_value) {}

	/// Returns true if the user has changed the value.
	bool draw() {
		ImGui::SetNextItemWidth(-1.0f);
		switch (info.type) {
			case PropertyType::BOOL:
				return ImGui::Checkbox("##value", &std::get<bool>(value));
			case PropertyType::ENUM:
				return draw_choice();
			case PropertyType::INT:
				return draw_whole_number();
			case PropertyType::FLOAT:
				return draw_number();
			case PropertyType::VECTOR3:
				return draw_vector();
			case PropertyType::STRING:
				return draw_text();
		}
		return false;
	}

private:
	bool draw_choice() {
		const std::string chosen = std::get<std::string>(value);
		bool is_changed = false;
		if (ImGui::BeginCombo("##value", chosen.empty() ? "(default)" : chosen.c_str())) {
			const std::vector<std::string> choices = get_choices(info);
			for (size_t index = 0; index < choices.size(); ++index) {
				const char *label = choices[index].empty() ? "(default)" : choices[index].c_str();
				if (ImGui::Selectable(label, choices[index] == chosen)) {
					value = choices[index];
					is_changed = true;
				}
				context.record_item_rect("choice " + choices[index]);
				if (ImGui::IsItemHovered() && index < info.choice_tooltips.size()) {
					ImGui::SetTooltip("%s", info.choice_tooltips[index].c_str());
				}
			}
			ImGui::EndCombo();
		}
		return is_changed;
	}

	bool draw_whole_number() {
		// Per pixel of a drag. The default step, 0.01, would need 100 pixels for the next number.
		const float MIN_SPEED = 0.2f;
		const PropertyRange range = get_range(info);
		// The limits of a property without a range, 1e30, do not fit an int64_t.
		return drag_number<int64_t>(ImGuiDataType_S64, "%lld",
				std::max(float(range.step), MIN_SPEED),
				static_cast<int64_t>(std::max(range.minimum, -1e15)),
				static_cast<int64_t>(std::min(range.maximum, 1e15)));
	}

	bool draw_number() {
		const PropertyRange range = get_range(info);
		return drag_number<double>(
				ImGuiDataType_Double, "%.4g", float(range.step), range.minimum, range.maximum);
	}

	/// A value that is dragged below the range becomes the special value, such as -1 for "derived".
	/// Dragged up from there, it becomes the minimum of the range.
	template <typename T>
	bool drag_number(
			ImGuiDataType p_type, const char *p_format, float p_speed, T p_minimum, T p_maximum) {
		T &number = std::get<T>(value);
		T lower_limit = p_minimum;
		T special = 0;
		const bool has_special = !info.special.empty();
		if (has_special) {
			std::from_chars(
					info.special.data(), info.special.data() + info.special.size(), special);
			lower_limit = std::min(lower_limit, special);
		}
		const bool is_special = has_special && number == special;
		const std::string special_text = info.special_meaning.empty()
				? info.special
				: text(info.special, " (", info.special_meaning, ")");
		const bool is_changed =
				ImGui::DragScalar("##value", p_type, &number, p_speed, &lower_limit, &p_maximum,
						is_special ? special_text.c_str() : p_format, ImGuiSliderFlags_AlwaysClamp);
		if (is_changed && has_special && number < p_minimum) {
			number = is_special && number > special ? p_minimum : special;
		}
		return is_changed;
	}

	bool draw_vector() {
		const PropertyRange range = get_range(info);
		// A drag continues from the values that were shown, not from those that the node returns,
		// because a node may return other angles for the same rotation.
		static std::string dragged_name;
		static glm::dvec3 dragged;
		glm::dvec3 &vector = std::get<glm::dvec3>(value);
		if (info.is_color) {
			glm::vec3 color(vector);
			const bool is_changed =
					ImGui::ColorEdit3("##value", &color.x, ImGuiColorEditFlags_Float);
			vector = glm::clamp(color, glm::vec3(0.0f), glm::vec3(1.0f));
			return is_changed;
		}
		vector = dragged_name == info.name ? dragged : vector;
		const bool is_changed =
				ImGui::DragScalarN("##value", ImGuiDataType_Double, &vector.x, 3, float(range.step),
						&range.minimum, &range.maximum, "%.4g", ImGuiSliderFlags_AlwaysClamp);
		if (ImGui::IsItemActive()) {
			dragged_name = info.name;
			dragged = vector;
		} else if (dragged_name == info.name) {
			dragged_name.clear();
		}
		return is_changed;
	}

	bool draw_text() {
		char text[512] = {};
		std::strncpy(text, std::get<std::string>(value).c_str(), sizeof(text) - 1);
		const bool is_done = ImGui::InputText(
				"##value", text, sizeof(text), ImGuiInputTextFlags_EnterReturnsTrue);
		value = std::string(text);
		return is_done;
	}

	EditorContext &context;
	const PropertyInfo &info;
	PropertyValue &value;
};

void draw_label(const PropertyInfo &p_info) {
	ImGui::AlignTextToFramePadding();
	ImGui::TextUnformatted(p_info.name.c_str());
	if (ImGui::IsItemHovered()) {
		ImGui::BeginTooltip();
		ImGui::PushTextWrapPos(30.0f * ImGui::GetFontSize());
		ImGui::TextUnformatted(p_info.tooltip.c_str());
		ImGui::TextDisabled("%s", describe_range(p_info).c_str());
		ImGui::PopTextWrapPos();
		ImGui::EndTooltip();
	}
}

/// The edit that a widget requests in this frame. It is applied after all widgets are drawn,
/// because it may change which properties the node has.
struct PropertyEdit {
	bool is_requested = false;
	std::string name;
	std::optional<PropertyValue> value;
	bool is_drag = false;
	bool ends_drag = false;

	void apply(EditorContext &r_context, Node3D &r_node) const {
		if (is_requested) {
			r_context.attempt(
					[&] { r_context.document.set_property(r_node, name, value, is_drag); });
			r_context.viewport.is_moving = is_drag;
		}
		if (ends_drag) {
			r_context.document.end_drag();
		}
	}
};

void draw_property(EditorContext &r_context, const Node3D &p_node, const PropertyInfo &p_info,
		PropertyEdit &r_edit) {
	ImGui::PushID(p_info.name.c_str());
	ImGui::TableNextRow();
	ImGui::TableNextColumn();
	draw_label(p_info);
	ImGui::TableNextColumn();
	PropertyValue value = get_node_property(p_node, p_info.name);
	const bool is_changed = PropertyEditor(r_context, p_info, value).draw();
	r_context.record_item_rect("property " + p_info.name);
	if (is_changed) {
		r_edit = { /*is_requested=*/true, p_info.name, value, ImGui::IsItemActive() };
	}
	r_edit.ends_drag |= ImGui::IsItemDeactivated() || ImGui::IsMouseReleased(ImGuiMouseButton_Left);
	ImGui::TableNextColumn();
	ImGui::TextDisabled("%s", p_info.unit.c_str());
	ImGui::TableNextColumn();
	if (is_node_property_set(p_node, p_info.name)) {
		if (ImGui::SmallButton("x")) {
			r_edit = { /*is_requested=*/true, p_info.name, std::nullopt };
		}
		if (ImGui::IsItemHovered()) {
			ImGui::SetTooltip(
					"Back to the default, %s", format_property(p_info.default_value).c_str());
		}
	}
	ImGui::PopID();
}

/// Draws a notice if an animation poses the node: then the viewport shows other values than the
/// inspector.
void draw_pose(EditorContext &r_context, const Node3D &p_node) {
	const Animation *animation = r_context.document.get_timeline().get_animation();
	const auto *instance = dynamic_cast<const MeshInstance3D *>(&p_node);
	if (animation == nullptr ||
			!(p_node.posed_parent_from_node || (instance && instance->posed_morph_weights))) {
		return;
	}
	ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.25f, 1.0f), "Posed by %s", animation->name.c_str());
	r_context.record_item_rect("posed");
	if (ImGui::IsItemHovered()) {
		ImGui::SetTooltip("The viewport shows the node as the animation poses it.\n"
						  "Below is the node's own transform, which is edited and saved;\n"
						  "the parts that the animation replaces are visible at rest.");
	}
}

bool matches_filter(const EditorContext &p_context, const PropertyInfo &p_info) {
	return p_info.name.find(p_context.inspector_filter) != std::string::npos ||
			p_info.group.find(p_context.inspector_filter) != std::string::npos;
}

/// Draws all properties under one heading, in the order of the list.
void draw_group(EditorContext &r_context, const Node3D &p_node, const std::string &p_group,
		const std::vector<PropertyInfo> &p_properties, PropertyEdit &r_edit) {
	const char *heading = p_group.empty() ? "Other" : p_group.c_str();
	if (!ImGui::CollapsingHeader(heading, ImGuiTreeNodeFlags_DefaultOpen) ||
			!ImGui::BeginTable(heading, 4)) {
		return;
	}
	ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 1.5f);
	ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 1.4f);
	ImGui::TableSetupColumn("unit", ImGuiTableColumnFlags_WidthFixed, 2.0f * ImGui::GetFontSize());
	ImGui::TableSetupColumn("reset", ImGuiTableColumnFlags_WidthFixed, 1.5f * ImGui::GetFontSize());
	for (const PropertyInfo &info : p_properties) {
		if (info.group == p_group && matches_filter(r_context, info)) {
			draw_property(r_context, p_node, info, r_edit);
		}
	}
	ImGui::EndTable();
}

} // namespace

void draw_inspector(EditorContext &r_context) {
	if (!ImGui::Begin("Inspector", nullptr, PANEL_FLAGS)) {
		ImGui::End();
		return;
	}
	Node3D *node = r_context.document.get_selected();
	if (node == nullptr) {
		ImGui::TextDisabled("Select a node in the scene.");
		ImGui::End();
		return;
	}
	ImGui::TextUnformatted(node->name.c_str());
	ImGui::SameLine();
	ImGui::TextDisabled("%s", node->get_class_name());
	draw_pose(r_context, *node);
	char filter[128] = {};
	std::strncpy(filter, r_context.inspector_filter.c_str(), sizeof(filter) - 1);
	ImGui::SetNextItemWidth(-1.0f);
	if (ImGui::InputTextWithHint("##filter", "Search properties", filter, sizeof(filter))) {
		r_context.inspector_filter = filter;
	}
	r_context.record_item_rect("search properties");
	const std::vector<PropertyInfo> properties = list_node_properties(*node).get_properties();
	std::vector<std::string> groups;
	for (const PropertyInfo &info : properties) {
		if (matches_filter(r_context, info) &&
				std::find(groups.begin(), groups.end(), info.group) == groups.end()) {
			groups.push_back(info.group);
		}
	}
	PropertyEdit edit;
	for (const std::string &group : groups) {
		draw_group(r_context, *node, group, properties, edit);
	}
	edit.apply(r_context, *node);
	ImGui::End();
}

} // namespace gnomon
