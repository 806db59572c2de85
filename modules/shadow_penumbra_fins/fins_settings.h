#pragma once

#include "modules/shadows/shadow_technique.h"

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

#include <optional>
#include <string>

namespace gnomon {

/// How the layers are found; both ways give the same bits.
enum class Peeling { PASSES, ONE_PASS };
/// How the fins are made; both ways give the same edges and corners.
enum class FinMethod { GEOMETRY_SHADER, COMPUTE };

/// What one light's properties and the device make of the technique. Lengths in metres.
struct FinsSettings {
	float outer_width_m = 0; // r of Sun et al. 2010
	float inner_width_m = 0; // t
	float beta_m = 0;
	uint32_t map_size_px = 1024;
	uint32_t layer_count = 1; // as requested; 1 without an inner half
	uint32_t curve = FINS_CURVE_SINE;
	bool has_inner_half = true;		// false: the technique has outer fins only
	std::optional<Peeling> peeling; // none: whichever is faster, see choose_peeling
	FinMethod method = FinMethod::COMPUTE;

	bool has_fins() const { return outer_width_m > 0 || inner_width_m > 0; }
	/// Are the maps the same, bit for bit? Ways to make them do not count.
	bool gives_maps_of(const FinsSettings &p_other) const;
};

/// The properties of a technique of this module. p_id begins their names.
void add_fins_properties(const std::string &p_id, bool p_has_inner_half, PropertyList &r_list);

/// Its settings.
void add_fins_settings(bool p_has_inner_half, PropertyList &r_list);

/// Widths and map size alone: what the light's views depend on.
FinsSettings read_fins_view_settings(const std::string &p_id, bool p_has_inner_half,
		const LightSnapshot &p_light, const PropertyValues &p_properties);

/// Everything, with the method decided for this device.
FinsSettings read_fins_settings(
		const std::string &p_id, bool p_has_inner_half, const ShadowTechnique::Inputs &p_inputs);

/// How to peel one view. ONE_PASS needs fragment stores and layers that one storage buffer can
/// hold; a wish for it that the device cannot grant becomes PASSES.
Peeling choose_peeling(const FinsSettings &p_settings, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index);

} // namespace gnomon
