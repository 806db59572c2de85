// A fuzz target with one failure of each kind, chosen by the input's first word. The replay must
// report each; see test_replay.py.
#include "tests/fuzz/fuzz_target.h"

#include <chrono>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace gnomon;

namespace {

const uint8_t *volatile held = nullptr; // volatile: the compiler must not see the errors

void cause_failure(std::string_view p_word, const uint8_t *p_data, size_t p_size) {
	if (p_word == "overflow") {
		held = p_data + p_size;
		held = p_data + *held; // reads the byte after the input
	} else if (p_word == "undefined") {
		volatile int value = std::numeric_limits<int>::max();
		value = value + 1;
	} else if (p_word == "exception") {
		throw std::runtime_error("not the documented Error");
	} else if (p_word == "assertion") {
		GNOMON_ASSERT(p_size == 0, "asserted");
	} else if (p_word == "leak") {
		held = new uint8_t[1000];
		held = nullptr;
	} else if (p_word == "slow") {
		std::this_thread::sleep_for(std::chrono::hours(1));
	} else if (p_word == "large") {
		const volatile size_t size = size_t(3) << 30;
		held = std::make_unique<uint8_t[]>(size).get();
	} else {
		fail("Word \"", p_word, "\" is unknown, as documented.");
	}
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] { cause_failure(to_text(p_data, p_size), p_data, p_size); });
}
