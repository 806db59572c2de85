// Bit masks of the 64 sample points of the light (two words each, see DiscMasks), and 64 counters, stored as nine bit
// planes. Functions of directions take two at once, component by component: the chains of dependent divisions, square
// roots and products take most of the time, and processors compute two such chains in nearly the time of one.
#ifndef COUNT_MASKS_INC_GLSL
#define COUNT_MASKS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

const float COUNT_PI = 3.14159265358979;

/// Number of sets of 64 points: 1, or 4 for 256 points. The results of all sets are averaged.
layout(constant_id = EDGE_COUNT_CONSTANT_SAMPLE_SETS) const uint SAMPLE_SET_COUNT = 1u;
/// Invocations, called lanes, that share the sample sets of a receiver.
layout(constant_id = EDGE_COUNT_CONSTANT_IS_CPU) const bool IS_CPU = true;
const uint LANES_PER_RECEIVER = IS_CPU ? 1u : SAMPLE_SET_COUNT;
const uint SETS_PER_LANE = SAMPLE_SET_COUNT / LANES_PER_RECEIVER;

/// Loads the masks of sample sets 2 p_pair (in x, y) and 2 p_pair + 1 (in z, w). p_index: see find_count_mask_indices.
uvec4 load_count_masks(uint p_index, uint p_pair);

/// Indices in the mask table of the points of the unit disc that are beyond two lines, component by component. p_x, p_y:
/// unit vector from the disc's centre to the line at p_offset (0..1). The direction is rounded to the middle of a bin, and
/// the line then turned about its point at p_middle, which is measured from the foot of the perpendicular, a quarter turn
/// counter-clockwise from (p_x, p_y): there the rounding does not move it. Bins divide the range 0..4 of the diamond angle
/// evenly, which is 1 + y / (|x| + |y|) where x >= 0, else 3 - y / (|x| + |y|): 0 at -y, 1 at +x, 2 at +y, 3 at -x.
uvec2 find_count_mask_indices(vec2 p_x, vec2 p_y, vec2 p_offset, vec2 p_middle) {
	const float bins_per_unit = float(EDGE_COUNT_DIRECTION_COUNT / 4);
	const vec2 sum = max(abs(p_x) + abs(p_y), vec2(1e-37));
	const vec2 ratio = p_y / sum;
	const vec2 angle = mix(3.0 - ratio, 1.0 + ratio, greaterThanEqual(p_x, vec2(0.0))) * bins_per_unit;
	const vec2 bin = floor(angle);
	// The derivative of the angle in radians by the diamond angle is sum^2.
	const vec2 turn = (bin + 0.5 - angle) * (sum * sum / bins_per_unit);
	const vec2 offset = p_offset + turn * p_middle;
	// 0.9999: offset 1 is in the last row.
	const uvec2 row = uvec2(float(EDGE_COUNT_OFFSET_COUNT) * clamp(offset, 0.0, 0.9999));
	return uvec2(bin) % uint(EDGE_COUNT_DIRECTION_COUNT) * uint(EDGE_COUNT_OFFSET_COUNT) + row;
}

/// Angles in radians (0..pi) of two directions with y >= 0. The error is at most 2e-6. Needs two fewer divisions than
/// atan.
vec2 count_half_angles(vec2 p_x, vec2 p_y) {
	// pi / 4 plus the arc tangent of u in -1..1: a Chebyshev series of six terms.
	const vec2 x = abs(p_x);
	const vec2 u = (p_y - x) / max(p_y + x, vec2(1e-37));
	const vec2 u2 = u * u;
	const vec2 u4 = u2 * u2;
	const vec2 low = 0.999974491 - 0.332568317 * u2;
	const vec2 middle = 0.193235292 - 0.115729441 * u2;
	const vec2 high = 0.0519505321 - 0.0114658097 * u2;
	const vec2 angle = 0.25 * COUNT_PI + u * (low + u4 * (middle + u4 * high));
	return mix(angle, COUNT_PI - angle, lessThan(p_x, vec2(0.0)));
}

/// The angles of two directions in units of 2 pi / 64, plus 65, so that find_count_sector rounds a positive number up.
vec2 find_count_angles(vec2 p_x, vec2 p_y) {
	const vec2 half_angle = count_half_angles(p_x, abs(p_y));
	const vec2 angle = mix(half_angle, 2.0 * COUNT_PI - half_angle, lessThan(p_y, vec2(0.0)));
	const float sectors = float(EDGE_COUNT_SAMPLE_COUNT);
	return angle * (sectors / (2.0 * COUNT_PI)) + 1.0 + sectors;
}

/// Index of the first point of a sample set whose angle is not below p_angle (see find_count_angles). Points are
/// ordered by angle, one in each of 64 equal sectors. In a sector the points of all sets are evenly spaced, see
/// DiscMasks.
int find_count_sector(float p_angle, uint p_sample_set) {
	return int(p_angle - (float(p_sample_set) + 0.5) / float(SAMPLE_SET_COUNT)) & (EDGE_COUNT_SAMPLE_COUNT - 1);
}

/// Mask of the points with an index below p_index, 0..63.
uvec2 find_points_before(int p_index) {
	const uint bits_before = (1u << (p_index & 31)) - 1u;
	return p_index < 32 ? uvec2(bits_before, 0u) : uvec2(0xffffffffu, bits_before);
}

/// Mask of a sample set's points between two angles (see find_count_angles), counter-clockwise. Two wedges with a
/// common border have no point in common and miss none.
uvec2 find_count_wedge(float p_from, float p_to, uint p_sample_set) {
	const int from = find_count_sector(p_from, p_sample_set);
	const int to = find_count_sector(p_to, p_sample_set);
	const uvec2 between = find_points_before(from) ^ find_points_before(to);
	return from > to ? ~between : between;
}

/// Counters of all points, modulo 512, as bit planes: bit k of bit0 is the lowest bit of point k's counter. Not an
/// array: drivers put arrays into memory if the compiler does not know all indices.
struct PointCounters {
	uvec2 bit0;
	uvec2 bit1;
	uvec2 bit2;
	uvec2 bit3;
	uvec2 bit4;
	uvec2 bit5;
	uvec2 bit6;
	uvec2 bit7;
	uvec2 bit8;
};
const int COUNT_MAX_SOLIDS = 200; // in front of the light's centre; the count of a point is at most 255

PointCounters make_point_counters() {
	const uvec2 zero = uvec2(0u);
	return PointCounters(zero, zero, zero, zero, zero, zero, zero, zero, zero);
}

/// The carry of a sum of three bits.
uvec2 find_carry(uvec2 p_one, uvec2 p_two, uvec2 p_three) {
	return (p_one & p_two) | (p_three & (p_one ^ p_two));
}

/// Adds a carry to one bit plane, and returns the carry to the next.
uvec2 add_carry(inout uvec2 r_plane, uvec2 p_carry) {
	const uvec2 next = r_plane & p_carry;
	r_plane ^= p_carry;
	return next;
}

/// Adds 1 to the counters of the points in two masks, and 2 to those in two others.
void add_masks(inout PointCounters r_counters, uvec2 p_once0, uvec2 p_once1, uvec2 p_twice0, uvec2 p_twice1) {
	const uvec2 carry1 = find_carry(r_counters.bit0, p_once0, p_once1);
	r_counters.bit0 ^= p_once0 ^ p_once1;
	const uvec2 carry2 = find_carry(r_counters.bit1, carry1, p_twice0);
	r_counters.bit1 ^= carry1 ^ p_twice0;
	const uvec2 other2 = add_carry(r_counters.bit1, p_twice1);
	uvec2 carry = find_carry(r_counters.bit2, carry2, other2);
	r_counters.bit2 ^= carry2 ^ other2;
	carry = add_carry(r_counters.bit3, carry);
	carry = add_carry(r_counters.bit4, carry);
	carry = add_carry(r_counters.bit5, carry);
	carry = add_carry(r_counters.bit6, carry);
	carry = add_carry(r_counters.bit7, carry);
	r_counters.bit8 ^= carry;
}

int count_points(uvec2 p_mask) {
	const ivec2 counts = bitCount(p_mask);
	return counts.x + counts.y;
}

/// Adds a bit, the same for all points, and a carry to one bit plane. r_carry becomes the carry to the next.
void add_bit(inout uvec2 r_plane, int p_bit, inout uvec2 r_carry) {
	const uvec2 added = uvec2(p_bit != 0 ? 0xffffffffu : 0u);
	const uvec2 both = r_plane ^ added;
	const uvec2 next = (r_plane & added) | (both & r_carry);
	r_plane = both ^ r_carry;
	r_carry = next;
}

/// Each counter plus p_added, modulo 512, in two's complement.
PointCounters add_to_all(PointCounters p_counters, int p_added) {
	PointCounters sums = p_counters;
	uvec2 carry = uvec2(0u);
	add_bit(sums.bit0, p_added & 1, carry);
	add_bit(sums.bit1, p_added & 2, carry);
	add_bit(sums.bit2, p_added & 4, carry);
	add_bit(sums.bit3, p_added & 8, carry);
	add_bit(sums.bit4, p_added & 16, carry);
	add_bit(sums.bit5, p_added & 32, carry);
	add_bit(sums.bit6, p_added & 64, carry);
	add_bit(sums.bit7, p_added & 128, carry);
	add_bit(sums.bit8, p_added & 256, carry);
	return sums;
}

/// Points whose count is above 1.
uvec2 find_above_one(PointCounters p_sums) {
	return (p_sums.bit1 | p_sums.bit2 | p_sums.bit3 | p_sums.bit4 | p_sums.bit5 | p_sums.bit6 | p_sums.bit7) &
			~p_sums.bit8;
}

/// Points whose count is above 0.
uvec2 find_hidden(PointCounters p_sums) {
	return find_above_one(p_sums) | (p_sums.bit0 & ~p_sums.bit8);
}

/// True if some count is above 1: casters overlap. Rounding alone can make counts of a thin solid negative, where the
/// lines of two opposite edges are rounded past each other; its area is exact even so.
bool has_overlap(PointCounters p_sums) {
	const uvec2 overlapping = find_above_one(p_sums);
	return (overlapping.x | overlapping.y) != 0u;
}

/// Sum of the counts of all points.
int sum_points(PointCounters p_sums) {
	return count_points(p_sums.bit0) + 2 * count_points(p_sums.bit1) + 4 * count_points(p_sums.bit2) +
			8 * count_points(p_sums.bit3) + 16 * count_points(p_sums.bit4) + 32 * count_points(p_sums.bit5) +
			64 * count_points(p_sums.bit6) + 128 * count_points(p_sums.bit7) -
			256 * count_points(p_sums.bit8);
}

/// Rotates a mask: bit k becomes that of point k + 2, a neighbour in angle at another distance from the centre.
uvec2 rotate_points(uvec2 p_mask) {
	return (p_mask >> 2) | (p_mask.yx << 30);
}

/// Subtracts the rotated bit plane (see rotate_points) and a borrow from a bit plane. r_borrow becomes the next borrow.
uvec2 subtract_rotated(uvec2 p_plane, inout uvec2 r_borrow) {
	const uvec2 rotated = rotate_points(p_plane);
	const uvec2 differs = p_plane ^ rotated;
	const uvec2 difference = differs ^ r_borrow;
	r_borrow = (~p_plane & rotated) | (~differs & r_borrow);
	return difference;
}

/// Sums over the points of the light.
struct CountSums {
	int hidden; // points whose count is above 0
	int count; // sum of all counts
	// Changes of the count from each point k to point k + 2: the sum of their squares, and that of their absolute values where
	// exactly one of the two points is hidden. Changes by more than 15 count as 15.
	int square;
	int product;
};

/// Adds the changes of one sample set. p_hidden_differs: bit k is set if exactly one of points k and k + 2 is hidden.
void add_changes(PointCounters p_sums, uvec2 p_hidden_differs, inout CountSums r_sums) {
	uvec2 borrow = uvec2(0u);
	const uvec2 d0 = subtract_rotated(p_sums.bit0, borrow);
	const uvec2 d1 = subtract_rotated(p_sums.bit1, borrow);
	const uvec2 d2 = subtract_rotated(p_sums.bit2, borrow);
	const uvec2 d3 = subtract_rotated(p_sums.bit3, borrow);
	const uvec2 d4 = subtract_rotated(p_sums.bit4, borrow);
	const uvec2 d5 = subtract_rotated(p_sums.bit5, borrow);
	const uvec2 d6 = subtract_rotated(p_sums.bit6, borrow);
	const uvec2 d7 = subtract_rotated(p_sums.bit7, borrow);
	const uvec2 sign = subtract_rotated(p_sums.bit8, borrow);
	// Bits of the absolute value: negative changes are inverted, plus 1.
	uvec2 s0 = d0 ^ sign;
	uvec2 s1 = d1 ^ sign;
	uvec2 s2 = d2 ^ sign;
	uvec2 s3 = d3 ^ sign;
	uvec2 carry = add_carry(s0, sign);
	carry = add_carry(s1, carry);
	carry = add_carry(s2, carry);
	carry = add_carry(s3, carry);
	const uvec2 is_large = carry | (d4 ^ sign) | (d5 ^ sign) | (d6 ^ sign) | (d7 ^ sign);
	s0 |= is_large;
	s1 |= is_large;
	s2 |= is_large;
	s3 |= is_large;
	// Expanded: the sum over all points of (s0 + 2 s1 + 4 s2 + 8 s3)^2, with bits s0 to s3.
	r_sums.square += count_points(s0) + 4 * (count_points(s1) + count_points(s0 & s1)) +
			8 * count_points(s0 & s2) +
			16 * (count_points(s2) + count_points(s0 & s3) + count_points(s1 & s2)) +
			32 * count_points(s1 & s3) + 64 * (count_points(s3) + count_points(s2 & s3));
	r_sums.product += count_points(s0 & p_hidden_differs) + 2 * count_points(s1 & p_hidden_differs) +
			4 * count_points(s2 & p_hidden_differs) + 8 * count_points(s3 & p_hidden_differs);
}

#endif
