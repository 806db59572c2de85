#include "modules/shadow_edge_count/count_buffers.h"

#include "modules/core/text.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace gnomon {

namespace {

// Of all edges of a light's casters those that are silhouettes from a point of it are a small part,
// but how small is known only on the GPU: room for so many a view, where there are more edges.
constexpr uint32_t RECORDS_OF_ONE_VIEW = 1u << 18;
constexpr uint32_t RECORDS_OF_SIX_VIEWS = 1u << 16;
// Fragments per texel on average; more where it is known beforehand that there may be more, up to
// 16 MiB a view.
constexpr uint64_t MOST_BOUNDED_FRAGMENTS = 1u << 22;
constexpr uint32_t FRAGMENTS_OF_ONE_VIEW = 12;
constexpr uint32_t FRAGMENTS_OF_SIX_VIEWS = 8;

} // namespace

uint32_t CountCapacities::get_bundles_per_view() const {
	return (records_per_view + EDGE_COUNT_BUNDLE_SIZE - 1) / EDGE_COUNT_BUNDLE_SIZE;
}

CountCapacities choose_capacities(uint32_t p_view_count, glm::uvec2 p_map_size_px,
		uint32_t p_edge_count, uint64_t p_fragment_bound, uint32_t p_layer_count) {
	const bool is_one = p_view_count == 1;
	CountCapacities capacities;
	capacities.view_count = p_view_count;
	capacities.texels_per_view = p_map_size_px.x * p_map_size_px.y;
	capacities.records_per_view =
			std::clamp(p_edge_count, 1u, is_one ? RECORDS_OF_ONE_VIEW : RECORDS_OF_SIX_VIEWS);
	const uint32_t per_texel = p_layer_count > 0 ? p_layer_count
			: is_one							 ? FRAGMENTS_OF_ONE_VIEW
												 : FRAGMENTS_OF_SIX_VIEWS;
	capacities.fragments_per_view = capacities.texels_per_view * per_texel;
	if (p_layer_count == 0 && p_fragment_bound <= MOST_BOUNDED_FRAGMENTS) {
		// In powers of two, so that what moves seldom needs other buffers.
		capacities.fragments_per_view = std::max(capacities.fragments_per_view,
				std::bit_ceil(static_cast<uint32_t>(p_fragment_bound)));
	}
	return capacities;
}

void CountBuffers::grow(RenderingDevice &p_device, CountCapacities &r_capacities) const {
	if (!totals_readback) {
		return;
	}
	uint32_t found[EDGE_COUNT_TOTAL_COUNT];
	std::memcpy(found, p_device.get_mapped(totals_readback.get()), sizeof(found));
	const auto raise = [](uint32_t &r_capacity, uint32_t p_found) {
		// A quarter more, so that what moves does not need more each frame.
		r_capacity = p_found > r_capacity ? p_found + p_found / 4 : r_capacity;
	};
	for (uint32_t view = 0; view < r_capacities.view_count; ++view) {
		raise(r_capacities.records_per_view, found[EDGE_COUNT_TOTAL_RECORDS + view]);
		raise(r_capacities.fragments_per_view, found[EDGE_COUNT_TOTAL_FRAGMENTS + view]);
	}
}

bool CountBuffers::prepare(
		RenderingDevice &p_device, const std::string &p_light, CountCapacities p_capacities) {
	forget_frame();
	// Never smaller than they are: a scene that swings about a limit keeps its buffers.
	if (records && capacities.view_count == p_capacities.view_count &&
			capacities.texels_per_view == p_capacities.texels_per_view) {
		p_capacities.records_per_view =
				std::max(p_capacities.records_per_view, capacities.records_per_view);
		p_capacities.fragments_per_view =
				std::max(p_capacities.fragments_per_view, capacities.fragments_per_view);
		grow(p_device, p_capacities);
	}
	// Without room in the device's buffers either, the filter stays.
	const auto limit = [&](uint32_t &r_count, uint64_t p_item_bytes) {
		const uint64_t most = p_device.get_features().max_storage_buffer_bytes / p_item_bytes /
				p_capacities.view_count;
		r_count = static_cast<uint32_t>(std::min<uint64_t>(r_count, most));
	};
	limit(p_capacities.records_per_view, sizeof(shader::CountEdgeRecord));
	limit(p_capacities.fragments_per_view, sizeof(uint32_t));
	if (records && capacities == p_capacities) {
		return true;
	}
	reset();
	capacities = p_capacities;
	light = p_light;
	views.resize(capacities.view_count);
	const auto make = [&](const char *p_what, uint64_t p_count, uint64_t p_item_bytes,
							  Format p_format, BufferUsage p_usage) {
		return OwnedBuffer(p_device,
				p_device.create_buffer({ text(p_what, " of ", p_light), p_count * p_item_bytes,
						BufferUsage::STORAGE | BufferUsage::TEXEL | p_usage, MemoryKind::GPU,
						p_format }));
	};
	const uint64_t view_count = capacities.view_count;
	records = make("edges", view_count * capacities.records_per_view,
			sizeof(shader::CountEdgeRecord), Format::RGBA32_SFLOAT, BufferUsage::STORAGE);
	bundles = make("bundles", view_count * capacities.get_bundles_per_view(),
			sizeof(shader::CountEdgeBundle), Format::RGBA32_SFLOAT, BufferUsage::STORAGE);
	// Pixels beside the receivers of a group look into the map as well, also of views without
	// casters, and must find short lists there.
	const std::vector<uint8_t> empty_texels(
			view_count * capacities.texels_per_view * sizeof(glm::uvec2), 0);
	texels = OwnedBuffer(p_device,
			p_device.create_buffer_with_data(
					{ text("layer map of ", p_light), empty_texels.size(),
							BufferUsage::STORAGE | BufferUsage::TEXEL | BufferUsage::COPY_TARGET,
							MemoryKind::GPU, Format::RG32_UINT },
					empty_texels));
	fragments = make("layers", view_count * capacities.fragments_per_view, sizeof(uint32_t),
			Format::R32_UINT, BufferUsage::STORAGE);
	const std::vector<uint8_t> zeros(EDGE_COUNT_TOTAL_COUNT * sizeof(uint32_t), 0);
	totals = OwnedBuffer(p_device,
			p_device.create_buffer_with_data(
					{ text("totals of ", p_light), zeros.size(),
							BufferUsage::STORAGE | BufferUsage::TEXEL | BufferUsage::COPY_SOURCE |
									BufferUsage::COPY_TARGET,
							MemoryKind::GPU, Format::R32_UINT },
					zeros));
	totals_readback = OwnedBuffer(p_device,
			p_device.create_buffer({ text("read totals of ", p_light), zeros.size(),
					BufferUsage::COPY_TARGET, MemoryKind::READBACK }));
	std::memset(p_device.get_mapped(totals_readback.get()), 0, zeros.size());
	return false;
}

bool CountBuffers::prepare_view(
		RenderingDevice &p_device, uint32_t p_view_index, const CountCasters &p_casters) {
	ViewBuffers &view = views[p_view_index];
	const glm::uvec3 counts(p_casters.face_count, p_casters.word_count, p_casters.block_count);
	if (view.planes && view.counts == counts) {
		return true;
	}
	view = {};
	view.counts = counts;
	const auto make = [&](const char *p_what, uint64_t p_count, uint64_t p_item_bytes) {
		return OwnedBuffer(p_device,
				p_device.create_buffer({ text(p_what, " ", p_view_index, " of ", light),
						std::max(p_count, uint64_t(1)) * p_item_bytes, BufferUsage::STORAGE }));
	};
	view.planes = make("planes", counts.x, sizeof(glm::vec4));
	view.words = make("edge words", counts.y, sizeof(uint32_t));
	view.blocks = make("edge blocks", counts.z, sizeof(uint32_t));
	return false;
}

void CountBuffers::reset() {
	records.reset();
	bundles.reset();
	texels.reset();
	fragments.reset();
	totals.reset();
	totals_readback.reset();
	views.clear();
	capacities = {};
}

const CountFrameBuffers &CountBuffers::import(RenderGraph &r_graph) {
	if (!is_imported) {
		frame = { r_graph.import_buffer(records.get()), r_graph.import_buffer(bundles.get()),
			r_graph.import_buffer(texels.get()), r_graph.import_buffer(fragments.get()),
			r_graph.import_buffer(totals.get()) };
		is_imported = true;
	}
	return frame;
}

CountViewBuffers CountBuffers::import_view(RenderGraph &r_graph, uint32_t p_view_index) const {
	const ViewBuffers &view = views[p_view_index];
	return { r_graph.import_buffer(view.planes.get()), r_graph.import_buffer(view.words.get()),
		r_graph.import_buffer(view.blocks.get()) };
}

void CountBuffers::add_readback(RenderGraph &r_graph) {
	const RGBuffer source = import(r_graph).totals;
	const RGBuffer target = r_graph.import_buffer(totals_readback.get());
	r_graph.add_pass("read totals")
			.reads(source, Access::COPY_READ)
			.writes(target, Access::COPY_WRITE)
			.keep()
			.execute([=](PassContext &p_context) {
				p_context.commands.copy_buffer(p_context.get(source), p_context.get(target),
						EDGE_COUNT_TOTAL_COUNT * sizeof(uint32_t));
			});
}

} // namespace gnomon
