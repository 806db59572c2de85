#include "modules/render_graph/transient_pool.h"

#include "modules/core/limits.h"

#include <algorithm>
#include <numeric>

namespace gnomon {

namespace {

// Each debug view and each set of skipped passes has its own frame layout. Caching more layouts
// would waste memory.
constexpr size_t MAX_CACHED_ENTRIES = 3;

bool overlaps_in_time(const PlacedBlock &p_left, const PlacedBlock &p_right) {
	return p_left.first_pass <= p_right.last_pass && p_right.first_pass <= p_left.last_pass;
}

uint64_t align_up(uint64_t p_value, uint64_t p_alignment) {
	return (p_value + p_alignment - 1) / p_alignment * p_alignment;
}

bool overlaps_in_memory(const PlacedBlock &p_left, const PlacedBlock &p_right) {
	return p_left.offset_bytes < p_right.offset_bytes + p_right.size_bytes &&
			p_right.offset_bytes < p_left.offset_bytes + p_left.size_bytes;
}

} // namespace

uint64_t place_blocks(std::vector<PlacedBlock> &r_blocks) {
	std::vector<uint32_t> order(r_blocks.size());
	std::iota(order.begin(), order.end(), 0u);
	std::stable_sort(order.begin(), order.end(), [&](uint32_t p_left, uint32_t p_right) {
		return r_blocks[p_left].size_bytes > r_blocks[p_right].size_bytes;
	});
	uint64_t total_bytes = 0;
	std::vector<uint32_t> placed;
	for (uint32_t index : order) {
		PlacedBlock &block = r_blocks[index];
		block.offset_bytes = 0;
		// Move it behind each block that it overlaps, lowest offset first, until it overlaps none.
		std::sort(placed.begin(), placed.end(), [&](uint32_t p_left, uint32_t p_right) {
			return r_blocks[p_left].offset_bytes < r_blocks[p_right].offset_bytes;
		});
		for (uint32_t other : placed) {
			if (overlaps_in_time(block, r_blocks[other]) &&
					overlaps_in_memory(block, r_blocks[other])) {
				block.offset_bytes =
						align_up(r_blocks[other].offset_bytes + r_blocks[other].size_bytes,
								block.alignment_bytes);
			}
		}
		placed.push_back(index);
		total_bytes = std::max(total_bytes, block.offset_bytes + block.size_bytes);
	}
	return total_bytes;
}

std::vector<uint32_t> share_resources(const std::vector<TransientRequest> &p_requests,
		SharedKinds p_kinds, std::vector<std::vector<uint32_t>> &r_predecessors) {
	struct Slot {
		uint32_t owner = 0; // the request whose resource it is
		uint32_t last = 0;	// the request that used it last
	};
	std::vector<uint32_t> order(p_requests.size());
	std::iota(order.begin(), order.end(), 0u);
	std::stable_sort(order.begin(), order.end(), [&](uint32_t p_left, uint32_t p_right) {
		return p_requests[p_left].first_pass < p_requests[p_right].first_pass;
	});
	const auto may_share = [&](const TransientRequest &p_request) {
		// Submissions, not barriers, order accesses to host-mapped buffers, so these are not
		// shared.
		return p_request.is_texture ? p_kinds == SharedKinds::BUFFERS_AND_TEXTURES
									: p_request.buffer.memory == MemoryKind::GPU;
	};
	const auto has_same_desc = [](TransientRequest p_left, const TransientRequest &p_right) {
		p_left.texture.name = p_right.texture.name;
		p_left.buffer.name = p_right.buffer.name;
		return p_left.is_texture == p_right.is_texture &&
				(p_left.is_texture ? p_left.texture == p_right.texture
								   : p_left.buffer == p_right.buffer);
	};
	std::vector<Slot> slots;
	std::vector<uint32_t> owners(p_requests.size());
	for (const uint32_t index : order) {
		const TransientRequest &request = p_requests[index];
		owners[index] = index;
		if (!may_share(request)) {
			continue;
		}
		const auto free_slot = std::find_if(slots.begin(), slots.end(), [&](const Slot &p_slot) {
			return has_same_desc(p_requests[p_slot.owner], request) &&
					p_requests[p_slot.last].last_pass < request.first_pass;
		});
		if (free_slot == slots.end()) {
			slots.push_back({ index, index });
			continue;
		}
		r_predecessors[index].push_back(free_slot->last);
		owners[index] = free_slot->owner;
		free_slot->last = index;
	}
	return owners;
}

const TransientPlacement &TransientPool::place(const std::vector<TransientRequest> &p_requests) {
	++use_count;
	std::erase_if(entries, [&](const std::unique_ptr<Entry> &p_entry) {
		return use_count - p_entry->last_use > MAX_UNUSED_FRAMES;
	});
	for (const std::unique_ptr<Entry> &entry : entries) {
		if (entry->requests == p_requests) {
			entry->last_use = use_count;
			return entry->placement;
		}
	}
	if (entries.size() >= MAX_CACHED_ENTRIES) {
		entries.erase(std::min_element(
				entries.begin(), entries.end(), [](const auto &p_left, const auto &p_right) {
					return p_left->last_use < p_right->last_use;
				}));
	}
	entries.push_back(make_entry(p_requests));
	entries.back()->last_use = use_count;
	return entries.back()->placement;
}

std::unique_ptr<TransientPool::Entry> TransientPool::make_entry(
		const std::vector<TransientRequest> &p_requests) {
	auto entry = std::make_unique<Entry>();
	entry->requests = p_requests;
	TransientPlacement &placement = entry->placement;
	placement.textures.resize(p_requests.size());
	placement.buffers.resize(p_requests.size());
	placement.predecessors.resize(p_requests.size());

	const bool has_aliased_memory = device.get_features().aliased_memory;
	const std::vector<uint32_t> owners = share_resources(p_requests,
			has_aliased_memory ? SharedKinds::BUFFERS : SharedKinds::BUFFERS_AND_TEXTURES,
			placement.predecessors);
	for (uint32_t index = 0; index < p_requests.size(); ++index) {
		const TransientRequest &request = p_requests[index];
		const bool is_owner = owners[index] == index;
		if (!request.is_texture && is_owner) {
			entry->buffers.emplace_back(device, device.create_buffer(request.buffer));
			placement.buffers[index] = entry->buffers.back().get();
		} else if (request.is_texture && !has_aliased_memory) {
			const uint64_t bytes =
					compute_layer_bytes(request.texture) * request.texture.layer_count;
			placement.unaliased_bytes += bytes;
			if (is_owner) {
				entry->textures.emplace_back(device, device.create_texture(request.texture));
				placement.textures[index] = entry->textures.back().get();
				placement.aliased_bytes += bytes;
			}
		}
	}
	for (uint32_t index = 0; index < p_requests.size(); ++index) {
		placement.textures[index] = placement.textures[owners[index]];
		placement.buffers[index] = placement.buffers[owners[index]];
	}
	if (has_aliased_memory) {
		place_textures(*entry);
	}
	return entry;
}

void TransientPool::place_textures(Entry &r_entry) {
	TransientPlacement &placement = r_entry.placement;
	std::vector<PlacedBlock> blocks;
	std::vector<uint32_t> block_requests;
	for (uint32_t index = 0; index < r_entry.requests.size(); ++index) {
		const TransientRequest &request = r_entry.requests[index];
		if (!request.is_texture) {
			continue;
		}
		const auto needs = device.get_placement_requirements(request.texture);
		blocks.push_back(
				{ needs.size_bytes, needs.alignment_bytes, request.first_pass, request.last_pass });
		block_requests.push_back(index);
		placement.unaliased_bytes += needs.size_bytes;
	}
	placement.aliased_bytes = place_blocks(blocks);
	if (!blocks.empty()) {
		r_entry.memory = OwnedMemory(device,
				device.create_texture_memory("transient textures", placement.aliased_bytes));
	}
	for (size_t index = 0; index < blocks.size(); ++index) {
		const uint32_t request = block_requests[index];
		r_entry.textures.emplace_back(device,
				device.create_placed_texture(r_entry.requests[request].texture,
						r_entry.memory.get(), blocks[index].offset_bytes));
		placement.textures[request] = r_entry.textures.back().get();
		for (size_t other = 0; other < blocks.size(); ++other) {
			if (blocks[other].last_pass < blocks[index].first_pass &&
					overlaps_in_memory(blocks[index], blocks[other])) {
				placement.predecessors[request].push_back(block_requests[other]);
			}
		}
	}
}

} // namespace gnomon
