#include "modules/shadow_edge_count/count_buffers.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/shadows/fetched_buffers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <span>

namespace gnomon {

uint32_t CountCapacities::get_run_count() const {
	return (word_count + EDGE_COUNT_WORDS_PER_RUN - 1) / EDGE_COUNT_WORDS_PER_RUN;
}

CountCapacities choose_capacities(const CountCasters &p_casters) {
	return { .face_count = p_casters.face_count,
		.cut_face_count = p_casters.may_cut_disc ? p_casters.face_count : 0,
		.edge_count = p_casters.edge_count,
		.word_count = p_casters.word_count };
}

uint32_t count_nodes(uint32_t p_item_count, uint32_t p_level) {
	const uint32_t shift = std::bit_width(uint32_t(EDGE_COUNT_CLUSTER_SIZE)) - 1 +
			p_level * (std::bit_width(uint32_t(EDGE_COUNT_NODE_WIDTH)) - 1);
	return (p_item_count + (1u << shift) - 1) >> shift;
}

CountTrees lay_out_trees(const CountCapacities &p_capacities) {
	CountTrees trees;
	for (const auto &[levels, item_count] :
			{ std::pair(&trees.face_levels, p_capacities.face_count),
					std::pair(&trees.edge_levels, p_capacities.edge_count) }) {
		for (uint32_t level = 0; level < EDGE_COUNT_MAX_LEVELS; ++level) {
			(*levels)[level] = trees.node_count;
			trees.node_count += count_nodes(item_count, level);
		}
	}
	return trees;
}

bool CountBuffers::prepare(RenderingDevice &p_device, const std::string &p_light,
		const CountCapacities &p_capacities) {
	is_imported = false;
	if (faces && capacities == p_capacities) {
		return true;
	}
	reset();
	const uint64_t max_bytes = p_device.get_features().max_storage_buffer_bytes;
	const auto make = [&](const char *p_what, uint64_t p_count, uint64_t p_item_bytes,
							  std::optional<Format> p_fetched_format = std::nullopt) {
		const uint64_t size_bytes = std::max(p_count, uint64_t(1)) * p_item_bytes;
		if (size_bytes > max_bytes) {
			fail_capacity("Light \"", p_light, "\": edge_count needs ", size_bytes,
					" bytes for the ", p_what, " of its casters, and ", p_device.get_info().name,
					" has room for ", max_bytes,
					" in one buffer. Let fewer meshes cast shadows, or set another "
					"shadow_technique.");
		}
		const std::string name = text(p_what, " of ", p_light);
		BufferDesc desc = p_fetched_format
				? make_fetched_buffer_desc(p_device, name, size_bytes, *p_fetched_format)
				: BufferDesc{ .name = name, .size_bytes = size_bytes };
		desc.usage = desc.usage | BufferUsage::COPY_TARGET | BufferUsage::COPY_SOURCE;
		return OwnedBuffer(p_device, p_device.create_buffer(desc));
	};
	planes = make("planes", p_capacities.face_count, sizeof(glm::vec4), Format::RGBA32_SFLOAT);
	faces = make(
			"faces", p_capacities.face_count, sizeof(shader::CountFaceRecord), Format::RGBA32_UINT);
	words = make("edge words", p_capacities.word_count, sizeof(uint32_t), Format::R32_UINT);
	runs = make("edge runs", p_capacities.get_run_count(), sizeof(uint32_t), Format::R32_UINT);
	edges = make(
			"edges", p_capacities.edge_count, sizeof(shader::CountEdgeRecord), Format::RGBA32_UINT);
	nodes = make("trees", lay_out_trees(p_capacities).node_count, sizeof(shader::CountNode),
			Format::RGBA32_SFLOAT);
	cut_faces = make("cut faces", p_capacities.cut_face_count, sizeof(uint32_t), Format::R32_UINT);
	const std::array<uint32_t, EDGE_COUNT_TOTAL_COUNT> zeros = {};
	totals = OwnedBuffer(p_device,
			p_device.create_buffer_with_data(
					{ .name = text("totals of ", p_light),
							.size_bytes = sizeof(zeros),
							.usage = BufferUsage::STORAGE | BufferUsage::COPY_TARGET |
									BufferUsage::COPY_SOURCE },
					bytes_of(std::span<const uint32_t>(zeros))));
	capacities = p_capacities;
	return false;
}

void CountBuffers::reset() {
	for (OwnedBuffer *buffer :
			{ &planes, &faces, &words, &runs, &edges, &nodes, &cut_faces, &totals }) {
		buffer->reset();
	}
	capacities = {};
}

const CountFrameBuffers &CountBuffers::import(RenderGraph &r_graph) {
	if (!is_imported) {
		frame = { r_graph.import_buffer(planes.get()), r_graph.import_buffer(faces.get()),
			r_graph.import_buffer(words.get()), r_graph.import_buffer(runs.get()),
			r_graph.import_buffer(edges.get()), r_graph.import_buffer(nodes.get()),
			r_graph.import_buffer(cut_faces.get()), r_graph.import_buffer(totals.get()) };
		is_imported = true;
	}
	return frame;
}

} // namespace gnomon
