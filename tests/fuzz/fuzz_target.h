#pragma once

#include "modules/core/error.h"
#include "modules/core/log.h"

#include <cstdint>
#include <span>

/// The entry point of a fuzz target. libFuzzer and the replay call it once per input.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size);

namespace gnomon {

/// Calls a function that reads untrusted input. An Error is the documented reaction to bad input
/// and is ignored, as are log messages. Every other exception is a finding and ends the program.
template <typename Read> int run_reader(const Read &p_read) {
	// Static, so that only the first call replaces the sink, by one that drops all messages.
	static const LogSink previous_sink = set_log_sink([](LogLevel, const std::string &) {});
	try {
		p_read();
	} catch (const Error &) {
		return 0;
	}
	return 0;
}

/// Views an input as text.
inline std::string_view to_text(const uint8_t *p_data, size_t p_size) {
	return { reinterpret_cast<const char *>(p_data), p_size };
}

} // namespace gnomon
