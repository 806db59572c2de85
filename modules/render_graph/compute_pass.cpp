#include "modules/render_graph/compute_pass.h"

namespace gnomon {

void declare_bindings(PassBuilder &r_pass, std::span<const PassBinding> p_bindings) {
	for (const PassBinding &binding : p_bindings) {
		const RGResource resource =
				binding.texture ? RGResource(binding.texture) : RGResource(binding.buffer);
		if (is_write(binding.access)) {
			r_pass.writes(resource, binding.access, binding.content);
		} else {
			r_pass.reads(resource, binding.access);
		}
	}
}

void bind_compute(PassContext &r_context, PipelineRID p_pipeline,
		std::span<const PassBinding> p_bindings, std::span<const uint8_t> p_push) {
	std::vector<Binding> resources;
	for (const PassBinding &binding : p_bindings) {
		if (binding.texture) {
			resources.emplace_back(
					binding.binding, r_context.get(binding.texture), binding.sampler);
			resources.back().layer = binding.layer;
		} else {
			resources.emplace_back(binding.binding, r_context.get(binding.buffer));
		}
	}
	r_context.commands.bind_pipeline(p_pipeline);
	r_context.commands.bind_resources(resources);
	if (!p_push.empty()) {
		r_context.commands.push_constants(p_push);
	}
}

void add_compute_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, glm::uvec3 p_item_count,
		std::span<const uint8_t> p_push) {
	PassBuilder pass = r_graph.add_pass(p_name);
	declare_bindings(pass, p_bindings);
	std::vector<uint8_t> push(p_push.begin(), p_push.end());
	pass.execute([p_pipeline, bindings = std::move(p_bindings), push = std::move(push),
						 p_item_count](PassContext &p_context) {
		bind_compute(p_context, p_pipeline, bindings, push);
		p_context.commands.dispatch_items(p_item_count);
	});
}

} // namespace gnomon
