// The passes that find the faces and edges of a light's casters, compared with CountedCasters of
// count_in_double.h, which finds them in double precision.

#include "modules/shadow_edge_count/count_mesh.h"
#include "modules/shadow_edge_count/tests/count_records.h"
#include "modules/shadow_edge_count/tests/count_scene.h"
#include "modules/shadows/fetched_buffers.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <bit>
#include <cstring>
#include <map>
#include <tuple>

using namespace gnomon;

namespace {

/// One mesh in light space, and the buffers that the passes read.
struct Caster {
	std::shared_ptr<const MeshTopology> topology;
	glm::dmat4 light_from_node;
	CountMesh mesh;
	shader::CountCasterPush push;
	OwnedBuffer positions;
	OwnedBuffer faces;
	OwnedBuffer edges;
	OwnedBuffer source_parts;
};

/// Results of the passes, in light space.
struct Found {
	std::vector<shader::CountEdgeRecord> edges;
	std::vector<shader::CountFaceRecord> faces;
	std::vector<glm::vec4> planes;
};

/// Runs the passes over all casters and reads back their results.
Found find_edges(
		KernelFixture &r_fixture, std::vector<Caster> &r_casters, const CountSpace &p_space) {
	const BufferUsage fetched = get_fetched_usage(*r_fixture.device);
	uint32_t face_count = 0;
	uint32_t word_count = 0;
	uint32_t block_count = 0;
	uint32_t edge_count = 0;
	for (Caster &caster : r_casters) {
		caster.mesh = build_count_mesh(*caster.topology);
		const bool is_mirrored = glm::determinant(glm::dmat3(caster.light_from_node)) < 0;
		const bool is_last = &caster == &r_casters.back();
		caster.push = { glm::mat4(caster.light_from_node), uint32_t(caster.mesh.faces.size()),
			face_count, uint32_t(caster.mesh.edges.size()), word_count, block_count,
			(is_mirrored ? EDGE_COUNT_CASTER_MIRRORED : 0u) |
					(is_last ? EDGE_COUNT_CASTER_LAST : 0u) |
					(p_space.is_directional ? EDGE_COUNT_CASTER_DIRECTIONAL : 0u),
			float(p_space.disc_radius),
			// SIDE_TOLERANCE_COSINE and SIDE_TOLERANCE_SIZES of count_casters.cpp.
			p_space.is_directional ? 1e-6f : float(2.5e-7 * p_space.scene_size_m) };
		std::vector<glm::vec4> positions;
		for (const glm::vec3 &position : caster.topology->welded_positions_node) {
			positions.emplace_back(position, 1.0f);
		}
		caster.positions =
				r_fixture.make_buffer("positions", positions, fetched, Format::RGBA32_SFLOAT);
		caster.faces = r_fixture.make_buffer(
				"mesh faces", caster.mesh.faces, fetched, Format::RGBA32_UINT);
		caster.edges =
				r_fixture.make_buffer("edges", caster.mesh.edges, fetched, Format::RGBA32_UINT);
		caster.source_parts = r_fixture.make_buffer(
				"source parts", caster.mesh.source_parts, fetched, Format::RGBA32_SFLOAT);
		face_count += caster.push.face_count;
		edge_count += caster.push.edge_count;
		word_count += caster.mesh.get_word_count();
		block_count += caster.mesh.get_block_count();
	}
	const OwnedBuffer planes = r_fixture.make_buffer("planes", std::vector<glm::vec4>(face_count),
			fetched | BufferUsage::COPY_SOURCE, Format::RGBA32_SFLOAT);
	const OwnedBuffer faces =
			r_fixture.make_buffer("faces", std::vector<shader::CountFaceRecord>(face_count),
					BufferUsage::STORAGE | BufferUsage::COPY_SOURCE);
	const OwnedBuffer planes_readback = r_fixture.make_readback(face_count * sizeof(glm::vec4));
	const OwnedBuffer faces_readback =
			r_fixture.make_readback(face_count * sizeof(shader::CountFaceRecord));
	const OwnedBuffer words =
			r_fixture.make_buffer("words", std::vector<uint32_t>(word_count), fetched);
	const OwnedBuffer blocks = r_fixture.make_buffer(
			"blocks", std::vector<uint32_t>(block_count), fetched | BufferUsage::COPY_SOURCE);
	const uint64_t list_bytes = edge_count * sizeof(shader::CountEdgeRecord);
	const OwnedBuffer list(*r_fixture.device,
			r_fixture.device->create_buffer({ .name = "list",
					.size_bytes = list_bytes,
					.usage = BufferUsage::STORAGE | BufferUsage::COPY_SOURCE }));
	const OwnedBuffer totals =
			r_fixture.make_buffer("totals", std::vector<uint32_t>(EDGE_COUNT_TOTAL_COUNT),
					BufferUsage::STORAGE | BufferUsage::COPY_SOURCE);
	const OwnedBuffer totals_readback =
			r_fixture.make_readback(EDGE_COUNT_TOTAL_COUNT * sizeof(uint32_t));
	const OwnedBuffer list_readback = r_fixture.make_readback(list_bytes);
	const OwnedBuffer blocks_readback = r_fixture.make_readback(block_count * sizeof(uint32_t));

	CommandList &commands = r_fixture.device->begin_commands();
	const auto wait = [&](const OwnedBuffer &p_buffer, Access p_after) {
		const Barrier barrier = {
			.buffer = p_buffer.get(), .before = Access::SHADER_WRITE_COMPUTE, .after = p_after
		};
		commands.barriers({ &barrier, 1 });
	};
	const auto run = [&](const char *p_shader, uint32_t p_items(const Caster &), auto p_bind) {
		const std::string shader = choose_fetching_shader(*r_fixture.device, p_shader);
		commands.bind_pipeline(
				r_fixture.device->get_compute_pipeline({ .name = shader, .shader = shader }));
		for (const Caster &caster : r_casters) {
			p_bind(caster);
			commands.push_constants(caster.push);
			commands.dispatch_items({ p_items(caster), 1, 1 });
		}
	};
	const auto count_words = [](const Caster &p_caster) { return p_caster.mesh.get_word_count(); };
	run(
			"shadow_edge_count/caster_faces.comp",
			[](const Caster &p_caster) { return p_caster.push.face_count; },
			[&](const Caster &p_caster) {
				commands.bind_resources({ { FIND_BINDING_POSITIONS, p_caster.positions.get() },
						{ FIND_BINDING_MESH_FACES, p_caster.faces.get() },
						{ FIND_BINDING_SOURCE_PARTS, p_caster.source_parts.get() },
						{ FIND_BINDING_PLANES, planes.get() },
						{ FIND_BINDING_FACES, faces.get() } });
			});
	wait(planes, Access::SHADER_READ_COMPUTE);
	run("shadow_edge_count/mark_edges.comp", count_words, [&](const Caster &p_caster) {
		commands.bind_resources({ { FIND_BINDING_POSITIONS, p_caster.positions.get() },
				{ FIND_BINDING_MESH_EDGES, p_caster.edges.get() },
				{ FIND_BINDING_PLANES, planes.get() }, { FIND_BINDING_WORDS, words.get() },
				{ FIND_BINDING_BLOCKS, blocks.get() } });
	});
	wait(words, Access::SHADER_READ_COMPUTE);
	wait(blocks, Access::SHADER_READ_COMPUTE);
	run("shadow_edge_count/list_edges.comp", count_words, [&](const Caster &p_caster) {
		commands.bind_resources({ { FIND_BINDING_POSITIONS, p_caster.positions.get() },
				{ FIND_BINDING_MESH_EDGES, p_caster.edges.get() },
				{ FIND_BINDING_WORDS, words.get() }, { FIND_BINDING_BLOCKS, blocks.get() },
				{ FIND_BINDING_EDGES, list.get() }, { FIND_BINDING_TOTALS, totals.get() } });
	});
	wait(faces, Access::COPY_READ);
	commands.copy_buffer(
			faces.get(), faces_readback.get(), face_count * sizeof(shader::CountFaceRecord));
	const Barrier planes_barrier = {
		.buffer = planes.get(), .before = Access::SHADER_READ_COMPUTE, .after = Access::COPY_READ
	};
	commands.barriers({ &planes_barrier, 1 });
	commands.copy_buffer(planes.get(), planes_readback.get(), face_count * sizeof(glm::vec4));
	wait(list, Access::COPY_READ);
	wait(totals, Access::COPY_READ);
	wait(blocks, Access::COPY_READ);
	commands.copy_buffer(list.get(), list_readback.get(), list_bytes);
	commands.copy_buffer(
			totals.get(), totals_readback.get(), EDGE_COUNT_TOTAL_COUNT * sizeof(uint32_t));
	commands.copy_buffer(blocks.get(), blocks_readback.get(), block_count * sizeof(uint32_t));
	r_fixture.device->submit_commands(RenderingDevice::SubmitMode::WAIT);
	uint32_t found_count = 0;
	for (const uint32_t count : r_fixture.read<uint32_t>(blocks_readback, block_count)) {
		found_count += count;
	}
	CHECK(r_fixture.read<uint32_t>(
				  totals_readback, EDGE_COUNT_TOTAL_COUNT)[EDGE_COUNT_TOTAL_EDGES] == found_count);
	Found found = { r_fixture.read<shader::CountEdgeRecord>(list_readback, edge_count),
		r_fixture.read<shader::CountFaceRecord>(faces_readback, face_count),
		r_fixture.read<glm::vec4>(planes_readback, face_count) };
	found.edges.resize(found_count);
	return found;
}

/// The caster's topology with its edges in the order of CountMesh.
MeshTopology reorder(const Caster &p_caster) {
	const auto make_key = [](const auto &p_edge) {
		return std::tuple(p_edge.a, p_edge.b, p_edge.face0, p_edge.face1);
	};
	std::map<std::tuple<uint32_t, uint32_t, uint32_t, uint32_t>, MeshEdge> edges;
	for (const MeshEdge &edge : p_caster.topology->edges) {
		edges[make_key(edge)] = edge;
	}
	MeshTopology topology = *p_caster.topology;
	topology.edges.clear();
	for (shader::CountMeshEdge edge : p_caster.mesh.edges) {
		edge.face0 &= EDGE_COUNT_FACE_MASK;
		topology.edges.push_back(edges.at(make_key(edge)));
	}
	return topology;
}

} // namespace

TEST_CASE("[GPU][EdgeCount] faces and edges of all casters match the double version, in order") {
	KernelFixture fixture;
	for (const bool is_directional : { false, true }) {
		for (const double radius : { 0.02, 0.3 }) {
			CAPTURE(is_directional);
			CAPTURE(radius);
			CountScene scene;
			scene.is_directional = is_directional;
			scene.radius = radius;
			scene.build();
			const auto make_transform = [](double p_angle_rad, double p_scale) {
				glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), glm::dvec3(0.31, -0.23, 4.1));
				matrix = glm::rotate(matrix, p_angle_rad, glm::dvec3(0.3, 0.7, -0.2));
				return glm::scale(matrix, glm::dvec3(p_scale, 1.0, 1.0));
			};
			const std::shared_ptr<const Mesh> quad = make_mesh("quad",
					{ { -0.5f, 0, -0.4f }, { 0.5f, 0, -0.4f }, { 0.5f, 0.1f, 0.4f },
							{ -0.5f, 0, 0.4f } },
					{}, { 0, 1, 2, 0, 2, 3 });
			std::vector<Caster> casters(4);
			casters[0].topology = get_topology(make_count_sphere(0.8, 24)); // several blocks
			casters[0].light_from_node = make_transform(0.4, 1.0);
			casters[1].topology = get_topology(make_box_mesh("box", glm::vec3(0.4, 0.3, 0.2)));
			casters[1].light_from_node = make_transform(1.3, -1.0); // mirrored
			casters[2].topology = get_topology(quad);
			casters[2].light_from_node = make_transform(2.1, 1.0);
			casters[3].topology = get_topology(make_count_sphere(0.3, 6));
			casters[3].light_from_node = make_transform(0.9, 1.5);
			const Found found = find_edges(fixture, casters, scene.get_space());
			CountedCasters expected;
			for (const Caster &caster : casters) {
				expected.add_mesh(reorder(caster), caster.light_from_node, scene.get_space());
			}
			REQUIRE(found.edges.size() == expected.edges.size());
			CHECK(found.edges.size() > 50);
			const auto to_point = [](const glm::uvec4 &p_bits) {
				return glm::dvec3(std::bit_cast<float>(p_bits.x), std::bit_cast<float>(p_bits.y),
						std::bit_cast<float>(p_bits.z));
			};
			for (size_t index = 0; index < found.edges.size(); ++index) {
				const shader::CountEdgeRecord &record = found.edges[index];
				const CountEdge &edge = expected.edges[index];
				CHECK(glm::length(to_point(record.a_face0) - edge.a) < 1e-5);
				CHECK(glm::length(to_point(record.b_face1) - edge.b) < 1e-5);
				CHECK(((record.a_face0.w & EDGE_COUNT_DOUBLE_SIDED) != 0) == edge.is_double_sided);
				CHECK((record.b_face1.w != EDGE_COUNT_NO_FACE) == edge.has_face1);
				const glm::vec4 plane = found.planes[record.a_face0.w & EDGE_COUNT_FACE_MASK];
				CHECK(glm::length(glm::dvec4(plane) - edge.plane0) < 1e-4);
			}
			REQUIRE(found.faces.size() == expected.faces.size());
			for (size_t index = 0; index < found.faces.size(); ++index) {
				CHECK(glm::length(to_point(found.faces[index].b_first_distance) -
							  expected.faces[index].corners[1]) < 1e-5);
				CHECK((found.faces[index].a_kind.w != 0) == expected.faces[index].is_double_sided);
			}
			CHECK(std::memcmp(find_edges(fixture, casters, scene.get_space()).edges.data(),
						  found.edges.data(), found.edges.size() * sizeof(found.edges[0])) == 0);
		}
	}
}
