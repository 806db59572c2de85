// The cache of topologies by mesh id: get_topology and the functions after it in topology.h.

#include "modules/mesh_tools/topology.h"

#include <map>
#include <mutex>

namespace gnomon {

namespace {

struct CacheEntry {
	std::weak_ptr<const Mesh> mesh;
	std::once_flag once;
	std::shared_ptr<const MeshTopology> topology;
};

std::mutex cache_mutex;
std::map<uint64_t, std::shared_ptr<CacheEntry>> cache; // by mesh id, which is never used twice

/// Removes the entries of freed meshes. The caller must hold cache_mutex.
void erase_expired() {
	std::erase_if(cache, [](const auto &p_item) { return p_item.second->mesh.expired(); });
}

} // namespace

std::shared_ptr<const MeshTopology> get_topology(const std::shared_ptr<const Mesh> &p_mesh) {
	if (p_mesh->rest) {
		return get_topology(p_mesh->rest);
	}
	if (p_mesh->id == 0) {
		return std::make_shared<const MeshTopology>(build_topology(*p_mesh));
	}
	std::shared_ptr<CacheEntry> entry;
	{
		const std::lock_guard<std::mutex> lock(cache_mutex);
		std::shared_ptr<CacheEntry> &slot = cache[p_mesh->id];
		if (!slot) {
			slot = std::make_shared<CacheEntry>();
			slot->mesh = p_mesh;
			// New meshes are rare, so this search for freed meshes is not expensive.
			erase_expired();
		}
		entry = slot;
	}
	// Outside the lock, so that building a large mesh does not block threads that need another one.
	std::call_once(entry->once, [&] {
		entry->topology = std::make_shared<const MeshTopology>(build_topology(*p_mesh));
	});
	return entry->topology;
}

void drop_unused_topologies() {
	const std::lock_guard<std::mutex> lock(cache_mutex);
	erase_expired();
}

size_t get_cached_topology_count() {
	const std::lock_guard<std::mutex> lock(cache_mutex);
	return cache.size();
}

} // namespace gnomon
