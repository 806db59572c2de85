// Faults that an invocation found in what earlier passes wrote. They become bits of the status buffer, which the host
// reads back and reports (EDGE_COUNT_STATUS_FAULTS): a list without an end costs an image, not the device.
//
// Drivers may end loops: llvmpipe ends every loop after an invocation has made 65535 iterations in all its loops
// together. So loops whose length depends on the scene check that they reached their end.
#ifndef COUNT_STATUS_INC_GLSL
#define COUNT_STATUS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

uint count_faults = 0u; // EDGE_COUNT_FAULT_* of this invocation

void note_fault(bool p_is_fault, uint p_fault) {
	count_faults |= p_is_fault ? p_fault : 0u;
}

#endif
