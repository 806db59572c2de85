#pragma once

#include <godot_api.gen.h>

#include <memory>
#include <set>
#include <vector>

namespace gnomon {

/// Keeps a list of the GridMaps of a scene tree. Culling queries of the RenderingServer do not find
/// them, because unlike other nodes they do not give their instances the id of the node. Main
/// thread only.
class GridMaps {
public:
	explicit GridMaps(const godot::SceneTree &p_tree);
	~GridMaps();
	GridMaps(const GridMaps &) = delete;
	GridMaps &operator=(const GridMaps &) = delete;

	/// Returns the node ids of the GridMaps in the world p_scenario.
	std::vector<uint64_t> find(godot::RID p_scenario);

private:
	uint64_t tree_id;
	std::shared_ptr<std::set<uint64_t>> ids = std::make_shared<std::set<uint64_t>>();
	godot::Callable on_node_added;
};

} // namespace gnomon
