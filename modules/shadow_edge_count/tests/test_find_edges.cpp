#include "modules/shadow_edge_count/count_mesh.h"
#include "modules/shadow_edge_count/tests/count_records.h"
#include "modules/shadow_edge_count/tests/count_scene.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <map>
#include <tuple>

using namespace gnomon;

namespace {

struct Caster {
	std::shared_ptr<const MeshTopology> topology;
	glm::dmat4 view_from_node;
	CountMesh mesh;
	shader::CountCasterPush push;
	OwnedBuffer positions;
	OwnedBuffer faces;
	OwnedBuffer edges;
};

/// Runs the three passes over all casters and reads the list back.
std::vector<shader::CountEdgeRecord> find_edges(
		KernelFixture &r_fixture, std::vector<Caster> &r_casters, const CountScene &p_scene) {
	uint32_t face_count = 0;
	uint32_t word_count = 0;
	uint32_t block_count = 0;
	uint32_t edge_count = 0;
	for (Caster &caster : r_casters) {
		caster.mesh = build_count_mesh(*caster.topology);
		const bool is_mirrored = glm::determinant(glm::dmat3(caster.view_from_node)) < 0;
		const bool is_last = &caster == &r_casters.back();
		caster.push = { glm::mat4(caster.view_from_node), caster.topology->get_face_count(),
			face_count, uint32_t(caster.mesh.edges.size()), word_count, block_count,
			caster.mesh.inconsistent_from,
			(caster.topology->is_double_sided() ? uint32_t(EDGE_COUNT_DOUBLE_SIDED) : 0u) |
					(is_mirrored ? uint32_t(EDGE_COUNT_MIRRORED) : 0u) |
					(is_last ? uint32_t(EDGE_COUNT_LAST_CASTER) : 0u),
			1u << 20 };
		std::vector<glm::vec4> positions;
		for (const glm::vec3 &position : caster.topology->welded_positions_node) {
			positions.emplace_back(position, 1.0f);
		}
		caster.positions = r_fixture.make_buffer("positions", positions);
		caster.faces = r_fixture.make_buffer("faces", caster.topology->triangles);
		caster.edges = r_fixture.make_buffer("edges", caster.mesh.edges);
		face_count += caster.push.face_count;
		edge_count += caster.push.edge_count;
		word_count += caster.mesh.get_word_count();
		block_count += caster.mesh.get_block_count();
	}
	const OwnedBuffer view = r_fixture.make_buffer("view",
			std::vector<shader::CountViewConstants>{ make_constants(p_scene) },
			BufferUsage::UNIFORM);
	const OwnedBuffer planes = r_fixture.make_buffer("planes", std::vector<glm::vec4>(face_count));
	const OwnedBuffer words = r_fixture.make_buffer("words", std::vector<uint32_t>(word_count));
	const OwnedBuffer blocks = r_fixture.make_buffer("blocks", std::vector<uint32_t>(block_count),
			BufferUsage::STORAGE | BufferUsage::COPY_SOURCE);
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
		commands.bind_pipeline(
				r_fixture.device->get_compute_pipeline({ .name = p_shader, .shader = p_shader }));
		for (const Caster &caster : r_casters) {
			p_bind(caster);
			commands.push_constants(caster.push);
			commands.dispatch_items({ p_items(caster), 1, 1 });
		}
	};
	const auto count_words = [](const Caster &p_caster) { return p_caster.mesh.get_word_count(); };
	run(
			"shadow_edge_count/face_planes.comp",
			[](const Caster &p_caster) { return p_caster.push.face_count; },
			[&](const Caster &p_caster) {
				commands.bind_resources({ { FIND_BINDING_POSITIONS, p_caster.positions.get() },
						{ FIND_BINDING_FACES, p_caster.faces.get() },
						{ FIND_BINDING_PLANES, planes.get() } });
			});
	wait(planes, Access::SHADER_READ_COMPUTE);
	run("shadow_edge_count/mark_edges.comp", count_words, [&](const Caster &p_caster) {
		commands.bind_resources({ { FIND_BINDING_VIEW, view.get() },
				{ FIND_BINDING_POSITIONS, p_caster.positions.get() },
				{ FIND_BINDING_PLANES, planes.get() }, { FIND_BINDING_EDGES, p_caster.edges.get() },
				{ FIND_BINDING_WORDS, words.get() }, { FIND_BINDING_BLOCKS, blocks.get() } });
	});
	wait(words, Access::SHADER_READ_COMPUTE);
	wait(blocks, Access::SHADER_READ_COMPUTE);
	run("shadow_edge_count/list_edges.comp", count_words, [&](const Caster &p_caster) {
		commands.bind_resources({ { FIND_BINDING_VIEW, view.get() },
				{ FIND_BINDING_POSITIONS, p_caster.positions.get() },
				{ FIND_BINDING_PLANES, planes.get() }, { FIND_BINDING_EDGES, p_caster.edges.get() },
				{ FIND_BINDING_WORDS, words.get() }, { FIND_BINDING_BLOCKS, blocks.get() },
				{ FIND_BINDING_LIST, list.get() }, { FIND_BINDING_TOTALS, totals.get() } });
	});
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
	CHECK(r_fixture.read<uint32_t>(totals_readback, EDGE_COUNT_TOTAL_COUNT)[0] == found_count);
	auto records = r_fixture.read<shader::CountEdgeRecord>(list_readback, edge_count);
	records.resize(found_count);
	return records;
}

/// The same mesh with its edges in the order of the caster's.
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
	for (const shader::CountMeshEdge &edge : p_caster.mesh.edges) {
		topology.edges.push_back(edges.at(make_key(edge)));
	}
	return topology;
}

} // namespace

TEST_CASE(
		"[GPU][EdgeCount] the passes list the edges of all casters as in double, in their order") {
	KernelFixture fixture;
	for (const bool is_directional : { false, true }) {
		for (const double radius : { 0.02, 0.3 }) {
			CAPTURE(is_directional);
			CAPTURE(radius);
			CountScene scene;
			scene.is_directional = is_directional;
			scene.radius = radius;
			scene.build();
			const auto place = [](double p_turn, double p_scale) {
				glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), glm::dvec3(0.31, -0.23, 4.1));
				matrix = glm::rotate(matrix, p_turn, glm::dvec3(0.3, 0.7, -0.2));
				return glm::scale(matrix, glm::dvec3(p_scale, 1.0, 1.0));
			};
			const std::shared_ptr<const Mesh> sheet = make_mesh("sheet",
					{ { -0.5f, 0, -0.4f }, { 0.5f, 0, -0.4f }, { 0.5f, 0.1f, 0.4f },
							{ -0.5f, 0, 0.4f } },
					{}, { 0, 1, 2, 0, 2, 3 });
			std::vector<Caster> casters(4);
			casters[0].topology = get_topology(make_count_sphere(0.8, 24)); // several blocks
			casters[0].view_from_node = place(0.4, 1.0);
			casters[1].topology = get_topology(make_box_mesh("box", glm::vec3(0.4, 0.3, 0.2)));
			casters[1].view_from_node = place(1.3, -1.0); // mirrored
			casters[2].topology = get_topology(sheet);
			casters[2].view_from_node = place(2.1, 1.0);
			casters[3].topology = get_topology(make_count_sphere(0.3, 6));
			casters[3].view_from_node = place(0.9, 1.5);
			const auto found = find_edges(fixture, casters, scene);
			std::vector<CountEdge> expected;
			for (const Caster &caster : casters) {
				add_count_edges(
						reorder(caster), caster.view_from_node, scene.get_space(), expected);
			}
			REQUIRE(found.size() == expected.size());
			CHECK(found.size() > 50);
			for (size_t index = 0; index < found.size(); ++index) {
				const shader::CountEdgeRecord record = make_record(expected[index]);
				CHECK(found[index].by_bw_weight_kind.z == record.by_bw_weight_kind.z);
				CHECK(found[index].by_bw_weight_kind.w == record.by_bw_weight_kind.w);
				CHECK(glm::length(found[index].a_bx - record.a_bx) < 1e-4f);
				CHECK(glm::length(found[index].by_bw_weight_kind - record.by_bw_weight_kind) <
						1e-4f);
			}
			CHECK(std::memcmp(find_edges(fixture, casters, scene).data(), found.data(),
						  found.size() * sizeof(found[0])) == 0);
		}
	}
}
