#include "modules/shadow_edge_count/tests/count_records.h"
#include "modules/shadow_edge_count/tests/count_scene.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

const glm::dvec3 UP(0.0, 1.0, 0.0);

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
	const shader::CountViewConstants constants = make_constants(p_scene);
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
			scene.add(make_box_mesh("box", glm::vec3(4.2, 0.2, 4.2)),
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
	scene.add(make_box_mesh("box", glm::vec3(4.2, 0.2, 4.2)),
			glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.2, 0.0)));
	for (int index = 0; index < 6; ++index) {
		const glm::dvec3 place(
				0.4 * std::cos(2.1 * index), 0.4 + 0.35 * index, 0.4 * std::sin(2.1 * index));
		scene.add(make_box_mesh("box", glm::vec3(0.4, 0.04, 0.35)),
				glm::rotate(glm::translate(glm::dmat4(1.0), place), 0.7 * index,
						glm::dvec3(0.2, 1.0, 0.1)));
	}
	scene.build();
	const Agreement agreement = compare(scene, fixture);
	CHECK(agreement.mean < 5e-4);
	CHECK(agreement.greatest < 0.05);  // one point of 64 more or less, in two layers
	CHECK(agreement.apart_count < 60); // of 2000: a point that lies on an edge
}

TEST_CASE("[GPU][EdgeCount] edges are classified as in double") {
	KernelFixture fixture;
	TestRandom random;
	for (const bool is_directional : { false, true }) {
		CAPTURE(is_directional);
		CountScene scene;
		scene.is_directional = is_directional;
		scene.radius = is_directional ? 0.07 : 0.4;
		scene.build();
		const CountSpace &space = scene.get_space();
		std::vector<glm::vec4> input;
		std::vector<std::vector<CountEdge>> expected;
		const size_t count = 4000;
		for (size_t index = 0; index < count; ++index) {
			// Two triangles with a common edge, the second one missing now and then; some reach
			// behind the light.
			glm::vec3 corners[4];
			for (glm::vec3 &corner : corners) {
				corner = glm::vec3(random.next(-2, 2), random.next(-2, 2), random.next(-1, 7));
			}
			const bool has_second = index % 5 != 0;
			std::vector<uint32_t> indices = { 0, 1, 2 };
			if (has_second) {
				indices.insert(indices.end(), { 1, 0, 3 });
			}
			const auto mesh =
					make_mesh("pair", { corners, corners + (has_second ? 4 : 3) }, {}, indices);
			MeshTopology topology = build_topology(*mesh);
			std::erase_if(topology.edges, [&](const MeshEdge &p_edge) {
				return (p_edge.face1 != NO_FACE) != has_second ||
						topology.welded_positions_node[p_edge.a] == corners[2] ||
						topology.welded_positions_node[p_edge.b] == corners[2];
			});
			REQUIRE(topology.edges.size() == 1);
			expected.emplace_back();
			add_count_edges(topology, glm::dmat4(1.0), space, expected.back());
			const bool is_reversed =
					topology.welded_positions_node[topology.edges[0].a] != corners[0];
			input.emplace_back(corners[0], has_second ? 1.0f : 0.0f);
			input.emplace_back(corners[1], is_reversed ? 1.0f : 0.0f);
			input.emplace_back(corners[2], 0.0f);
			input.emplace_back(corners[3], 0.0f);
		}
		const auto results = fixture.run_with_constants(
				"count_classify.comp", make_constants(scene), input, count, 5);
		size_t apart_count = 0;
		for (size_t index = 0; index < count; ++index) {
			const glm::vec4 *result = &results[5 * index];
			if ((result[4].x > 0.5f) != !expected[index].empty()) {
				++apart_count; // a light that touches a face's plane
				continue;
			}
			if (expected[index].empty()) {
				continue;
			}
			const CountEdge &edge = expected[index][0];
			const shader::CountEdgeRecord record = make_record(edge);
			CHECK(result[1].w == record.by_bw_weight_kind.w);
			CHECK(result[1].z == record.by_bw_weight_kind.z);
			// Near the light w is large: compared as shares.
			const float scale = 1.0f + float(std::max(std::abs(edge.a.z), std::abs(edge.b.z)));
			CHECK(glm::length(result[0] - record.a_bx) < 2e-3f * scale);
			CHECK(glm::length(result[1] - record.by_bw_weight_kind) < 2e-3f * scale);
			CHECK(glm::length(glm::vec3(result[2]) - glm::vec3(record.plane0)) < 1e-4f);
		}
		CHECK(apart_count <= 2);
	}
}
