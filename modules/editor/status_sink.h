#pragma once

#include "modules/core/log.h"

#include <mutex>
#include <string>
#include <vector>

namespace gnomon {

/// While it exists, errors and warnings of all modules are collected for the status bar, in
/// addition to the previous log sink. They may come from any thread.
class StatusSink {
public:
	StatusSink();
	~StatusSink();
	StatusSink(const StatusSink &) = delete;
	StatusSink &operator=(const StatusSink &) = delete;

	/// Returns the messages since the last call.
	std::vector<std::string> take();

private:
	LogSink before;
	std::mutex mutex;
	std::vector<std::string> lines;
};

} // namespace gnomon
