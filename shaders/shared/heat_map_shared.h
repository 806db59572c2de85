// The colours of errors, result minus reference: white 0, blue too dark, red too light, in full colour from
// HEAT_MAP_RANGE on; grey where there is no receiver.
#ifndef HEAT_MAP_SHARED_H
#define HEAT_MAP_SHARED_H

#define HEAT_MAP_RANGE 0.25f
#define HEAT_MAP_NO_RECEIVER 96 // of 255: neither white nor on the way to a colour

#endif
