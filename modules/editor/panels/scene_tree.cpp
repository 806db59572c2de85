// The panel "Scene": the tree of nodes.

#include "modules/editor/editor_context.h"

#include <imgui.h>

#include <cstring>

namespace gnomon {

namespace {

/// The node that is being renamed, and the text typed so far.
struct Renaming {
	Node3D *node = nullptr;
	char text[256] = {};
	bool needs_focus = false; // the text field needs the keyboard focus

	void begin(Node3D &r_node) {
		node = &r_node;
		std::strncpy(text, r_node.name.c_str(), sizeof(text) - 1);
		needs_focus = true;
	}
};

Renaming renaming;

void draw_name_field(EditorContext &r_context, Node3D &r_node) {
	if (renaming.needs_focus) {
		ImGui::SetKeyboardFocusHere();
		renaming.needs_focus = false;
	}
	const bool is_done = ImGui::InputText("##name", renaming.text, sizeof(renaming.text),
			ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
	if (is_done) {
		r_context.attempt([&] { r_context.document.rename(r_node, renaming.text); });
		renaming.node = nullptr;
	} else if (ImGui::IsItemDeactivated()) {
		renaming.node = nullptr;
	}
}

void draw_node(EditorContext &r_context, Node3D &r_node) {
	ImGuiTreeNodeFlags flags = ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_SpanAvailWidth |
			ImGuiTreeNodeFlags_DefaultOpen;
	flags |= r_node.children.empty() ? ImGuiTreeNodeFlags_Leaf : 0;
	flags |= r_context.document.get_selected() == &r_node ? ImGuiTreeNodeFlags_Selected : 0;
	const bool is_root = r_node.parent == nullptr;
	const std::string name = is_root ? "Scene" : r_node.name;
	ImGui::PushID(&r_node);
	if (renaming.node == &r_node) {
		draw_name_field(r_context, r_node);
		for (const std::unique_ptr<Node3D> &child : r_node.children) {
			draw_node(r_context, *child);
		}
		ImGui::PopID();
		return;
	}
	const bool is_open = ImGui::TreeNodeEx("node", flags, "%s", name.c_str());
	r_context.record_item_rect("node " + name);
	if (ImGui::IsItemClicked()) {
		r_context.document.select(is_root ? nullptr : &r_node);
	}
	if (!is_root && ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
		renaming.begin(r_node);
	}
	ImGui::SameLine();
	ImGui::TextDisabled("%s%s", r_node.is_staged ? "staged " : "", r_node.get_class_name());
	if (is_open) {
		for (const std::unique_ptr<Node3D> &child : r_node.children) {
			draw_node(r_context, *child);
		}
		ImGui::TreePop();
	}
	ImGui::PopID();
}

} // namespace

void draw_scene_tree(EditorContext &r_context) {
	if (ImGui::Begin("Scene", nullptr, PANEL_FLAGS)) {
		draw_node(r_context, *r_context.document.get_scene().root);
	}
	ImGui::End();
}

} // namespace gnomon
