#include "modules/shadow_reference/truth_entry.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

const uint64_t KEY = 42;

Truth make_truth() {
	Truth truth;
	truth.visibility = { 0.0f, 0.25f, 1.0f };
	truth.colors.assign(3, glm::vec3(0.5f, 1.0f, 0.0f));
	truth.standard_error = 0.125f;
	truth.penumbra_pixel_count = 1;
	return truth;
}

} // namespace

TEST_CASE("[TruthEntry] a truth comes back as it was, with colours and without") {
	Truth truth = make_truth();
	const auto colored = parse_truth_entry(build_truth_entry(KEY, truth), KEY, 3, true);
	REQUIRE(colored);
	CHECK(colored->visibility == truth.visibility);
	CHECK(colored->colors == truth.colors);
	CHECK(colored->standard_error == truth.standard_error);
	CHECK(colored->penumbra_pixel_count == 1);
	truth.colors.clear();
	const auto plain = parse_truth_entry(build_truth_entry(KEY, truth), KEY, 3, false);
	REQUIRE(plain);
	CHECK(plain->colors.empty());
}

TEST_CASE("[TruthEntry] another key, another size and counts that wrap around are nothing") {
	const std::vector<uint8_t> bytes = build_truth_entry(KEY, make_truth());
	CHECK_FALSE(parse_truth_entry(bytes, KEY + 1, 3, true));
	CHECK_FALSE(parse_truth_entry(bytes, KEY, 3, false));
	CHECK_FALSE(parse_truth_entry(bytes, KEY, 2, true));
	CHECK_FALSE(parse_truth_entry(std::span(bytes).first(bytes.size() - 1), KEY, 3, true));
	CHECK_FALSE(parse_truth_entry({}, KEY, 0, false));
	std::vector<uint8_t> wraps = build_truth_entry(KEY, Truth());
	wraps[23] = 0x40; // 2^62 pixels of 4 bytes: 0 bytes in 64 bits
	CHECK_FALSE(parse_truth_entry(wraps, KEY, size_t(1) << 62, false));
}
