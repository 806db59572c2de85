#include "modules/render_graph/compute_pass.h"

#include <algorithm>

namespace gnomon {

namespace {

/// How the steps of one pass use a resource.
struct StepResource {
	PassBinding declared;		// what the graph knows; its binding is unused
	Access last = Access::NONE; // NONE: no step has used it
};

StepResource &find_step_resource(
		std::vector<StepResource> &r_resources, const PassBinding &p_binding) {
	const auto found = std::find_if(
			r_resources.begin(), r_resources.end(), [&](const StepResource &p_resource) {
				return p_resource.declared.texture.index == p_binding.texture.index &&
						p_resource.declared.buffer.index == p_binding.buffer.index;
			});
	if (found != r_resources.end()) {
		return *found;
	}
	r_resources.push_back({ p_binding });
	return r_resources.back();
}

/// What a step uses: its bindings, and the buffer of its arguments.
std::vector<PassBinding> list_uses(const ComputeStep &p_step) {
	std::vector<PassBinding> uses = p_step.bindings;
	if (p_step.arguments) {
		uses.push_back({ .buffer = p_step.arguments, .access = Access::INDIRECT_READ });
	}
	return uses;
}

/// Collects the resources of all steps. One that some step writes is declared with that access, and
/// with content that is preserved unless the first step that uses it writes all of it.
std::vector<StepResource> collect_step_resources(const std::vector<ComputeStep> &p_steps) {
	std::vector<StepResource> resources;
	for (const ComputeStep &step : p_steps) {
		for (const PassBinding &use : list_uses(step)) {
			PassBinding &declared = find_step_resource(resources, use).declared;
			if (is_write(use.access) && !is_write(declared.access)) {
				declared.access = use.access;
				declared.content = PassBuilder::Content::UPDATE;
			}
		}
	}
	return resources;
}

/// Adds the barrier before another use of a resource, unless both uses only read it in one way.
void push_step_barrier(PassContext &r_context, StepResource &r_resource, Access p_access,
		std::vector<Barrier> &r_barriers) {
	const PassBinding &declared = r_resource.declared;
	const Access before = r_resource.last == Access::NONE ? declared.access : r_resource.last;
	const bool is_hazard = r_resource.last != Access::NONE && is_write(before);
	if (is_hazard || before != p_access) {
		Barrier barrier = { .before = before, .after = p_access };
		if (declared.texture) {
			barrier.texture = r_context.get(declared.texture);
		} else {
			barrier.buffer = r_context.get(declared.buffer);
		}
		r_barriers.push_back(barrier);
	}
	r_resource.last = p_access;
}

void record_step(
		PassContext &r_context, const ComputeStep &p_step, std::vector<StepResource> &r_resources) {
	std::vector<Barrier> barriers;
	for (const PassBinding &use : list_uses(p_step)) {
		push_step_barrier(r_context, find_step_resource(r_resources, use), use.access, barriers);
	}
	if (!barriers.empty()) {
		r_context.commands.barriers(barriers);
	}
	bind_compute(r_context, p_step.pipeline, p_step.bindings, p_step.push);
	if (p_step.arguments) {
		r_context.commands.dispatch_indirect(
				r_context.get(p_step.arguments), p_step.arguments_offset_bytes);
	} else {
		r_context.commands.dispatch_items(p_step.item_count);
	}
}

} // namespace

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

void add_compute_steps(
		RenderGraph &r_graph, const std::string &p_name, std::vector<ComputeStep> p_steps) {
	if (p_steps.empty()) {
		return;
	}
	std::vector<StepResource> resources = collect_step_resources(p_steps);
	std::vector<PassBinding> declared;
	for (const StepResource &resource : resources) {
		declared.push_back(resource.declared);
	}
	PassBuilder pass = r_graph.add_pass(p_name);
	declare_bindings(pass, declared);
	pass.execute(
			[steps = std::move(p_steps), resources = std::move(resources)](PassContext &p_context) {
				std::vector<StepResource> used = resources;
				for (const ComputeStep &step : steps) {
					record_step(p_context, step, used);
				}
				std::vector<Barrier> barriers; // back to the access that the graph knows
				for (StepResource &resource : used) {
					const Access access = resource.declared.access;
					if (resource.last != access) {
						push_step_barrier(p_context, resource, access, barriers);
					}
				}
				if (!barriers.empty()) {
					p_context.commands.barriers(barriers);
				}
			});
}

} // namespace gnomon
