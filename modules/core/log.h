#pragma once

#include "modules/core/text.h"

#include <functional>
#include <string>

namespace gnomon {

enum class LogLevel { INFO, WARNING, ERROR };

/// Receives every line that is not below the log level. Called from any thread, one line at a time.
/// It must not log or replace the sink.
using LogSink = std::function<void(LogLevel, const std::string &)>;

/// Replaces the sink and returns the previous one. An empty function restores the default, which
/// prints to stderr with "WARNING: " or "ERROR: " in front.
LogSink set_log_sink(LogSink p_sink);
/// Passes a line to the sink, or to the default output if the sink is empty.
void forward_log(const LogSink &p_sink, LogLevel p_level, const std::string &p_line);
/// Filters the log while it exists: the previous sink receives only the lines that pass the filter.
class LogFilterScope {
public:
	/// p_passes: called with each line; returns true if the previous sink is to receive the line.
	explicit LogFilterScope(std::function<bool(LogLevel, const std::string &)> p_passes);
	~LogFilterScope();
	LogFilterScope(const LogFilterScope &) = delete;
	LogFilterScope &operator=(const LogFilterScope &) = delete;

private:
	LogSink previous_sink;
};
/// Lines below this level are dropped. Default INFO.
void set_log_level(LogLevel p_level);
/// Logs one line. Callable from any thread.
void write_log(LogLevel p_level, const std::string &p_line);

template <typename... Arguments> void log_info(const Arguments &...p_arguments) {
	write_log(LogLevel::INFO, text(p_arguments...));
}
template <typename... Arguments> void log_warning(const Arguments &...p_arguments) {
	write_log(LogLevel::WARNING, text(p_arguments...));
}
/// Starts the warnings of log_fault. Tests fail on such a line.
inline constexpr char FAULT_PREFIX[] = "Incomplete result: ";
/// Logs a warning about a result that is incomplete although its input is valid, because of a
/// programming error or of a limit of the driver.
template <typename... Arguments> void log_fault(const Arguments &...p_arguments) {
	write_log(LogLevel::WARNING, text(FAULT_PREFIX, p_arguments...));
}
template <typename... Arguments> void log_error(const Arguments &...p_arguments) {
	write_log(LogLevel::ERROR, text(p_arguments...));
}

} // namespace gnomon
