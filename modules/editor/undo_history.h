#pragma once

#include "modules/scene/nodes.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// Undo and redo steps for the nodes of one scene. Nodes that a step removed stay alive in it, so
/// that pointers to nodes stay valid as long as the history exists.
class UndoHistory {
public:
	/// Runs p_change, which may change the node's state but not its children. Consecutive steps
	/// with the same key are merged until close(), as when a slider is dragged; an empty key is
	/// never merged. A change that throws, or changes nothing, leaves no step.
	void change(Node3D &r_node, const std::string &p_name, const std::string &p_key,
			const std::function<void()> &p_change);
	void close() { open_key.clear(); }
	void add(Node3D &r_parent, std::unique_ptr<Node3D> p_node, const std::string &p_name);
	void remove(Node3D &r_node, const std::string &p_name);

	bool can_undo() const { return step_index > 0; }
	bool can_redo() const { return step_index < steps.size(); }
	/// Name of the step that the next undo reverts or the next redo repeats: "Set light_size of
	/// Spot".
	const std::string &get_undo_name() const { return steps[step_index - 1].name; }
	const std::string &get_redo_name() const { return steps[step_index].name; }
	/// Returns the node that changed.
	Node3D *undo();
	Node3D *redo();

	/// Marks the current state as saved.
	void set_saved() { saved_serial = get_serial(); }
	bool is_saved() const { return saved_serial == get_serial(); }
	/// Identifies the state of the scene: changes whenever the scene changes, and undo and redo
	/// restore it.
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
		// For a node that was added or removed: its position, and the node while it is in no tree.
		Node3D *parent = nullptr;
		size_t index = 0;
		std::unique_ptr<Node3D> held;
		bool is_removal = false;
	};

	void push(Step p_step);
	/// Restores a state of the step's node, or inserts it into or removes it from the tree. Returns
	/// it.
	Node3D *apply(Step &r_step, const Node3D *p_state, bool p_is_put_in);

	std::vector<Step> steps;
	size_t step_index = 0; // number of steps that are applied
	std::string open_key;
	uint64_t next_serial = 1;
	uint64_t saved_serial = 0;
};

} // namespace gnomon
