#pragma once

#include "modules/shadow_volume/caster_culling.h"

#include <optional>

namespace gnomon {

/// How a caster's volume is counted, see ShadowVolume.
enum class VolumeCount { Z_PASS, Z_FAIL };
/// How volumes are made; all ways give the same triangles, but for the CPU's rounding.
enum class VolumeMaker { GEOMETRY_SHADER, COMPUTE, CPU };

/// What the technique's settings and the device make of it.
struct VolumeSettings {
	std::optional<VolumeCount> count; // none: chosen for each caster
	std::optional<VolumeMaker> maker; // none: the same
	bool is_always_robust = false;
	bool has_scissor = true; // and depth bounds, where the device can
	CasterCulling::Wish culling = CasterCulling::Wish::OFF;
};

void add_volume_settings(bool p_is_on_cpu, PropertyList &r_list);
/// Light properties of files that were written before these were settings.
void add_removed_volume_properties(const std::string &p_id, PropertyList &r_list);
VolumeSettings read_volume_settings(bool p_is_on_cpu, const ShadowTechnique::Inputs &p_inputs);

} // namespace gnomon
