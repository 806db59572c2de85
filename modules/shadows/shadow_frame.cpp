#include "modules/shadows/shadow_frame.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/render_graph/fill_pass.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/light_properties.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/nearest_caster.h"
#include "modules/shadows/translucent_casters.h"
#include "modules/shadows/view_fit.h"

#include "shadows/shadows_shared.h"

namespace gnomon {

namespace {

/// Bounds of the instances that cast.
Bounds compute_bounds(const SceneSnapshot &p_scene, const CasterFlags &p_casts) {
	Bounds bounds;
	for (size_t index = 0; index < p_scene.instances.size(); ++index) {
		if (p_casts[index] != 0) {
			bounds.add(p_scene.instances[index].bounds_world);
		}
	}
	return bounds;
}

std::string describe_merged(const LightSnapshot &p_light, const TranslucentCasters &p_casters) {
	if (p_casters.merged_count == 0) {
		return {};
	}
	return text("Light \"", p_light.name, "\": ", p_casters.merged_count,
			" translucent casters get the colour of another group, since at most ",
			TranslucentCasters::MAX_GROUP_COUNT,
			" groups are possible. Give casters of one colour the same transmission, or use "
			"fewer colours.");
}

void check_surface(const RenderGraph &p_graph, RGTexture p_texture, const char *p_what,
		Format p_format, glm::uvec2 p_size_px) {
	if (!p_texture) {
		return;
	}
	const TextureDesc desc = p_graph.get_desc(p_texture);
	GNOMON_ASSERT(desc.format == p_format && desc.size_px == p_size_px, p_what, " is ",
			desc.size_px.x, "x", desc.size_px.y, " ", get_format_name(desc.format), ", must be ",
			p_size_px.x, "x", p_size_px.y, " ", get_format_name(p_format));
}

} // namespace

void TechniquePlan::skip_light_view(uint32_t p_view_index, const std::string &p_reason) {
	if (skipped_views.insert(p_view_index).second) {
		skip(text("light view ", p_view_index), p_reason);
	}
}

struct ShadowFrame::Work {
	const SceneSnapshot &scene;
	const SceneSummary &summary;		 // of `scene`
	const LightSnapshot &snapshot_light; // the snapshot's own
	const LightSnapshot &light;			 // with the technique's widths
	const ShadowTechniqueInfo &info;
	const PropertyValues &properties;
	const VisibleReceivers &lit_receivers;
	LightShadow &shadow;
	bool wants_debug_views;
};

ShadowFrame::ShadowFrame(ShadowSystem &r_system, RenderGraph &r_graph, FramePlan &r_plan,
		std::shared_ptr<const SceneSnapshot> p_scene, glm::uvec2 p_size_px,
		ShadowFrameOptions p_options) :
		system(r_system),
		graph(r_graph), plan(r_plan), scene(std::move(p_scene)), size_px(p_size_px),
		options(std::move(p_options)) {
	GNOMON_ASSERT(scene, "a frame needs a scene");
	if (!options.technique_override.empty()) {
		ShadowRegistry::get(options.technique_override); // throws when it is not registered
	}
	system.begin_frame(*scene, size_px);
	const size_t posed_count = system.derived_scene.summary.get_whole().posed_count;
	const uint32_t moved_count =
			posed_count > 0 ? system.meshes->add_deform_pass(graph, *scene, options.may_reuse) : 0;
	if (moved_count > 0) {
		plan.run(text("deform, meshes: ", moved_count));
	}
	if (posed_count > moved_count) {
		plan.skip(text("deform, meshes: ", posed_count - moved_count),
				"cached: their pose is the same");
	}
	constants = graph.upload_constants("frame constants", system.derived_camera.constants,
			BufferUsage::STORAGE | BufferUsage::UNIFORM); // hosts may bind it as either
	for (const std::string &line : system.derived_scene.cut_out_lines) {
		plan.run(line);
	}
}

ShadowFrame::~ShadowFrame() {
	if (!has_ended) {
		system.clear_caches();
		system.meshes->forget_poses();
	}
}

void ShadowFrame::end() {
	has_ended = true;
	for (auto &[key, slot] : system.slots) {
		if (key.second == 0 && slot.last_frame == system.frame) {
			std::vector<PassTiming> passes;
			std::copy_if(graph.get_timings().begin(), graph.get_timings().end(),
					std::back_inserter(passes), [&](const PassTiming &p_pass) {
						return p_pass.name.starts_with(key.first + ": ");
					});
			slot.technique->receive_times(passes);
		}
	}
	system.meshes->collect_garbage();
}

void ShadowFrame::set_surfaces(const HostSurfaces &p_surfaces) {
	GNOMON_ASSERT(p_surfaces.depth, "HostSurfaces::depth is required");
	check_surface(graph, p_surfaces.depth, "depth", Format::D32_SFLOAT, size_px);
	check_surface(
			graph, p_surfaces.geometric_normal, "geometric_normal", Format::R32_UINT, size_px);
	check_surface(graph, p_surfaces.material, "material", Format::RGBA16_SFLOAT, size_px);
	surfaces = p_surfaces;
	if (!surfaces.geometric_normal) {
		surfaces.geometric_normal = add_normals_pass();
		plan.run("normals from depth");
	}
	tile_depths = add_tile_depths_pass(graph, system.device, constants, surfaces.depth, size_px);
}

RGTexture ShadowFrame::add_normals_pass() {
	const RGTexture normals = graph.create_texture({ "geometric normal", Format::R32_UINT, size_px,
			1, TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	add_compute_pass(graph, "normals from depth",
			system.device.get_compute_pipeline(
					{ "normals from depth", "shadows/normals_from_depth.comp", {} }),
			{
					PassBinding::constants(SURFACE_BINDING_FRAME, constants),
					PassBinding::read(SURFACE_BINDING_DEPTH, surfaces.depth),
					PassBinding::write(SURFACE_BINDING_RESULT, normals),
			},
			glm::uvec3(size_px, 1u));
	return normals;
}

void ShadowFrame::add_receivers_pass(LightShadow &r_shadow, bool p_lists_all_tiles) {
	r_shadow.tiles = add_lit_tiles_pass(graph, system.device, constants, r_shadow.light_constants,
			tile_depths, size_px, p_lists_all_tiles);
	r_shadow.receivers = graph.create_texture({ "receivers", Format::R8_UNORM, size_px, 1,
			TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE |
					TextureUsage::COPY_TARGET });
	add_clear_pass(graph, "clear receivers", r_shadow.receivers, 0.0f);
	add_tile_pass(graph, "receivers",
			system.device.get_compute_pipeline({ "receivers", "shadows/receivers.comp", {} }),
			{
					PassBinding::constants(SURFACE_BINDING_FRAME, constants),
					PassBinding::constants(SURFACE_BINDING_LIGHT, r_shadow.light_constants),
					PassBinding::read(SURFACE_BINDING_DEPTH, surfaces.depth),
					PassBinding::read(SURFACE_BINDING_NORMAL, surfaces.geometric_normal),
					PassBinding::write(SURFACE_BINDING_RESULT, r_shadow.receivers,
							PassBuilder::Content::UPDATE),
			},
			r_shadow.tiles, SURFACE_BINDING_TILES);
}

std::string ShadowFrame::describe_unlit(const LightSnapshot &p_light) const {
	if (!system.derive_lit_receivers(p_light).list.empty()) {
		return {};
	}
	return text("the camera sees no surface",
			p_light.type == LightType::SPOT			  ? " in its cone and range"
					: p_light.type == LightType::OMNI ? " in its range"
													  : "");
}

LightShadow ShadowFrame::add_light(const LightSnapshot &p_light, bool p_wants_debug_views) {
	GNOMON_ASSERT(surfaces.depth, "call set_surfaces before add_light");
	graph.set_pass_prefix(p_light.name + ": ");
	plan.set_light(p_light.name);
	LightShadow shadow;
	shadow.light_constants = graph.upload_constants(
			"light constants", compute_light_constants(p_light, scene->camera));
	add_receivers_pass(shadow, !options.may_skip || p_wants_debug_views);
	plan.run("receivers");
	const VisibleReceivers &lit = system.derive_lit_receivers(p_light);
	if (!p_light.casts_shadow) {
		plan.skip("shadow", "shadow_enabled is false");
		shadow.mask = add_constant_mask(graph, size_px, 1.0f);
	} else if (options.may_skip && lit.list.empty() && !p_wants_debug_views) {
		plan.skip("shadow", describe_unlit(p_light));
		shadow.mask = add_constant_mask(graph, size_px, 1.0f);
	} else {
		try {
			shadow.mask = add_shadow(p_light, lit, shadow, p_wants_debug_views);
		} catch (const CapacityError &error) {
			fail_capacity(error.what(), " ", scene->describe_largest_caster());
		}
	}
	return shadow;
}

std::vector<LightShadow> ShadowFrame::add_all_lights() {
	std::vector<LightShadow> shadows;
	for (const LightSnapshot &light : scene->lights) {
		shadows.push_back(add_light(light));
	}
	graph.set_pass_prefix("");
	plan.set_light("");
	return shadows;
}

void ShadowFrame::hold(const LightShadow &p_shadow, RGTexture p_array, uint32_t p_layer,
		float p_no_receiver_value) {
	const TextureDesc desc = graph.get_desc(p_array);
	GNOMON_ASSERT(desc.is_array && glm::all(glm::greaterThanEqual(desc.size_px, size_px)) &&
					p_layer < desc.layer_count,
			"hold() needs an array of at least ", size_px.x, "x", size_px.y, " px with layer ",
			p_layer, "; the texture has ", desc.size_px.x, "x", desc.size_px.y, " px, ",
			desc.layer_count, " layers and is ", desc.is_array ? "" : "not ", "an array");
	const bool has_color = desc.format == Format::RGBA16_SFLOAT;
	GNOMON_ASSERT(has_color || desc.format == Format::R16_SFLOAT, "the array of hold() is ",
			get_format_name(desc.format), ", must be R16_SFLOAT or RGBA16_SFLOAT");
	shader::HoldPush push = {};
	push.layer = p_layer;
	push.no_receiver_value = p_no_receiver_value;
	add_clear_pass(graph, "clear held mask", p_array, p_no_receiver_value, p_layer);
	add_tile_pass(graph, "hold mask",
			system.device.get_compute_pipeline(
					{ "hold mask", has_color ? "shadows/hold_color.comp" : "shadows/hold_gray.comp",
							make_mask_constants(graph, p_shadow.mask) }),
			{
					PassBinding::read(HOLD_BINDING_MASK, p_shadow.mask),
					PassBinding::read(HOLD_BINDING_RECEIVERS, p_shadow.receivers),
					PassBinding::write(HOLD_BINDING_RESULT, p_array, PassBuilder::Content::UPDATE),
			},
			p_shadow.tiles, HOLD_BINDING_TILES, make_push_bytes(push));
}

ShadowTechnique::Inputs ShadowFrame::make_inputs(const Work &p_work,
		std::span<const LightView> p_views, std::span<const CasterList> p_casters,
		bool p_wants_debug_views) const {
	return {
		.device = system.device,
		.meshes = *system.meshes,
		.scene = p_work.scene,
		.summary = p_work.summary,
		.light = p_work.light,
		.properties = p_work.properties,
		.settings = ShadowRegistry::get_setting_values(p_work.info.id),
		.views = p_views,
		.casters = p_casters,
		.size_px = size_px,
		.depth = surfaces.depth,
		.geometric_normal = surfaces.geometric_normal,
		.material = surfaces.material,
		.receivers = p_work.shadow.receivers,
		.tiles = p_work.shadow.tiles,
		.frame = constants,
		.light_constants = p_work.shadow.light_constants,
		.may_skip = options.may_skip,
		.may_reuse = options.may_reuse,
		.wants_debug_views = p_wants_debug_views,
		.lit_receivers = p_work.lit_receivers.list,
	};
}

RGTexture ShadowFrame::add_filters(const Work &p_work, RGTexture p_mask) {
	const ShadowTechnique::Inputs inputs =
			make_inputs(p_work, /*p_views=*/{}, /*p_casters=*/{}, p_work.wants_debug_views);
	TechniquePlan filter_plan(plan);
	for (size_t index = 0; index < system.filters.size(); ++index) {
		const MaskFilterInfo &info = MaskFilterRegistry::get_all()[index];
		if (p_work.info.is_reference && info.spread) {
			continue; // the reference already integrates what the filter approximates
		}
		const PropertyValues properties = resolve_light_properties(
				p_work.light, MaskFilterRegistry::get_light_properties(info.id));
		if (system.filters[index]->plan(inputs, properties, filter_plan)) {
			p_mask = system.filters[index]->apply(graph, inputs, properties, p_mask);
		}
	}
	return p_mask;
}

void ShadowFrame::derive_run(const Work &p_work, const ShadowTechnique &p_technique,
		const TranslucentCasters &p_translucent, const TranslucentGroup *p_group,
		bool p_wants_debug_views, ShadowSystem::DerivedRun &r_run) const {
	if (r_run.light == &p_work.snapshot_light && r_run.may_skip == options.may_skip &&
			r_run.wants_debug_views == p_wants_debug_views) {
		return;
	}
	r_run.light = &p_work.snapshot_light;
	r_run.may_skip = options.may_skip;
	r_run.wants_debug_views = p_wants_debug_views;
	r_run.views.clear();
	r_run.casters.clear();
	const bool casts_all = p_translucent.is_empty();
	const CasterFlags opaque =
			casts_all ? CasterFlags() : find_opaque_casters(p_work.scene, p_translucent, p_group);
	const CasterFlags &casts = casts_all ? p_work.summary.get_casters() : opaque;
	const Bounds bounds_world =
			casts_all ? p_work.summary.get_caster_bounds() : compute_bounds(p_work.scene, casts);
	p_technique.get_light_views(
			p_work.light, { p_work.scene, bounds_world }, p_work.properties, r_run.views);
	r_run.culling.resize(r_run.views.size());
	for (size_t index = 0; index < r_run.views.size(); ++index) {
		LightView &view = r_run.views[index];
		if (p_technique.queries_receivers_only() && view.is_orthographic) {
			const Bounds seen = find_bounds_in_view(view, p_work.lit_receivers);
			fit_to_receivers(
					view, seen, compute_fit_reach_m(view, p_work.light, p_work.scene, seen));
		}
		r_run.casters.push_back(r_run.culling[index].update(
				p_work.scene, p_work.summary, casts, view, options.may_skip));
		// While debug views are shown, every view counts as having receivers, so that its map is
		// drawn.
		r_run.casters.back().has_receivers =
				p_wants_debug_views || may_view_contain_any(view, p_work.lit_receivers);
	}
}

RGTexture ShadowFrame::add_technique(const Work &p_work, ShadowSystem::Slot &r_slot,
		const TranslucentCasters &p_translucent, const TranslucentGroup *p_group,
		const std::string &p_run) {
	TechniquePlan technique_plan(plan, p_run.empty() ? "" : p_run + ": ");
	const bool wants_debug_views = p_work.wants_debug_views && p_run.empty();
	ShadowTechnique &technique = *r_slot.technique;
	const ShadowSystem::DerivedRun &derived = r_slot.derived_run;
	derive_run(p_work, technique, p_translucent, p_group, wants_debug_views, r_slot.derived_run);
	const std::vector<LightView> &views = derived.views;
	const std::vector<CasterList> &casters = derived.casters;
	ShadowTechnique::Inputs inputs = make_inputs(p_work, views, casters, wants_debug_views);
	inputs.wants_explanation = options.wants_explanation && p_run.empty();
	technique.plan(inputs, technique_plan);
	for (uint32_t index = 0; index < views.size(); ++index) {
		if (technique_plan.is_light_view_skipped(index)) {
			continue;
		}
		technique_plan.run(text("light view ", index));
		technique.before_light_view(graph, inputs, index);
		technique.at_light_view(graph, inputs, index);
		technique.after_light_view(graph, inputs, index);
	}
	technique_plan.run("resolve");
	const RGTexture mask = technique.resolve(graph, inputs);
	if (wants_debug_views) {
		technique.get_debug_views(p_work.shadow.debug_views);
		for (ShadowTechnique::DebugView &view : p_work.shadow.debug_views) {
			view.shown_range =
					view.is_light_depth ? compute_debug_depth_range(inputs) : view.shown_range;
		}
	}
	return mask;
}

RGTexture ShadowFrame::add_translucent_casters(
		const Work &p_work, const TranslucentCasters &p_casters, RGTexture p_opaque) {
	RGTexture mask = p_opaque;
	for (size_t index = 0; index < p_casters.groups.size(); ++index) {
		const TranslucentGroup &group = p_casters.groups[index];
		const std::string name = text("translucent ", index + 1);
		graph.set_pass_prefix(text(p_work.light.name, ": ", name, ": "));
		ShadowSystem::Slot &slot = system.get_slot({ p_work.light.name, index + 1 }, p_work.info);
		const RGTexture both = add_technique(p_work, slot, p_casters, &group, name);
		const RGTexture tinted = create_mask(graph, size_px, Format::RGBA16_SFLOAT);
		add_compute_pass(graph, "tint",
				system.device.get_compute_pipeline(
						{ "tint", "shadows/tint.comp", make_mask_constants(graph, mask) }),
				{
						PassBinding::read(TINT_BINDING_OPAQUE, p_opaque),
						PassBinding::read(TINT_BINDING_BOTH, both),
						PassBinding::read(TINT_BINDING_BEFORE, mask),
						PassBinding::write(TINT_BINDING_RESULT, tinted),
				},
				size_px, shader::TintPush{ glm::vec4(group.transmittance, 0.0f) });
		mask = tinted;
	}
	graph.set_pass_prefix(p_work.light.name + ": ");
	return mask;
}

RGTexture ShadowFrame::add_shadow(const LightSnapshot &p_light, const VisibleReceivers &p_lit,
		LightShadow &r_shadow, bool p_wants_debug_views) {
	const TechniqueChoice choice = choose_technique(p_light, options.technique_override);
	system.warn_once(choice.warning);
	if (!choice.info) {
		plan.skip("shadow", "no technique that it could use is enabled");
		return add_constant_mask(graph, size_px, 1.0f);
	}
	if (!choice.warning.empty()) {
		plan.skip(p_light.technique_id, "not enabled; " + choice.info->id + " runs instead");
	}
	const PropertyValues properties = resolve_light_properties(
			p_light, ShadowRegistry::get_light_properties(choice.info->id));
	ShadowSystem::Slot &slot = system.get_slot({ p_light.name, 0 }, *choice.info);
	ShadowSystem::DerivedLight &derived = slot.derived_light;
	system.derive_light(*scene, p_light, derived);
	const SceneSnapshot &seen = derived.selection ? *derived.selection : *scene;
	LightSnapshot &light = lights.emplace_back(p_light);
	light.derive_widths(choice.info->derived_widths);
	const SceneSummary &summary = derived.get_summary(system.derived_scene);
	const Work work = { seen, summary, p_light, light, *choice.info, properties, p_lit, r_shadow,
		p_wants_debug_views };
	for (const ExceededLimit &limit : slot.limits.find_exceeded(
				 seen, summary, light, choice.info->id, slot.technique->get_limits(properties))) {
		system.warn_once(limit.key, limit.warning);
	}
	RGTexture mask;
	const TranslucentCasters none;
	const TranslucentCasters &translucent =
			slot.technique->sees_translucent_casters() ? none : derived.translucent;
	std::erase_if(system.slots, [&](const auto &p_slot) { // groups that no longer exist
		return p_slot.first.first == p_light.name &&
				p_slot.first.second > translucent.groups.size();
	});
	mask = add_technique(work, slot, translucent, /*p_group=*/nullptr, /*p_run=*/"");
	if (!translucent.is_empty()) {
		system.warn_once(describe_merged(p_light, translucent));
		mask = add_translucent_casters(work, translucent, mask);
	}
	mask = add_filters(work, mask);
	if (p_wants_debug_views) {
		r_shadow.debug_views.push_back({ "mask", mask });
		r_shadow.debug_views.back().is_color = is_colored_mask(graph, mask);
	}
	return mask;
}

} // namespace gnomon
