#ifndef MASK_SHARED_H
#define MASK_SHARED_H

// Luminance of a coloured mask: the primaries of ITU-R BT.709, linear.
#define MASK_LUMINANCE_R 0.2126f
#define MASK_LUMINANCE_G 0.7152f
#define MASK_LUMINANCE_B 0.0722f

#endif
