#pragma once

#include "modules/shadow_volume/caster_culling.h"

#include <optional>

namespace gnomon {

/// How the stencil counts a caster's volume: in front of the receiver (z-pass), or behind it with
/// caps (z-fail).
enum class StencilMethod { Z_PASS, Z_FAIL };
/// What extrudes a volume. All give the same triangles, except for rounding on the CPU.
enum class VolumeExtruder { GEOMETRY_SHADER, COMPUTE, CPU };

/// The technique's settings, restricted to what the device supports.
struct VolumeSettings {
	std::optional<StencilMethod> stencil_method; // none: chosen for each caster
	std::optional<VolumeExtruder> extruder;		 // none: chosen for each caster
	bool is_always_robust = false;				 // all faces are robust, see VolumeShape::robust
	bool has_scissor = true; // use scissor rectangles, and depth bounds where supported
	CasterCulling::Mode culling = CasterCulling::Mode::OFF;
};

/// p_is_on_cpu: for the technique that extrudes volumes on the CPU, which has fewer settings.
void add_volume_settings(bool p_is_on_cpu, PropertyList &r_list);
/// Declares light properties of older scene files that have become settings.
void add_removed_volume_properties(const std::string &p_id, PropertyList &r_list);
VolumeSettings read_volume_settings(bool p_is_on_cpu, const ShadowTechnique::Inputs &p_inputs);

} // namespace gnomon
