#include "shared/light_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

constexpr uint32_t SIZE_PX = 16;
constexpr float HALF_EXTENT_M = 4.0f; // so that a texel is half a metre
constexpr uint32_t BINDING_MAP = 3;

shader::LightViewConstants make_view() {
	shader::LightViewConstants view = {};
	view.view_from_camera_relative = glm::mat4(1.0f);
	view.half_extent = glm::vec2(HALF_EXTENT_M);
	view.far_m = 10.0f;
	view.depth_scale = 1.0f / view.far_m;
	view.size_px = glm::uvec2(SIZE_PX);
	view.is_orthographic = 1;
	return view;
}

/// Looks up receivers at w = 5 in a map whose texels have a caster at w = 9, nearer to the light,
/// or none. w is 10 at the light and 0 at the far plane. p_texels: positions in texels. p_width:
/// width of the filter in texels.
std::vector<glm::vec4> look_up(KernelFixture &r_fixture, const std::vector<bool> &p_is_hidden,
		const std::vector<glm::vec2> &p_texels, float p_width) {
	std::vector<float> depths;
	for (bool is_hidden : p_is_hidden) {
		depths.push_back(is_hidden ? 0.9f : 0.0f);
	}
	const OwnedTexture map(*r_fixture.device,
			r_fixture.device->create_texture_with_data({ .name = "map",
															   .format = Format::R32_SFLOAT,
															   .size_px = glm::uvec2(SIZE_PX),
															   .usage = TextureUsage::SAMPLED,
															   .is_array = true },
					bytes_of(std::span<const float>(depths))));
	const OwnedBuffer view = r_fixture.make_buffer(
			"view", std::vector<shader::LightViewConstants>{ make_view() }, BufferUsage::STORAGE);
	std::vector<glm::vec4> points;
	for (const glm::vec2 &texel : p_texels) {
		const glm::vec2 xy = (texel / float(SIZE_PX) * 2.0f - 1.0f) * HALF_EXTENT_M;
		points.push_back(glm::vec4(xy, 5.0f, p_width));
	}
	return r_fixture.run("map_lookup.comp", points, points.size(), 1,
			{ { KernelFixture::BINDING_CONSTANTS, view.get() }, { BINDING_MAP, map.get() } });
}

/// Length of the overlap of [p_low, p_low + p_width] and the texel, in texels.
double compute_overlap(double p_low, double p_width, int p_texel) {
	return std::max(
			0.0, std::min(p_low + p_width, p_texel + 1.0) - std::max(p_low, double(p_texel)));
}

/// Fraction of the filter's box around the position p_texel (in texels) that covers lit texels or
/// is outside the map. p_width: width of the box in texels.
double compute_reference(
		const std::vector<bool> &p_is_hidden, const glm::dvec2 &p_texel, double p_width) {
	const glm::dvec2 low = p_texel - 0.5 * p_width;
	double hidden = 0;
	for (int y = 0; y < int(SIZE_PX); ++y) {
		for (int x = 0; x < int(SIZE_PX); ++x) {
			if (p_is_hidden[size_t(y) * SIZE_PX + x]) {
				hidden += compute_overlap(low.x, p_width, x) * compute_overlap(low.y, p_width, y);
			}
		}
	}
	return 1 - hidden / (p_width * p_width);
}

} // namespace

TEST_CASE("[GPU][Shaders] a filtered lookup weights each texel by its area in the box") {
	KernelFixture fixture;
	TestRandom random;
	std::vector<bool> is_hidden;
	for (uint32_t index = 0; index < SIZE_PX * SIZE_PX; ++index) {
		is_hidden.push_back(random.next() < 0.5);
	}
	std::vector<glm::vec2> texels;
	for (int index = 0; index < 2000; ++index) { // beyond the borders too
		texels.push_back(glm::vec2(random.next(-4, 20), random.next(-4, 20)));
	}
	for (int index = 0; index < 16; ++index) { // texel centres and corners
		texels.push_back(glm::vec2(0.5f * float(index), 8.0f));
	}
	for (const float width : { 2.0f, 3.0f, 5.0f, 7.0f }) {
		CAPTURE(width);
		const std::vector<glm::vec4> results = look_up(fixture, is_hidden, texels, width);
		double largest_error = 0;
		for (size_t index = 0; index < texels.size(); ++index) {
			const double reference =
					compute_reference(is_hidden, glm::dvec2(texels[index]), double(width));
			largest_error = std::max(largest_error, std::abs(double(results[index].x) - reference));
		}
		CHECK(largest_error < 1e-5); // float32 rounding
	}
}

TEST_CASE("[GPU][Shaders] lookups are 1 on an empty map and beyond it, 0 on a full one") {
	KernelFixture fixture;
	const size_t texel_count = SIZE_PX * SIZE_PX;
	TestRandom random;
	std::vector<glm::vec2> inside;
	std::vector<glm::vec2> outside;
	for (int index = 0; index < 500; ++index) { // with all of the widest box, 7 texels
		inside.push_back(glm::vec2(random.next(4, 12), random.next(4, 12)));
		outside.push_back(glm::vec2(random.next(21, 40), random.next(-20, 40)));
	}
	for (const float width : { 2.0f, 3.0f, 5.0f, 7.0f }) {
		CAPTURE(width);
		const auto count_other = [&](bool p_is_hidden, const std::vector<glm::vec2> &p_texels,
										 float p_expected) {
			size_t count = 0;
			for (const glm::vec4 &result : look_up(
						 fixture, std::vector<bool>(texel_count, p_is_hidden), p_texels, width)) {
				count += std::abs(result.x - p_expected) > 1e-6f || result.y != p_expected;
			}
			return count;
		};
		CHECK(count_other(false, inside, 1.0f) == 0);
		CHECK(count_other(true, inside, 0.0f) == 0);
		CHECK(count_other(true, outside, 1.0f) == 0);
	}
}
