#include "modules/godot_addon/grid_maps.h"

namespace gnomon {

namespace {

const char NODE_SIGNAL[] = "node_added";

godot::GridMap to_grid_map(const godot::Variant &p_node) {
	return godot::cast<godot::GridMap>(godot::ObjectHandle(p_node.to_object()));
}

} // namespace

GridMaps::GridMaps(const godot::SceneTree &p_tree) :
		tree_id(godot::get_instance_id(p_tree.get_object())),
		on_node_added([ids = ids](std::span<const godot::Variant> p_arguments) {
			const godot::GridMap added = to_grid_map(p_arguments.front());
			if (added) {
				ids->insert(godot::get_instance_id(added.get_object()));
			}
		}) {
	p_tree.connect(NODE_SIGNAL, on_node_added, /*flags=*/0);
	const godot::Node root(p_tree.get_root().get_object());
	const godot::Array found =
			root.find_children("*", "GridMap", /*recursive=*/true, /*owned=*/false);
	for (int64_t index = 0; index < found.get_size(); ++index) {
		ids->insert(godot::get_instance_id(to_grid_map(found.get_value(index)).get_object()));
	}
}

GridMaps::~GridMaps() {
	if (void *tree = godot::get_instance(tree_id)) {
		godot::Object(tree).disconnect(NODE_SIGNAL, on_node_added);
	}
}

std::vector<uint64_t> GridMaps::find(godot::RID p_scenario) {
	std::erase_if(*ids, [](uint64_t p_id) { return godot::get_instance(p_id) == nullptr; });
	std::vector<uint64_t> found;
	for (const uint64_t id : *ids) {
		const godot::GridMap grid_map(godot::get_instance(id));
		if (!grid_map.is_inside_tree()) {
			continue;
		}
		const godot::Ref<godot::World3D> world = grid_map.get_world_3d();
		if (world && world.get_scenario() == p_scenario) {
			found.push_back(id);
		}
	}
	return found;
}

} // namespace gnomon
