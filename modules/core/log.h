#pragma once

#include "modules/core/text.h"

#include <functional>
#include <string>

namespace gnomon {

enum class LogLevel { INFO, WARNING, ERROR };

/// Receives every line. Called from any thread, one line at a time.
using LogSink = std::function<void(LogLevel, const std::string &)>;

/// Replaces where lines go (default: stderr, "WARNING: " or "ERROR: " in front) and returns the
/// sink before. An empty function restores the default.
LogSink set_log_sink(LogSink p_sink);
/// Passes a line to a previous sink, or to the default output when that sink is empty.
void forward_log(const LogSink &p_sink, LogLevel p_level, const std::string &p_line);
/// Sees every line while it exists; the sink from before gets those that pass.
class LogFilterScope {
public:
	/// p_passes: true: the line goes on to the sink from before.
	explicit LogFilterScope(std::function<bool(LogLevel, const std::string &)> p_passes);
	~LogFilterScope();
	LogFilterScope(const LogFilterScope &) = delete;
	LogFilterScope &operator=(const LogFilterScope &) = delete;

private:
	LogSink before;
};
/// Lines below this level are dropped. Default INFO.
void set_log_level(LogLevel p_level);
void write_log(LogLevel p_level, const std::string &p_line);

template <typename... Arguments> void log_info(const Arguments &...p_arguments) {
	write_log(LogLevel::INFO, text(p_arguments...));
}
template <typename... Arguments> void log_warning(const Arguments &...p_arguments) {
	write_log(LogLevel::WARNING, text(p_arguments...));
}
template <typename... Arguments> void log_error(const Arguments &...p_arguments) {
	write_log(LogLevel::ERROR, text(p_arguments...));
}

} // namespace gnomon
