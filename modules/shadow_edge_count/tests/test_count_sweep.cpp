// Numbers of faces by a sweep from another receiver, and along a receiver's own way through the
// tree of faces, compared with a test of every face.

#include "modules/shadow_edge_count/count_buffers.h"
#include "modules/shadow_edge_count/tests/count_records.h"
#include "modules/shadow_edge_count/tests/count_scene.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Nodes of a tree over faces: level 0 from the faces, each other one from the level below.
std::vector<shader::CountNode> make_face_nodes(
		const std::vector<shader::CountFaceRecord> &p_faces, const CountTrees &p_trees) {
	const float FAR = 3e38f;
	std::vector<shader::CountNode> nodes(p_trees.node_count);
	std::vector<std::pair<glm::vec3, glm::vec3>> below; // minimum and maximum
	for (const shader::CountFaceRecord &face : p_faces) {
		glm::vec3 minimum(FAR);
		glm::vec3 maximum(-FAR);
		for (const glm::uvec4 &words :
				{ face.a_kind, face.b_first_distance, face.c_end_distance }) {
			const glm::vec3 corner(std::bit_cast<float>(words.x), std::bit_cast<float>(words.y),
					std::bit_cast<float>(words.z));
			minimum = glm::min(minimum, corner);
			maximum = glm::max(maximum, corner);
		}
		below.emplace_back(minimum, maximum);
	}
	for (uint32_t level = 0; level < EDGE_COUNT_MAX_LEVELS; ++level) {
		const size_t width = level == 0 ? EDGE_COUNT_CLUSTER_SIZE : EDGE_COUNT_NODE_WIDTH;
		std::vector<std::pair<glm::vec3, glm::vec3>> bounds;
		for (size_t first = 0; first < below.size(); first += width) {
			auto joined = below[first];
			for (size_t i = first; i < std::min(first + width, below.size()); ++i) {
				joined.first = glm::min(joined.first, below[i].first);
				joined.second = glm::max(joined.second, below[i].second);
			}
			nodes[p_trees.face_levels[level] + bounds.size()] = {
				glm::vec4(0.5f * (joined.first + joined.second), -FAR),
				glm::vec4(0.50005f * (joined.second - joined.first) + 1e-6f, FAR)
			};
			bounds.push_back(joined);
		}
		below = std::move(bounds);
	}
	return nodes;
}

/// Runs count_sweep.comp.
std::vector<glm::vec4> sweep(KernelFixture &r_fixture, const CountScene &p_scene,
		const std::vector<glm::vec4> &p_pairs) {
	CountArrays arrays(p_scene);
	// Edges have planes of their own after those of the faces: faces without area belong to them.
	arrays.faces.resize(arrays.planes.size());
	arrays.light.face_count = uint32_t(arrays.faces.size());
	arrays.light.max_edge_count = uint32_t(arrays.edges.size());
	const CountTrees trees = lay_out_trees({ .face_count = arrays.light.face_count });
	for (uint32_t level = 0; level < EDGE_COUNT_MAX_LEVELS; ++level) {
		arrays.light.face_levels[level / 4][int(level % 4)] = trees.face_levels[level];
	}
	for (size_t face = p_scene.get_faces().size(); face < arrays.planes.size(); ++face) {
		arrays.faces[face] = arrays.faces[0];
		arrays.faces[face].b_first_distance = arrays.faces[0].a_kind;
		arrays.faces[face].c_end_distance = arrays.faces[0].a_kind;
	}
	const BufferUsage fetched = BufferUsage::TEXEL; // the kernel has no variant for storage buffers
	const OwnedBuffer light = r_fixture.make_buffer("light",
			std::vector<shader::CountLightConstants>{ arrays.light }, BufferUsage::STORAGE);
	const OwnedBuffer edges =
			r_fixture.make_buffer("edges", arrays.edges, fetched, Format::RGBA32_UINT);
	const OwnedBuffer faces =
			r_fixture.make_buffer("faces", arrays.faces, fetched, Format::RGBA32_UINT);
	const OwnedBuffer planes =
			r_fixture.make_buffer("planes", arrays.planes, fetched, Format::RGBA32_SFLOAT);
	const OwnedBuffer nodes = r_fixture.make_buffer(
			"nodes", make_face_nodes(arrays.faces, trees), fetched, Format::RGBA32_SFLOAT);
	std::vector<uint32_t> totals(EDGE_COUNT_TOTAL_COUNT);
	totals[EDGE_COUNT_TOTAL_EDGES] = uint32_t(arrays.edges.size());
	const OwnedBuffer totals_buffer = r_fixture.make_buffer("totals", totals, BufferUsage::STORAGE);
	const OwnedBuffer cut_faces =
			r_fixture.make_buffer("cut faces", std::vector<uint32_t>(1), fetched, Format::R32_UINT);
	return r_fixture.run("count_sweep.comp", p_pairs, p_pairs.size() / 2, 1,
			{ { COUNT_BINDING_LIGHT, light.get() }, { COUNT_BINDING_EDGES, edges.get() },
					{ COUNT_BINDING_FACES, faces.get() }, { COUNT_BINDING_PLANES, planes.get() },
					{ COUNT_BINDING_NODES, nodes.get() },
					{ COUNT_BINDING_CUT_FACES, cut_faces.get() },
					{ COUNT_BINDING_TOTALS, totals_buffer.get() } },
			arrays.pipeline_constants);
}

/// Closed meshes that pierce each other, an open one, and two sheets that share no vertex.
CountScene make_swept_scene(bool p_is_directional, double p_scale, TestRandom &r_random) {
	CountScene scene;
	scene.is_directional = p_is_directional;
	scene.light *= p_scale;
	scene.target *= p_scale;
	scene.scene_size *= p_scale;
	scene.radius = p_is_directional ? 0.05 : 0.1 * p_scale;
	const auto make_transform = [&]() {
		const glm::dvec3 position(
				r_random.next(-0.8, 0.8), r_random.next(0.2, 2.0), r_random.next(-0.8, 0.8));
		return glm::scale(glm::rotate(glm::translate(glm::dmat4(1.0), p_scale * position),
								  r_random.next(0.0, 6.28), r_random.next_unit()),
				glm::dvec3(p_scale));
	};
	scene.add(make_box_mesh("ground", glm::vec3(4.2, 0.2, 4.2)),
			glm::scale(glm::dmat4(1.0), glm::dvec3(p_scale)));
	scene.add(make_box_mesh("box", glm::vec3(0.5, 0.3, 0.4)), make_transform());
	scene.add(make_box_mesh("bar", glm::vec3(0.05, 0.9, 0.05)), make_transform());
	scene.add(make_count_sphere(0.6, 12), make_transform());
	for (int sheet = 0; sheet < 2; ++sheet) {
		scene.add(make_mesh("quad",
						  { { -0.5f, 0, -0.4f }, { 0.5f, 0, -0.4f }, { 0.5f, 0.1f, 0.4f },
								  { -0.5f, 0, 0.4f } },
						  {}, { 0, 1, 2, 0, 2, 3 }),
				make_transform());
	}
	scene.build();
	return scene;
}

} // namespace

TEST_CASE("[GPU][EdgeCount] numbers of faces that a sweep decides are those of a test of every "
		  "face") {
	KernelFixture fixture;
	TestRandom random;
	size_t pair_count = 0;
	size_t changed_count = 0; // receivers with faces on their way
	size_t undecided_count = 0;
	for (const bool is_directional : { false, true }) {
		for (const double scale : { 1e-3, 1.0, 1e3 }) {
			for (int repetition = 0; repetition < 4; ++repetition) {
				CAPTURE(is_directional);
				CAPTURE(scale);
				const CountScene scene = make_swept_scene(is_directional, scale, random);
				std::vector<glm::vec4> pairs;
				for (int pair = 0; pair < 2000; ++pair) {
					// From the size of a pixel to that of the scene; also inside of solids.
					const double distance = std::pow(10.0, random.next(-4.0, 0.3));
					const glm::dvec3 anchor(
							random.next(-1.5, 1.5), random.next(-0.1, 2.5), random.next(-1.5, 1.5));
					const glm::dvec3 receiver = anchor + distance * random.next_unit();
					for (const glm::dvec3 &position : { anchor, receiver }) {
						pairs.emplace_back(glm::vec3(scene.make_receiver(scale * position, {})),
								float(scene.get_faces().size()));
					}
				}
				size_t wrong_count = 0;
				size_t wrong_ray_count = 0;
				for (const glm::vec4 &result : sweep(fixture, scene, pairs)) {
					++pair_count;
					changed_count += result.z > 0.0f ? 1 : 0;
					undecided_count += result.y > 0.0f ? 1 : 0;
					wrong_count += result.y == 0.0f && result.x > 0.0f ? 1 : 0;
					wrong_ray_count += result.w > 0.0f ? 1 : 0;
				}
				CHECK(wrong_count == 0);
				CHECK(wrong_ray_count == 0);
			}
		}
	}
	CHECK(changed_count > pair_count / 5);
	CHECK(undecided_count < pair_count / 100);
	CHECK(undecided_count > 0); // some are so close that rounding may decide
}
