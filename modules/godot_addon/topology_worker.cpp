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
	wakes.notify_all();
	if (thread.joinable()) {
		thread.join();
	}
}

void TopologyWorker::prepare(const std::shared_ptr<const Mesh> &p_mesh) {
	if (p_mesh->get_triangle_count() <= MOST_IMMEDIATE_TRIANGLES) {
		return;
	}
	const std::lock_guard lock(mutex);
	unready[p_mesh->id] = p_mesh;
	waiting.push_back(p_mesh);
	if (!thread.joinable()) {
		thread = std::thread([this] { run(); });
	}
	wakes.notify_one();
}

bool TopologyWorker::is_ready(const std::shared_ptr<const Mesh> &p_mesh) {
	const std::lock_guard lock(mutex);
	return !p_mesh || !unready.contains(p_mesh->id);
}

void TopologyWorker::forget_unused() {
	const std::lock_guard lock(mutex);
	std::erase_if(unready, [](const auto &p_entry) { return p_entry.second.expired(); });
}

void TopologyWorker::run() {
	std::unique_lock lock(mutex);
	while (true) {
		wakes.wait(lock, [&] { return is_ending || !waiting.empty(); });
		if (is_ending) {
			return;
		}
		const std::shared_ptr<const Mesh> mesh = waiting.front().lock();
		waiting.pop_front();
		if (!mesh) {
			continue;
		}
		lock.unlock();
		try {
			get_topology(mesh);
		} catch (const std::exception &failure) { // of memory: whoever needs the edges fails too
			log_error("\"", mesh->name, "\": ", describe_failure(failure));
		}
		lock.lock();
		unready.erase(mesh->id);
	}
}

} // namespace gnomon
