#pragma once

#include <cstdio>
#include <sstream>
#include <string>

namespace gnomon {

/// Joins its arguments as operator<< prints them: text("size ", 3, " px"). (g++ 12 lacks
/// std::format.) Floating-point numbers have 9 significant digits, enough to read a float back.
template <typename... Arguments> std::string text(const Arguments &...p_arguments) {
	std::ostringstream stream;
	stream.precision(9);
	(stream << ... << p_arguments);
	return stream.str();
}

/// Formats a number for people, with 6 significant digits, so that 0.3f is "0.3".
inline std::string format_number(double p_value) {
	char digits[32];
	std::snprintf(digits, sizeof(digits), "%.6g", p_value);
	return digits;
}

} // namespace gnomon
