#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace gnomon {

/// Warns while the driver compiles a pipeline for long, from a thread of its own, because the
/// driver may never return. The compilation itself cannot be ended.
class CompilationWatch {
public:
	/// p_limit_s: time until the first warning; the next ones follow when the time has doubled. 0 =
	/// no warnings.
	CompilationWatch(const std::string &p_pipeline, double p_limit_s);
	~CompilationWatch();
	CompilationWatch(const CompilationWatch &) = delete;
	CompilationWatch &operator=(const CompilationWatch &) = delete;

	/// Returns after the first warning; at once if there are none. For an injected fault.
	void wait_for_warning();

private:
	void watch(const std::string &p_pipeline, double p_limit_s);

	std::mutex mutex; // of the booleans
	std::condition_variable changed;
	bool has_warned = false;
	bool is_compiled = false;
	std::thread thread;
};

} // namespace gnomon
