// Masks of 64 points of the light, two words each, and 64 counters as nine bit planes: see
// DiscMasks.
#ifndef COUNT_MASKS_INC_GLSL
#define COUNT_MASKS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

const float COUNT_PI = 3.14159265358979;

// The points may be turned several times; their results are averaged.
#ifndef COUNT_TURN_COUNT
#define COUNT_TURN_COUNT 1
#endif

/// Two masks of the tables, of turns 2 p_pair and 2 p_pair + 1: x, y and z, w. p_index: see find_count_mask_index.
uvec4 load_count_masks(uint p_index, uint p_pair);

/// The bin of a direction by its diamond angle y / (|x| + |y|): 0 at -y, 1 at +x, 2 at +y, 3 at -x.
uint count_direction(vec2 p_direction) {
	const float sum = abs(p_direction.x) + abs(p_direction.y);
	const float share = sum > 0.0 ? p_direction.y / sum : 0.0;
	const float angle = p_direction.x >= 0.0 ? 1.0 + share : 3.0 - share;
	return uint(angle * float(EDGE_COUNT_DIRECTION_COUNT / 4)) % uint(EDGE_COUNT_DIRECTION_COUNT);
}

/// Where the tables have the points of the unit disc beyond the line that is p_offset from the centre in that
/// direction.
uint find_count_mask_index(vec2 p_direction, float p_offset) {
	const uint row = uint(float(EDGE_COUNT_OFFSET_COUNT) * clamp(p_offset, 0.0, 0.9999));
	return count_direction(p_direction) * uint(EDGE_COUNT_OFFSET_COUNT) + row;
}

/// Angle of a direction with y not below 0, 0..pi, to 2e-6; two divisions less than atan.
float count_half_angle(vec2 p_direction) {
	// Half a right angle and the arc tangent of u in -1..1: a Chebyshev series of six terms.
	const float x = abs(p_direction.x);
	const float u = (p_direction.y - x) / max(p_direction.y + x, 1e-37);
	const float u2 = u * u;
	const float odd = ((((-0.0114658097 * u2 + 0.0519505321) * u2 - 0.115729441) * u2 + 0.193235292) *
									u2 -
							0.332568317) *
					u2 +
			0.999974491;
	const float angle = 0.25 * COUNT_PI + u * odd;
	return p_direction.x < 0.0 ? COUNT_PI - angle : angle;
}

/// The angle of a direction in sectors of the points, plus an offset so that it is not below 0 in any turn.
float find_count_angle(vec2 p_direction) {
	const float half_angle = count_half_angle(vec2(p_direction.x, abs(p_direction.y)));
	const float angle = p_direction.y < 0.0 ? 2.0 * COUNT_PI - half_angle : half_angle;
	const float sectors = float(EDGE_COUNT_SAMPLE_COUNT);
	return angle * (sectors / (2.0 * COUNT_PI)) + 1.0 + sectors;
}

/// The first point of a turn whose angle is not below that of find_count_angle: points are in the order of their
/// angles, one in each of 64 equal sectors; in a sector the turns follow each other evenly (see DiscMasks).
int find_count_sector(float p_angle, uint p_turn) {
	return int(p_angle - (float(p_turn) + 0.5) / float(COUNT_TURN_COUNT)) & (EDGE_COUNT_SAMPLE_COUNT - 1);
}

/// Mask of the points below an index, 0..63.
uvec2 count_points_before(int p_index) {
	const uint part = (1u << (p_index & 31)) - 1u;
	return p_index < 32 ? uvec2(part, 0u) : uvec2(0xffffffffu, part);
}

/// Mask of a turn's points from one angle (see find_count_angle) counter-clockwise to another. Neighbours that share a direction share no
/// point and leave none.
uvec2 find_count_wedge(float p_from, float p_to, uint p_turn) {
	const int from = find_count_sector(p_from, p_turn);
	const int to = find_count_sector(p_to, p_turn);
	const uvec2 between = count_points_before(from) ^ count_points_before(to);
	return from > to ? ~between : between;
}

/// Counters of all points, one bit of each in a plane: numbers of nine bits, modulo 512. No array: where one of its
/// indices is not known to the compiler, drivers keep it in memory.
struct CountPlanes {
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
const int COUNT_MOST_SOLIDS = 200; // before the light's centre; counts of points reach 255

CountPlanes make_count_planes() {
	const uvec2 zero = uvec2(0u);
	return CountPlanes(zero, zero, zero, zero, zero, zero, zero, zero, zero);
}

/// The carry of three bits.
uvec2 find_carry(uvec2 p_one, uvec2 p_two, uvec2 p_three) {
	return (p_one & p_two) | (p_three & (p_one ^ p_two));
}

/// Adds a carry to one plane; the carry that goes on.
uvec2 carry_count(inout uvec2 r_plane, uvec2 p_carry) {
	const uvec2 next = r_plane & p_carry;
	r_plane ^= p_carry;
	return next;
}

/// Adds 1 at the points of two masks, and 2 at those of two others.
void add_masks(inout CountPlanes r_counters, uvec2 p_once0, uvec2 p_once1, uvec2 p_twice0, uvec2 p_twice1) {
	const uvec2 carry1 = find_carry(r_counters.bit0, p_once0, p_once1);
	r_counters.bit0 ^= p_once0 ^ p_once1;
	const uvec2 carry2 = find_carry(r_counters.bit1, carry1, p_twice0);
	r_counters.bit1 ^= carry1 ^ p_twice0;
	const uvec2 other2 = carry_count(r_counters.bit1, p_twice1);
	uvec2 carry = find_carry(r_counters.bit2, carry2, other2);
	r_counters.bit2 ^= carry2 ^ other2;
	carry = carry_count(r_counters.bit3, carry);
	carry = carry_count(r_counters.bit4, carry);
	carry = carry_count(r_counters.bit5, carry);
	carry = carry_count(r_counters.bit6, carry);
	carry = carry_count(r_counters.bit7, carry);
	r_counters.bit8 ^= carry;
}

int count_points(uvec2 p_mask) {
	const ivec2 counts = bitCount(p_mask);
	return counts.x + counts.y;
}

/// Adds a bit that is the same for all points, and a carry.
void add_bit(inout uvec2 r_plane, int p_bit, inout uvec2 r_carry) {
	const uvec2 added = uvec2(p_bit != 0 ? 0xffffffffu : 0u);
	const uvec2 both = r_plane ^ added;
	const uvec2 next = (r_plane & added) | (both & r_carry);
	r_plane = both ^ r_carry;
	r_carry = next;
}

/// Each counter plus p_added, modulo 512, as numbers in two's complement.
CountPlanes add_to_all(CountPlanes p_counters, int p_added) {
	CountPlanes sums = p_counters;
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

uvec2 find_above_one(CountPlanes p_sums) {
	return (p_sums.bit1 | p_sums.bit2 | p_sums.bit3 | p_sums.bit4 | p_sums.bit5 | p_sums.bit6 | p_sums.bit7) &
			~p_sums.bit8;
}

/// Points whose count is above 0.
uvec2 find_hidden(CountPlanes p_sums) {
	return find_above_one(p_sums) | (p_sums.bit0 & ~p_sums.bit8);
}

/// True where counts are neither 0 nor 1: casters overlap, or rounding took some away.
bool has_overlap(CountPlanes p_sums) {
	const uvec2 beyond = find_above_one(p_sums) | p_sums.bit8;
	return (beyond.x | beyond.y) != 0u;
}

/// Sum of the counts of all points.
int sum_points(CountPlanes p_sums) {
	return count_points(p_sums.bit0) + 2 * count_points(p_sums.bit1) + 4 * count_points(p_sums.bit2) +
			8 * count_points(p_sums.bit3) + 16 * count_points(p_sums.bit4) + 32 * count_points(p_sums.bit5) +
			64 * count_points(p_sums.bit6) + 128 * count_points(p_sums.bit7) -
			256 * count_points(p_sums.bit8);
}

/// Bits of the points two on: neighbours in angle, at other distances from the centre.
uvec2 turn_points(uvec2 p_mask) {
	return (p_mask >> 2) | (p_mask.yx << 30);
}

/// The difference of a plane and its turned one, less a borrow.
uvec2 subtract_turned(uvec2 p_plane, inout uvec2 r_borrow) {
	const uvec2 turned = turn_points(p_plane);
	const uvec2 differs = p_plane ^ turned;
	const uvec2 difference = differs ^ r_borrow;
	r_borrow = (~p_plane & turned) | (~differs & r_borrow);
	return difference;
}

/// How counts change from each point to the one two on: sums over all points.
struct CountChanges {
	int square;	 // of the change's square
	int product; // of the change's size, where one of the two points is hidden and the other is not
};

/// Changes by more than 15 are taken as 15. p_is_parted: one of the two points is hidden.
CountChanges sum_changes(CountPlanes p_sums, uvec2 p_is_parted) {
	uvec2 borrow = uvec2(0u);
	const uvec2 d0 = subtract_turned(p_sums.bit0, borrow);
	const uvec2 d1 = subtract_turned(p_sums.bit1, borrow);
	const uvec2 d2 = subtract_turned(p_sums.bit2, borrow);
	const uvec2 d3 = subtract_turned(p_sums.bit3, borrow);
	const uvec2 d4 = subtract_turned(p_sums.bit4, borrow);
	const uvec2 d5 = subtract_turned(p_sums.bit5, borrow);
	const uvec2 d6 = subtract_turned(p_sums.bit6, borrow);
	const uvec2 d7 = subtract_turned(p_sums.bit7, borrow);
	const uvec2 sign = subtract_turned(p_sums.bit8, borrow);
	// Bits of the size: where the change is negative those of its inverse, plus 1.
	uvec2 s0 = d0 ^ sign;
	uvec2 s1 = d1 ^ sign;
	uvec2 s2 = d2 ^ sign;
	uvec2 s3 = d3 ^ sign;
	uvec2 carry = carry_count(s0, sign);
	carry = carry_count(s1, carry);
	carry = carry_count(s2, carry);
	carry = carry_count(s3, carry);
	const uvec2 is_large = carry | (d4 ^ sign) | (d5 ^ sign) | (d6 ^ sign) | (d7 ^ sign);
	s0 |= is_large;
	s1 |= is_large;
	s2 |= is_large;
	s3 |= is_large;
	CountChanges changes;
	changes.square = count_points(s0) + 4 * (count_points(s1) + count_points(s0 & s1)) +
			8 * count_points(s0 & s2) +
			16 * (count_points(s2) + count_points(s0 & s3) + count_points(s1 & s2)) +
			32 * count_points(s1 & s3) + 64 * (count_points(s3) + count_points(s2 & s3));
	changes.product = count_points(s0 & p_is_parted) + 2 * count_points(s1 & p_is_parted) +
			4 * count_points(s2 & p_is_parted) + 8 * count_points(s3 & p_is_parted);
	return changes;
}

#endif
