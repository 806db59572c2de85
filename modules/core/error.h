#pragma once

#include "modules/core/text.h"

#include <stdexcept>
#include <string>

namespace gnomon {

/// Bad input or a failed device: ends the command with exit code 1 and one line on stderr.
/// The text names the object, the value, the allowed range and the next step.
class Error : public std::runtime_error {
public:
	using std::runtime_error::runtime_error;
};

/// Wrong usage of the command line: exit code 2.
class UsageError : public Error {
public:
	using Error::Error;
};

/// The GPU device is lost: every later call to it fails too, so the caller should not continue.
class DeviceLost : public Error {
public:
	using Error::Error;
};

/// There is more data than a device or a method can hold. A caller that knows the scene adds which
/// object has most of it.
class CapacityError : public Error {
public:
	using Error::Error;
};

/// Returns the message of a caught exception. For std::bad_alloc, which has no useful message, it
/// states what the user can do.
std::string describe_failure(const std::exception &p_failure);

/// Throws Error with the arguments joined by text().
template <typename... Arguments> [[noreturn]] void fail(const Arguments &...p_arguments) {
	throw Error(text(p_arguments...));
}

/// Throws CapacityError with the arguments joined by text().
template <typename... Arguments> [[noreturn]] void fail_capacity(const Arguments &...p_arguments) {
	throw CapacityError(text(p_arguments...));
}

/// Prints the message with its location and aborts. Called by GNOMON_ASSERT only.
[[noreturn]] void abort_with_message(
		const char *p_file, int p_line, const char *p_condition, const std::string &p_message);

} // namespace gnomon

/// Checks for programming errors, never for bad input. If the condition is false, prints it and the
/// other arguments, joined by text(), and aborts. Enabled in every build, because measurements
/// taken in an invalid state would be wrong.
#define GNOMON_ASSERT(m_condition, ...)                                                            \
	do {                                                                                           \
		if (!(m_condition)) [[unlikely]] {                                                         \
			::gnomon::abort_with_message(                                                          \
					__FILE__, __LINE__, #m_condition, ::gnomon::text(__VA_ARGS__));                \
		}                                                                                          \
	} while (false)
