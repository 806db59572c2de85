#include "modules/editor/status_sink.h"

#include <utility>

namespace gnomon {

StatusSink::StatusSink() {
	previous_sink = set_log_sink([this](LogLevel p_level, const std::string &p_line) {
		forward_log(previous_sink, p_level, p_line);
		if (p_level != LogLevel::INFO) {
			const std::lock_guard lock(mutex);
			lines.push_back(p_line);
		}
	});
}

StatusSink::~StatusSink() {
	set_log_sink(previous_sink);
}

std::vector<std::string> StatusSink::take() {
	const std::lock_guard lock(mutex);
	return std::exchange(lines, {});
}

} // namespace gnomon
