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

namespace {

// Node capacity of a view's face lists if there is no smaller upper bound: four per face, the
// maximum number of texels that a small face overlaps, and some per texel for large faces.
constexpr uint64_t NODES_PER_FACE = 4;
constexpr uint64_t NODES_PER_TEXEL_OF_ONE_VIEW = 4;
constexpr uint64_t NODES_PER_TEXEL_OF_SIX_VIEWS = 2;

} // namespace

uint32_t CountCapacities::get_block_count() const {
	return (word_count + EDGE_COUNT_WORDS_PER_BLOCK - 1) / EDGE_COUNT_WORDS_PER_BLOCK;
}

uint32_t CountCapacities::get_bundle_count() const {
	return (edge_count + EDGE_COUNT_BUNDLE_SIZE - 1) / EDGE_COUNT_BUNDLE_SIZE;
}

uint32_t CountCapacities::get_bundle_group_count() const {
	return (get_bundle_count() + EDGE_COUNT_BUNDLES_PER_GROUP - 1) / EDGE_COUNT_BUNDLES_PER_GROUP;
}

CountCapacities choose_capacities(
		uint32_t p_view_count, glm::uvec2 p_map_size_px, const CountCasters &p_casters) {
	CountCapacities capacities;
	capacities.view_count = p_view_count;
	capacities.texels_per_view = p_map_size_px.x * p_map_size_px.y;
	capacities.face_count = p_casters.face_count;
	capacities.cut_face_count = p_casters.may_cut_disc ? p_casters.face_count : 0;
	capacities.edge_count = p_casters.edge_count;
	capacities.word_count = p_casters.word_count;
	const uint64_t usual = NODES_PER_FACE * p_casters.face_count +
			capacities.texels_per_view *
					(p_view_count == 1 ? NODES_PER_TEXEL_OF_ONE_VIEW
									   : NODES_PER_TEXEL_OF_SIX_VIEWS);
	// Rounded up to powers of two, so that a moving scene seldom needs other buffers.
	const uint64_t bound = p_casters.max_nodes_per_view;
	capacities.nodes_per_view = static_cast<uint32_t>(
			bound >= usual ? usual : std::min(usual, std::bit_ceil(std::max(bound, uint64_t(1)))));
	return capacities;
}

bool CountBuffers::prepare(RenderingDevice &p_device, const std::string &p_light,
		const CountCapacities &p_capacities) {
	is_imported = false;
	CountCapacities needed = p_capacities;
	if (nodes && capacities.view_count == needed.view_count &&
			capacities.texels_per_view == needed.texels_per_view &&
			capacities.face_count == needed.face_count) {
		// The node capacity does not shrink: a scene that oscillates about a limit reuses buffers.
		needed.nodes_per_view = std::max(needed.nodes_per_view, capacities.nodes_per_view);
	}
	// With fewer nodes than usual, texels get larger; the largest needs one node per face.
	const uint64_t max_bytes = p_device.get_features().max_storage_buffer_bytes;
	const uint64_t max_nodes = std::max<uint64_t>(
			needed.face_count, max_bytes / sizeof(glm::uvec2) / needed.view_count);
	needed.nodes_per_view =
			static_cast<uint32_t>(std::min<uint64_t>(needed.nodes_per_view, max_nodes));
	if (nodes && capacities == needed) {
		return true;
	}
	reset();
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
		desc.usage = desc.usage | BufferUsage::COPY_TARGET;
		return OwnedBuffer(p_device, p_device.create_buffer(desc));
	};
	planes = make("planes", needed.face_count, sizeof(glm::vec4), Format::RGBA32_SFLOAT);
	faces = make("faces", needed.face_count, sizeof(shader::CountFaceRecord), Format::RGBA32_UINT);
	words = make("edge words", needed.word_count, sizeof(uint32_t), Format::R32_UINT);
	blocks = make("edge blocks", needed.get_block_count(), sizeof(uint32_t), Format::R32_UINT);
	edges = make("edges", needed.edge_count, sizeof(shader::CountEdgeRecord), Format::RGBA32_UINT);
	bundles = make("bundles", needed.get_bundle_count() + needed.get_bundle_group_count(),
			sizeof(shader::CountEdgeBundle), Format::RGBA32_SFLOAT);
	const uint64_t view_count = needed.view_count;
	heads = make(
			"face lists", view_count * needed.texels_per_view, sizeof(uint32_t), Format::R32_UINT);
	nodes = make("listed faces", view_count * needed.nodes_per_view, sizeof(glm::uvec2),
			Format::RG32_UINT);
	cut_faces = make("cut faces", needed.cut_face_count, sizeof(uint32_t), Format::R32_UINT);
	const std::array<uint32_t, EDGE_COUNT_TOTAL_COUNT> zeros = {};
	totals = OwnedBuffer(p_device,
			p_device.create_buffer_with_data(
					{ .name = text("totals of ", p_light),
							.size_bytes = sizeof(zeros),
							.usage = BufferUsage::STORAGE | BufferUsage::COPY_TARGET },
					bytes_of(std::span<const uint32_t>(zeros))));
	capacities = needed;
	return false;
}

void CountBuffers::reset() {
	for (OwnedBuffer *buffer : { &planes, &faces, &words, &blocks, &edges, &bundles, &heads, &nodes,
				 &cut_faces, &totals }) {
		buffer->reset();
	}
	capacities = {};
}

const CountFrameBuffers &CountBuffers::import(RenderGraph &r_graph) {
	if (!is_imported) {
		frame = { r_graph.import_buffer(planes.get()), r_graph.import_buffer(faces.get()),
			r_graph.import_buffer(words.get()), r_graph.import_buffer(blocks.get()),
			r_graph.import_buffer(edges.get()), r_graph.import_buffer(bundles.get()),
			r_graph.import_buffer(heads.get()), r_graph.import_buffer(nodes.get()),
			r_graph.import_buffer(cut_faces.get()), r_graph.import_buffer(totals.get()) };
		is_imported = true;
	}
	return frame;
}

} // namespace gnomon
