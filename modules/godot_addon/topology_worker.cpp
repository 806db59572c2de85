#include "modules/godot_addon/topology_worker.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/mesh_tools/topology.h"

namespace gnomon {

TopologyWorker::~TopologyWorker() {
	{
		const std::lock_guard lock(mutex);
		is_ending = true;
	}
	wake_condition.notify_all();
	if (thread.joinable()) {
		thread.join();
	}
}

void TopologyWorker::prepare(const std::shared_ptr<const Mesh> &p_mesh) {
	if (p_mesh->get_triangle_count() <= MAX_IMMEDIATE_TRIANGLES) {
		return;
	}
	const std::lock_guard lock(mutex);
	pending[p_mesh->id] = p_mesh;
	queue.push_back(p_mesh);
	if (!thread.joinable()) {
		thread = std::thread([this] { run(); });
	}
	wake_condition.notify_one();
}

bool TopologyWorker::is_ready(const std::shared_ptr<const Mesh> &p_mesh) {
	const std::lock_guard lock(mutex);
	return !p_mesh || !pending.contains(p_mesh->id);
}

void TopologyWorker::forget_unused() {
	const std::lock_guard lock(mutex);
	std::erase_if(pending, [](const auto &p_entry) { return p_entry.second.expired(); });
}

void TopologyWorker::run() {
	std::unique_lock lock(mutex);
	while (true) {
		wake_condition.wait(lock, [&] { return is_ending || !queue.empty(); });
		if (is_ending) {
			return;
		}
		const std::shared_ptr<const Mesh> mesh = queue.front().lock();
		queue.pop_front();
		if (!mesh) {
			continue;
		}
		lock.unlock();
		try {
			get_topology(mesh);
		} catch (const std::exception &failure) { // out of memory
			log_error("Edges of mesh \"", mesh->name, "\": ", describe_failure(failure));
		}
		lock.lock();
		pending.erase(mesh->id);
	}
}

} // namespace gnomon
