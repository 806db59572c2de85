#ifndef MASK_SHARED_H
#define MASK_SHARED_H

#define MASK_CONSTANT_IS_COLORED                                                                   \
	0 // specialization constant of shaders that read a mask: 1 when it has three channels

// Weights of a coloured mask's luminance: linear, primaries of ITU-R BT.709.
#define MASK_LUMINANCE_R 0.2126f
#define MASK_LUMINANCE_G 0.7152f
#define MASK_LUMINANCE_B 0.0722f

#endif
