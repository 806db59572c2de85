#pragma once

#include "modules/scene/mesh.h"

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace gnomon {

/// Builds the topology of large meshes, which is their edges with the adjacent faces (get_topology
/// of mesh_tools, which caches it), on a worker thread, so that a new mesh does not stall the
/// frame. Small meshes are ready at once.
class TopologyWorker {
public:
	/// Meshes of up to this many triangles are ready at once: their topology takes a few
	/// milliseconds.
	static constexpr uint32_t MAX_IMMEDIATE_TRIANGLES = 10'000;

	TopologyWorker() = default;
	~TopologyWorker();
	TopologyWorker(const TopologyWorker &) = delete;
	TopologyWorker &operator=(const TopologyWorker &) = delete;

	/// Starts to build the topology of a large mesh.
	void prepare(const std::shared_ptr<const Mesh> &p_mesh);
	/// True if the topology of the mesh is built, if the mesh is small, and for null.
	bool is_ready(const std::shared_ptr<const Mesh> &p_mesh);
	/// Removes freed meshes.
	void forget_unused();

private:
	void run();

	std::mutex mutex; // guards all below
	std::condition_variable wake_condition;
	std::deque<std::weak_ptr<const Mesh>> queue;
	std::map<uint64_t, std::weak_ptr<const Mesh>> pending; // by Mesh::id
	bool is_ending = false;
	std::thread thread; // started with the first large mesh
};

} // namespace gnomon
