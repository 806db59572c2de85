#include "modules/shadow_jittered_pcf/shadow_jittered_pcf.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/shadow_jittered_pcf/jitter_offsets.h"
#include "modules/shadows/mask.h"

#include "shadow_jittered_pcf/shadow_jittered_pcf_shared.h"

namespace gnomon {

void ShadowJitteredPcf::get_light_properties(PropertyList &r_list) const {
	r_list.add({ "jittered_pcf_radius_uv", PropertyType::FLOAT, 0.01, "0,0.5,0.001",
			"Radius of the filter, as a part of the map's width. One for all pixels.", "uv",
			"Jittered filter" });
	r_list.add({ "jittered_pcf_rings", PropertyType::INT, int64_t(8), "1,32,1",
			"Rings of eight taps. Few make noise, many cost time.", "", "Jittered filter" });
	r_list.add({ "jittered_pcf_early_out", PropertyType::BOOL, true, "",
			"Stop after the outermost ring where it is all lit or all hidden. Faster; misses what "
			"is smaller than the filter.",
			"", "Jittered filter" });
	add_size_property(r_list, "Jittered filter");
}

void ShadowJitteredPcf::get_quality_settings(
		const LightSnapshot & /*p_light*/, std::vector<QualitySetting> &r_settings) const {
	// One radius suits one light size. The error report shows which is best.
	for (const double radius_uv : { 0.003, 0.01, 0.03 }) {
		r_settings.push_back(
				{ text("radius ", radius_uv), { { "jittered_pcf_radius_uv", radius_uv } } });
	}
}

void ShadowJitteredPcf::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	DepthMapTechnique::plan(p_inputs, r_plan);
	const uint32_t ring_count = read_count(p_inputs.properties, "jittered_pcf_rings");
	if (!is_all_empty() && offset_ring_count != ring_count) {
		const std::vector<glm::vec4> values = build_jitter_offsets(ring_count);
		const auto bytes = bytes_of(std::span<const glm::vec4>(values));
		offsets.reset();
		offsets = OwnedBuffer(p_inputs.device,
				p_inputs.device.create_buffer_with_data(
						{ "jitter offsets", bytes.size(), BufferUsage::STORAGE }, bytes));
		offset_ring_count = ring_count;
	}
}

void ShadowJitteredPcf::filter(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_empty_views,
		std::vector<PassBinding> p_bindings) {
	p_bindings.push_back(
			PassBinding::read(JITTERED_PCF_BINDING_OFFSETS, r_graph.import_buffer(offsets.get())));
	shader::JitteredPcfPush push = {};
	push.empty_views = p_empty_views;
	push.ring_count = offset_ring_count;
	push.radius_uv = read_float(p_inputs.properties, "jittered_pcf_radius_uv");
	push.has_early_out = read_switch(p_inputs.properties, "jittered_pcf_early_out") ? 1 : 0;
	add_map_resolve_pass(r_graph, "resolve",
			p_inputs.device.get_compute_pipeline({ "jittered_pcf resolve", shader, {} }),
			std::move(p_bindings), p_inputs, make_push_bytes(push));
}

} // namespace gnomon
