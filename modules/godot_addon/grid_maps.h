#pragma once

#include <godot_api.gen.h>

#include <memory>
#include <set>
#include <vector>

namespace gnomon {

/// The GridMaps of a scene tree: their instances do not give Godot's RenderingServer the id of
/// their node, as those of other nodes do. Main thread only.
class GridMaps {
public:
	explicit GridMaps(const godot::SceneTree &p_tree);
	~GridMaps();
	GridMaps(const GridMaps &) = delete;
	GridMaps &operator=(const GridMaps &) = delete;

	/// Ids of those in a world.
	std::vector<uint64_t> find(godot::RID p_scenario);

private:
	uint64_t tree_id;
	std::shared_ptr<std::set<uint64_t>> ids = std::make_shared<std::set<uint64_t>>();
	godot::Callable on_node_added;
};

} // namespace gnomon
