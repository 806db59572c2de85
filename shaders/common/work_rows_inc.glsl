// The order in which rows of work groups are distributed.
#ifndef WORK_ROWS_INC_GLSL
#define WORK_ROWS_INC_GLSL

/// The row of this work group: even ones first. Drivers that give each core one half of a dispatch then give it
/// every other row, and no core waits where one half of the image costs more. pcss with 64 taps at 512 x 512, 2
/// cores: terrain 246 ms so and 298 without, contact_box 172 and 202.
uint find_work_row() {
	const uint even_count = (gl_NumWorkGroups.y + 1u) / 2u;
	const uint group = gl_WorkGroupID.y;
	return group < even_count ? 2u * group : 2u * (group - even_count) + 1u;
}

#endif
