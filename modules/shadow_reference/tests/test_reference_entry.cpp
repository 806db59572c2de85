#include "modules/shadow_reference/reference_entry.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

const uint64_t KEY = 42;

ReferenceVisibility make_reference() {
	ReferenceVisibility reference;
	reference.visibility = { 0.0f, 0.25f, 1.0f };
	reference.colors.assign(3, glm::vec3(0.5f, 1.0f, 0.0f));
	reference.standard_error = 0.125f;
	reference.penumbra_pixel_count = 1;
	return reference;
}

} // namespace

TEST_CASE("[ReferenceEntry] a built entry can be parsed again, with colours or without") {
	ReferenceVisibility reference = make_reference();
	const auto colored = parse_reference_entry(build_reference_entry(KEY, reference), KEY,
			/*p_pixel_count=*/3, /*p_is_colored=*/true);
	REQUIRE(colored);
	CHECK(colored->visibility == reference.visibility);
	CHECK(colored->colors == reference.colors);
	CHECK(colored->standard_error == reference.standard_error);
	CHECK(colored->penumbra_pixel_count == 1);
	reference.colors.clear();
	const auto plain = parse_reference_entry(build_reference_entry(KEY, reference), KEY,
			/*p_pixel_count=*/3, /*p_is_colored=*/false);
	REQUIRE(plain);
	CHECK(plain->colors.empty());
}

TEST_CASE("[ReferenceEntry] another key, another size and counts that wrap around are rejected") {
	const std::vector<uint8_t> bytes = build_reference_entry(KEY, make_reference());
	CHECK_FALSE(parse_reference_entry(bytes, KEY + 1, 3, true));
	CHECK_FALSE(parse_reference_entry(bytes, KEY, 3, /*p_is_colored=*/false));
	CHECK_FALSE(parse_reference_entry(bytes, KEY, 2, true));
	CHECK_FALSE(parse_reference_entry(std::span(bytes).first(bytes.size() - 1), KEY, 3, true));
	CHECK_FALSE(parse_reference_entry({}, KEY, 0, false));
	std::vector<uint8_t> wraps = build_reference_entry(KEY, ReferenceVisibility());
	// Highest byte of pixel_count: 2^62 pixels of 4 bytes are 0 bytes in 64 bits.
	wraps[23] = 0x40;
	CHECK_FALSE(parse_reference_entry(wraps, KEY, size_t(1) << 62, false));
}
