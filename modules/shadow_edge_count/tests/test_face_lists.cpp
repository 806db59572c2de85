// The texels' lists of faces: none lacks a face that may be between a receiver there and the light.

#include "modules/shadow_edge_count/tests/count_in_double.h"
#include "modules/shadows/fetched_buffers.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <set>

using namespace gnomon;

namespace {

/// Random large and small faces and slivers, in front of the light, across its plane and behind it.
std::vector<CountFace> make_soup(TestRandom &r_random, size_t p_count) {
	std::vector<CountFace> faces;
	for (size_t index = 0; index < p_count; ++index) {
		const double size_m = index % 7 == 0 ? 4.0 : index % 3 == 0 ? 0.3 : 0.02;
		const glm::dvec3 middle(r_random.next(-4, 4), r_random.next(-4, 4), r_random.next(-1, 6));
		CountFace face;
		for (glm::dvec3 &corner : face.corners) {
			corner =
					glm::dvec3(glm::vec3(middle + size_m * r_random.next() * r_random.next_unit()));
		}
		if (index % 11 == 0) { // a sliver
			face.corners[2] = glm::dvec3(
					glm::vec3(glm::mix(face.corners[0], face.corners[1], r_random.next()) + 1e-5));
		}
		faces.push_back(face);
	}
	return faces;
}

struct Lists {
	std::vector<uint32_t> heads;
	std::vector<glm::uvec2> nodes;
	std::vector<uint32_t> totals;
};

/// Runs the passes that list the faces of one view. p_totals: content of the buffer `totals` after
/// an earlier frame.
Lists list_faces(KernelFixture &r_fixture, const std::vector<CountFace> &p_faces,
		bool p_is_directional, const shader::CountLightConstants &p_light,
		const std::vector<uint32_t> &p_totals = std::vector<uint32_t>(EDGE_COUNT_TOTAL_COUNT)) {
	const auto pack = [](const glm::dvec3 &p_point) {
		return glm::uvec4(std::bit_cast<uint32_t>(float(p_point.x)),
				std::bit_cast<uint32_t>(float(p_point.y)),
				std::bit_cast<uint32_t>(float(p_point.z)), 0u);
	};
	std::vector<shader::CountFaceRecord> records;
	for (const CountFace &face : p_faces) {
		records.push_back({ pack(face.corners[0]), pack(face.corners[1]), pack(face.corners[2]) });
	}
	const uint32_t texel_count = p_light.views[0].map_size_px.x * p_light.views[0].map_size_px.y;
	const BufferUsage usage = BufferUsage::STORAGE | BufferUsage::COPY_SOURCE;
	const OwnedBuffer light = r_fixture.make_buffer(
			"light", std::vector<shader::CountLightConstants>{ p_light }, BufferUsage::STORAGE);
	const OwnedBuffer faces = r_fixture.make_buffer(
			"faces", records, get_fetched_usage(*r_fixture.device), Format::RGBA32_UINT);
	// 77: values that the shader has to clear.
	const OwnedBuffer heads =
			r_fixture.make_buffer("heads", std::vector<uint32_t>(texel_count, 77u), usage);
	const OwnedBuffer nodes =
			r_fixture.make_buffer("nodes", std::vector<glm::uvec2>(p_light.node_capacity), usage);
	const OwnedBuffer totals = r_fixture.make_buffer("totals", p_totals, usage);
	const OwnedBuffer heads_readback = r_fixture.make_readback(texel_count * sizeof(uint32_t));
	const OwnedBuffer nodes_readback =
			r_fixture.make_readback(p_light.node_capacity * sizeof(glm::uvec2));
	const OwnedBuffer totals_readback =
			r_fixture.make_readback(EDGE_COUNT_TOTAL_COUNT * sizeof(uint32_t));
	CommandList &commands = r_fixture.device->begin_commands();
	const auto wait = [&](const OwnedBuffer &p_buffer, Access p_after) {
		const Barrier barrier = {
			.buffer = p_buffer.get(), .before = Access::SHADER_WRITE_COMPUTE, .after = p_after
		};
		commands.barriers({ &barrier, 1 });
	};
	const shader::CountFaceListPush push = {
		.view = 0, .face_count = uint32_t(p_faces.size()), .is_first = 1, .may_overflow = 1
	};
	commands.bind_pipeline(r_fixture.device->get_compute_pipeline(
			{ .name = "clear", .shader = "shadow_edge_count/clear_faces.comp" }));
	commands.bind_resources({ { FACE_LIST_BINDING_LIGHT, light.get() },
			{ FACE_LIST_BINDING_HEADS, heads.get() }, { FACE_LIST_BINDING_TOTALS, totals.get() } });
	commands.push_constants(push);
	commands.dispatch_items({ texel_count, 1, 1 });
	wait(heads, Access::SHADER_WRITE_COMPUTE);
	wait(totals, Access::SHADER_WRITE_COMPUTE);
	commands.bind_pipeline(r_fixture.device->get_compute_pipeline({ .name = "list",
			.shader =
					choose_fetching_shader(*r_fixture.device, "shadow_edge_count/list_faces.comp"),
			.constants = { { EDGE_COUNT_CONSTANT_IS_DIRECTIONAL, p_is_directional ? 1u : 0u } } }));
	commands.bind_resources({ { FACE_LIST_BINDING_LIGHT, light.get() },
			{ FACE_LIST_BINDING_FACES, faces.get() }, { FACE_LIST_BINDING_HEADS, heads.get() },
			{ FACE_LIST_BINDING_NODES, nodes.get() }, { FACE_LIST_BINDING_TOTALS, totals.get() } });
	commands.push_constants(push);
	commands.dispatch_items({ p_faces.size(), 1, 1 });
	for (const OwnedBuffer *buffer : { &heads, &nodes, &totals }) {
		wait(*buffer, Access::COPY_READ);
	}
	commands.copy_buffer(heads.get(), heads_readback.get(), texel_count * sizeof(uint32_t));
	commands.copy_buffer(
			nodes.get(), nodes_readback.get(), p_light.node_capacity * sizeof(glm::uvec2));
	commands.copy_buffer(
			totals.get(), totals_readback.get(), EDGE_COUNT_TOTAL_COUNT * sizeof(uint32_t));
	r_fixture.device->submit_commands(RenderingDevice::SubmitMode::WAIT);
	return { r_fixture.read<uint32_t>(heads_readback, texel_count),
		r_fixture.read<glm::uvec2>(nodes_readback, p_light.node_capacity),
		r_fixture.read<uint32_t>(totals_readback, EDGE_COUNT_TOTAL_COUNT) };
}

/// True if the line from the light's centre through a point of the map meets the face.
bool is_met(bool p_is_directional, const glm::dvec2 &p_position, const CountFace &p_face) {
	const auto to_plane = [&](const glm::dvec3 &p_point) {
		return p_is_directional ? glm::dvec3(p_point.x, p_point.y, 1.0) : p_point;
	};
	const glm::dvec3 a = to_plane(p_face.corners[0]);
	const glm::dvec3 b = to_plane(p_face.corners[1]);
	const glm::dvec3 c = to_plane(p_face.corners[2]);
	const glm::dvec3 direction(p_position, 1.0);
	const double orientation = glm::dot(a, glm::cross(b, c)) >= 0 ? 1.0 : -1.0;
	return orientation * glm::dot(direction, glm::cross(a, b)) >= 0 &&
			orientation * glm::dot(direction, glm::cross(b, c)) >= 0 &&
			orientation * glm::dot(direction, glm::cross(c, a)) >= 0;
}

} // namespace

TEST_CASE("[GPU][EdgeCount] each face is in the lists of all texels that it covers, and in all "
		  "cells") {
	KernelFixture fixture;
	TestRandom random;
	size_t pair_count = 0;	 // of a face and a position
	size_t listed_count = 0; // faces in the lists of the positions' texels
	size_t cell_count = 0;	 // of these, in the positions' cells (4 x 4 in each texel)
	for (const bool is_directional : { false, true }) {
		for (const uint32_t map_size_px : { 1u, 16u, 48u, 256u }) {
			CAPTURE(is_directional);
			CAPTURE(map_size_px);
			const std::vector<CountFace> faces = make_soup(random, 700);
			shader::CountLightConstants light = {};
			light.views[0] = { glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
				glm::vec2(is_directional ? 3.0f : 1.1f), glm::uvec2(map_size_px) };
			light.view_count = 1;
			light.node_capacity = 1u << 20;
			light.face_count = uint32_t(faces.size());
			const Lists lists = list_faces(fixture, faces, is_directional, light);
			const uint32_t node_count = lists.totals[EDGE_COUNT_TOTAL_NODES];
			REQUIRE(node_count <= light.node_capacity);
			CHECK(lists.totals[EDGE_COUNT_TOTAL_LEVELS] == 0);
			size_t missing_count = 0;
			size_t met_count = 0;
			for (int index = 0; index < 250; ++index) {
				const glm::dvec2 fraction(random.next(), random.next());
				const glm::dvec2 position =
						(fraction * 2.0 - 1.0) * double(light.views[0].half_extent.x);
				const glm::uvec2 texel = glm::min(
						glm::uvec2(fraction * double(map_size_px)), glm::uvec2(map_size_px - 1));
				const glm::uvec2 cell =
						glm::uvec2((fraction * double(map_size_px) - glm::dvec2(texel)) *
								double(EDGE_COUNT_NODE_CELLS_PER_SIDE));
				const uint32_t cell_bits =
						(1u << cell.x | 1u << (EDGE_COUNT_NODE_CELLS_PER_SIDE + cell.y))
						<< EDGE_COUNT_NODE_CELLS_SHIFT;
				std::set<uint32_t> listed;
				std::set<uint32_t> in_cell;
				for (uint32_t node = lists.heads[texel.y * map_size_px + texel.x]; node != 0;
						node = lists.nodes[node - 1].y) {
					const uint32_t word = lists.nodes[node - 1].x;
					const uint32_t face = word & EDGE_COUNT_FACE_MASK;
					CHECK(listed.insert(face).second); // each once
					if ((word & cell_bits) == cell_bits) {
						in_cell.insert(face);
					}
				}
				listed_count += listed.size();
				cell_count += in_cell.size();
				for (uint32_t face = 0; face < faces.size(); ++face) {
					if (is_met(is_directional, position, faces[face])) {
						++met_count;
						missing_count += in_cell.contains(face) ? 0 : 1;
					}
				}
				pair_count += faces.size();
			}
			CHECK(missing_count == 0);
			CHECK(met_count > 200);
			// The lists are selective: not every face is in every list.
			CHECK((map_size_px < 256 ||
					node_count < faces.size() * map_size_px * map_size_px / 20));
		}
	}
	CHECK(pair_count >= 1'000'000);
	CHECK(cell_count < 0.9 * double(listed_count)); // the cells are selective, too
}

TEST_CASE("[GPU][EdgeCount] face lists start with the size of texels that fitted last") {
	KernelFixture fixture;
	TestRandom random;
	const std::vector<CountFace> faces = make_soup(random, 20);
	shader::CountLightConstants light = {};
	light.views[0] = { glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
		glm::vec2(1.1f), glm::uvec2(64) };
	light.view_count = 1;
	light.node_capacity = 1u << 17;
	light.face_count = uint32_t(faces.size());
	// The level (load_count_level) of the first attempt after a frame with this level and number of
	// nodes.
	const auto find_level = [&](uint32_t p_level, uint32_t p_node_count) {
		std::vector<uint32_t> totals(EDGE_COUNT_TOTAL_COUNT);
		totals[EDGE_COUNT_TOTAL_LEVELS] = p_level;
		totals[EDGE_COUNT_TOTAL_NODES] = p_node_count;
		return list_faces(fixture, faces, /*p_is_directional=*/false, light, totals)
				.totals[EDGE_COUNT_TOTAL_LEVELS];
	};
	CHECK(find_level(0, 0) == 0);
	CHECK(find_level(2, light.node_capacity / 2) == 2);
	CHECK(find_level(2, light.node_capacity / 4) == 1); // smaller texels would fit, too
	CHECK(find_level(31, light.node_capacity) == 6);	// 64 x 64 texels become one at level 6
}
