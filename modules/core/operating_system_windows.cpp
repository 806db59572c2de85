#include "modules/core/files.h"
#include "modules/core/operating_system.h"

#define WIN32_LEAN_AND_MEAN
#define NOGDI // wingdi.h defines ERROR, a name of LogLevel
#include <cpuid.h>
#include <windows.h>

#include <cstring>
#include <vector>

namespace gnomon {

namespace fs = std::filesystem;

std::optional<std::string> get_environment_variable(const char *p_name) {
	const std::wstring name = make_path(p_name).native();
	std::wstring value;
	DWORD length = ::GetEnvironmentVariableW(name.c_str(), nullptr, 0);
	while (length > value.size()) { // again if it has grown since
		value.resize(length);
		length = ::GetEnvironmentVariableW(
				name.c_str(), value.data(), static_cast<DWORD>(value.size()));
	}
	value.resize(length);
	return value.empty() ? std::nullopt : std::optional<std::string>(fs::path(value).string());
}

fs::path find_system_user_folder(UserFolderKind p_kind) {
	const auto folder = get_environment_variable("LOCALAPPDATA");
	if (!folder) {
		return {};
	}
	return make_path(*folder) / "gnomon" / (p_kind == UserFolderKind::CACHE ? "cache" : "config");
}

bool is_folder_writable(const fs::path &p_folder) {
	// The attribute "read-only" does not state it for folders, so the right to add a file is
	// requested.
	const HANDLE handle = ::CreateFileW(p_folder.c_str(), FILE_ADD_FILE,
			FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, /*security=*/nullptr,
			OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, /*template=*/nullptr);
	if (handle == INVALID_HANDLE_VALUE) {
		return false;
	}
	::CloseHandle(handle);
	std::error_code code;
	return fs::is_directory(p_folder, code);
}

bool is_error_output_terminal() {
	const HANDLE output = ::GetStdHandle(STD_ERROR_HANDLE);
	DWORD mode = 0;
	return ::GetConsoleMode(output, &mode) &&
			::SetConsoleMode(output, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

fs::path find_program_path() {
	std::wstring path(MAX_PATH, L'\0');
	for (;;) {
		const DWORD length =
				::GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()));
		if (length < path.size()) {
			return path.substr(0, length);
		}
		path.resize(2 * path.size()); // it was cut off
	}
}

std::string find_cpu_name() {
	// CPUID leaves 0x80000002 to 0x80000004 have 16 letters each.
	constexpr unsigned FIRST_LEAF = 0x80000002;
	constexpr unsigned LEAF_COUNT = 3;
	unsigned registers[4 * LEAF_COUNT + 1] = {}; // the last stays 0 and ends the name
	for (unsigned leaf = 0; leaf < LEAF_COUNT; ++leaf) {
		unsigned *values = registers + size_t(4) * leaf;
		if (!__get_cpuid(FIRST_LEAF + leaf, values, values + 1, values + 2, values + 3)) {
			return "unknown";
		}
	}
	char name[sizeof(registers)];
	std::memcpy(name, registers, sizeof(registers));
	const std::string text = name;
	const size_t begin = text.find_first_not_of(' ');
	return begin == std::string::npos ? "unknown"
									  : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

double read_thread_time_ms() {
	FILETIME unused = {};
	FILETIME kernel = {};
	FILETIME user = {};
	::GetThreadTimes(::GetCurrentThread(), &unused, &unused, &kernel, &user);
	const auto read_ms = [](const FILETIME &p_time) { // in units of 100 ns
		return (double(p_time.dwHighDateTime) * 4294967296.0 + p_time.dwLowDateTime) / 1e4;
	};
	return read_ms(kernel) + read_ms(user);
}

} // namespace gnomon
