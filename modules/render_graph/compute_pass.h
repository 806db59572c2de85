#pragma once

#include "modules/render_graph/render_graph.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// A resource of a compute pass: its access, which the graph needs, and its binding in the shader.
struct PassBinding {
	uint32_t binding = 0;
	RGTexture texture;
	RGBuffer buffer;
	Access access = Access::SHADER_READ_COMPUTE;
	/// For a written resource: whether its earlier content is preserved.
	PassBuilder::Content content = PassBuilder::Content::FRESH;

	SamplerRID sampler; // set for a texture that the shader samples, not only fetches
	uint32_t layer = Binding::ALL_LAYERS; // layer of the texture

	/// A texture that the shader samples (with a sampler) or fetches (without).
	static PassBinding read(uint32_t p_binding, RGTexture p_texture, SamplerRID p_sampler = {}) {
		return { p_binding, p_texture, {}, Access::SHADER_READ_COMPUTE, PassBuilder::Content::FRESH,
			p_sampler };
	}
	/// A storage buffer that the shader only reads.
	static PassBinding read(uint32_t p_binding, RGBuffer p_buffer) {
		return { p_binding, {}, p_buffer, Access::SHADER_READ_COMPUTE };
	}
	/// A storage or uniform block of constants, see RenderGraph::upload_constants.
	static PassBinding constants(uint32_t p_binding, RGBuffer p_buffer) {
		return { p_binding, {}, p_buffer, Access::UNIFORM_READ };
	}
	/// A storage texture or buffer that the shader writes. UPDATE: the shader also reads it, or
	/// does not write all of it.
	static PassBinding write(uint32_t p_binding, RGTexture p_texture,
			PassBuilder::Content p_content = PassBuilder::Content::FRESH) {
		return { p_binding, p_texture, {}, Access::SHADER_WRITE_COMPUTE, p_content };
	}
	static PassBinding write(uint32_t p_binding, RGBuffer p_buffer,
			PassBuilder::Content p_content = PassBuilder::Content::FRESH) {
		return { p_binding, {}, p_buffer, Access::SHADER_WRITE_COMPUTE, p_content };
	}
};

/// Declares the bindings as reads and writes of the pass.
void declare_bindings(PassBuilder &r_pass, std::span<const PassBinding> p_bindings);
/// Binds the pipeline, the resources and the push constants (empty: the shader has none) for a
/// dispatch.
void bind_compute(PassContext &r_context, PipelineRID p_pipeline,
		std::span<const PassBinding> p_bindings, std::span<const uint8_t> p_push);

/// Adds a pass that dispatches a compute shader with enough workgroups to cover the items. Each
/// binding is declared as a read or write of the pass and bound to the shader. p_push: the shader's
/// push constants, copied; empty if it has none.
void add_compute_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, glm::uvec3 p_item_count,
		std::span<const uint8_t> p_push = {});

/// Adds a compute pass over the texels of an image, with a struct as push constants.
template <typename Push>
void add_compute_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, glm::uvec2 p_size_px, const Push &p_push) {
	add_compute_pass(r_graph, p_name, p_pipeline, std::move(p_bindings), glm::uvec3(p_size_px, 1u),
			std::span(reinterpret_cast<const uint8_t *>(&p_push), sizeof(Push)));
}

/// A dispatch of a pass that has several, see add_compute_steps.
struct ComputeStep {
	PipelineRID pipeline;
	std::vector<PassBinding> bindings;
	std::vector<uint8_t> push; // the shader's push constants; empty if it has none
	/// Without arguments, enough work groups to cover the items.
	glm::uvec3 item_count{ 0 };
	/// Indirect dispatch: the buffer of its arguments, and their offset.
	RGBuffer arguments;
	uint64_t arguments_offset_bytes = 0;
};

/// The bytes of a struct of push constants.
template <typename Push> std::vector<uint8_t> make_push_bytes(const Push &p_push) {
	const auto *bytes = reinterpret_cast<const uint8_t *>(&p_push);
	return std::vector<uint8_t>(bytes, bytes + sizeof(Push));
}

/// Adds one pass that runs the steps in order, with barriers between those that use the same
/// resource. A pass for each step would measure it, which takes longer than a step that finds
/// nothing to do. Without steps, no pass is added. A resource that some step writes has to have
/// content that is preserved (UPDATE) in each step, except in the first that uses it.
void add_compute_steps(
		RenderGraph &r_graph, const std::string &p_name, std::vector<ComputeStep> p_steps);

} // namespace gnomon
