#pragma once

#include "modules/core/error.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

/// Table of resources by handle. A handle contains the slot's generation (upper 32 bits) and its
/// index + 1 (lower 32 bits; 0 would be the null handle), so that the use of a freed resource is
/// detected and reported by name, even if the slot has a new resource. The type Resource needs a
/// member `desc.name`.
template <typename Handle, typename Resource> class SlotTable {
public:
	explicit SlotTable(const char *p_kind) : kind(p_kind) {}

	Handle add(Resource &&p_resource) {
		if (free_indices.empty()) {
			free_indices.push_back(static_cast<uint32_t>(slots.size()));
			slots.emplace_back();
		}
		const uint32_t index = free_indices.back();
		free_indices.pop_back();
		slots[index].resource.emplace(std::move(p_resource));
		return Handle{ (uint64_t(slots[index].generation) << 32) | (index + 1u) };
	}

	Resource &get(Handle p_handle) { return *slots[find_index(p_handle)].resource; }
	const Resource &get(Handle p_handle) const { return *slots[find_index(p_handle)].resource; }

	/// Removes and returns the resource; the handle becomes invalid.
	Resource remove(Handle p_handle) {
		Slot &slot = slots[find_index(p_handle)];
		Resource resource = std::move(*slot.resource);
		slot.resource.reset();
		slot.freed_name = resource.desc.name;
		++slot.generation;
		free_indices.push_back(get_index(p_handle));
		return resource;
	}

	/// Calls p_visit(handle, resource) for each resource, oldest slot first.
	template <typename Visit> void for_each(const Visit &p_visit) {
		for (uint32_t index = 0; index < slots.size(); ++index) {
			Slot &slot = slots[index];
			if (slot.resource) {
				p_visit(Handle{ (uint64_t(slot.generation) << 32) | (index + 1u) }, *slot.resource);
			}
		}
	}

private:
	struct Slot {
		std::optional<Resource> resource;
		uint32_t generation = 1;
		std::string freed_name; // name of the slot's previous resource
	};

	static uint32_t get_index(Handle p_handle) { return static_cast<uint32_t>(p_handle.id) - 1u; }

	/// Returns the slot index of a valid handle; an invalid one is an assertion.
	uint32_t find_index(Handle p_handle) const {
		GNOMON_ASSERT(p_handle, "An empty ", kind, " handle was used.");
		GNOMON_ASSERT(get_index(p_handle) < slots.size(), "A ", kind, " handle of another device, ",
				p_handle.id, ", was used.");
		const Slot &slot = slots[get_index(p_handle)];
		GNOMON_ASSERT(slot.resource && slot.generation == p_handle.id >> 32, "The ", kind, " '",
				slot.freed_name, "' was used after it was freed.");
		return get_index(p_handle);
	}

	const char *kind;
	std::deque<Slot> slots; // a deque, so that references survive add()
	std::vector<uint32_t> free_indices;
};

} // namespace gnomon
