#include "modules/godot_addon/unculled_nodes.h"

namespace gnomon {

namespace {

const char NODE_SIGNAL[] = "node_added";

/// Adds the node if culling queries do not find its class.
void add_unculled(const godot::Variant &p_node, std::set<uint64_t> &r_ids) {
	const godot::ObjectHandle node(p_node.to_object());
	if (godot::cast<godot::GridMap>(node) || godot::cast<godot::DirectionalLight3D>(node)) {
		r_ids.insert(godot::get_instance_id(node.get_object()));
	}
}

} // namespace

UnculledNodes::UnculledNodes(const godot::SceneTree &p_tree) :
		tree_id(godot::get_instance_id(p_tree.get_object())),
		on_node_added([ids = ids](std::span<const godot::Variant> p_arguments) {
			add_unculled(p_arguments.front(), *ids);
		}) {
	p_tree.connect(NODE_SIGNAL, on_node_added, /*flags=*/0);
	const godot::Node root(p_tree.get_root().get_object());
	for (const char *type : { "GridMap", "DirectionalLight3D" }) {
		const godot::Array found =
				root.find_children("*", type, /*recursive=*/true, /*owned=*/false);
		for (int64_t index = 0; index < found.get_size(); ++index) {
			add_unculled(found.get_value(index), *ids);
		}
	}
}

UnculledNodes::~UnculledNodes() {
	if (void *tree = godot::get_instance(tree_id)) {
		godot::Object(tree).disconnect(NODE_SIGNAL, on_node_added);
	}
}

std::vector<uint64_t> UnculledNodes::find(godot::RID p_scenario) {
	std::erase_if(*ids, [](uint64_t p_id) { return godot::get_instance(p_id) == nullptr; });
	std::vector<uint64_t> found;
	for (const uint64_t id : *ids) {
		const godot::Node3D node(godot::get_instance(id));
		if (!node.is_inside_tree()) {
			continue;
		}
		const godot::Ref<godot::World3D> world = node.get_world_3d();
		if (world && world.get_scenario() == p_scenario) {
			found.push_back(id);
		}
	}
	return found;
}

} // namespace gnomon
