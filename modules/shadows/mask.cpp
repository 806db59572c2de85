#include "modules/shadows/mask.h"

#include "modules/core/error.h"
#include "modules/render_graph/fill_pass.h"
#include "modules/render_graph/read_back.h"

#include "shared/frame_shared.h"
#include "shared/map_resolve_shared.h"
#include "shared/mask_shared.h"

#include <glm/gtc/packing.hpp>

#include <cstring>

namespace gnomon {

namespace {

template <typename T> T read_texel(const std::vector<uint8_t> &p_bytes, size_t p_index) {
	T texel;
	std::memcpy(&texel, p_bytes.data() + sizeof(T) * p_index, sizeof(T));
	return texel;
}

} // namespace

RGTexture create_mask(RenderGraph &r_graph, glm::uvec2 p_size_px, Format p_format) {
	return r_graph.create_texture({ "visibility mask", p_format, p_size_px, 1,
			TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
}

RGTexture create_tiled_mask(RenderGraph &r_graph, glm::uvec2 p_size_px, Format p_format) {
	const RGTexture mask = r_graph.create_texture({ "visibility mask", p_format, p_size_px, 1,
			TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE |
					TextureUsage::COPY_TARGET });
	add_clear_pass(r_graph, "clear mask", mask, 1.0f);
	return mask;
}

RGTexture add_constant_mask(RenderGraph &r_graph, glm::uvec2 p_size_px, float p_visibility) {
	const RGTexture mask = r_graph.create_texture({ "constant mask", Format::R16_SFLOAT, p_size_px,
			1, TextureUsage::COPY_TARGET | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	add_clear_pass(r_graph, "constant mask", mask, p_visibility);
	return mask;
}

bool is_colored_mask(const RenderGraph &p_graph, RGTexture p_mask) {
	const Format format = p_graph.get_desc(p_mask).format;
	return format == Format::RGBA16_SFLOAT || format == Format::RGBA32_SFLOAT;
}

std::vector<SpecializationConstant> make_mask_constants(
		const RenderGraph &p_graph, RGTexture p_mask) {
	return { { MASK_CONSTANT_IS_COLORED, is_colored_mask(p_graph, p_mask) ? 1u : 0u } };
}

float compute_mask_luminance(const glm::vec3 &p_mask) {
	return glm::dot(p_mask, glm::vec3(MASK_LUMINANCE_R, MASK_LUMINANCE_G, MASK_LUMINANCE_B));
}

std::vector<PassBinding> make_map_resolve_bindings(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs) {
	return make_map_resolve_bindings(r_graph, p_inputs, p_inputs.light,
			std::vector<LightView>(p_inputs.views.begin(), p_inputs.views.end()));
}

std::vector<PassBinding> make_map_resolve_bindings(RenderGraph &r_graph,
		const ShadowTechnique::Inputs &p_inputs, const LightSnapshot &p_light,
		const std::vector<LightView> &p_views) {
	const RGBuffer views = r_graph.upload_constants(
			"light views", compute_light_views_constants(p_light, p_inputs.scene.camera, p_views));
	return {
		PassBinding::constants(MAP_RESOLVE_BINDING_FRAME, p_inputs.frame),
		PassBinding::constants(MAP_RESOLVE_BINDING_VIEWS, views),
		PassBinding::read(MAP_RESOLVE_BINDING_DEPTH, p_inputs.depth),
		PassBinding::read(MAP_RESOLVE_BINDING_NORMAL, p_inputs.geometric_normal),
		PassBinding::read(MAP_RESOLVE_BINDING_RECEIVERS, p_inputs.receivers),
	};
}

void add_map_resolve_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, const ShadowTechnique::Inputs &p_inputs,
		std::vector<uint8_t> p_push) {
	add_tile_pass(r_graph, p_name, p_pipeline, std::move(p_bindings), p_inputs.tiles,
			MAP_RESOLVE_BINDING_TILES, std::move(p_push));
}

RGTexture create_drawn_mask(RenderGraph &r_graph, glm::uvec2 p_size_px) {
	return r_graph.create_texture({ "shadow mask", Format::R16_SFLOAT, p_size_px, 1,
			TextureUsage::SAMPLED | TextureUsage::COLOR_ATTACHMENT | TextureUsage::COPY_SOURCE });
}

RGTexture create_stencil_target(
		RenderGraph &r_graph, const std::string &p_name, glm::uvec2 p_size_px) {
	return r_graph.create_texture(
			{ p_name, Format::D32_SFLOAT_S8_UINT, p_size_px, 1, TextureUsage::DEPTH_ATTACHMENT });
}

RasterPipelineDesc make_screen_desc(
		const std::string &p_name, const std::string &p_fragment_shader) {
	RasterPipelineDesc desc;
	desc.name = p_name;
	desc.vertex_shader = "shadows/screen.vert";
	desc.fragment_shader = p_fragment_shader;
	desc.color_formats = { Format::R16_SFLOAT };
	desc.has_stencil = true;
	desc.depth_compare = CompareOp::ALWAYS;
	desc.writes_depth = false;
	return desc;
}

void MaskReadback::add(RenderGraph &r_graph, RGTexture p_mask, RGTexture p_receivers) {
	format = r_graph.get_desc(p_mask).format;
	add_readback(r_graph, p_mask, mask_bytes);
	add_readback(r_graph, p_receivers, receiver_bytes);
}

MaskValues MaskReadback::get_values() const {
	MaskValues values;
	const size_t count = receiver_bytes.size();
	values.visibility.resize(count);
	values.receiver.resize(count);
	const bool is_colored = format == Format::RGBA16_SFLOAT || format == Format::RGBA32_SFLOAT;
	values.colors.resize(is_colored ? count : 0);
	for (size_t index = 0; index < count; ++index) {
		if (receiver_bytes[index] == 0) {
			continue; // the values stay 0
		}
		const bool is_far = shader::is_on_far_side(float(receiver_bytes[index]) / 255.0f);
		values.receiver[index] = is_far ? float(RECEIVER_FAR_SIDE) : float(RECEIVER_NEAR_SIDE);
		switch (format) {
			case Format::R16_SFLOAT:
				values.visibility[index] =
						glm::unpackHalf1x16(read_texel<uint16_t>(mask_bytes, index));
				break;
			case Format::R32_SFLOAT:
				values.visibility[index] = read_texel<float>(mask_bytes, index);
				break;
			case Format::RGBA16_SFLOAT:
				values.colors[index] =
						glm::vec3(glm::unpackHalf4x16(read_texel<uint64_t>(mask_bytes, index)));
				break;
			case Format::RGBA32_SFLOAT:
				values.colors[index] = glm::vec3(read_texel<glm::vec4>(mask_bytes, index));
				break;
			default:
				GNOMON_ASSERT(false, "mask of format ", get_format_name(format));
		}
		if (is_colored) {
			values.visibility[index] = compute_mask_luminance(values.colors[index]);
		}
	}
	return values;
}

} // namespace gnomon
