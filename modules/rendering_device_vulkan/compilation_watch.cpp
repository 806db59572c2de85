#include "modules/rendering_device_vulkan/compilation_watch.h"

#include "modules/core/log.h"

#include <chrono>

namespace gnomon {

CompilationWatch::CompilationWatch(const std::string &p_pipeline, double p_limit_s) {
	if (p_limit_s > 0) {
		thread = std::thread([this, p_pipeline, p_limit_s] { watch(p_pipeline, p_limit_s); });
	}
}

CompilationWatch::~CompilationWatch() {
	if (!thread.joinable()) {
		return;
	}
	{
		const std::lock_guard lock(mutex);
		is_compiled = true;
	}
	changed.notify_all();
	thread.join();
}

void CompilationWatch::wait_for_warning() {
	if (thread.joinable()) {
		std::unique_lock lock(mutex);
		changed.wait(lock, [&] { return has_warned; });
	}
}

void CompilationWatch::watch(const std::string &p_pipeline, double p_limit_s) {
	const auto start = std::chrono::steady_clock::now();
	std::unique_lock lock(mutex);
	for (double limit_s = p_limit_s;; limit_s *= 2) {
		const auto time = start +
				std::chrono::duration_cast<std::chrono::steady_clock::duration>(
						std::chrono::duration<double>(limit_s));
		if (changed.wait_until(lock, time, [&] { return is_compiled; })) {
			return;
		}
		log_warning("The driver has been compiling pipeline '", p_pipeline, "' for ", limit_s,
				" s. If it does not end, update the driver, or choose another device with "
				"--device. GNOMON_DEVICE_TIMEOUT_S is the time of this warning in seconds, 0 = "
				"none.");
		has_warned = true;
		changed.notify_all();
	}
}

} // namespace gnomon
