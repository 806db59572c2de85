#include "modules/renderer/light_shadows.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/renderer/light_properties.h"
#include "modules/renderer/lighting.h"
#include "modules/renderer/map_resolve.h"
#include "modules/renderer/nearest_caster.h"
#include "modules/renderer/view_fit.h"

#include "renderer/renderer_shared.h"

#include <algorithm>

namespace gnomon {

namespace {

// A light that turns away and comes back soon finds its maps; one that stays away holds no memory.
constexpr uint64_t KEPT_FRAMES = 60;

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
		if (!instance.casts_shadow || (p_may_cull && !p_view.may_see(instance))) {
			continue;
		}
		casters.instances.push_back(index);
		hash = compute_value_hash(instance.mesh->id, hash);
		hash = compute_value_hash(instance.world_from_node, hash);
	}
	casters.content_hash = hash;
	return casters;
}

std::string describe_forced(const LightSnapshot &p_light, const TranslucentCasters &p_casters) {
	if (p_casters.forced_count == 0) {
		return {};
	}
	return text("Light \"", p_light.name, "\": ", p_casters.forced_count,
			" translucent casters share the colour of others, as it can tell ",
			TranslucentCasters::MAX_GROUP_COUNT,
			" groups apart. Give casters of one colour the same transmission, or fewer colours.");
}

} // namespace

void TechniquePlan::leave_out_light_view(uint32_t p_view_index, const std::string &p_reason) {
	if (left_out_views.insert(p_view_index).second) {
		leave_out(text("light view ", p_view_index), p_reason);
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

struct LightShadows::Work {
	RenderGraph &graph;
	const Request &request;
	const ShadowTechniqueInfo &info;
	const PropertyValues &properties;
	FramePlan &plan;
	std::vector<ShadowTechnique::DebugView> &debug_views;
};

LightShadows::Slot &LightShadows::get_slot(
		const SlotKey &p_key, const ShadowTechniqueInfo &p_info) {
	Slot &slot = slots[p_key];
	if (!slot.technique || slot.technique_id != p_info.id) {
		slot.technique.reset(); // before the new one takes memory
		slot.technique = p_info.make();
		slot.technique_id = p_info.id;
	}
	slot.last_frame = frame;
	return slot;
}

float LightShadows::get_standard_error(const std::string &p_light_name) const {
	const auto slot = slots.find({ p_light_name, 0 });
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
	warn_once("scene_size", describe_unfit_size(p_scene));
	++frame;
	std::erase_if(slots, [&](const auto &p_slot) {
		return frame - p_slot.second.last_frame > KEPT_FRAMES ||
				p_scene.find_light(p_slot.first.first) == nullptr;
	});
}

void LightShadows::warn_once(const std::string &p_warning) {
	warn_once(p_warning, p_warning);
}

void LightShadows::warn_once(const std::string &p_key, const std::string &p_warning) {
	if (!p_warning.empty() && warned.insert(p_key).second) {
		log_warning(p_warning);
	}
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

RGTexture LightShadows::add_technique(const Work &p_work, ShadowTechnique &r_technique,
		const SceneSnapshot &p_scene, const std::string &p_run) {
	const Request &request = p_work.request;
	TechniquePlan plan(p_work.plan, p_run.empty() ? "" : p_run + ": ");
	const bool wants_debug_views = request.wants_debug_views && p_run.empty();
	std::vector<LightView> views;
	r_technique.get_light_views(request.light, p_scene, p_work.properties, views);
	std::vector<CasterList> casters;
	for (LightView &view : views) {
		if (r_technique.asks_receivers_alone()) {
			fit_to_receivers(
					view, request.lit_receivers, compute_fit_reach_m(view, request.light, p_scene));
		}
		casters.push_back(cull_casters(p_scene, view, request.may_leave_out));
		// What is shown itself is seen, receivers or not.
		casters.back().has_receivers =
				wants_debug_views || may_view_hold_any(view, request.lit_receivers);
	}
	const ShadowTechnique::Inputs inputs = { device, meshes, p_scene, request.light,
		p_work.properties, views, casters, request.size_px, request.gbuffer.depth,
		request.gbuffer.geometric_normal, request.gbuffer.shading_normal, request.gbuffer.material,
		request.receivers, request.frame, request.light_constants, request.may_leave_out,
		request.may_keep, wants_debug_views, request.lit_receivers.list };
	r_technique.plan(inputs, plan);
	for (uint32_t index = 0; index < views.size(); ++index) {
		if (plan.is_light_view_left_out(index)) {
			continue;
		}
		plan.run(text("light view ", index));
		r_technique.before_light_view(p_work.graph, inputs, index);
		r_technique.at_light_view(p_work.graph, inputs, index);
		r_technique.after_light_view(p_work.graph, inputs, index);
	}
	plan.run("resolve");
	const RGTexture mask = r_technique.resolve(p_work.graph, inputs);
	if (wants_debug_views) {
		r_technique.get_debug_views(p_work.debug_views);
		for (ShadowTechnique::DebugView &view : p_work.debug_views) {
			view.shown_range =
					view.is_light_depth ? compute_shown_depths(inputs) : view.shown_range;
		}
	}
	return mask;
}

RGTexture LightShadows::add_translucent_casters(
		const Work &p_work, const TranslucentCasters &p_casters, RGTexture p_opaque) {
	const Request &request = p_work.request;
	RGTexture mask = p_opaque;
	for (size_t index = 0; index < p_casters.groups.size(); ++index) {
		const TranslucentGroup &group = p_casters.groups[index];
		const std::string name = text("translucent ", index + 1);
		p_work.graph.set_pass_prefix(text(request.light.name, ": ", name, ": "));
		Slot &slot = get_slot({ request.light.name, index + 1 }, p_work.info);
		slot.scene = make_opaque_scene(request.scene, p_casters, &group);
		const RGTexture both = add_technique(p_work, *slot.technique, *slot.scene, name);
		const RGTexture tinted = create_mask(p_work.graph, request.size_px, Format::RGBA16_SFLOAT);
		add_compute_pass(p_work.graph, "tint",
				device.get_compute_pipeline(
						{ "tint", "renderer/tint.comp", make_mask_constants(p_work.graph, mask) }),
				{
						PassBinding::read(TINT_BINDING_OPAQUE, p_opaque),
						PassBinding::read(TINT_BINDING_BOTH, both),
						PassBinding::read(TINT_BINDING_BEFORE, mask),
						PassBinding::write(TINT_BINDING_RESULT, tinted),
				},
				request.size_px, shader::TintPush{ glm::vec4(group.transmittance, 0.0f) });
		mask = tinted;
	}
	p_work.graph.set_pass_prefix(request.light.name + ": ");
	return mask;
}

RGTexture LightShadows::add_passes(RenderGraph &r_graph, const Request &p_request,
		FramePlan &r_plan, std::vector<ShadowTechnique::DebugView> &r_debug_views) {
	const LightSnapshot &light = p_request.light;
	const TechniqueChoice choice = choose_technique(light, p_request.technique_override);
	warn_once(choice.warning);
	if (!choice.info) {
		r_plan.leave_out("shadow", "no technique is enabled");
		return add_constant_mask(r_graph, p_request.size_px, 1.0f);
	}
	if (!choice.warning.empty()) {
		r_plan.leave_out(light.technique_id, "not enabled; " + choice.info->id + " runs instead");
	}
	const PropertyValues properties =
			resolve_light_properties(light, ShadowRegistry::get_light_properties(choice.info->id));
	const Work work = { r_graph, p_request, *choice.info, properties, r_plan, r_debug_views };
	Slot &slot = get_slot({ light.name, 0 }, *choice.info);
	slot.scene.reset();
	for (const BrokenLimit &limit : slot.limits.find_broken(
				 p_request.scene, light, choice.info->id, slot.technique->get_limits(properties))) {
		warn_once(limit.key, limit.warning);
	}
	RGTexture mask;
	TranslucentCasters translucent;
	if (!slot.technique->sees_translucent_casters()) {
		translucent = find_translucent_casters(p_request.scene, light);
	}
	std::erase_if(slots, [&](const auto &p_slot) { // of groups that there are no more
		return p_slot.first.first == light.name && p_slot.first.second > translucent.groups.size();
	});
	if (translucent.is_empty()) {
		mask = add_technique(work, *slot.technique, p_request.scene, "");
	} else {
		warn_once(describe_forced(light, translucent));
		slot.scene = make_opaque_scene(p_request.scene, translucent, nullptr);
		mask = add_technique(work, *slot.technique, *slot.scene, "");
		mask = add_translucent_casters(work, translucent, mask);
	}
	const ShadowTechnique::Inputs inputs = { device, meshes, p_request.scene, light, properties, {},
		{}, p_request.size_px, p_request.gbuffer.depth, p_request.gbuffer.geometric_normal,
		p_request.gbuffer.shading_normal, p_request.gbuffer.material, p_request.receivers,
		p_request.frame, p_request.light_constants, p_request.may_leave_out, p_request.may_keep,
		p_request.wants_debug_views, p_request.lit_receivers.list };
	TechniquePlan plan(r_plan);
	mask = add_filters(r_graph, inputs, choice.info->is_reference, mask, plan);
	if (p_request.wants_debug_views) {
		r_debug_views.push_back({ "mask", mask });
		r_debug_views.back().is_color = is_colored_mask(r_graph, mask);
	}
	return mask;
}

} // namespace gnomon
