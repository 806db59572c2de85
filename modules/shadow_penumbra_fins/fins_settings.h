#pragma once

#include "modules/shadows/shadow_technique.h"

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

#include <optional>
#include <string>

namespace gnomon {

/// How the depth layers are peeled; both ways give the same bits.
enum class Peeling { PASSES, ONE_PASS };
/// How the fins are extruded; both ways give the same edges and vertices.
enum class FinMethod { GEOMETRY_SHADER, COMPUTE };

/// The widths r and t of a light that sets none. Over the study's scenes and three light sizes, r =
/// t = R has a mean error of 0.220, as large as that of a hard shadow, because the fins cross.
/// These have 0.139; the best widths for each scene and size have 0.126
/// (doc/techniques/penumbra_fins.md).
constexpr DerivedWidths PENUMBRA_FINS_WIDTHS = { 1.0f / 4.0f, 1.0f / 2.0f };
/// Without inner fins: 0.187 instead of 0.340 (doc/techniques/outer_fins.md).
constexpr DerivedWidths OUTER_FINS_WIDTHS = { 1.0f / 6.0f, 0.0f };

/// The technique's parameters for one light and device. Lengths in metres.
struct FinsSettings {
	float outer_width_m = 0; // r of Sun et al. 2010
	float inner_width_m = 0; // t
	float beta_m = 0;		 // inner fins farther than this behind layer 1 are discarded
	uint32_t map_size_px = 1024;
	uint32_t layer_count = 1; // 1..3; without an inner half 1
	uint32_t curve = FINS_CURVE_SINE;
	bool has_inner_half = true;		// false: the technique has outer fins only
	std::optional<Peeling> peeling; // none: whichever is faster, see choose_peeling
	FinMethod method = FinMethod::COMPUTE;

	bool has_fins() const { return outer_width_m > 0 || inner_width_m > 0; }
	/// True when both settings give the same maps, bit for bit. `method` and `peeling` do not
	/// matter.
	bool gives_same_maps(const FinsSettings &p_other) const;
};

/// Adds the light properties of a technique of this module. Their names begin with p_id.
/// p_has_inner_half: false for the technique with outer fins only.
void add_fins_properties(const std::string &p_id, bool p_has_inner_half, PropertyList &r_list);

/// Adds the settings that apply to all lights: "method" and, with inner fins, "peeling".
void add_fins_settings(bool p_has_inner_half, PropertyList &r_list);

/// Reads only the widths and the map size: the light's views depend on no other setting.
FinsSettings read_fins_view_settings(const std::string &p_id, bool p_has_inner_half,
		const LightSnapshot &p_light, const PropertyValues &p_properties);

/// Reads all settings and chooses the method for this device.
FinsSettings read_fins_settings(
		const std::string &p_id, bool p_has_inner_half, const ShadowTechnique::Inputs &p_inputs);

/// Chooses how to peel one view. ONE_PASS needs stores in fragment shaders, copies from buffers to
/// textures, more than one layer, and layers that fit into one storage buffer. Otherwise PASSES is
/// returned even when ONE_PASS is requested.
Peeling choose_peeling(const FinsSettings &p_settings, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index);

} // namespace gnomon
