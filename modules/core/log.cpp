#include "modules/core/log.h"

#include <atomic>
#include <cstdio>
#include <mutex>
#include <utility>

namespace gnomon {

namespace {

std::mutex log_mutex;
LogSink log_sink;
std::atomic<LogLevel> min_level = LogLevel::INFO;

} // namespace

LogSink set_log_sink(LogSink p_sink) {
	std::lock_guard lock(log_mutex);
	return std::exchange(log_sink, std::move(p_sink));
}

LogFilterScope::LogFilterScope(std::function<bool(LogLevel, const std::string &)> p_passes) {
	previous_sink = set_log_sink(
			[this, passes = std::move(p_passes)](LogLevel p_level, const std::string &p_line) {
				if (passes(p_level, p_line)) {
					forward_log(previous_sink, p_level, p_line);
				}
			});
}

LogFilterScope::~LogFilterScope() {
	set_log_sink(std::move(previous_sink));
}

void set_log_level(LogLevel p_level) {
	min_level = p_level;
}

void write_log(LogLevel p_level, const std::string &p_line) {
	if (p_level < min_level) {
		return;
	}
	std::lock_guard lock(log_mutex);
	forward_log(log_sink, p_level, p_line);
}

void forward_log(const LogSink &p_sink, LogLevel p_level, const std::string &p_line) {
	if (p_sink) {
		p_sink(p_level, p_line);
		return;
	}
	static const char *const PREFIXES[] = { "", "WARNING: ", "ERROR: " };
	std::fprintf(stderr, "%s%s\n", PREFIXES[static_cast<int>(p_level)], p_line.c_str());
}

} // namespace gnomon
