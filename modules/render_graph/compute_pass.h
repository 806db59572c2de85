#pragma once

#include "modules/render_graph/render_graph.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// One resource of a compute pass: its access for the graph, and its binding in the shader.
struct PassBinding {
	uint32_t binding = 0;
	RGTexture texture;
	RGBuffer buffer;
	Access access = Access::SHADER_READ_COMPUTE;
	/// Whether a written resource keeps earlier content.
	PassBuilder::Content content = PassBuilder::Content::FRESH;

	SamplerRID sampler; // set for a texture that the shader samples, not only fetches
	uint32_t layer = Binding::ALL_LAYERS; // of the texture

	/// The shader samples or fetches the texture.
	static PassBinding read(uint32_t p_binding, RGTexture p_texture, SamplerRID p_sampler = {}) {
		return { p_binding, p_texture, {}, Access::SHADER_READ_COMPUTE, PassBuilder::Content::FRESH,
			p_sampler };
	}
	static PassBinding read(uint32_t p_binding, RGBuffer p_buffer) {
		return { p_binding, {}, p_buffer, Access::SHADER_READ_COMPUTE };
	}
	/// A uniform block of constants, see RenderGraph::upload_constants.
	static PassBinding constants(uint32_t p_binding, RGBuffer p_buffer) {
		return { p_binding, {}, p_buffer, Access::UNIFORM_READ };
	}
	/// A storage image or buffer. UPDATE: the shader also reads it, or does not write all of it.
	static PassBinding write(uint32_t p_binding, RGTexture p_texture,
			PassBuilder::Content p_content = PassBuilder::Content::FRESH) {
		return { p_binding, p_texture, {}, Access::SHADER_WRITE_COMPUTE, p_content };
	}
	static PassBinding write(uint32_t p_binding, RGBuffer p_buffer,
			PassBuilder::Content p_content = PassBuilder::Content::FRESH) {
		return { p_binding, {}, p_buffer, Access::SHADER_WRITE_COMPUTE, p_content };
	}
};

/// Declares the reads and writes of a pass's bindings.
void declare_bindings(PassBuilder &r_pass, std::span<const PassBinding> p_bindings);
/// Binds pipeline, resources and push constants (empty: the shader has none), for a dispatch.
void bind_compute(PassContext &r_context, PipelineRID p_pipeline,
		std::span<const PassBinding> p_bindings, std::span<const uint8_t> p_push);

/// Adds a pass that runs one compute shader over the items, with enough workgroups of its local
/// size to cover them. The bindings both declare reads and writes and bind the resources. p_push:
/// the shader's push constants, copied; empty if it has none.
void add_compute_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, glm::uvec3 p_item_count,
		std::span<const uint8_t> p_push = {});

/// Adds such a pass over the texels of an image, with a push-constant block.
template <typename Push>
void add_compute_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, glm::uvec2 p_size_px, const Push &p_push) {
	add_compute_pass(r_graph, p_name, p_pipeline, std::move(p_bindings), glm::uvec3(p_size_px, 1u),
			std::span(reinterpret_cast<const uint8_t *>(&p_push), sizeof(Push)));
}

} // namespace gnomon
