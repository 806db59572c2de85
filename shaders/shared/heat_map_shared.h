// Colours of the error, result minus reference: white is 0, blue is too dark, red is too light,
// saturated from HEAT_MAP_RANGE on. Pixels without a receiver are grey.
#ifndef HEAT_MAP_SHARED_H
#define HEAT_MAP_SHARED_H

#define HEAT_MAP_RANGE 0.25f	// of the absolute error; visibility is 0..1
#define HEAT_MAP_NO_RECEIVER 96 // grey level, 0..255; no error has a grey colour

#endif
