#include "modules/editor/undo_history.h"

#include "modules/core/error.h"
#include "modules/scene/node_properties.h"

#include <algorithm>

namespace gnomon {

namespace {

bool is_same_state(const Node3D &p_left, const Node3D &p_right) {
	if (p_left.name != p_right.name || p_left.parent_from_node != p_right.parent_from_node) {
		return false;
	}
	for (const NodeField &field : p_left.get_fields()) {
		if (field.read(p_left) != field.read(p_right)) {
			return false;
		}
	}
	// The fields only show one of a mesh's materials, but a change may affect all of them.
	if (const auto *left = dynamic_cast<const MeshInstance3D *>(&p_left)) {
		const auto &right = dynamic_cast<const MeshInstance3D &>(p_right);
		if (!std::equal(left->surfaces.begin(), left->surfaces.end(), right.surfaces.begin(),
					right.surfaces.end(), [](const auto &p_one, const auto &p_other) {
						return p_one.mesh == p_other.mesh && p_one.material == p_other.material;
					})) {
			return false;
		}
	}
	const PropertyValues *left = p_left.find_stored_properties();
	const PropertyValues *right = p_right.find_stored_properties();
	return left == nullptr || right == nullptr || *left == *right;
}

} // namespace

void UndoHistory::push(Step p_step) {
	steps.resize(step_index);
	p_step.serial = next_serial++;
	steps.push_back(std::move(p_step));
	step_index = steps.size();
}

void UndoHistory::change(Node3D &r_node, const std::string &p_name, const std::string &p_key,
		const std::function<void()> &p_change) {
	std::unique_ptr<Node3D> before = r_node.copy();
	try {
		p_change();
	} catch (...) {
		r_node.assign(*before);
		throw;
	}
	if (is_same_state(*before, r_node)) {
		return;
	}
	const bool is_merged = !p_key.empty() && p_key == open_key && step_index == steps.size() &&
			step_index > 0 && steps.back().node == &r_node && steps.back().key == p_key;
	open_key = p_key;
	if (is_merged) {
		steps.back().after = r_node.copy();
		steps.back().serial = next_serial++;
		return;
	}
	Step step;
	step.name = p_name;
	step.key = p_key;
	step.node = &r_node;
	step.before = std::move(before);
	step.after = r_node.copy();
	push(std::move(step));
}

void UndoHistory::add(Node3D &r_parent, std::unique_ptr<Node3D> p_node, const std::string &p_name) {
	Step step;
	step.name = p_name;
	step.node = p_node.get();
	step.parent = &r_parent;
	step.index = r_parent.children.size();
	step.detached_node = std::move(p_node);
	apply(step, nullptr, /*p_inserts=*/true);
	push(std::move(step));
}

void UndoHistory::remove(Node3D &r_node, const std::string &p_name) {
	GNOMON_ASSERT(r_node.parent, "the root cannot be removed");
	const auto &siblings = r_node.parent->children;
	Step step;
	step.name = p_name;
	step.node = &r_node;
	step.parent = r_node.parent;
	step.index = size_t(std::find_if(siblings.begin(), siblings.end(), [&](const auto &p_one) {
		return p_one.get() == &r_node;
	}) - siblings.begin());
	step.is_removal = true;
	apply(step, nullptr, /*p_inserts=*/false);
	push(std::move(step));
}

Node3D *UndoHistory::apply(Step &r_step, const Node3D *p_state, bool p_inserts) {
	close();
	if (p_state != nullptr) {
		r_step.node->assign(*p_state);
	} else if (p_inserts) {
		r_step.parent->insert_child(std::move(r_step.detached_node), r_step.index);
	} else {
		r_step.detached_node = r_step.parent->remove_child(*r_step.node);
	}
	return r_step.node;
}

Node3D *UndoHistory::undo() {
	GNOMON_ASSERT(can_undo(), "nothing to undo");
	Step &step = steps[--step_index];
	return apply(step, step.before.get(), step.is_removal);
}

Node3D *UndoHistory::redo() {
	GNOMON_ASSERT(can_redo(), "nothing to redo");
	Step &step = steps[step_index++];
	return apply(step, step.after.get(), !step.is_removal);
}

} // namespace gnomon
