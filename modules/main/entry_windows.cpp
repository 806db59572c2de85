// The entry point on Windows. Arguments and output are UTF-8 in the program. Windows passes
// arguments as UTF-16, and its consoles expect the code page of the user's language.

#include "modules/main/commands.h"

#define WIN32_LEAN_AND_MEAN
#define NOGDI // wingdi.h defines ERROR, a name of LogLevel
#include <windows.h>

#include <cstdio>
#include <string>
#include <vector>

namespace {

/// Sets the console's code page, which outlives the program, and restores it at the end.
struct ConsoleCodePage {
	const UINT previous = ::GetConsoleOutputCP();
	ConsoleCodePage() { ::SetConsoleOutputCP(CP_UTF8); }
	~ConsoleCodePage() {
		std::fflush(nullptr);
		::SetConsoleOutputCP(previous);
	}
	ConsoleCodePage(const ConsoleCodePage &) = delete;
	ConsoleCodePage &operator=(const ConsoleCodePage &) = delete;
};

/// Converts text to UTF-8. Half a character (a lone surrogate) becomes U+FFFD.
std::string to_utf8(const wchar_t *p_text) {
	std::string converted;
	const int size = ::WideCharToMultiByte(CP_UTF8, 0, p_text, -1, nullptr, 0, nullptr, nullptr);
	converted.resize(static_cast<size_t>(size)); // with the final 0
	::WideCharToMultiByte(CP_UTF8, 0, p_text, -1, converted.data(), size, nullptr, nullptr);
	converted.resize(converted.size() - 1);
	return converted;
}

} // namespace

int wmain(int p_argument_count, wchar_t **p_arguments) {
	const ConsoleCodePage code_page;
	std::vector<std::string> texts;
	for (int index = 0; index < p_argument_count; ++index) {
		texts.push_back(to_utf8(p_arguments[index]));
	}
	std::vector<char *> arguments;
	for (std::string &text : texts) {
		arguments.push_back(text.data());
	}
	arguments.push_back(nullptr);
	return gnomon::run_gnomon(p_argument_count, arguments.data());
}
