#include "modules/renderer/light_shadows.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/renderer/light_properties.h"
#include "modules/renderer/lighting.h"

#include <algorithm>

namespace gnomon {

namespace {

CasterList cull_casters(const SceneSnapshot &p_scene, const LightView &p_view, bool p_may_cull) {
	CasterList casters;
	// Field by field: the struct has padding.
	uint64_t hash = compute_value_hash(p_view.view_from_world, 1);
	hash = compute_value_hash(p_view.half_extent, hash);
	hash = compute_value_hash(p_view.size_px, hash);
	hash = compute_value_hash(p_view.near_m, hash);
	hash = compute_value_hash(p_view.far_m, hash);
	for (uint32_t index = 0; index < p_scene.instances.size(); ++index) {
		const InstanceSnapshot &instance = p_scene.instances[index];
		if (!instance.casts_shadow || (p_may_cull && !p_view.may_see(instance.bounds_world))) {
			continue;
		}
		casters.instances.push_back(index);
		hash = compute_value_hash(instance.mesh->id, hash);
		hash = compute_value_hash(instance.world_from_node, hash);
	}
	casters.content_hash = hash;
	return casters;
}

} // namespace

void TechniquePlan::leave_out_light_view(uint32_t p_view_index, const std::string &p_reason) {
	if (left_out_views.insert(p_view_index).second) {
		plan.leave_out(text("light view ", p_view_index), p_reason);
	}
}

TechniqueChoice choose_technique(const LightSnapshot &p_light, const std::string &p_override) {
	if (!p_override.empty()) {
		return { &ShadowRegistry::get(p_override), {} };
	}
	if (p_light.technique_id.empty()) {
		const ShadowTechniqueInfo *info = ShadowRegistry::find_default();
		return { info,
			info ? ""
				 : text("Light \"", p_light.name,
						   "\": no technique is enabled; it casts no shadow. ",
						   "Enable a module; `gnomon modules` lists them.") };
	}
	if (const ShadowTechniqueInfo *info = ShadowRegistry::find(p_light.technique_id)) {
		return { info, {} };
	}
	const ShadowTechniqueInfo *info = ShadowRegistry::find_fallback();
	return { info,
		text("Light \"", p_light.name, "\": technique \"", p_light.technique_id,
				"\" is not enabled; ",
				info ? "\"" + info->id + "\" is used instead" : "it casts no shadow",
				". `gnomon techniques` lists those that are.") };
}

ShadowTechnique &LightShadows::get_technique(
		const LightSnapshot &p_light, const ShadowTechniqueInfo &p_info) {
	Slot &slot = slots[p_light.name];
	if (!slot.technique || slot.technique_id != p_info.id) {
		slot.technique.reset(); // before the new one takes memory
		slot.technique = p_info.make();
		slot.technique_id = p_info.id;
	}
	return *slot.technique;
}

float LightShadows::get_standard_error(const std::string &p_light_name) const {
	const auto slot = slots.find(p_light_name);
	return slot == slots.end() ? 0.0f : slot->second.technique->get_standard_error();
}

void LightShadows::collect_garbage(const SceneSnapshot &p_scene) {
	if (technique_revision != ShadowRegistry::get_revision()) {
		technique_revision = ShadowRegistry::get_revision();
		slots.clear();
		warned.clear(); // a warning is due again after modules were switched
	}
	if (filter_revision != MaskFilterRegistry::get_revision()) {
		filter_revision = MaskFilterRegistry::get_revision();
		filters.clear();
		for (const MaskFilterInfo &info : MaskFilterRegistry::get_filters()) {
			filters.push_back(info.make());
		}
	}
	std::erase_if(slots, [&](const auto &p_slot) {
		return std::none_of(p_scene.lights.begin(), p_scene.lights.end(),
				[&](const LightSnapshot &p_light) { return p_light.name == p_slot.first; });
	});
}

RGTexture LightShadows::add_filters(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		bool p_is_exact, RGTexture p_mask, TechniquePlan &r_plan) {
	for (size_t index = 0; index < filters.size(); ++index) {
		const MaskFilterInfo &info = MaskFilterRegistry::get_filters()[index];
		if (p_is_exact && info.spread) {
			continue;
		}
		const PropertyValues properties = resolve_light_properties(
				p_inputs.light, MaskFilterRegistry::get_light_properties(info.id));
		if (filters[index]->plan(p_inputs, properties, r_plan)) {
			p_mask = filters[index]->apply(r_graph, p_inputs, properties, p_mask);
		}
	}
	return p_mask;
}

RGTexture LightShadows::add_passes(RenderGraph &r_graph, const Request &p_request,
		FramePlan &r_plan, std::vector<ShadowTechnique::DebugView> &r_debug_views) {
	const LightSnapshot &light = p_request.light;
	const TechniqueChoice choice = choose_technique(light, p_request.technique_override);
	if (!choice.warning.empty() && warned.insert(choice.warning).second) {
		log_warning(choice.warning);
	}
	if (!choice.info) {
		r_plan.leave_out("shadow", "no technique is enabled");
		return add_constant_mask(r_graph, p_request.size_px, 1.0f);
	}
	if (!choice.warning.empty()) {
		r_plan.leave_out(light.technique_id, "not enabled; " + choice.info->id + " runs instead");
	}
	ShadowTechnique &technique = get_technique(light, *choice.info);
	const PropertyValues properties =
			resolve_light_properties(light, ShadowRegistry::get_light_properties(choice.info->id));
	std::vector<LightView> views;
	technique.get_light_views(light, p_request.scene, properties, views);
	std::vector<CasterList> casters;
	for (const LightView &view : views) {
		casters.push_back(cull_casters(p_request.scene, view, p_request.may_leave_out));
	}
	const ShadowTechnique::Inputs inputs = { device, meshes, p_request.scene, light, properties,
		views, casters, p_request.size_px, p_request.gbuffer.depth,
		p_request.gbuffer.geometric_normal, p_request.gbuffer.shading_normal,
		p_request.gbuffer.material, p_request.receivers, p_request.frame, p_request.light_constants,
		p_request.may_leave_out, p_request.may_keep, p_request.wants_debug_views };
	TechniquePlan plan(r_plan);
	technique.plan(inputs, plan);
	for (uint32_t index = 0; index < views.size(); ++index) {
		if (plan.is_light_view_left_out(index)) {
			continue;
		}
		plan.run(text("light view ", index));
		technique.before_light_view(r_graph, inputs, index);
		technique.at_light_view(r_graph, inputs, index);
		technique.after_light_view(r_graph, inputs, index);
	}
	plan.run("resolve");
	const RGTexture mask = add_filters(
			r_graph, inputs, choice.info->is_reference, technique.resolve(r_graph, inputs), plan);
	if (p_request.wants_debug_views) {
		technique.get_debug_views(r_debug_views);
		r_debug_views.push_back({ "mask", mask });
	}
	return mask;
}

} // namespace gnomon
