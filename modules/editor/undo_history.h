#pragma once

#include "modules/scene/nodes.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// Steps of changes to one scene's nodes, which can be undone and done again. Nodes that a step
/// removed live on in it, so that pointers to nodes stay valid as long as the history does.
class UndoHistory {
public:
	/// Runs p_change, which may change the node's state but not its children. Steps of the same key
	/// that follow each other are one, until close(): a slider that is dragged. Empty: never
	/// joined. A change that throws, or changes nothing, leaves no step.
	void change(Node3D &r_node, const std::string &p_name, const std::string &p_key,
			const std::function<void()> &p_change);
	void close() { open_key.clear(); }
	void add(Node3D &r_parent, std::unique_ptr<Node3D> p_node, const std::string &p_name);
	void remove(Node3D &r_node, const std::string &p_name);

	bool can_undo() const { return step_index > 0; }
	bool can_redo() const { return step_index < steps.size(); }
	/// What the next undo or redo takes back or does again: "Set light_size of Spot".
	const std::string &get_undo_name() const { return steps[step_index - 1].name; }
	const std::string &get_redo_name() const { return steps[step_index].name; }
	/// Returns the node that changed.
	Node3D *undo();
	Node3D *redo();

	/// The scene as it is now is what the file has.
	void set_saved() { saved_serial = get_serial(); }
	bool is_saved() const { return saved_serial == get_serial(); }
	/// Another number whenever the scene is another.
	uint64_t get_serial() const { return step_index == 0 ? 0 : steps[step_index - 1].serial; }

private:
	struct Step {
		std::string name;
		std::string key;
		uint64_t serial = 0;
		Node3D *node = nullptr;
		// A change: the node's state before and after, without children.
		std::unique_ptr<Node3D> before;
		std::unique_ptr<Node3D> after;
		// Added or removed: where, and the node while it is in no tree.
		Node3D *parent = nullptr;
		size_t index = 0;
		std::unique_ptr<Node3D> held;
		bool is_removal = false;
	};

	void push(Step p_step);
	/// Gives the step's node a state, else puts it into the tree or takes it out. Returns it.
	Node3D *apply(Step &r_step, const Node3D *p_state, bool p_is_put_in);

	std::vector<Step> steps;
	size_t step_index = 0; // steps before it are done
	std::string open_key;
	uint64_t next_serial = 1;
	uint64_t saved_serial = 0;
};

} // namespace gnomon
