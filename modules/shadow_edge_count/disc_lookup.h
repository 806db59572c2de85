#pragma once

#include "modules/shadow_edge_count/disc_masks.h"

namespace gnomon {

/// Lookups of masks in double precision: the C++ version of count_masks_inc.glsl.
class DiscLookup : public DiscMasks {
public:
	explicit DiscLookup(uint32_t p_sample_set = 0, uint32_t p_sample_set_count = 1) :
			DiscMasks(p_sample_set, p_sample_set_count), sample_set(p_sample_set),
			sample_set_count(p_sample_set_count) {}

	/// Mask of the points that are farther than p_offset (0..1) from the centre along p_direction,
	/// which is unit. The line keeps its point at p_middle when its direction is rounded, see
	/// find_count_mask_indices.
	uint64_t get_mask(const glm::dvec2 &p_direction, double p_offset, double p_middle) const;
	/// Mask of the points in the sector from p_from counter-clockwise to p_to, less than half a
	/// circle. Adjacent sectors have no point in common and miss none between them.
	uint64_t get_wedge(const glm::dvec2 &p_from, const glm::dvec2 &p_to) const;
	/// Index of the first point whose angle is not below the direction's.
	uint32_t find_sector(const glm::dvec2 &p_direction) const;

private:
	uint32_t sample_set = 0;
	uint32_t sample_set_count = 1;
};

} // namespace gnomon
