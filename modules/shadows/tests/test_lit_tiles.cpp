// The tiles of pixels that a light may reach: they contain all receivers, and few others.

#include "modules/shadows/tests/each_technique.h"

#include "shared/lit_tiles_shared.h"

#include <cstring>
#include <set>

using namespace gnomon;

namespace {

constexpr glm::uvec2 TILED_SIZE_PX(203, 149); // no multiple of a tile
constexpr uint32_t COLUMNS = (TILED_SIZE_PX.x + LIT_TILE_PX - 1) / LIT_TILE_PX;
constexpr uint32_t ROWS = (TILED_SIZE_PX.y + LIT_TILE_PX - 1) / LIT_TILE_PX;

struct TileResult {
	std::vector<uint8_t> receivers; // per pixel, above 0: a receiver
	std::vector<uint32_t> tiles;	// in the order of the list

	/// The number of tiles with at least one receiver.
	size_t count_needed() const {
		std::set<uint32_t> needed;
		for (uint32_t pixel = 0; pixel < receivers.size(); ++pixel) {
			if (receivers[pixel] > 0) {
				needed.insert(pixel / TILED_SIZE_PX.x / LIT_TILE_PX * COLUMNS +
						pixel % TILED_SIZE_PX.x / LIT_TILE_PX);
			}
		}
		return needed.size();
	}
};

TileResult find_tiles(MaskFixture &r_fixture, const SmallScene &p_scene, bool p_may_skip) {
	const std::shared_ptr<const SceneSnapshot> scene = p_scene.snap();
	TileResult result;
	std::vector<uint8_t> words;
	RenderGraph graph(*r_fixture.device, *r_fixture.transients);
	FramePlan plan;
	ShadowFrame frame(*r_fixture.shadows, graph, plan, scene, TILED_SIZE_PX,
			{ .technique_override = ShadowRegistry::find_default()->id, .may_skip = p_may_skip });
	frame.set_surfaces(add_surface_pass(
			graph, *r_fixture.shadows, *scene, TILED_SIZE_PX, frame.get_constants()));
	const LightShadow shadow = frame.add_light(scene->lights.front());
	add_readback(graph, shadow.receivers, result.receivers);
	graph.add_pass("read tiles")
			.reads(shadow.tiles.tiles, Access::COPY_READ)
			.keep()
			.execute([&](PassContext &p_context) {
				p_context.get_device().read_back(
						p_context.get(shadow.tiles.tiles), [&](std::span<const uint8_t> p_bytes) {
							words.assign(p_bytes.begin(), p_bytes.end());
						});
			});
	graph.execute(RenderGraph::Mode::WAIT);
	frame.end();
	REQUIRE(words.size() == (LIT_TILES_FIRST + COLUMNS * ROWS) * sizeof(uint32_t));
	uint32_t count = 0;
	std::memcpy(&count, words.data() + LIT_TILES_COUNT * sizeof(uint32_t), sizeof(count));
	REQUIRE(count <= COLUMNS * ROWS);
	result.tiles.resize(count);
	std::memcpy(result.tiles.data(), words.data() + LIT_TILES_FIRST * sizeof(uint32_t),
			count * sizeof(uint32_t));
	return result;
}

} // namespace

TEST_CASE("[GPU][Shadows] the tiles of a light contain all its receivers, and few others") {
	MaskFixture fixture;
	struct Case {
		const char *name;
		LightType type;
		double range_m; // 0: unlimited
		double cone_rad;
		glm::dvec3 from;
		double most_unneeded; // tiles, as a fraction of those with a receiver
	};
	const Case cases[] = {
		{ "sun", LightType::DIRECTIONAL, 0, 0.8, { 1.2, 4, 0.8 }, 0.15 },
		{ "unlimited", LightType::OMNI, 0, 0.8, { 1.2, 4, 0.8 }, 0.15 },
		{ "small range", LightType::OMNI, 0.7, 0.8, { 0.9, 0.4, 0.9 }, 3.0 },
		{ "inside the box", LightType::OMNI, 1.5, 0.8, { 0, 1, 0 }, 2.0 },
		{ "reaches nothing", LightType::OMNI, 0.5, 0.8, { 0, 9, 0 }, 0 },
		{ "narrow", LightType::SPOT, 0, 0.1, { 1.2, 4, 0.8 }, 1.2 },
		{ "half space", LightType::SPOT, 0, 1.5707, { 1.2, 4, 0.8 }, 0.15 },
		{ "wide and near", LightType::SPOT, 1.2, 1.2, { 0.9, 0.9, 0.9 }, 1.0 },
		{ "behind the camera", LightType::SPOT, 0, 0.3, { -4, 5, 5 }, 0.4 },
	};
	for (const Case &test : cases) {
		for (const double scale : { 0.001, 1.0, 1000.0 }) {
			CAPTURE(std::string(test.name));
			CAPTURE(scale);
			SmallScene scene(test.type, scale, glm::dvec3(20, -7, 3) * scale);
			const glm::dvec3 origin = glm::dvec3(20, -7, 3) * scale;
			scene.light->range_m = static_cast<float>(test.range_m * scale);
			scene.light->outer_cone_rad = static_cast<float>(test.cone_rad);
			scene.light->parent_from_node =
					look_at(origin + scale * test.from, origin + scale * glm::dvec3(0, 0.3, 0));
			const TileResult all = find_tiles(fixture, scene, /*p_may_skip=*/false);
			const TileResult some = find_tiles(fixture, scene, /*p_may_skip=*/true);
			CHECK(all.tiles.size() == COLUMNS * ROWS);
			CHECK(all.receivers == some.receivers);
			CHECK(std::set<uint32_t>(some.tiles.begin(), some.tiles.end()).size() ==
					some.tiles.size());
			const double needed = static_cast<double>(all.count_needed());
			CHECK(static_cast<double>(some.tiles.size()) <= (1.0 + test.most_unneeded) * needed);
		}
	}
}
