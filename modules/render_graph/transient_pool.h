#pragma once

#include "modules/rendering_device/rendering_device.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

/// A transient resource, and the first and last pass of its lifetime.
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
	/// For each request, the requests whose memory it reuses (all of them ended before it starts).
	std::vector<std::vector<uint32_t>> predecessors;
	uint64_t unaliased_bytes = 0; // of the textures, without aliasing
	uint64_t aliased_bytes = 0;	  // of the textures, as placed
};

/// A memory block with a lifetime, from first_pass to last_pass, that needs an offset.
struct PlacedBlock {
	uint64_t size_bytes = 0;
	uint64_t alignment_bytes = 1;
	uint32_t first_pass = 0;
	uint32_t last_pass = 0;
	uint64_t offset_bytes = 0; // set by place_blocks
};
/// Gives each block an offset such that blocks that live at the same time do not overlap: largest
/// block first, each at the lowest free offset. Returns the total size in bytes.
uint64_t place_blocks(std::vector<PlacedBlock> &r_blocks);

/// The kinds of resources that share_resources() shares.
enum class SharedKinds { BUFFERS, BUFFERS_AND_TEXTURES };
/// Returns for each request the index of the request whose resource it uses: its own, or that of a
/// request with the same description (names may differ) whose lifetime ended before.
/// r_predecessors, one list per request, receives the request that used the resource directly
/// before. Host-mapped buffers, and kinds that are not shared, get their own resource.
std::vector<uint32_t> share_resources(const std::vector<TransientRequest> &p_requests,
		SharedKinds p_kinds, std::vector<std::vector<uint32_t>> &r_predecessors);

/// Caches the transient resources of the last few frame layouts, so that a frame with the same
/// requests as an earlier one allocates nothing. Resources that were unused for MAX_UNUSED_FRAMES
/// frames are freed.
class TransientPool {
public:
	explicit TransientPool(RenderingDevice &p_device) : device(p_device) {}

	/// Returns the resources of a frame. They stay valid until the call after the next one.
	const TransientPlacement &place(const std::vector<TransientRequest> &p_requests);

private:
	struct Entry {
		std::vector<TransientRequest> requests;
		TransientPlacement placement;
		OwnedMemory memory; // of the textures, if the device has aliased memory
		std::vector<OwnedTexture> textures;
		std::vector<OwnedBuffer> buffers;
		uint64_t last_use = 0;
	};

	std::unique_ptr<Entry> make_entry(const std::vector<TransientRequest> &p_requests);
	/// Places all textures in one memory block; those that do not live at the same time overlap.
	void place_textures(Entry &r_entry);

	RenderingDevice &device;
	std::vector<std::unique_ptr<Entry>> entries;
	uint64_t use_count = 0;
};

} // namespace gnomon
