#pragma once

#include "modules/scene/nodes.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// Undo and redo steps for the nodes of one scene. A step owns its node while that is outside of
/// the tree, so that the pointers to it in other steps stay valid.
class UndoHistory {
public:
	/// Runs p_change, which may change the node's state but not its children, and adds a step for
	/// it. p_name: see get_undo_name. p_key: consecutive steps of the node with the same key are
	/// merged until close(), as when a slider is dragged; an empty key is never merged. If p_change
	/// throws, the node is restored. A change that throws, or changes nothing, adds no step.
	void change(Node3D &r_node, const std::string &p_name, const std::string &p_key,
			const std::function<void()> &p_change);
	/// Prevents the next step from being merged with the last one.
	void close() { open_key.clear(); }
	/// Adds a node as the last child of r_parent, as a step.
	void add(Node3D &r_parent, std::unique_ptr<Node3D> p_node, const std::string &p_name);
	/// Removes a node with its descendants, as a step.
	void remove(Node3D &r_node, const std::string &p_name);

	bool can_undo() const { return step_index > 0; }
	bool can_redo() const { return step_index < steps.size(); }
	/// Returns the name of the step that the next undo reverts, for example "Set light_size of
	/// Spot". can_undo() must be true.
	const std::string &get_undo_name() const { return steps[step_index - 1].name; }
	/// Returns the name of the step that the next redo repeats. can_redo() must be true.
	const std::string &get_redo_name() const { return steps[step_index].name; }
	/// Reverts a step and returns the node that changed. can_undo() must be true.
	Node3D *undo();
	/// Repeats a step and returns the node that changed. can_redo() must be true.
	Node3D *redo();

	/// Marks the current state as saved.
	void set_saved() { saved_serial = get_serial(); }
	bool is_saved() const { return saved_serial == get_serial(); }
	/// Returns a number that identifies the state of the scene: every change gives a new one, and
	/// undo and redo restore the number together with the state.
	uint64_t get_serial() const { return step_index == 0 ? 0 : steps[step_index - 1].serial; }

private:
	struct Step {
		std::string name;
		std::string key;
		uint64_t serial = 0;
		Node3D *node = nullptr;
		// For a change: the node's state before and after, without children.
		std::unique_ptr<Node3D> before;
		std::unique_ptr<Node3D> after;
		// For a node that was added or removed: its position in the tree, and the node itself while
		// it is outside the tree.
		Node3D *parent = nullptr;
		size_t index = 0;
		std::unique_ptr<Node3D> detached_node;
		bool is_removal = false;
	};

	void push(Step p_step);
	/// Restores p_state of the step's node. If p_state is null, inserts the node into the tree or
	/// removes it. Returns the node.
	Node3D *apply(Step &r_step, const Node3D *p_state, bool p_inserts);

	std::vector<Step> steps;
	size_t step_index = 0; // number of steps that are applied
	std::string open_key;
	uint64_t next_serial = 1;
	uint64_t saved_serial = 0;
};

} // namespace gnomon
