#pragma once

#include "modules/rendering_device/range_allocator.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

#include <memory>
#include <vector>

namespace gnomon {

/// Buffers and optimally tiled images never share a block, so that bufferImageGranularity never
/// matters.
enum class Tiling { LINEAR, OPTIMAL };

/// The memory of one vkAllocateMemory call.
struct MemoryBlock {
	VkDeviceMemory memory = VK_NULL_HANDLE;
	uint64_t size_bytes = 0;
	uint32_t memory_type = 0;
	Tiling tiling = Tiling::LINEAR;
	bool is_dedicated = false; // holds one resource
	uint8_t *mapped = nullptr; // of LINEAR blocks in host-visible memory
	RangeAllocator ranges;

	explicit MemoryBlock(uint64_t p_size_bytes) : size_bytes(p_size_bytes), ranges(p_size_bytes) {}
};

/// A range of a block; empty if `block` is null.
struct Allocation {
	MemoryBlock *block = nullptr;
	uint64_t offset_bytes = 0;
	uint64_t size_bytes = 0;
};

struct MemoryRequest {
	VkMemoryRequirements needs = {};
	MemoryKind kind = MemoryKind::GPU;
	Tiling tiling = Tiling::LINEAR;
};

/// Sub-allocates device memory from blocks of at most 64 MiB, which each have one memory type and
/// tiling. Requests for more than half a block get their own block. Empty blocks are freed, except
/// one per memory type and tiling.
class MemoryAllocator {
public:
	static constexpr uint64_t BLOCK_BYTES = uint64_t(64) << 20;

	/// p_budget_bytes = 0: what the device reports, but at most 90 % of each heap.
	void initialize(VkPhysicalDevice p_physical_device, VkDevice p_device,
			bool p_has_budget_extension, uint64_t p_budget_bytes);
	/// All allocations must have been freed.
	void destroy();

	/// Returns an empty allocation if it would exceed the budget or the driver is out of memory.
	Allocation allocate(const MemoryRequest &p_request);
	void free(Allocation &r_allocation);

	/// Returns the best memory type for the kind among the allowed ones. Vulkan guarantees that one
	/// exists for the bits that buffers and images require.
	uint32_t find_memory_type(uint32_t p_type_bits, MemoryKind p_kind) const;
	MemoryUse get_use() const { return use; }
	uint64_t compute_budget_bytes(uint32_t p_memory_type);

private:
	MemoryBlock *create_block(
			const MemoryRequest &p_request, uint32_t p_type, uint64_t p_size_bytes);
	void destroy_block(MemoryBlock *p_block);
	void refresh_heap_budgets();
	Allocation allocate_in_block(MemoryBlock &r_block, const MemoryRequest &p_request);

	VkPhysicalDevice physical_device = VK_NULL_HANDLE;
	VkDevice device = VK_NULL_HANDLE;
	bool has_budget_extension = false;
	uint64_t option_budget_bytes = 0;
	uint64_t max_allocation_bytes = 0;
	VkPhysicalDeviceMemoryProperties properties = {};
	uint64_t heap_budget_bytes[VK_MAX_MEMORY_HEAPS] = {};
	uint64_t heap_used_bytes[VK_MAX_MEMORY_HEAPS] = {};
	std::vector<std::unique_ptr<MemoryBlock>> blocks;
	MemoryUse use;
};

} // namespace gnomon
