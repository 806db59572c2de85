// Casters with so many edges that these are counted in several rounds.

#include "modules/shadow_edge_count/count_rounds.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// A screen of p_side x p_side squares that cover a quarter of it, in the plane y = 0.
std::shared_ptr<const Mesh> make_screen(uint32_t p_side, float p_size_m) {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	const float cell_m = p_size_m / float(p_side);
	for (uint32_t index = 0; index < p_side * p_side; ++index) {
		const glm::vec3 corner(cell_m * float(index % p_side) - 0.5f * p_size_m, 0.0f,
				cell_m * float(index / p_side) - 0.5f * p_size_m);
		const uint32_t first = uint32_t(positions.size());
		for (const auto &[x, z] :
				{ std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1) }) {
			positions.push_back(corner + 0.5f * cell_m * glm::vec3(x, 0, z));
		}
		for (const uint32_t offset : { 0u, 2u, 1u, 0u, 3u, 2u }) {
			indices.push_back(first + offset);
		}
	}
	return make_mesh("screen", std::move(positions), {}, std::move(indices));
}

} // namespace

TEST_CASE("[EdgeCount] there are rounds only if a subgroup can run out of iterations, and the "
		  "states between them take at most 4 MB") {
	const glm::uvec2 size_px(640, 360);
	const CountRoundLimits none = choose_round_limits(size_px, 8'000, { 8, 1, 1 });
	CHECK(none.round_count == 0);
	CHECK(none.slot_count == 0);
	for (const uint32_t subgroup_size : { 4u, 8u, 16u, 32u, 64u }) {
		for (const auto &[lanes, sets] :
				{ std::pair(1u, 1u), std::pair(1u, 4u), std::pair(4u, 1u) }) {
			for (const uint32_t edge_count : { 8'001u, 200'000u, 10'000'000u }) {
				CAPTURE(subgroup_size);
				CAPTURE(lanes);
				CAPTURE(sets);
				CAPTURE(edge_count);
				const CountRoundLimits limits =
						choose_round_limits(size_px, edge_count, { subgroup_size, lanes, sets });
				CHECK(limits.round_count >= 2);
				CHECK(limits.round_count <= 24);
				CHECK(limits.slot_count >= 1);
				CHECK(uint64_t(limits.slot_count) * subgroup_size * EDGE_COUNT_STATE_WORDS(sets) *
								4 <=
						4'000'000);
			}
		}
	}
	// A small image has a slot for each of its subgroups.
	CHECK(choose_round_limits({ 17, 9 }, 200'000, { 8, 1, 4 }).slot_count == 3 * 2 * 64 / 8);
	CHECK(choose_round_limits({ 17, 9 }, 200'000, { 32, 4, 1 }).slot_count == 3 * 2 * 64 * 4 / 32);
}

TEST_CASE("[GPU][EdgeCount] a receiver that sees the light behind 160,000 edges counts all of "
		  "them, as in double precision") {
	MaskFixture fixture;
	const auto screen = make_screen(200, 1.2f);
	for (const auto &[type, quality] : { std::pair(LightType::SPOT, "256"),
				 std::pair(LightType::DIRECTIONAL, "64"), std::pair(LightType::OMNI, "64") }) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		scene.box->surfaces.clear();
		add_mesh(scene.scene, "Screen", screen, { 0.45, 1.5, 0.3 });
		scene.camera->parent_from_node = look_at({ -0.3, 0.6, 0.4 }, { 0, 0, 0 });
		scene.light->properties["light_size"] = 2.0;
		scene.light->properties["light_angular_distance"] = 48.0;
		scene.light->properties["edge_count_quality"] = std::string(quality);
		const MaskResult frame =
				render_frame(fixture, scene, { .size_px = { 5, 4 }, .wants_surfaces = true });
		const MaskDifference difference =
				compare_masks(frame.visibility, count_in_double(scene, frame));
		CHECK(difference.penumbra_count == 20);
		CHECK(difference.maximum < 0.02);
	}
}

TEST_CASE("[GPU][EdgeCount] an error about too many triangles names the nodes with the most") {
	MaskFixture fixture;
	const auto screen = make_screen(300, 1.2f); // 180,000 triangles
	SmallScene scene(LightType::OMNI);
	for (int index = 0; index < 56; ++index) {
		add_mesh(scene.scene, text("Screen ", index), screen, { 0.45, 1.5 + 0.01 * index, 0.3 });
	}
	std::string message;
	try {
		render_frame(fixture, scene, { .size_px = { 16, 16 } });
	} catch (const Error &error) {
		message = error.what();
	}
	CAPTURE(message);
	CHECK(message.find("Light \"Light\": its casters have more than 10000000 ") == 0);
	CHECK(message.find("are of \"Screen 0\" and 55 other nodes with its mesh.") !=
			std::string::npos);
}
