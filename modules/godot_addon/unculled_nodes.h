#pragma once

#include <godot_api.gen.h>

#include <memory>
#include <set>
#include <vector>

namespace gnomon {

/// Keeps a list of the nodes of a scene tree that culling queries of the RenderingServer do not
/// find: GridMaps, which do not give their instances the id of the node, and DirectionalLight3Ds,
/// which are nowhere. Main thread only.
class UnculledNodes {
public:
	explicit UnculledNodes(const godot::SceneTree &p_tree);
	~UnculledNodes();
	UnculledNodes(const UnculledNodes &) = delete;
	UnculledNodes &operator=(const UnculledNodes &) = delete;

	/// Returns the ids of those nodes in the world p_scenario.
	std::vector<uint64_t> find(godot::RID p_scenario);

private:
	uint64_t tree_id;
	std::shared_ptr<std::set<uint64_t>> ids = std::make_shared<std::set<uint64_t>>();
	godot::Callable on_node_added;
};

} // namespace gnomon
