#pragma once

#include "modules/core/log.h"

#include <mutex>
#include <string>
#include <vector>

namespace gnomon {

/// While it exists, collects errors and warnings from the log for the status bar, and passes all
/// lines on to the previous log sink. Lines may come from any thread.
class StatusSink {
public:
	StatusSink();
	~StatusSink();
	StatusSink(const StatusSink &) = delete;
	StatusSink &operator=(const StatusSink &) = delete;

	/// Returns the messages since the last call.
	std::vector<std::string> take();

private:
	LogSink previous_sink;
	std::mutex mutex;
	std::vector<std::string> lines;
};

} // namespace gnomon
