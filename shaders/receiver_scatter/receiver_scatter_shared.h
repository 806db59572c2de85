#ifndef RECEIVER_SCATTER_SHARED_H
#define RECEIVER_SCATTER_SHARED_H
#include "shared/shared_begin.h"

#define SCATTER_BINDING_FRAME 0
#define SCATTER_BINDING_DEPTH 1
#define SCATTER_BINDING_NORMAL 2
#define SCATTER_BINDING_MATERIAL 3
#define SCATTER_BINDING_RECEIVERS 4
#define SCATTER_BINDING_MASK 5 // the pass's input
#define SCATTER_BINDING_RESULT 6
#define SCATTER_BINDING_SAMPLES 7
#define SCATTER_BINDING_PIXELS 8 // the result of pack.comp
#define SCATTER_GROUP_SIZE 8

// The pixels of a block of 1, 2 x 2 or 4 x 4 pixels take their samples from as many different sets
// (make_scatter_samples), and average.comp averages them. The buffer holds the sets of all three
// block sizes, one after another. Averaging blurs by a pixel or two. So blocks of width 2 and 4 are
// used only for discs whose radius is at least this many pixels, where the blur is small in
// comparison.
#define SCATTER_SET_COUNT (1 + 4 + 16)
#define SCATTER_RADIUS_OF_2_PX 4.0f
#define SCATTER_RADIUS_OF_4_PX 14.0f

// Radius at s = 1, in pixels, of the sampling disc of Wang and Xiao 2015, section 1.2.
#define SCATTER_RADIUS_PX 16.0f
// The paper's weights of the disc are not known. Here they are exp(-SCATTER_FALLOFF d / R), d:
// distance, R: radius. All rings have the same number of samples, so the weight per area is that
// divided by d, which is close to the dipole's.
#define SCATTER_FALLOFF 3.0f

// In the order of the choices of the light properties receiver_scatter_method and
// receiver_scatter_refusal. METHOD_AUTO: in metres where the material gives a distance.
// REFUSAL_AUTO: on in metres only.
#define SCATTER_METHOD_AUTO 0u
#define SCATTER_METHOD_METRES 1u
#define SCATTER_METHOD_PIXELS 2u
#define SCATTER_REFUSAL_AUTO 0u
#define SCATTER_REFUSAL_ON 1u
#define SCATTER_REFUSAL_OFF 2u

/// Push constants of spread.comp and average.comp.
struct SHARED_ALIGN ReceiverScatterPush {
	uint sample_count; // per set
	uint sector_count; // of the disc in pixels
	uint method;	   // SCATTER_METHOD_*
	uint refusal;	   // SCATTER_REFUSAL_*: whether samples on other surfaces are skipped
};
SHARED_SIZE(ReceiverScatterPush, 16);

#include "shared/shared_end.h"
#endif
