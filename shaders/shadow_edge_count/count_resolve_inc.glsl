// Counts the edges of a block's pixels: what the resolve and its debug images share.
//
// Software drivers run a branch that nobody takes, and a loop's body once even where nobody enters it. So
// what is rare has a loop of its own behind the common case, and loops test at their ends.
#ifndef COUNT_RESOLVE_INC_GLSL
#define COUNT_RESOLVE_INC_GLSL

#include "shadow_edge_count/count_blocks_inc.glsl"
#include "shadow_edge_count/count_bundles_inc.glsl"
#include "shadow_edge_count/count_edge_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_CHAINS) uniform utextureBuffer chains_buffer;
layout(set = 0, binding = COUNT_BINDING_LISTS) uniform utextureBuffer lists_buffer;
layout(set = 0, binding = COUNT_BINDING_MASKS) uniform utextureBuffer masks_buffer;

/// The blocks have no lists: each group of pixels goes through all bundles of the light.
layout(constant_id = EDGE_COUNT_CONSTANT_HAS_NO_LIST) const bool HAS_NO_LIST = false;

uvec2 load_count_mask(uint p_index) {
	return texelFetch(masks_buffer, int(p_index)).rg;
}

// Edges that some receiver of a subgroup may have to count, and what is known of them, in one word each: a slice
// for each subgroup.
const uint SLICE_SIZE = 64u;
shared uint chosen_edges[SLICE_SIZE * EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX / 4];
// Edges that a receiver has to count, and their weights. All entries 0 of a subgroup, then all entries 1.
const uint MOST_OWN_EDGES = 112u;
shared uint own_edges[MOST_OWN_EDGES * EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX];

/// One pixel: what it receives, and what was counted.
struct CountPixel {
	ivec2 pixel;
	uint edge_count; // that it counted
	float visibility; // 0 where it is no receiver
	int solid_count; // between it and the light's centre
};

/// Pixels of a work group so that those of a subgroup lie close together: 4 x 2, 8 x 4 or 8 x 8.
uvec2 find_count_place() {
	const uint index = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
	const uint x = (index & 1u) | ((index >> 1) & 2u) | ((index >> 2) & 4u);
	const uint y = ((index >> 1) & 1u) | ((index >> 2) & 2u) | ((index >> 3) & 4u);
	return uvec2(x, y);
}

/// Edges that a box's receivers may need.
struct CountChoice {
	uint next; // index in the list, or edge, from where to go on
	uint count;
};

/// Each invocation tests one edge. p_entry: the edge and what is known of it for the block.
void choose_edge(CountBox p_box, uint p_entry, bool p_is_there, inout CountChoice r_choice) {
	const CountEdgeRecord edge = load_count_edge(p_entry & COUNT_EDGE_MASK);
	const bool is_chosen = p_is_there &&
			is_edge_in_reach(p_box, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz));
	const uvec4 chosen = subgroupBallot(is_chosen);
	if (is_chosen) {
		chosen_edges[gl_SubgroupID * SLICE_SIZE + r_choice.count + subgroupBallotExclusiveBitCount(chosen)] =
				p_entry;
	}
	r_choice.count += subgroupBallotBitCount(chosen);
}

bool has_choice_room(CountChoice p_choice, uint p_more) {
	return p_choice.count + p_more <= SLICE_SIZE;
}

/// From the block's list, which has p_end edges. Ends where the slice may be full.
CountChoice choose_from_list(uint p_first, uint p_end, inout uint r_chunk, CountBox p_box) {
	const uint size = uint(EDGE_COUNT_CHUNK_SIZE);
	CountChoice choice = CountChoice(p_first, 0u);
	do {
		const uint index = choice.next + gl_SubgroupInvocationID;
		const bool is_there = index < p_end;
		const uint entry = texelFetch(lists_buffer, is_there ? int(r_chunk * size + index % size) : 0).r;
		choose_edge(p_box, is_there ? entry : 0u, is_there, choice);
		choice.next += gl_SubgroupSize;
		r_chunk = choice.next % size == 0u
				? texelFetch(lists_buffer, int(light.chunk_capacity * size + r_chunk)).r
				: r_chunk;
	} while (choice.next < p_end && has_choice_room(choice, gl_SubgroupSize));
	return choice;
}

/// From all edges of the light, bundle by bundle. Edges p_first .. p_end, whole bundles.
CountChoice choose_from_bundles(uint p_first, uint p_end, CountBox p_box) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint bundle_count = find_bundle_count(p_end);
	CountChoice choice = CountChoice(p_first, 0u);
	do {
		const uint first_bundle = choice.next / size;
		const uint bundle = first_bundle + gl_SubgroupInvocationID;
		const bool is_wanted = bundle < bundle_count &&
				may_use_bundle(p_box, load_count_bundle(min(bundle, bundle_count - 1u)));
		uvec4 wanted = subgroupBallot(is_wanted);
		choice.next += gl_SubgroupSize * size;
		while (subgroupBallotBitCount(wanted) != 0u) {
			const uint lane = subgroupBallotFindLSB(wanted);
			if (has_choice_room(choice, size)) {
				wanted[lane / 32u] &= ~(1u << (lane & 31u));
				for (uint i = 0u; i < size; i += gl_SubgroupSize) {
					const uint edge = (first_bundle + lane) * size + i + gl_SubgroupInvocationID;
					choose_edge(p_box, min(edge, p_end - 1u),
							i + gl_SubgroupInvocationID < size && edge < p_end, choice);
				}
			} else {
				choice.next = (first_bundle + lane) * size; // from here on the next time
				wanted = uvec4(0u);
			}
		}
	} while (choice.next < p_end && has_choice_room(choice, size));
	return choice;
}

/// False: the part of the edge that lies between a receiver and its disc hides nothing of it. Wider than
/// what count_add_edge does by more than rounding.
bool may_hide(vec3 p_receiver, vec3 p_to_light, vec3 p_a, vec3 p_b) {
	const float ROUNDING = 4e-6;
	const float radius = 1.001 * light.disc_radius;
	const vec3 a = p_a - p_receiver;
	const vec3 b = p_b - p_receiver;
	const float d_a = dot(p_to_light, a);
	const float d_b = dot(p_to_light, b);
	const float length_a = length(a);
	const float length_b = length(b);
	const float inverse = length(p_to_light);
	// The edge on the disc's plane goes along `way`, at least `aside` from the centre.
	const vec3 way = b * d_a - a * d_b;
	const float length_way = length(way);
	const float aside = abs(dot(p_to_light, cross(a, b)));
	const bool is_aside = aside > inverse * (radius * length_way + ROUNDING * length_a * length_b);
	const bool is_beyond = min(d_a, d_b) > 0.0 &&
			(dot(a, way) > length_way * (radius * d_a + ROUNDING * length_a) ||
					dot(b, way) < -length_way * (radius * d_b + ROUNDING * length_b));
	const bool is_below = max(d_a, d_b) <= 0.0;
	const bool is_above = light.is_directional == 0u && min(d_a, d_b) > 1.001;
	return !is_aside && !is_beyond && !is_below && !is_above;
}

/// An edge that a subgroup may have to count; each invocation has one.
struct CountCandidate {
	uint entry;
	bool is_there;
	vec3 a;
	vec3 b;
	CountEdgeKind kind;
	vec4 plane0;
	vec4 plane1;
};

/// Gives the candidates to one receiver, if it is in the cluster and has to count them.
void share_with(uint p_lane, CountCandidate p_candidate, uvec4 p_cluster, CountReceiver p_receiver,
		inout uint r_own_count) {
	const uint own_begin = gl_SubgroupID * gl_SubgroupSize * MOST_OWN_EDGES;
	const vec3 receiver = subgroupBroadcast(p_receiver.position, p_lane);
	const vec3 to_light = subgroupBroadcast(p_receiver.to_light, p_lane);
	const uint known = p_candidate.entry >> COUNT_KNOWN_SHIFT;
	const int weight = (known & COUNT_KNOWS_WEIGHT) != 0u
			? get_known_weight(known)
			: count_weight(receiver, p_candidate.plane0, p_candidate.plane1, p_candidate.kind);
	const bool is_own = p_candidate.is_there && subgroupBallotBitExtract(p_cluster, p_lane) && weight != 0 &&
			may_hide(receiver, to_light, p_candidate.a, p_candidate.b);
	const uvec4 own = subgroupBallot(is_own);
	const uint place = subgroupBroadcast(r_own_count, p_lane) + subgroupBallotExclusiveBitCount(own);
	if (is_own) {
		own_edges[own_begin + place * gl_SubgroupSize + p_lane] = (p_candidate.entry & COUNT_EDGE_MASK) |
				uint(weight + COUNT_WEIGHT_BIAS) << (COUNT_WEIGHT_SHIFT + COUNT_KNOWN_SHIFT);
	}
	r_own_count += gl_SubgroupInvocationID == p_lane ? subgroupBallotBitCount(own) : 0u;
}

/// Gives the chosen edges to those receivers of a cluster that have to count them. r_own_count: how many edges
/// this invocation's receiver has. Four receivers an iteration: llvmpipe ends every loop once an
/// invocation has made 65535 iterations, of all its loops together.
void share_choice(uint p_count, uvec4 p_cluster, CountReceiver p_receiver, inout uint r_own_count) {
	uint first = 0u;
	do {
		const uint item = first + gl_SubgroupInvocationID;
		CountCandidate candidate;
		candidate.is_there = item < p_count;
		candidate.entry = candidate.is_there ? chosen_edges[gl_SubgroupID * SLICE_SIZE + item]
											 : COUNT_KNOWS_WEIGHT << COUNT_KNOWN_SHIFT;
		const CountEdgeRecord edge = load_count_edge(candidate.entry & COUNT_EDGE_MASK);
		candidate.a = uintBitsToFloat(edge.a_face0.xyz);
		candidate.b = uintBitsToFloat(edge.b_face1.xyz);
		candidate.kind = make_count_kind(edge.a_face0.w, edge.b_face1.w);
		candidate.plane0 = load_count_plane0(edge);
		candidate.plane1 = load_count_plane1(edge);
		for (uint lane = 0u; lane < gl_SubgroupSize; lane += 4u) {
			share_with(lane, candidate, p_cluster, p_receiver, r_own_count);
			share_with(lane + 1u, candidate, p_cluster, p_receiver, r_own_count);
			share_with(lane + 2u, candidate, p_cluster, p_receiver, r_own_count);
			share_with(lane + 3u, candidate, p_cluster, p_receiver, r_own_count);
		}
		first += gl_SubgroupSize;
	} while (first < p_count);
}

/// Counts the edges that each invocation's receiver has.
void count_own_edges(CountReceiver p_receiver, uint p_own_count, inout CountState r_state) {
	const uint own_begin = gl_SubgroupID * gl_SubgroupSize * MOST_OWN_EDGES + gl_SubgroupInvocationID;
	const uint most = subgroupMax(p_own_count);
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	uint i = 0u;
	do {
		const bool is_there = i < p_own_count;
		const uint entry = is_there ? own_edges[own_begin + i * gl_SubgroupSize] : 0u;
		const CountEdgeRecord edge = load_count_edge(entry & COUNT_EDGE_MASK);
		count_add_edge(p_receiver, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz),
				is_there ? get_known_weight(entry >> COUNT_KNOWN_SHIFT) : 0, r_state);
		++i;
	} while (i < most);
	subgroupMemoryBarrierShared();
	subgroupBarrier();
}

/// The bounds of those receivers of a subgroup that are in it.
CountBounds find_subgroup_bounds(CountPoint p_point, bool p_is_here, vec2 p_slope) {
	const float range = p_point.warped.z - dot(p_slope, p_point.warped.xy);
	return CountBounds(subgroupMin(p_is_here ? p_point.warped.xy : vec2(COUNT_FAR)),
			subgroupMax(p_is_here ? p_point.warped.xy : vec2(-COUNT_FAR)), p_slope,
			vec2(subgroupMin(p_is_here ? range : COUNT_FAR), subgroupMax(p_is_here ? range : -COUNT_FAR)));
}

CountPixel count_pixel() {
	const float CLUSTER_SIZES = 0.05; // of S
	const uint block = find_block();
	CountPixel result;
	result.pixel = ivec2(find_block_corner(block) + find_count_place());
	result.edge_count = 0u;
	const bool is_receiver = is_in_picture(result.pixel) && is_receiver_pixel(result.pixel);
	CountPoint point = CountPoint(vec3(0.0, 0.0, 1.0), 0u, vec3(0.0, 0.0, 1.0), vec2(0.0));
	if (is_receiver) {
		point = load_count_point(result.pixel);
	}
	const bool is_counted = is_receiver && may_count_at(point);
	const CountReceiver receiver = make_count_receiver(light, point.position);
	CountState state = make_count_state(
			is_counted ? count_solids(light, VIEW_COUNT == 1u ? 0u : point.view, point.warped.xy, receiver) : 0);
	bool waits = is_counted;
	uint next = 0u; // in the list of the cluster
	uint chunk = 0u;
	do {
		uint own_count = 0u;
		bool is_full = false;
		do {
			// A cluster: those beside the first one. Where pixels lie far apart, as beside an object's outline,
			// what is between them would make them ask for many edges that none of them needs.
			const bool is_any = subgroupAny(waits);
			const uint leader = is_any ? subgroupBallotFindLSB(subgroupBallot(waits)) : 0u;
			const uint view = VIEW_COUNT == 1u ? 0u : subgroupBroadcast(point.view, leader);
			const vec3 away = point.position - subgroupBroadcast(point.position, leader);
			const float widest = CLUSTER_SIZES * light.scene_size_m;
			const bool is_here = waits && point.view == view && dot(away, away) <= widest * widest;
			const uvec4 cluster = subgroupBallot(is_here);
			const CountBox box = make_count_box(light, light.views[view],
					find_subgroup_bounds(point, is_here, subgroupBroadcast(point.slope, leader)));
			uint end = find_edge_count();
			if (!HAS_NO_LIST) {
				const uint chain = (block * VIEW_COUNT + view) * uint(EDGE_COUNT_CHAIN_WORDS);
				end = texelFetch(chains_buffer, int(chain + uint(EDGE_COUNT_CHAIN_COUNT))).r;
				chunk = next > 0u ? chunk
								  : texelFetch(chains_buffer, int(chain + uint(EDGE_COUNT_CHAIN_FIRST))).r;
			}
			end = is_any ? end : 0u;
			do {
				CountChoice choice;
				if (HAS_NO_LIST) {
					choice = choose_from_bundles(next, end, box);
				} else {
					choice = choose_from_list(next, end, chunk, box);
				}
				next = choice.next;
				subgroupMemoryBarrierShared();
				subgroupBarrier();
				share_choice(choice.count, cluster, receiver, own_count);
				subgroupMemoryBarrierShared();
				subgroupBarrier();
				is_full = subgroupAny(own_count + SLICE_SIZE > MOST_OWN_EDGES);
			} while (next < end && !is_full);
			const bool is_done = next >= end;
			waits = waits && !(is_done && is_here);
			next = is_done ? 0u : next;
		} while (!is_full && subgroupAny(waits));
		count_own_edges(receiver, own_count, state);
		result.edge_count += own_count;
	} while (subgroupAny(waits));
	result.solid_count = state.solid_count;
	result.visibility = is_counted ? count_resolve(state) : (is_receiver ? 1.0 : 0.0);
	return result;
}

#endif
