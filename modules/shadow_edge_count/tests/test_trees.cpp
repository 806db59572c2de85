// The trees over a light's faces and edges: each node contains what is below it.

#include "modules/shadow_edge_count/count_buffers.h"
#include "modules/shadows/fetched_buffers.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <bit>

using namespace gnomon;

namespace {

glm::uvec4 pack(const glm::vec3 &p_point, uint32_t p_word) {
	return { std::bit_cast<uint32_t>(p_point.x), std::bit_cast<uint32_t>(p_point.y),
		std::bit_cast<uint32_t>(p_point.z), p_word };
}

glm::vec3 unpack(const glm::uvec4 &p_words) {
	return { std::bit_cast<float>(p_words.x), std::bit_cast<float>(p_words.y),
		std::bit_cast<float>(p_words.z) };
}

struct Trees {
	CountTrees layout;
	std::vector<shader::CountNode> nodes;
};

/// Runs the passes of add_bound_pass in find_passes.cpp. p_edge_capacity: of the list of edges, of
/// which the light has p_edges.
Trees bound(KernelFixture &r_fixture, const std::vector<shader::CountFaceRecord> &p_faces,
		const std::vector<shader::CountEdgeRecord> &p_edges, uint32_t p_edge_capacity) {
	Trees trees;
	trees.layout = lay_out_trees(
			{ .face_count = uint32_t(p_faces.size()), .edge_count = p_edge_capacity });
	shader::CountLightConstants constants = {};
	for (uint32_t level = 0; level < EDGE_COUNT_MAX_LEVELS; ++level) {
		constants.face_levels[level / 4][int(level % 4)] = trees.layout.face_levels[level];
		constants.edge_levels[level / 4][int(level % 4)] = trees.layout.edge_levels[level];
	}
	constants.face_count = uint32_t(p_faces.size());
	constants.max_edge_count = p_edge_capacity;
	const BufferUsage fetched = get_fetched_usage(*r_fixture.device);
	const OwnedBuffer light = r_fixture.make_buffer(
			"light", std::vector<shader::CountLightConstants>{ constants }, BufferUsage::STORAGE);
	const OwnedBuffer faces = r_fixture.make_buffer("faces", p_faces, fetched, Format::RGBA32_UINT);
	const OwnedBuffer edges = r_fixture.make_buffer("edges", p_edges, fetched, Format::RGBA32_UINT);
	std::vector<uint32_t> totals(EDGE_COUNT_TOTAL_COUNT);
	totals[EDGE_COUNT_TOTAL_EDGES] = uint32_t(p_edges.size());
	const OwnedBuffer totals_buffer = r_fixture.make_buffer("totals", totals, BufferUsage::STORAGE);
	const OwnedBuffer nodes =
			r_fixture.make_buffer("nodes", std::vector<shader::CountNode>(trees.layout.node_count),
					BufferUsage::STORAGE | BufferUsage::COPY_SOURCE);
	const OwnedBuffer readback =
			r_fixture.make_readback(trees.layout.node_count * sizeof(shader::CountNode));
	CommandList &commands = r_fixture.device->begin_commands();
	const uint32_t item_count = std::max(uint32_t(p_faces.size()), p_edge_capacity);
	const std::string clusters =
			choose_fetching_shader(*r_fixture.device, "shadow_edge_count/bound_clusters.comp");
	commands.bind_pipeline(
			r_fixture.device->get_compute_pipeline({ .name = clusters, .shader = clusters }));
	commands.bind_resources({ { COUNT_BINDING_LIGHT, light.get() },
			{ COUNT_BINDING_TOTALS, totals_buffer.get() }, { COUNT_BINDING_NODES, nodes.get() },
			{ COUNT_BINDING_EDGES, edges.get() }, { COUNT_BINDING_FACES, faces.get() } });
	commands.dispatch_items({ count_nodes(item_count, 0), 1, 2 });
	for (uint32_t level = 1; level < EDGE_COUNT_MAX_LEVELS; level += 3) {
		const Barrier barrier = { .buffer = nodes.get(),
			.before = Access::SHADER_WRITE_COMPUTE,
			.after = Access::SHADER_WRITE_COMPUTE };
		commands.barriers({ &barrier, 1 });
		commands.bind_pipeline(r_fixture.device->get_compute_pipeline(
				{ "nodes", "shadow_edge_count/bound_nodes.comp",
						{ { EDGE_COUNT_CONSTANT_FIRST_LEVEL, level } } }));
		commands.bind_resources({ { COUNT_BINDING_LIGHT, light.get() },
				{ COUNT_BINDING_TOTALS, totals_buffer.get() },
				{ COUNT_BINDING_NODES, nodes.get() } });
		commands.dispatch_items({ count_nodes(item_count, level), 1, 2 });
	}
	const Barrier barrier = {
		.buffer = nodes.get(), .before = Access::SHADER_WRITE_COMPUTE, .after = Access::COPY_READ
	};
	commands.barriers({ &barrier, 1 });
	commands.copy_buffer(
			nodes.get(), readback.get(), trees.layout.node_count * sizeof(shader::CountNode));
	r_fixture.device->submit_commands(RenderingDevice::SubmitMode::WAIT);
	trees.nodes = r_fixture.read<shader::CountNode>(readback, trees.layout.node_count);
	return trees;
}

/// A point, and the range of distances of what it belongs to.
struct Item {
	std::vector<glm::vec3> points;
	glm::vec2 distances;
};

/// Checks that each node of each level contains its items, and is not much larger.
void check_tree(const Trees &p_trees, const std::array<uint32_t, EDGE_COUNT_MAX_LEVELS> &p_levels,
		const std::vector<Item> &p_items) {
	size_t missing_count = 0;
	size_t loose_count = 0;
	uint32_t size = EDGE_COUNT_CLUSTER_SIZE;
	for (const uint32_t first_node : p_levels) {
		for (size_t first = 0, node_index = first_node; first < p_items.size();
				first += size, ++node_index) {
			const shader::CountNode &node = p_trees.nodes[node_index];
			const glm::vec3 center(node.center_first_distance);
			const glm::vec3 half_size(node.half_size_end_distance);
			glm::vec3 reach(0.0f);
			for (size_t i = first; i < std::min<size_t>(first + size, p_items.size()); ++i) {
				for (const glm::vec3 &point : p_items[i].points) {
					reach = glm::max(reach, glm::abs(point - center));
				}
				missing_count += p_items[i].distances.x < node.center_first_distance.w ||
						p_items[i].distances.y > node.half_size_end_distance.w;
			}
			missing_count += glm::any(glm::greaterThan(reach, half_size));
			loose_count += glm::any(
					glm::greaterThan(half_size, 1.001f * reach + 1e-4f * glm::abs(center)));
		}
		size *= EDGE_COUNT_NODE_WIDTH;
	}
	CHECK(missing_count == 0);
	CHECK(loose_count == 0);
}

} // namespace

TEST_CASE("[GPU][EdgeCount] each node of the trees contains its faces or edges, for any number of "
		  "them") {
	KernelFixture fixture;
	TestRandom random;
	for (const auto &[face_count, edge_count] :
			{ std::pair(1u, 1u), std::pair(16u, 17u), std::pair(129u, 3u), std::pair(1024u, 1025u),
					std::pair(20'000u, 70'000u), std::pair(600'000u, 9u) }) {
		CAPTURE(face_count);
		CAPTURE(edge_count);
		std::vector<shader::CountFaceRecord> faces;
		std::vector<Item> face_items;
		for (uint32_t face = 0; face < face_count; ++face) {
			const glm::vec3 corner(random.next(-9, 9), random.next(-2, 2), random.next(0, 30));
			const glm::vec2 distances(random.next(0, 2), random.next(2, 9));
			const glm::vec3 b = corner + glm::vec3(random.next(), random.next(), random.next());
			const glm::vec3 c = corner - glm::vec3(random.next(), random.next(), random.next());
			faces.push_back({ pack(corner, 0), pack(b, std::bit_cast<uint32_t>(distances.x)),
					pack(c, std::bit_cast<uint32_t>(distances.y)) });
			face_items.push_back({ { corner, b, c }, distances });
		}
		std::vector<shader::CountEdgeRecord> edges;
		std::vector<Item> edge_items;
		for (uint32_t edge = 0; edge < edge_count; ++edge) {
			const uint32_t face = edge % face_count;
			const glm::vec3 a = unpack(faces[face].a_kind);
			const glm::vec3 b = unpack(faces[face].b_first_distance);
			edges.push_back(
					{ pack(a, face | EDGE_COUNT_DOUBLE_SIDED), pack(b, EDGE_COUNT_NO_FACE) });
			edge_items.push_back({ { a, b }, face_items[face].distances });
		}
		const Trees trees = bound(fixture, faces, edges, edge_count + 40);
		check_tree(trees, trees.layout.face_levels, face_items);
		check_tree(trees, trees.layout.edge_levels, edge_items);
	}
}
