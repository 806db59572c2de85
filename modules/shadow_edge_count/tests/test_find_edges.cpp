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

/// One mesh in light space.
struct Caster {
	std::shared_ptr<const MeshTopology> topology;
	glm::dmat4 light_from_node;
	CountMesh mesh;
};

/// The casters and their meshes as the passes read them.
struct FindInputs {
	CountCasters casters;
	std::vector<shader::CountMeshFace> faces;
	std::vector<shader::CountMeshEdge> edges;
	std::vector<glm::vec4> points;

	void add(const Caster &p_caster) {
		const bool is_mirrored = glm::determinant(glm::dmat3(p_caster.light_from_node)) < 0;
		RecordedCaster recorded;
		CountCaster &caster = recorded.caster;
		caster.face_count = uint32_t(p_caster.mesh.faces.size());
		const uint32_t edge_count = uint32_t(p_caster.mesh.edges.size());
		caster.word_count =
				(edge_count + EDGE_COUNT_EDGES_PER_WORD - 1) / EDGE_COUNT_EDGES_PER_WORD;
		recorded.record = { glm::mat4(p_caster.light_from_node), /*first_face=*/0,
			/*first_word=*/0, edge_count, is_mirrored ? EDGE_COUNT_CASTER_MIRRORED : 0u,
			uint32_t(EDGE_COUNT_MESH_FACE_ITEMS * faces.size()), uint32_t(edges.size()),
			uint32_t(points.size()) };
		faces.insert(faces.end(), p_caster.mesh.faces.begin(), p_caster.mesh.faces.end());
		edges.insert(edges.end(), p_caster.mesh.edges.begin(), p_caster.mesh.edges.end());
		for (const glm::vec3 &position : p_caster.topology->welded_positions_node) {
			points.emplace_back(position, 1.0f);
		}
		casters.add("light", std::move(recorded));
	}
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
	FindInputs inputs;
	for (Caster &caster : r_casters) {
		caster.mesh = build_count_mesh(*caster.topology);
		inputs.add(caster);
	}
	const uint32_t face_count = inputs.casters.face_count;
	const uint32_t word_count = inputs.casters.word_count;
	const uint32_t edge_count = inputs.casters.edge_count;
	const std::vector<shader::CountWorkGroup> &face_groups = inputs.casters.face_groups;
	const std::vector<shader::CountWorkGroup> &word_groups = inputs.casters.word_groups;
	const uint32_t run_count = uint32_t(word_groups.size());
	const OwnedBuffer casters =
			r_fixture.make_buffer("casters", inputs.casters.records, fetched, Format::RGBA32_UINT);
	const OwnedBuffer points =
			r_fixture.make_buffer("points", inputs.points, fetched, Format::RGBA32_SFLOAT);
	const OwnedBuffer mesh_faces =
			r_fixture.make_buffer("mesh faces", inputs.faces, fetched, Format::RGBA32_UINT);
	const OwnedBuffer mesh_edges =
			r_fixture.make_buffer("mesh edges", inputs.edges, fetched, Format::RGBA32_UINT);
	const OwnedBuffer face_work =
			r_fixture.make_buffer("face groups", face_groups, BufferUsage::STORAGE);
	const OwnedBuffer word_work =
			r_fixture.make_buffer("word groups", word_groups, BufferUsage::STORAGE);
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
	const OwnedBuffer runs = r_fixture.make_buffer(
			"runs", std::vector<uint32_t>(run_count), fetched | BufferUsage::COPY_SOURCE);
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
	const OwnedBuffer runs_readback = r_fixture.make_readback(run_count * sizeof(uint32_t));

	CommandList &commands = r_fixture.device->begin_commands();
	const auto wait = [&](const OwnedBuffer &p_buffer, Access p_after) {
		const Barrier barrier = {
			.buffer = p_buffer.get(), .before = Access::SHADER_WRITE_COMPUTE, .after = p_after
		};
		commands.barriers({ &barrier, 1 });
	};
	const auto run = [&](const char *p_shader, uint32_t p_group_count, uint32_t p_item_count,
							 std::vector<Binding> p_bindings) {
		const std::string shader = choose_fetching_shader(*r_fixture.device, p_shader);
		commands.bind_pipeline(
				r_fixture.device->get_compute_pipeline({ .name = shader, .shader = shader }));
		p_bindings.push_back({ FIND_BINDING_CASTERS, casters.get() });
		p_bindings.push_back({ FIND_BINDING_POINTS, points.get() });
		commands.bind_resources(p_bindings);
		// SIDE_TOLERANCE_COSINE and SIDE_TOLERANCE_SIZES of count_casters.cpp.
		const float side_tolerance =
				p_space.is_directional ? 1e-6f : float(2.5e-7 * p_space.scene_size_m);
		commands.push_constants(shader::CountFindPush{ /*first_group=*/0, p_group_count,
				p_item_count, p_space.is_directional ? 1u : 0u, float(p_space.disc_radius),
				side_tolerance, inputs.casters.edge_count });
		// More work groups than needed, in two rows: the others do nothing.
		commands.dispatch({ p_group_count / 2 + 1, 2, 1 });
	};
	run("shadow_edge_count/caster_faces.comp", uint32_t(face_groups.size()), face_count,
			{ { FIND_BINDING_GROUPS, face_work.get() },
					{ FIND_BINDING_MESH_FACES, mesh_faces.get() },
					{ COUNT_BINDING_PLANES, planes.get() }, { COUNT_BINDING_FACES, faces.get() } });
	wait(planes, Access::SHADER_READ_COMPUTE);
	run("shadow_edge_count/mark_edges.comp", run_count, word_count,
			{ { FIND_BINDING_GROUPS, word_work.get() },
					{ FIND_BINDING_MESH_EDGES, mesh_edges.get() },
					{ COUNT_BINDING_PLANES, planes.get() }, { FIND_BINDING_WORDS, words.get() },
					{ FIND_BINDING_RUNS, runs.get() } });
	wait(words, Access::SHADER_READ_COMPUTE);
	wait(runs, Access::SHADER_READ_COMPUTE);
	run("shadow_edge_count/list_edges.comp", run_count, word_count,
			{ { FIND_BINDING_GROUPS, word_work.get() },
					{ FIND_BINDING_MESH_EDGES, mesh_edges.get() },
					{ FIND_BINDING_WORDS, words.get() }, { FIND_BINDING_RUNS, runs.get() },
					{ COUNT_BINDING_EDGES, list.get() }, { COUNT_BINDING_TOTALS, totals.get() } });
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
	wait(runs, Access::COPY_READ);
	commands.copy_buffer(list.get(), list_readback.get(), list_bytes);
	commands.copy_buffer(
			totals.get(), totals_readback.get(), EDGE_COUNT_TOTAL_COUNT * sizeof(uint32_t));
	commands.copy_buffer(runs.get(), runs_readback.get(), run_count * sizeof(uint32_t));
	r_fixture.device->submit_commands(RenderingDevice::SubmitMode::WAIT);
	uint32_t found_count = 0;
	for (const uint32_t count : r_fixture.read<uint32_t>(runs_readback, run_count)) {
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

/// The caster's topology with its faces and edges in the order of CountMesh.
MeshTopology reorder(const Caster &p_caster) {
	const MeshTopology &source = *p_caster.topology;
	MeshTopology topology = source;
	std::map<std::tuple<uint32_t, uint32_t, uint32_t>, uint32_t> faces; // by corners
	for (uint32_t face = 0; face < source.get_face_count(); ++face) {
		const uint32_t *corners = &source.triangles[3 * size_t(face)];
		faces[{ corners[0], corners[1], corners[2] }] = face;
	}
	std::vector<uint32_t> old_faces; // by new index
	std::vector<uint32_t> new_faces(faces.size());
	for (const shader::CountMeshFace &face : p_caster.mesh.faces) {
		const uint32_t old_face = faces.at({ face.a, face.b, face.c });
		new_faces[old_face] = uint32_t(old_faces.size());
		old_faces.push_back(old_face);
	}
	for (size_t face = 0; face < old_faces.size(); ++face) {
		const uint32_t old_face = old_faces[face];
		for (size_t corner = 0; corner < 3; ++corner) {
			topology.triangles[3 * face + corner] = source.triangles[3 * size_t(old_face) + corner];
		}
		topology.plane_faces[face] = new_faces[source.plane_faces[old_face]];
		topology.part_indices[face] = source.part_indices[old_face];
	}
	std::map<std::tuple<uint32_t, uint32_t, uint32_t>, MeshEdge> edges;
	for (MeshEdge edge : source.edges) {
		edge.face0 = new_faces[edge.face0];
		edge.face1 = edge.face1 == NO_FACE ? NO_FACE : new_faces[edge.face1];
		edges[{ edge.a, edge.b, edge.face0 }] = edge;
	}
	topology.edges.clear();
	for (const shader::CountMeshEdge &edge : p_caster.mesh.edges) {
		topology.edges.push_back(edges.at({ edge.a, edge.b, edge.face0 & EDGE_COUNT_FACE_MASK }));
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
			casters[0].topology = get_topology(make_count_sphere(0.8, 24)); // several runs
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
