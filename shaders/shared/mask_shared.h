#ifndef MASK_SHARED_H
#define MASK_SHARED_H

#define MASK_CONSTANT_IS_COLORED 0 // of shaders that read a mask; 1: it has three colours

// Luminance of a coloured mask: the primaries of ITU-R BT.709, linear.
#define MASK_LUMINANCE_R 0.2126f
#define MASK_LUMINANCE_G 0.7152f
#define MASK_LUMINANCE_B 0.0722f

#endif
