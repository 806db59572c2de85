#include "modules/shadow_edge_count/view_passes.h"

namespace gnomon {

void add_part_pass(RenderGraph &r_graph, RenderingDevice &p_device, const std::string &p_name,
		const char *p_shader, const CountViewPasses &p_passes, std::vector<PassBinding> p_bindings,
		uint32_t p_items, const std::vector<SpecializationConstant> &p_constants) {
	const shader::CountPartPush push = { p_passes.capacities.fragments_per_view,
		p_passes.capacities.records_per_view, 0, 0 };
	add_compute_pass(r_graph, p_name,
			p_device.get_compute_pipeline({ p_shader, p_shader, p_constants }),
			std::move(p_bindings), { p_items, 1, 1 },
			std::span(reinterpret_cast<const uint8_t *>(&push), sizeof(push)));
}

} // namespace gnomon
