#include "modules/core/error.h"

#include <cstdio>
#include <cstdlib>
#include <new>

namespace gnomon {

std::string describe_failure(const std::exception &p_failure) {
	if (dynamic_cast<const std::bad_alloc *>(&p_failure) != nullptr) {
		return "Out of memory. Close other programs, or use a smaller scene or image.";
	}
	return p_failure.what();
}

void abort_with_message(
		const char *p_file, int p_line, const char *p_condition, const std::string &p_message) {
	std::fprintf(stderr, "%s:%d: assertion failed: %s. %s\n", p_file, p_line, p_condition,
			p_message.c_str());
	std::fflush(stderr);
	std::abort();
}

} // namespace gnomon
