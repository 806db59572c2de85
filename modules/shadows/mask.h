#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/shadows/shadow_technique.h"

#include <cstdint>
#include <vector>

// Masks: how a technique makes one, what format it has, and its values on the CPU.

namespace gnomon {

/// A mask to be written by a compute pass; see ShadowTechnique::resolve for the formats.
RGTexture create_mask(
		RenderGraph &r_graph, glm::uvec2 p_size_px, Format p_format = Format::R16_SFLOAT);
/// A mask of one value; for lights without a shadow.
RGTexture add_constant_mask(RenderGraph &r_graph, glm::uvec2 p_size_px, float p_visibility);

/// Has the mask a value for each colour? A technique's has one; behind translucent casters it has
/// three.
bool is_colored_mask(const RenderGraph &p_graph, RGTexture p_mask);
/// MASK_CONSTANT_IS_COLORED of shaders that read a mask.
std::vector<SpecializationConstant> make_mask_constants(
		const RenderGraph &p_graph, RGTexture p_mask);
/// One value for a mask of three colours: its luminance, mask_luminance of mask_inc.glsl.
float compute_mask_luminance(const glm::vec3 &p_mask);

// Computed from light-view maps.

/// What common/map_resolve_inc.glsl reads, for a compute pass over the pixels; the technique adds
/// its own bindings from MAP_RESOLVE_OWN_BINDING on.
std::vector<PassBinding> make_map_resolve_bindings(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);
/// As above with other views than those of the inputs, of a light in another position.
std::vector<PassBinding> make_map_resolve_bindings(RenderGraph &r_graph,
		const ShadowTechnique::Inputs &p_inputs, const LightSnapshot &p_light,
		const std::vector<LightView> &p_views);

// Drawn with a stencil.

/// A mask that is drawn into: R16_SFLOAT.
RGTexture create_drawn_mask(RenderGraph &r_graph, glm::uvec2 p_size_px);
/// A D32_SFLOAT_S8_UINT target.
RGTexture create_stencil_target(
		RenderGraph &r_graph, const std::string &p_name, glm::uvec2 p_size_px);
/// A pipeline that draws one triangle over all of the image into those two, and changes neither
/// depth nor stencil. p_fragment_shader: what it writes. To be completed: the stencil.
RasterPipelineDesc make_screen_desc(
		const std::string &p_name, const std::string &p_fragment_shader);

// On the CPU.

/// A light's mask and where it counts, rows from the top.
struct MaskValues {
	std::vector<float> visibility; // luminance where it is coloured; 0 where there is no receiver
	std::vector<glm::vec3> colors; // of a mask behind translucent casters, else empty
	std::vector<float> receiver;   // 1 or 0
};
/// Copies a mask and its receivers to the CPU at the end of a frame.
class MaskReadback {
public:
	/// Adds the passes. This must live until the graph has been executed.
	void add(RenderGraph &r_graph, RGTexture p_mask, RGTexture p_receivers);
	/// After the graph was executed with Mode::WAIT or ONE_BY_ONE.
	MaskValues get_values() const;

private:
	Format format = Format::R16_SFLOAT;
	std::vector<uint8_t> mask_bytes;
	std::vector<uint8_t> receiver_bytes;
};

} // namespace gnomon
