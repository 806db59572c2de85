#pragma once

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <type_traits>

namespace gnomon {

/// Writes a value as operator<< does, and a path in quotes, without doubled backslashes.
template <typename T> void write_text(std::ostream &r_stream, const T &p_value) {
	if constexpr (std::is_same_v<T, std::filesystem::path>) {
		r_stream << '"' << p_value.string() << '"';
	} else {
		r_stream << p_value;
	}
}

/// Joins its arguments as write_text writes them: text("size ", 3, " px"). (g++ 12 lacks
/// std::format.) Floating-point numbers have 9 significant digits, enough to read a float back.
template <typename... Arguments> std::string text(const Arguments &...p_arguments) {
	std::ostringstream stream;
	stream.precision(9);
	(write_text(stream, p_arguments), ...);
	return stream.str();
}

/// Formats a number for people, with 6 significant digits, so that 0.3f is "0.3".
inline std::string format_number(double p_value) {
	char digits[32];
	std::snprintf(digits, sizeof(digits), "%.6g", p_value);
	return digits;
}

} // namespace gnomon
