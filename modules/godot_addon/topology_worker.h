#pragma once

#include "modules/scene/mesh.h"

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace gnomon {

/// Finds the edges of large meshes (mesh_tools' get_topology) on a thread of its own, so that a
/// mesh that appears does not hold up the frame. Small ones are ready at once.
class TopologyWorker {
public:
	/// Up to this many a mesh is ready at once: its edges take a few milliseconds.
	static constexpr uint32_t MOST_IMMEDIATE_TRIANGLES = 10'000;

	TopologyWorker() = default;
	~TopologyWorker();
	TopologyWorker(const TopologyWorker &) = delete;
	TopologyWorker &operator=(const TopologyWorker &) = delete;

	void prepare(const std::shared_ptr<const Mesh> &p_mesh);
	/// Null is ready.
	bool is_ready(const std::shared_ptr<const Mesh> &p_mesh);
	/// Drops what is known of meshes that are gone.
	void forget_unused();

private:
	void run();

	std::mutex mutex; // of all below
	std::condition_variable wakes;
	std::deque<std::weak_ptr<const Mesh>> waiting;
	std::map<uint64_t, std::weak_ptr<const Mesh>> unready; // by Mesh::id
	bool is_ending = false;
	std::thread thread; // started with the first large mesh
};

} // namespace gnomon
