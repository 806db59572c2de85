// Runs a fuzz target on files without libFuzzer, each file in its own process.
//     replay_<target> [--limit-s N] FILE|FOLDER...
// An input fails on a crash, a sanitizer's report, a leak, an uncaught exception, or if it takes
// more than N seconds (default: 10).
// Last line: N passed, N failed, N skipped. Exit code: 0 all passed, 1 not, 2 wrong usage.
#include "tests/fuzz/fuzz_target.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace fs = std::filesystem;

/// Read by the address sanitizer: an allocation beyond a gigabyte is a finding, not an exception.
extern "C" const char *__asan_default_options() {
	return "max_allocation_size_mb=1024:allocator_may_return_null=0:detect_leaks=1";
}

namespace {

std::vector<fs::path> list_inputs(const fs::path &p_path) {
	std::vector<fs::path> inputs;
	if (!fs::is_directory(p_path)) {
		return { p_path };
	}
	for (const auto &entry : fs::directory_iterator(p_path)) {
		inputs.push_back(entry.path());
	}
	std::sort(inputs.begin(), inputs.end());
	return inputs;
}

/// Runs the target on one input. Never returns: exits with 0, with the code of the leak check, or
/// with 2 if the input cannot be read.
[[noreturn]] void run_target(const fs::path &p_input, unsigned p_limit_s) {
	std::ifstream stream(p_input, std::ios::binary);
	if (!stream) {
		std::fprintf(stderr, "cannot read %s\n", p_input.c_str());
		std::_Exit(2);
	}
	const std::string text((std::istreambuf_iterator<char>(stream)), {});
	{
		// Exactly as large as the input, so that a read beyond its end is noticed.
		const auto bytes = std::make_unique<uint8_t[]>(text.size());
		std::memcpy(bytes.get(), text.data(), text.size());
		::alarm(p_limit_s);
		LLVMFuzzerTestOneInput(bytes.get(), text.size());
		::alarm(0);
	}
	std::exit(0);
}

/// Runs one input in a child process and describes its failure. Empty when it passed.
std::string find_failure(const fs::path &p_input, unsigned p_limit_s) {
	std::fflush(nullptr);
	const pid_t child = ::fork();
	if (child < 0) {
		return "no process could be started";
	}
	if (child == 0) {
		run_target(p_input, p_limit_s);
	}
	int status = 0;
	::waitpid(child, &status, 0);
	if (WIFEXITED(status)) {
		const int code = WEXITSTATUS(status);
		return code == 0 ? "" : "ended with " + std::to_string(code);
	}
	if (WTERMSIG(status) == SIGALRM) {
		return "took longer than " + std::to_string(p_limit_s) + " s";
	}
	return std::string("ended by signal: ") + ::strsignal(WTERMSIG(status));
}

} // namespace

int main(int p_argument_count, char **p_arguments) {
	unsigned limit_s = 10;
	std::vector<fs::path> inputs;
	for (int index = 1; index < p_argument_count; ++index) {
		if (std::strcmp(p_arguments[index], "--limit-s") == 0 && index + 1 < p_argument_count) {
			const std::string_view value = p_arguments[++index];
			const auto result = std::from_chars(value.data(), value.data() + value.size(), limit_s);
			if (result.ptr != value.data() + value.size() || limit_s < 1 || limit_s > 3600) {
				std::fprintf(stderr, "ERROR: --limit-s is %s, must be 1..3600.\n", value.data());
				return 2;
			}
			continue;
		}
		const std::vector<fs::path> listed = list_inputs(p_arguments[index]);
		inputs.insert(inputs.end(), listed.begin(), listed.end());
	}
	if (inputs.empty()) {
		std::fprintf(stderr, "ERROR: there is no input. Name a file or a folder of files.\n");
		return 2;
	}
	unsigned failed_count = 0;
	for (const fs::path &input : inputs) {
		const std::string failure = find_failure(input, limit_s);
		if (!failure.empty()) {
			++failed_count;
			std::printf("FAILED: %s: %s\n", input.c_str(), failure.c_str());
		}
	}
	std::printf("%zu passed, %u failed, 0 skipped\n", inputs.size() - failed_count, failed_count);
	return failed_count == 0 ? 0 : 1;
}
