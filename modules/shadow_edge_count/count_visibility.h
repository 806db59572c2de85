#pragma once

#include "modules/shadow_edge_count/count_edges.h"
#include "modules/shadow_edge_count/disc_masks.h"
#include "modules/shadow_edge_count/layer_map.h"

#include <span>

namespace gnomon {

/// The share of the light that the receiver sees, 0..1: the number of solids between it and the
/// light's centre, from the layer map, plus the edges crossed on the way from the centre to each
/// point of the light. In double: what the shader is tested against.
///
/// p_receiver.r: moved off its surface already. p_edges: all that may matter to it. p_masks: of 64
/// points of the light each; their results are averaged.
double compute_count_visibility(const CountSpace &p_space, const CountReceiver &p_receiver,
		std::span<const CountEdge> p_edges, const LayerMap &p_layers,
		std::span<const DiscMasks> p_masks);

} // namespace gnomon
