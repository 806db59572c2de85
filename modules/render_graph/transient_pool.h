#pragma once

#include "modules/rendering_device/rendering_device.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

/// A transient resource and the passes between which it lives, both included.
struct TransientRequest {
	bool is_texture = true;
	TextureDesc texture;
	BufferDesc buffer;
	uint32_t first_pass = 0;
	uint32_t last_pass = 0;
	bool operator==(const TransientRequest &) const = default;
};

/// Where the requests were placed. Entry i belongs to request i.
struct TransientPlacement {
	std::vector<TextureRID> textures;
	std::vector<BufferRID> buffers;
	/// Requests whose memory request i takes over (all lived before it).
	std::vector<std::vector<uint32_t>> predecessors;
	uint64_t unaliased_bytes = 0;
	uint64_t aliased_bytes = 0;
};

/// A block that lives during some passes and needs an offset.
struct PlacedBlock {
	uint64_t size_bytes = 0;
	uint64_t alignment_bytes = 1;
	uint32_t first_pass = 0;
	uint32_t last_pass = 0;
	uint64_t offset_bytes = 0; // set by place_blocks
};
/// Gives each block an offset such that blocks that live at the same time do not overlap. Largest
/// first, each at the lowest free offset. Returns the size of the whole.
uint64_t place_blocks(std::vector<PlacedBlock> &r_blocks);

/// For each request of a buffer the request whose buffer it gets: its own, or one of the same size,
/// usage and memory that was done with before. r_predecessors, one list per request, gets those
/// that had it before. Entries of textures mean nothing. Buffers that the host maps are not shared.
std::vector<uint32_t> share_buffers(const std::vector<TransientRequest> &p_requests,
		std::vector<std::vector<uint32_t>> &r_predecessors);

/// Keeps the transient resources of the last few frame shapes, so that a frame like an earlier one
/// allocates nothing. What many frames did not use is freed.
class TransientPool {
public:
	explicit TransientPool(RenderingDevice &p_device) : device(p_device) {}

	/// Valid until the frame after the next call.
	const TransientPlacement &place(const std::vector<TransientRequest> &p_requests);

private:
	struct Entry {
		std::vector<TransientRequest> requests;
		TransientPlacement placement;
		OwnedMemory memory;
		std::vector<OwnedTexture> textures;
		std::vector<OwnedBuffer> buffers;
		uint64_t last_use = 0;
	};

	RenderingDevice &device;
	std::vector<std::unique_ptr<Entry>> entries;
	uint64_t use_count = 0;
};

} // namespace gnomon
