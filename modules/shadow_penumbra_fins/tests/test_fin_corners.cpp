// Compares fin corners computed on the GPU with double precision on the CPU: B' = B + r N,
// B'' = B - t N (Sun et al. 2010, section 2.1.1).

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

using namespace gnomon;

namespace {

// Corner encoding of fin_inc.glsl.
constexpr uint32_t FIN_OFFSET_MASK = 6;
constexpr uint32_t FIN_OUTSIDE = 2;
constexpr uint32_t FIN_INSIDE = 4;

/// The input of fin.comp for one corner.
struct FinCase {
	glm::vec4 position_corner; // position_node, corner
	glm::vec4 normal;		   // normal_node, normal_sign
	glm::vec4 widths;		   // r and t in metres, is orthographic
};

/// Computes a corner in clip space, with the light view (extent, depth range) of fin.comp.
glm::dvec4 compute_clip(const FinCase &p_case, const glm::dmat4 &p_view_from_node) {
	glm::dvec3 position =
			glm::dvec3(p_view_from_node * glm::dvec4(glm::dvec3(p_case.position_corner), 1.0));
	// The inverse transpose, which defines normals. fin_inc.glsl uses cofactors and corrects their
	// sign for mirrored transforms.
	const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(glm::dmat3(p_view_from_node)));
	const glm::dvec3 normal = glm::normalize(normal_matrix * glm::dvec3(p_case.normal));
	const uint32_t corner = static_cast<uint32_t>(p_case.position_corner.w);
	const uint32_t side = corner & FIN_OFFSET_MASK;
	position += side == FIN_OUTSIDE ? double(p_case.widths.x) * normal
			: side == FIN_INSIDE	? -double(p_case.widths.y) * normal
									: glm::dvec3(0.0);
	const glm::dvec2 xy = glm::dvec2(position) / glm::dvec2(0.5, 0.25);
	return p_case.widths.z > 0.5f ? glm::dvec4(xy, (10.0 - position.z) * 0.1, 1.0)
								  : glm::dvec4(xy, 0.001, position.z);
}

} // namespace

TEST_CASE("[GPU][PenumbraFins] corners of fins are where the paper puts them, under any "
		  "transform") {
	KernelFixture fixture;
	TestRandom random;
	const glm::dmat4 rotation =
			glm::rotate(glm::dmat4(1.0), 0.8, glm::normalize(glm::dvec3(1, -2, 0.5)));
	for (const glm::dvec3 scale : { glm::dvec3(1.0), glm::dvec3(3, 0.2, 1), glm::dvec3(-2, 1, 1),
				 glm::dvec3(1e-3), glm::dvec3(1e3) }) {
		CAPTURE(scale.x);
		const glm::dmat4 view_from_node =
				glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, -0.2, 5) * std::abs(scale.x)) *
				rotation * glm::scale(glm::dmat4(1.0), scale);
		std::vector<FinCase> cases;
		for (int item = 0; item < 300; ++item) {
			const float corner = float(item % 6);
			const glm::dvec3 position = random.next_unit() * random.next();
			cases.push_back({ glm::vec4(glm::vec3(position), corner),
					glm::vec4(glm::vec3(random.next_unit()),
							glm::determinant(glm::dmat3(view_from_node)) < 0 ? -1.0f : 1.0f),
					glm::vec4(0.3 * scale.z, 0.1 * scale.z, item % 2, 0) });
		}
		const std::vector<glm::mat4> constants = { glm::mat4(view_from_node) };
		std::vector<glm::vec4> input;
		for (const FinCase &fin : cases) {
			input.insert(input.end(), { fin.position_corner, fin.normal, fin.widths });
		}
		const auto results = fixture.run_with_constants(
				"fin.comp", constants[0], input, cases.size(), /*p_output_per_item=*/2);
		for (size_t item = 0; item < cases.size(); ++item) {
			const glm::dvec4 expected = compute_clip(cases[item], view_from_node);
			const double tolerance = 2e-6 * glm::length(expected); // 17 float32 epsilons
			CHECK(glm::length(glm::dvec4(results[2 * item]) - expected) < tolerance);
			const uint32_t corner = static_cast<uint32_t>(cases[item].position_corner.w);
			const uint32_t side = corner & FIN_OFFSET_MASK;
			const float theta = side == FIN_OUTSIDE ? 1.0f : side == FIN_INSIDE ? 0.0f : 0.5f;
			CHECK(results[2 * item + 1].x == theta);
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] with a zero normal, the fin's outer corner stays on the edge") {
	KernelFixture fixture;
	// Two FinCases with r = t = 5 m: the outer corner (2), and the one on the edge (0).
	const std::vector<glm::vec4> input = { { 1, 2, 3, 2 }, { 0, 0, 0, 1 }, { 5, 5, 0, 0 },
		{ 1, 2, 3, 0 }, { 0, 0, 0, 1 }, { 5, 5, 0, 0 } };
	const auto results = fixture.run_with_constants("fin.comp", glm::mat4(1.0f), input,
			/*p_item_count=*/2, /*p_output_per_item=*/2);
	CHECK(results[0] == results[2]);
}
