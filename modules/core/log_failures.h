#pragma once

#include "modules/core/error.h"
#include "modules/core/log.h"

#include <exception>

namespace gnomon {

/// Calls p_function and logs its exceptions. For functions that another program calls, which
/// exceptions must not reach.
template <typename Function> void log_failures(Function p_function) {
	try {
		p_function();
	} catch (const std::exception &failure) {
		log_error(describe_failure(failure));
	}
}

} // namespace gnomon
