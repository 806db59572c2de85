// Counts the edges of a slice in the shape that suits GPUs: one invocation, a lane, per receiver and sample set, so that
// each has the counters of 64 points. The lanes of a receiver are consecutive. They divide the edges among themselves to
// test them and to find their sectors, and pass the sectors to each other.
#ifndef COUNT_SLICE_GPU_INC_GLSL
#define COUNT_SLICE_GPU_INC_GLSL

/// The invocation's sample set.
uint find_lane() {
	return gl_SubgroupInvocationID % LANES_PER_RECEIVER;
}

/// Edges of a slice that a receiver has to count, one bit each.
struct OwnEdges {
	uvec2 all;
	uvec2 is_negative; // their weight is negative
	uvec2 is_twice; // their weight is 2 or -2
};

bool has_bit(uvec2 p_bits, uint p_index) {
	return ((p_index < 32u ? p_bits.x : p_bits.y) >> (p_index & 31u) & 1u) != 0u;
}

/// Each lane tests its share of the edges.
OwnEdges find_own_edges(uint p_count, CountSubject p_subject) {
	OwnEdges own = OwnEdges(uvec2(0u), uvec2(0u), uvec2(0u));
	for (uint i = find_lane(); i < p_count; i += LANES_PER_RECEIVER) {
		const uint entry = chosen_edges[gl_SubgroupID * SLICE_SIZE + i];
		const CountEdgeRecord edge = load_count_edge(entry & COUNT_EDGE_MASK);
		if (p_subject.is_receiver &&
				may_hide(p_subject.receiver.position, p_subject.receiver.to_light, uintBitsToFloat(edge.a_face0.xyz),
						uintBitsToFloat(edge.b_face1.xyz))) {
			const uint packed_weight = entry >> COUNT_PACKED_WEIGHT_SHIFT;
			const int weight = (packed_weight & COUNT_HAS_WEIGHT) != 0u
					? unpack_weight(packed_weight)
					: count_weight(p_subject.receiver.position, load_count_plane0(edge), load_count_plane1(edge),
							  make_count_kind(edge.a_face0.w, edge.b_face1.w));
			const uvec2 bit = i < 32u ? uvec2(1u << i, 0u) : uvec2(0u, 1u << (i - 32u));
			own.all |= weight != 0 ? bit : uvec2(0u);
			own.is_negative |= weight < 0 ? bit : uvec2(0u);
			own.is_twice |= abs(weight) == 2 ? bit : uvec2(0u);
		}
	}
	// No two lanes have the same bit.
	const uvec4 bits = uvec4(add_lanes(ivec4(own.all, own.is_negative)));
	return OwnEdges(bits.xy, bits.zw, uvec2(add_lanes(ivec4(own.is_twice, 0, 0)).xy));
}

/// The edge with p_rank own ones before it.
CountedEdge load_own_edge(OwnEdges p_own, uint p_count, uint p_rank) {
	const bool is_valid = p_rank < p_count;
	const uint slot = is_valid ? find_set_bit(p_own.all, p_rank) : 0u;
	const CountEdgeRecord edge = load_count_edge(chosen_edges[gl_SubgroupID * SLICE_SIZE + slot] & COUNT_EDGE_MASK);
	const int weight = has_bit(p_own.is_twice, slot) ? 2 : 1;
	return CountedEdge(uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz),
			is_valid ? (has_bit(p_own.is_negative, slot) ? -weight : weight) : 0);
}

/// Adds the points of two sectors to the lane's counters. Their area is added where they were found.
void count_lane_sectors(CountSectors p_sectors, inout CountState r_state) {
	r_state.surplus += find_surplus(p_sectors);
	const uint lane = find_lane();
	const uvec4 first = load_count_masks(p_sectors.mask_index.x, lane / 2u);
	const uvec4 second = load_count_masks(p_sectors.mask_index.y, lane / 2u);
	const bool is_odd = (lane & 1u) != 0u;
	count_sample_set(p_sectors, is_odd ? first.zw : first.xy, is_odd ? second.zw : second.xy, lane, r_state.counters0);
}

/// The sectors that two lanes have found as their first ones, without their area: those whose numbers differ by the bits
/// p_other and p_other + 1.
CountSectors load_lane_sectors(CountSectors p_sectors, uint p_other) {
	const uint own_bits = (p_sectors.flip.x & 1u) | (p_sectors.once.x & 2u) | (p_sectors.twice.x & 4u);
	CountSectors sectors;
	sectors.area = vec2(0.0);
	uvec2 bits;
	for (uint i = 0u; i < 2u; ++i) {
		const uint other = p_other + i;
		sectors.mask_index[i] = subgroupShuffleXor(p_sectors.mask_index.x, other);
		sectors.from_angle[i] = subgroupShuffleXor(p_sectors.from_angle.x, other);
		sectors.to_angle[i] = subgroupShuffleXor(p_sectors.to_angle.x, other);
		bits[i] = subgroupShuffleXor(own_bits, other);
	}
	sectors.flip = make_bit_masks(notEqual(bits & 1u, uvec2(0u)));
	sectors.once = make_bit_masks(notEqual(bits & 2u, uvec2(0u)));
	sectors.twice = make_bit_masks(notEqual(bits & 4u, uvec2(0u)));
	return sectors;
}

void count_slice_on_gpu(uint p_count, CountSubject p_subject, inout CountState r_state) {
	const OwnEdges own = find_own_edges(p_count, p_subject);
	const uint count = uint(bitCount(own.all.x) + bitCount(own.all.y));
	const uint max_count = subgroup_max(count);
	r_state.edge_count += count;
	if (SAMPLE_SET_COUNT == 4u) {
		// Each lane finds the sectors of one edge at a time: two would take more registers. Lanes count two at a time.
		for (uint first = 0u; first < max_count; first += LANES_PER_RECEIVER) {
			const CountedEdge edge = load_own_edge(own, count, first + find_lane());
			const CountSectors sectors = find_edge_sectors(p_subject.receiver, edge, CountedEdge(edge.a, edge.b, 0));
			r_state.area += round_area(sectors);
			for (uint other = 0u; other < LANES_PER_RECEIVER; other += 2u) {
				count_lane_sectors(load_lane_sectors(sectors, other), r_state);
			}
		}
	} else {
		for (uint first = 0u; first < max_count; first += 2u) {
			const CountSectors sectors = find_edge_sectors(p_subject.receiver, load_own_edge(own, count, first),
					load_own_edge(own, count, first + 1u));
			r_state.area += round_area(sectors);
			count_lane_sectors(sectors, r_state);
		}
	}
	iteration_count += p_count;
}

#endif
