#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/shadows/shadow_technique.h"

#include <cstdint>
#include <vector>

// Visibility masks: how a technique creates one, its format, and its values on the CPU.

namespace gnomon {

/// Creates a mask that a compute pass writes; see ShadowTechnique::resolve for the formats.
RGTexture create_mask(
		RenderGraph &r_graph, glm::uvec2 p_size_px, Format p_format = Format::R16_SFLOAT);
/// Creates a mask that passes over the light's tiles write (add_map_resolve_pass). Other pixels are
/// fully lit. Bind it with PassBuilder::Content::UPDATE.
RGTexture create_tiled_mask(
		RenderGraph &r_graph, glm::uvec2 p_size_px, Format p_format = Format::R16_SFLOAT);
/// Adds a mask with the same value in each pixel, for example for lights without a shadow.
RGTexture add_constant_mask(RenderGraph &r_graph, glm::uvec2 p_size_px, float p_visibility);

/// True when the mask has three colour channels: that of a light with translucent casters. All
/// other masks have one channel.
bool is_colored_mask(const RenderGraph &p_graph, RGTexture p_mask);
/// The specialization constant MASK_CONSTANT_IS_COLORED for shaders that read the mask.
std::vector<SpecializationConstant> make_mask_constants(
		const RenderGraph &p_graph, RGTexture p_mask);
/// The luminance of a coloured mask's texel: mask_luminance of mask_inc.glsl.
float compute_mask_luminance(const glm::vec3 &p_mask);

// For masks that a compute shader derives from maps of the light's views.

/// The bindings that common/map_resolve_inc.glsl reads, for a compute pass over the pixels. The
/// technique's own bindings start at MAP_RESOLVE_FIRST_FREE_BINDING.
std::vector<PassBinding> make_map_resolve_bindings(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);
/// As above, but p_light and p_views replace those of the inputs, for example for a light that was
/// moved, or for maps of another size.
std::vector<PassBinding> make_map_resolve_bindings(RenderGraph &r_graph,
		const ShadowTechnique::Inputs &p_inputs, const LightSnapshot &p_light,
		const std::vector<LightView> &p_views);
/// Adds a pass over the pixels that the light may reach, for a shader that finds its pixel with
/// find_pixel of common/map_resolve_inc.glsl. p_bindings: those of make_map_resolve_bindings and
/// the technique's own. p_push: see make_push_bytes.
void add_map_resolve_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, const ShadowTechnique::Inputs &p_inputs,
		std::vector<uint8_t> p_push = {});

// For masks that are drawn with a stencil test.

/// Creates an R16_SFLOAT mask that is a colour attachment.
RGTexture create_drawn_mask(RenderGraph &r_graph, glm::uvec2 p_size_px);
/// Creates a D32_SFLOAT_S8_UINT attachment.
RGTexture create_stencil_target(
		RenderGraph &r_graph, const std::string &p_name, glm::uvec2 p_size_px);
/// Describes a pipeline that draws one triangle over the whole image into these two attachments,
/// and changes neither depth nor stencil. p_fragment_shader writes the mask. The caller sets the
/// stencil state.
RasterPipelineDesc make_screen_desc(
		const std::string &p_name, const std::string &p_fragment_shader);

// On the CPU.

/// A light's mask and its receivers; rows from the top.
struct MaskValues {
	std::vector<float> visibility; // of a coloured mask the luminance; 0 without a receiver
	std::vector<glm::vec3> colors; // only of a coloured mask, else empty
	std::vector<float> receiver;   // 1; 0 without one; RECEIVER_FAR_SIDE
};
/// Copies a mask and its receivers to the CPU at the end of a frame.
class MaskReadback {
public:
	/// Adds the passes. The MaskReadback must live until the graph has been executed.
	void add(RenderGraph &r_graph, RGTexture p_mask, RGTexture p_receivers);
	/// Call after the graph was executed with Mode::WAIT or ONE_BY_ONE.
	MaskValues get_values() const;

private:
	Format format = Format::R16_SFLOAT;
	std::vector<uint8_t> mask_bytes;
	std::vector<uint8_t> receiver_bytes;
};

} // namespace gnomon
