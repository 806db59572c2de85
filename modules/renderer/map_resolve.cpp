#include "modules/renderer/map_resolve.h"

namespace gnomon {

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

RGTexture create_mask(RenderGraph &r_graph, glm::uvec2 p_size_px, Format p_format) {
	return r_graph.create_texture({ "visibility mask", p_format, p_size_px, 1,
			TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
}

} // namespace gnomon
