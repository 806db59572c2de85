#pragma once

#include "modules/shadow_volume/caster_culling.h"

#include <optional>

namespace gnomon {

/// Where a caster's volume is counted, see ShadowVolume.
enum class VolumeCount { Z_PASS, Z_FAIL };
/// How volumes are extruded; all ways give the same triangles, except for rounding on the CPU.
enum class VolumeMaker { GEOMETRY_SHADER, COMPUTE, CPU };

/// The technique's settings, restricted to what the device supports.
struct VolumeSettings {
	std::optional<VolumeCount> count; // none: chosen for each caster
	std::optional<VolumeMaker> maker; // none: chosen for each caster
	bool is_always_robust = false;
	bool has_scissor = true; // also depth bounds, where the device supports them
	CasterCulling::Wish culling = CasterCulling::Wish::OFF;
};

void add_volume_settings(bool p_is_on_cpu, PropertyList &r_list);
/// Declares the light properties of older files that are settings now.
void add_removed_volume_properties(const std::string &p_id, PropertyList &r_list);
VolumeSettings read_volume_settings(bool p_is_on_cpu, const ShadowTechnique::Inputs &p_inputs);

} // namespace gnomon
