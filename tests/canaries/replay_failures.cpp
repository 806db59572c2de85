// A fuzz target with one failure of each kind, chosen by the input, which is a single word. Other
// words cause the documented Error. The replay must report each failure; see test_replay.py.
#include "tests/fuzz/fuzz_target.h"

#include <chrono>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace gnomon;

namespace {

const uint8_t *volatile escaped_pointer = nullptr; // volatile: the compiler must not see the errors

void cause_failure(std::string_view p_word, const uint8_t *p_data, size_t p_size) {
	if (p_word == "overflow") {
		escaped_pointer = p_data + p_size;
		escaped_pointer = p_data + *escaped_pointer; // reads the byte after the input
	} else if (p_word == "undefined") {
		volatile int value = std::numeric_limits<int>::max();
		value = value + 1;
	} else if (p_word == "exception") {
		throw std::runtime_error("not the documented Error");
	} else if (p_word == "assertion") {
		GNOMON_ASSERT(p_size == 0, "asserted");
	} else if (p_word == "leak") {
		escaped_pointer = new uint8_t[1000];
		escaped_pointer = nullptr;
	} else if (p_word == "slow") {
		std::this_thread::sleep_for(std::chrono::hours(1));
	} else if (p_word == "large") {
		const volatile size_t size = size_t(3) << 30; // 3 GiB; the replay allows 1 GiB
		escaped_pointer = std::make_unique<uint8_t[]>(size).get();
	} else {
		fail("Word \"", p_word, "\" is unknown, as documented.");
	}
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] { cause_failure(to_text(p_data, p_size), p_data, p_size); });
}
