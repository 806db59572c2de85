#pragma once

#include "modules/core/error.h"
#include "modules/core/log.h"

#include <cstdint>
#include <span>

/// What libFuzzer and the replay call, once per input.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size);

namespace gnomon {

/// Calls a reader. An Error is the documented answer to bad input, and log lines may hold anything;
/// every other exception is a finding and ends the program.
template <typename Read> int run_reader(const Read &p_read) {
	static const LogSink before = set_log_sink([](LogLevel, const std::string &) {});
	try {
		p_read();
	} catch (const Error &) {
		return 0;
	}
	return 0;
}

inline std::string_view to_text(const uint8_t *p_data, size_t p_size) {
	return { reinterpret_cast<const char *>(p_data), p_size };
}

} // namespace gnomon
