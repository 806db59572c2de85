#include "modules/core/error.h"

#include <cstdio>
#include <cstdlib>

namespace gnomon {

void abort_with_message(
		const char *p_file, int p_line, const char *p_condition, const std::string &p_message) {
	std::fprintf(stderr, "%s:%d: assertion failed: %s. %s\n", p_file, p_line, p_condition,
			p_message.c_str());
	std::fflush(stderr);
	std::abort();
}

} // namespace gnomon
