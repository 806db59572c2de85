#ifndef RECEIVER_SCATTER_SHARED_H
#define RECEIVER_SCATTER_SHARED_H
#include "shared/shared_begin.h"

#define SCATTER_BINDING_FRAME 0
#define SCATTER_BINDING_DEPTH 1
#define SCATTER_BINDING_NORMAL 2
#define SCATTER_BINDING_MATERIAL 3
#define SCATTER_BINDING_RECEIVERS 4
#define SCATTER_BINDING_MASK 5 // that was there
#define SCATTER_BINDING_RESULT 6
#define SCATTER_BINDING_SAMPLES 7
#define SCATTER_BINDING_PIXELS 8 // pack.comp
#define SCATTER_GROUP_SIZE 8

// Pixels of a block of 1, 2 x 2 or 4 x 4 take their samples from as many sets, and are averaged
// afterwards. The buffer holds the sets of all three, one after another. Averaging blurs by a pixel or
// two: blocks of width 2 and 4 are for discs whose radius is at least so many pixels, where that is
// below a tenth of it.
#define SCATTER_SET_COUNT (1 + 4 + 16)
#define SCATTER_RADIUS_OF_2_PX 4.0f
#define SCATTER_RADIUS_OF_4_PX 14.0f

// The source's disc, Wang and Xiao 2015, section 1.2: its radius at s = 1, in pixels.
#define SCATTER_RADIUS_PX 16.0f
// Its weights are lost in our text; ours are exp(-SCATTER_FALLOFF d / R). As every ring has as many
// samples as the next, the weight of an area is that over d, which is near the dipole's.
#define SCATTER_FALLOFF 3.0f

// In the order of the properties' choices. AUTO: in metres where the material gives a distance, and
// refusing in metres only.
#define SCATTER_METHOD_AUTO 0u
#define SCATTER_METHOD_METRES 1u
#define SCATTER_METHOD_PIXELS 2u
#define SCATTER_REFUSAL_AUTO 0u
#define SCATTER_REFUSAL_ON 1u
#define SCATTER_REFUSAL_OFF 2u

/// Push constants of both passes.
struct SHARED_ALIGN ReceiverScatterPush {
	uint sample_count; // of a set
	uint sector_count; // of the source's disc
	uint method;	   // SCATTER_METHOD_*
	uint refusal;	   // SCATTER_REFUSAL_*: whether samples on other surfaces do not count
};
SHARED_SIZE(ReceiverScatterPush, 16);

#include "shared/shared_end.h"
#endif
