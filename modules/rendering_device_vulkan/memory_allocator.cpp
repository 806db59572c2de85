#include "modules/rendering_device_vulkan/memory_allocator.h"

#include "modules/core/error.h"

#include <algorithm>

namespace gnomon {

namespace {

// A heap's last tenth is left to the driver and to other programs.
constexpr uint64_t HEAP_PERCENT = 90;
// A block takes at most 1/16 of its heap, so that a few spare blocks do not fill a small heap, such
// as a 256 MiB window into the memory of a large device.
constexpr uint64_t BLOCKS_PER_HEAP = 16;

/// Returns how well a memory type suits the kind: higher is better, -1 is unusable. The property
/// with factor 2 decides; the other one chooses between types that are equal in it.
int rate_memory_type(VkMemoryPropertyFlags p_flags, MemoryKind p_kind) {
	const auto has = [&](VkMemoryPropertyFlags p_flag) { return (p_flags & p_flag) == p_flag; };
	const bool is_mappable =
			has(VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
	if (has(VK_MEMORY_PROPERTY_PROTECTED_BIT) || has(VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT) ||
			has(VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD)) {
		return -1;
	}
	switch (p_kind) {
		case MemoryKind::GPU:
			return 2 * has(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) +
					!has(VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT);
		case MemoryKind::UPLOAD:
			return is_mappable ? 2 * !has(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) +
							!has(VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
							   : -1;
		case MemoryKind::READBACK:
			return is_mappable ? 2 * has(VK_MEMORY_PROPERTY_HOST_CACHED_BIT) +
							!has(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
							   : -1;
	}
	return -1;
}

} // namespace

void MemoryAllocator::initialize(VkPhysicalDevice p_physical_device, VkDevice p_device,
		bool p_has_budget_extension, uint64_t p_budget_bytes) {
	physical_device = p_physical_device;
	device = p_device;
	has_budget_extension = p_has_budget_extension;
	option_budget_bytes = p_budget_bytes;
	vkGetPhysicalDeviceMemoryProperties(physical_device, &properties);
	VkPhysicalDeviceMaintenance3Properties limits = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES
	};
	VkPhysicalDeviceProperties2 device_properties = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &limits
	};
	vkGetPhysicalDeviceProperties2(physical_device, &device_properties);
	max_allocation_bytes = limits.maxMemoryAllocationSize;
	refresh_heap_budgets();
	const uint32_t type = find_memory_type(/*p_type_bits=*/~0u, MemoryKind::GPU);
	use.budget_bytes = compute_budget_bytes(type);
}

void MemoryAllocator::destroy() {
	GNOMON_ASSERT(use.used_bytes == 0, use.used_bytes, " bytes are still in use");
	while (!blocks.empty()) {
		destroy_block(blocks.back().get());
	}
}

uint32_t MemoryAllocator::find_memory_type(uint32_t p_type_bits, MemoryKind p_kind) const {
	int best_rating = -1;
	uint32_t best_type = 0;
	for (uint32_t type = 0; type < properties.memoryTypeCount; ++type) {
		const int rating = rate_memory_type(properties.memoryTypes[type].propertyFlags, p_kind);
		if ((p_type_bits & (1u << type)) && rating > best_rating) {
			best_rating = rating;
			best_type = type;
		}
	}
	GNOMON_ASSERT(best_rating >= 0, "no memory type for kind ", static_cast<int>(p_kind),
			" in bits ", p_type_bits);
	return best_type;
}

void MemoryAllocator::refresh_heap_budgets() {
	VkPhysicalDeviceMemoryBudgetPropertiesEXT reported = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT
	};
	VkPhysicalDeviceMemoryProperties2 properties2 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2,
		.pNext = has_budget_extension ? &reported : nullptr
	};
	vkGetPhysicalDeviceMemoryProperties2(physical_device, &properties2);
	for (uint32_t heap = 0; heap < properties.memoryHeapCount; ++heap) {
		heap_budget_bytes[heap] = properties.memoryHeaps[heap].size / 100 * HEAP_PERCENT;
		if (reported.heapBudget[heap] > 0) {
			heap_budget_bytes[heap] =
					std::min<uint64_t>(heap_budget_bytes[heap], reported.heapBudget[heap]);
		}
	}
}

uint64_t MemoryAllocator::compute_budget_bytes(uint32_t p_memory_type) {
	return option_budget_bytes > 0
			? option_budget_bytes
			: heap_budget_bytes[properties.memoryTypes[p_memory_type].heapIndex];
}

Allocation MemoryAllocator::allocate_in_block(
		MemoryBlock &r_block, const MemoryRequest &p_request) {
	const auto offset = r_block.ranges.allocate(p_request.needs.size, p_request.needs.alignment);
	if (!offset) {
		return {};
	}
	use.used_bytes += p_request.needs.size;
	use.peak_bytes = std::max(use.peak_bytes, use.used_bytes);
	heap_used_bytes[properties.memoryTypes[r_block.memory_type].heapIndex] += p_request.needs.size;
	return { &r_block, *offset, p_request.needs.size };
}

Allocation MemoryAllocator::allocate(const MemoryRequest &p_request) {
	const uint64_t size_bytes = p_request.needs.size;
	const uint32_t type = find_memory_type(p_request.needs.memoryTypeBits, p_request.kind);
	const uint32_t heap = properties.memoryTypes[type].heapIndex;
	const uint64_t used = option_budget_bytes > 0 ? use.used_bytes : heap_used_bytes[heap];
	const uint64_t budget = compute_budget_bytes(type);
	if (size_bytes > max_allocation_bytes || size_bytes > budget || used > budget - size_bytes) {
		return {};
	}
	const uint64_t block_bytes =
			std::min(BLOCK_BYTES, properties.memoryHeaps[heap].size / BLOCKS_PER_HEAP);
	if (size_bytes <= block_bytes / 2) {
		for (const auto &block : blocks) {
			// A block for the GPU is not mapped if that failed, see create_block.
			const bool is_suitable = block->mapped || p_request.kind == MemoryKind::GPU;
			if (!block->is_dedicated && block->memory_type == type &&
					block->tiling == p_request.tiling && is_suitable) {
				if (Allocation allocation = allocate_in_block(*block, p_request);
						allocation.block) {
					return allocation;
				}
			}
		}
		if (MemoryBlock *block = create_block(p_request, type, block_bytes)) {
			return allocate_in_block(*block, p_request);
		}
	}
	// A large request, or the driver has no room for a whole block: allocate exactly the requested
	// size.
	MemoryBlock *block = create_block(p_request, type, size_bytes);
	if (!block) {
		return {};
	}
	block->is_dedicated = true;
	return allocate_in_block(*block, p_request);
}

void MemoryAllocator::free(Allocation &r_allocation) {
	MemoryBlock *block = r_allocation.block;
	if (!block) {
		return;
	}
	block->ranges.free(r_allocation.offset_bytes, r_allocation.size_bytes);
	use.used_bytes -= r_allocation.size_bytes;
	heap_used_bytes[properties.memoryTypes[block->memory_type].heapIndex] -=
			r_allocation.size_bytes;
	r_allocation = {};
	if (!block->ranges.is_empty()) {
		return;
	}
	// Keep one empty block per memory type and tiling, so that a resource that is freed and created
	// again does not allocate memory each time.
	const bool has_spare = std::any_of(blocks.begin(), blocks.end(), [&](const auto &p_other) {
		return p_other.get() != block && !p_other->is_dedicated && p_other->ranges.is_empty() &&
				p_other->memory_type == block->memory_type && p_other->tiling == block->tiling;
	});
	if (block->is_dedicated || has_spare) {
		destroy_block(block);
	}
}

MemoryBlock *MemoryAllocator::create_block(
		const MemoryRequest &p_request, uint32_t p_type, uint64_t p_size_bytes) {
	const VkMemoryAllocateInfo info = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
		.allocationSize = p_size_bytes,
		.memoryTypeIndex = p_type };
	auto block = std::make_unique<MemoryBlock>(p_size_bytes);
	if (vkAllocateMemory(device, &info, nullptr, &block->memory) != VK_SUCCESS) {
		return nullptr;
	}
	block->memory_type = p_type;
	block->tiling = p_request.tiling;
	const bool is_visible = (properties.memoryTypes[p_type].propertyFlags &
									VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
	if (is_visible && p_request.tiling == Tiling::LINEAR) {
		void *mapped = nullptr;
		if (vkMapMemory(device, block->memory, 0, VK_WHOLE_SIZE, 0, &mapped) != VK_SUCCESS &&
				p_request.kind != MemoryKind::GPU) {
			vkFreeMemory(device, block->memory, nullptr);
			return nullptr;
		}
		block->mapped = static_cast<uint8_t *>(mapped);
	}
	use.allocated_bytes += p_size_bytes;
	blocks.push_back(std::move(block));
	refresh_heap_budgets();
	return blocks.back().get();
}

void MemoryAllocator::destroy_block(MemoryBlock *p_block) {
	vkFreeMemory(device, p_block->memory, nullptr); // also unmaps
	use.allocated_bytes -= p_block->size_bytes;
	std::erase_if(blocks, [&](const auto &p_other) { return p_other.get() == p_block; });
}

} // namespace gnomon
