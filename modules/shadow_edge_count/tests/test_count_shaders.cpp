#include "modules/shadow_edge_count/tests/count_scene.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

const glm::dvec3 UP(0.0, 1.0, 0.0);

shader::CountEdgeRecord make_record(const CountEdge &p_edge) {
	const int kind = (p_edge.has_face1 ? EDGE_COUNT_HAS_FACE1 : 0) |
			(p_edge.is_double_sided ? EDGE_COUNT_DOUBLE_SIDED : 0);
	shader::CountEdgeRecord record;
	record.a_bx = glm::vec4(glm::vec3(p_edge.a), float(p_edge.b.x));
	record.by_bw_d0_d1 = glm::vec4(p_edge.b.y, p_edge.b.z, p_edge.plane0.w, p_edge.plane1.w);
	record.normal0_weight = glm::vec4(glm::vec3(p_edge.plane0), float(p_edge.center_weight));
	record.normal1_kind = glm::vec4(glm::vec3(p_edge.plane1), float(kind));
	return record;
}

/// The layer map as the shaders read it.
struct LayerArrays {
	std::vector<glm::uvec2> texels;
	std::vector<glm::vec2> fragments;

	explicit LayerArrays(const LayerMap &p_layers) {
		const glm::ivec2 size_px(p_layers.get_size_px());
		for (int y = 0; y < size_px.y; ++y) {
			for (int x = 0; x < size_px.x; ++x) {
				const auto &list = p_layers.get_fragments({ x, y });
				const uint32_t buried = p_layers.is_buried({ x, y }) ? 0x80000000u : 0u;
				texels.emplace_back(uint32_t(fragments.size()), uint32_t(list.size()) | buried);
				for (const LayerFragment &fragment : list) {
					fragments.emplace_back(float(fragment.w),
							fragment.is_double_sided   ? 2.0f
									: fragment.is_away ? 1.0f
													   : 0.0f);
				}
			}
		}
		fragments.emplace_back(0.0f, 0.0f); // never empty
	}
};

struct Agreement {
	double mean = 0;
	double greatest = 0;
	size_t apart_count = 0; // by more than 1e-3
};

/// Receivers on the ground, counted by the shader and in double.
Agreement compare(const CountScene &p_scene, KernelFixture &r_fixture) {
	const CountSpace &space = p_scene.get_space();
	shader::CountViewConstants constants = {};
	constants.disc_radius = float(space.disc_radius);
	constants.depth_scale_m = float(space.get_depth_scale(0));
	constants.depth_far_m = float(space.depth_far_m);
	constants.scene_size_m = float(space.scene_size_m);
	constants.half_extent = glm::vec2(float(p_scene.half_extent));
	constants.map_size_px = p_scene.get_layers().get_size_px();
	constants.is_directional = space.is_directional ? 1 : 0;
	std::vector<shader::CountEdgeRecord> records;
	for (const CountEdge &edge : p_scene.get_edges()) {
		records.push_back(make_record(edge));
	}
	const LayerArrays layers(p_scene.get_layers());
	std::vector<glm::vec4> input;
	std::vector<CountReceiver> receivers;
	TestRandom random;
	const size_t count = 2000;
	for (size_t index = 0; index < count; ++index) {
		const glm::dvec3 place(random.next(-1.6, 1.4), 0.0, random.next(-1.5, 1.3));
		CountReceiver receiver = p_scene.make_receiver(place, UP);
		// What float32 can hold is the question to both.
		receiver.r = glm::dvec3(glm::vec3(receiver.r));
		receiver.normal = glm::dvec3(glm::vec3(receiver.normal));
		receivers.push_back(receiver);
		input.emplace_back(glm::vec3(receiver.r), 0.0f);
		input.emplace_back(glm::vec3(receiver.normal), 0.0f);
	}
	const OwnedBuffer view = r_fixture.make_buffer(
			"view", std::vector<shader::CountViewConstants>{ constants }, BufferUsage::UNIFORM);
	const OwnedBuffer edges = r_fixture.make_buffer("edges", records);
	const OwnedBuffer texels = r_fixture.make_buffer("texels", layers.texels);
	const OwnedBuffer fragments = r_fixture.make_buffer("fragments", layers.fragments);
	const OwnedBuffer masks = r_fixture.make_buffer("masks", p_scene.get_masks()[0].get_table());
	const auto results = r_fixture.run("count_receiver.comp", input, count, 1,
			{ { 2, view.get() }, { 3, edges.get() }, { 4, texels.get() }, { 5, fragments.get() },
					{ 6, masks.get() } });
	Agreement agreement;
	for (size_t index = 0; index < count; ++index) {
		const double expected = p_scene.count(receivers[index]);
		const double difference = std::abs(results[index].x - expected);
		REQUIRE(results[index].x >= 0.0f);
		REQUIRE(results[index].x <= 1.0f);
		agreement.mean += difference / count;
		agreement.greatest = std::max(agreement.greatest, difference);
		agreement.apart_count += difference > 1e-3 ? 1 : 0;
	}
	return agreement;
}

} // namespace

TEST_CASE("[GPU][EdgeCount] the shader counts as double does where one solid hides the light") {
	KernelFixture fixture;
	for (const bool is_directional : { false, true }) {
		for (const double radius : { 0.0, 0.02, 0.1, 0.3 }) { // of S, or a tangent
			CAPTURE(is_directional);
			CAPTURE(radius);
			CountScene scene;
			scene.radius = is_directional ? radius : radius * scene.scene_size;
			scene.is_directional = is_directional;
			scene.half_extent = is_directional ? 6.0 : 0.95;
			scene.map_size = 128;
			scene.add(make_count_box({ 4.2, 0.2, 4.2 }),
					glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.2, 0.0)));
			scene.add(make_count_sphere(0.8, 8),
					glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 1.3, 0.0)));
			scene.build();
			const Agreement agreement = compare(scene, fixture);
			CHECK(agreement.mean < 5e-5);
			CHECK(agreement.apart_count <= 2); // on an outline, where rounding decides
		}
	}
}

TEST_CASE("[GPU][EdgeCount] the shader counts as double does where solids overlap") {
	KernelFixture fixture;
	CountScene scene;
	scene.map_size = 128;
	scene.add(make_count_box({ 4.2, 0.2, 4.2 }),
			glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.2, 0.0)));
	for (int index = 0; index < 6; ++index) {
		const glm::dvec3 place(
				0.4 * std::cos(2.1 * index), 0.4 + 0.35 * index, 0.4 * std::sin(2.1 * index));
		scene.add(make_count_box({ 0.4, 0.04, 0.35 }),
				glm::rotate(glm::translate(glm::dmat4(1.0), place), 0.7 * index,
						glm::dvec3(0.2, 1.0, 0.1)));
	}
	scene.build();
	const Agreement agreement = compare(scene, fixture);
	CHECK(agreement.mean < 5e-4);
	CHECK(agreement.greatest < 0.05);  // one point of 64 more or less, in two layers
	CHECK(agreement.apart_count < 60); // of 2000: a point that lies on an edge
}
