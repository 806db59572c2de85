#include "modules/render_graph/compute_pass.h"

namespace gnomon {

void add_compute_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, glm::uvec3 p_item_count,
		std::span<const uint8_t> p_push) {
	PassBuilder pass = r_graph.add_pass(p_name);
	for (const PassBinding &binding : p_bindings) {
		const bool is_written = is_write(binding.access);
		if (binding.texture && is_written) {
			pass.writes(binding.texture, binding.access, binding.content);
		} else if (binding.texture) {
			pass.reads(binding.texture, binding.access);
		} else if (is_written) {
			pass.writes(binding.buffer, binding.access, binding.content);
		} else {
			pass.reads(binding.buffer, binding.access);
		}
	}
	std::vector<uint8_t> push(p_push.begin(), p_push.end());
	pass.execute([p_pipeline, bindings = std::move(p_bindings), push = std::move(push),
						 p_item_count](PassContext &p_context) {
		std::vector<Binding> resources;
		for (const PassBinding &binding : bindings) {
			if (binding.texture) {
				resources.emplace_back(
						binding.binding, p_context.get(binding.texture), binding.sampler);
			} else {
				resources.emplace_back(binding.binding, p_context.get(binding.buffer));
			}
		}
		p_context.commands.bind_pipeline(p_pipeline);
		p_context.commands.bind_resources(resources);
		if (!push.empty()) {
			p_context.commands.push_constants(std::span<const uint8_t>(push));
		}
		p_context.commands.dispatch_items(p_item_count);
	});
}

} // namespace gnomon
