#pragma once

#include <sstream>
#include <string>

namespace gnomon {

/// Joins its arguments as operator<< prints them: text("size ", 3, " px"). (g++ 12 lacks
/// std::format.) Numbers are written with 9 significant digits, enough to read a float back.
template <typename... Arguments> std::string text(const Arguments &...p_arguments) {
	std::ostringstream stream;
	stream.precision(9);
	(stream << ... << p_arguments);
	return stream.str();
}

} // namespace gnomon
