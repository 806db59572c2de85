#include "modules/receiver_scatter/receiver_scatter.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/receiver_scatter/scatter_samples.h"
#include "modules/render_graph/compute_pass.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/scene_summary.h"

#include "receiver_scatter/receiver_scatter_shared.h"

#include <algorithm>

namespace gnomon {

namespace {

const char ENABLED[] = "receiver_scatter_enabled";
const char METHOD[] = "receiver_scatter_method";
const char SAMPLES[] = "receiver_scatter_samples";
const char REFUSAL[] = "receiver_scatter_refusal";
const std::vector<std::string> METHODS = { "auto", "metres", "pixels" }; // by SCATTER_METHOD_*
const std::vector<std::string> REFUSALS = { "auto", "on", "off" };		 // by SCATTER_REFUSAL_*

/// Returns the index of an enum property's value among its choices.
uint32_t find_choice(const PropertyValues &p_properties, const char *p_name,
		const std::vector<std::string> &p_choices) {
	const std::string &value = read_choice(p_properties, p_name);
	return static_cast<uint32_t>(
			std::find(p_choices.begin(), p_choices.end(), value) - p_choices.begin());
}

enum class ScatterKind { ANY, IN_METRES };

/// Whether the material scatters. IN_METRES: counts only a material with a scatter distance.
bool is_translucent(const Material &p_material, ScatterKind p_kind) {
	return clamp_scatter(p_material.scatter) > 0.0f &&
			(p_kind == ScatterKind::ANY || p_material.scatter_distance_m > 0.0f);
}

/// Whether the light reaches a translucent surface that the camera may see.
bool has_scatter(const ShadowTechnique::Inputs &p_inputs, ScatterKind p_kind) {
	return p_inputs.summary.get_whole().may_scatter &&
			std::any_of(p_inputs.lit_receivers.begin(), p_inputs.lit_receivers.end(),
					[&](const VisibleReceiver &p_receiver) {
						return is_translucent(
								*p_inputs.scene.instances[p_receiver.instance_index].material,
								p_kind);
					});
}

/// Packs depth, normal, material key and mask of each pixel into four 32-bit words (pack.comp).
RGTexture add_pack_pass(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs, RGTexture p_mask) {
	const RGTexture pixels = r_graph.create_texture({ "scatter pixels", Format::RGBA32_UINT,
			p_inputs.size_px, 1, TextureUsage::STORAGE | TextureUsage::SAMPLED });
	add_compute_pass(r_graph, "scatter pixels",
			p_inputs.device.get_compute_pipeline(
					{ "scatter pixels", "receiver_scatter/pack.comp", {} }),
			{
					PassBinding::constants(SCATTER_BINDING_FRAME, p_inputs.frame),
					PassBinding::read(SCATTER_BINDING_DEPTH, p_inputs.depth),
					PassBinding::read(SCATTER_BINDING_NORMAL, p_inputs.geometric_normal),
					PassBinding::read(SCATTER_BINDING_MATERIAL, p_inputs.material),
					PassBinding::read(SCATTER_BINDING_RECEIVERS, p_inputs.receivers),
					PassBinding::read(SCATTER_BINDING_MASK, p_mask),
					PassBinding::write(SCATTER_BINDING_PIXELS, pixels),
			},
			glm::uvec3(p_inputs.size_px, 1u));
	return pixels;
}

} // namespace

void ReceiverScatter::get_light_properties(PropertyList &r_list) const {
	const char GROUP[] = "Receiver scatter";
	r_list.add({ ENABLED, PropertyType::BOOL, true, "",
			"Whether shadows soften on materials whose scatter is above 0.", "", GROUP });
	r_list.add({ METHOD, PropertyType::ENUM, std::string("auto"), "auto,metres,pixels",
			"How wide shadows soften: metres = scatter times the material's scatter_distance, "
			"pixels = 16 times scatter, auto = metres where there is a scatter_distance.",
			"", GROUP });
	r_list.add({ SAMPLES, PropertyType::INT, int64_t(48), "8,1024,8",
			"Samples per pixel. The method pixels takes this number at scatter 0.5 and twice as "
			"many at 1. Few make noise, many cost time.",
			"", GROUP });
	r_list.add({ REFUSAL, PropertyType::ENUM, std::string("auto"), "auto,on,off",
			"Whether samples on other surfaces are skipped, so that light does not leak between "
			"them; auto = with the method metres only, because the paper's method, pixels, uses "
			"all samples.",
			"", GROUP });
}

void ReceiverScatter::get_quality_settings(std::vector<QualitySetting> &r_settings) const {
	r_settings.push_back({ "off", { { ENABLED, false } } });
	for (const int64_t count : { 48, 120 }) {
		r_settings.push_back({ text("pixels, ", count, " samples"),
				{ { METHOD, std::string("pixels") }, { SAMPLES, count } } });
	}
	for (const int64_t count : { 16, 48, 120 }) {
		r_settings.push_back({ text("metres, ", count, " samples"),
				{ { METHOD, std::string("metres") }, { SAMPLES, count } } });
	}
}

bool ReceiverScatter::may_change(const SceneSnapshot &p_scene, glm::uvec2 p_size_px) const {
	const LightView camera_view = make_camera_view(p_scene.camera, p_size_px);
	return std::any_of(p_scene.instances.begin(), p_scene.instances.end(),
			[&](const InstanceSnapshot &p_instance) {
				return is_translucent(*p_instance.material, ScatterKind::ANY) &&
						camera_view.may_see(p_instance.bounds_world);
			});
}

bool ReceiverScatter::plan(const ShadowTechnique::Inputs &p_inputs,
		const PropertyValues &p_properties, TechniquePlan &r_plan) {
	if (!read_switch(p_properties, ENABLED)) {
		r_plan.skip("scatter", text(ENABLED, " is false"));
		return false;
	}
	if (!p_inputs.material) {
		r_plan.skip("scatter", "the host draws no materials");
		return false;
	}
	if (p_inputs.may_skip && !has_scatter(p_inputs, ScatterKind::ANY)) {
		r_plan.skip("scatter", "it lights no visible surface that scatters");
		return false;
	}
	needs_average = read_choice(p_properties, METHOD) == METHODS[SCATTER_METHOD_METRES] ||
			!p_inputs.may_skip ||
			(read_choice(p_properties, METHOD) == METHODS[SCATTER_METHOD_AUTO] &&
					has_scatter(p_inputs, ScatterKind::IN_METRES));
	r_plan.run("scatter");
	if (!needs_average) {
		r_plan.skip("scatter average", "it lights no visible surface that scatters in metres");
	}
	return true;
}

RGTexture ReceiverScatter::apply(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const PropertyValues &p_properties, RGTexture p_mask) {
	shader::ReceiverScatterPush push = {};
	push.sample_count = read_count(p_properties, SAMPLES);
	push.sector_count = compute_sector_count(push.sample_count);
	push.method = find_choice(p_properties, METHOD, METHODS);
	push.refusal = find_choice(p_properties, REFUSAL, REFUSALS);
	if (samples_per_set != push.sample_count) {
		sample_offsets = make_scatter_samples(spread, push.sample_count);
		samples_per_set = push.sample_count;
	}
	const RGBuffer samples = r_graph.upload("scatter samples", BufferUsage::STORAGE,
			bytes_of(std::span<const glm::vec2>(sample_offsets)));
	const RGTexture pixels = add_pack_pass(r_graph, p_inputs, p_mask);
	// Replaces p_mask by the pass's result.
	const auto add_pass = [&](const char *p_name, const char *p_shader,
								  std::vector<PassBinding> p_own_bindings) {
		TextureDesc desc = r_graph.get_desc(p_mask);
		desc.name = "scattered mask";
		desc.usage = TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE;
		const RGTexture result = r_graph.create_texture(desc);
		std::vector<PassBinding> bindings = std::move(p_own_bindings);
		bindings.insert(bindings.end(),
				{
						PassBinding::constants(SCATTER_BINDING_FRAME, p_inputs.frame),
						PassBinding::read(SCATTER_BINDING_MATERIAL, p_inputs.material),
						PassBinding::read(SCATTER_BINDING_MASK, p_mask),
						PassBinding::read(SCATTER_BINDING_PIXELS, pixels),
						PassBinding::write(SCATTER_BINDING_RESULT, result),
				});
		add_compute_pass(r_graph, p_name,
				p_inputs.device.get_compute_pipeline({ p_name, p_shader, {} }), std::move(bindings),
				p_inputs.size_px, push);
		p_mask = result;
	};
	add_pass("scatter", "receiver_scatter/spread.comp",
			{ PassBinding::read(SCATTER_BINDING_SAMPLES, samples) });
	if (needs_average) {
		add_pass("scatter average", "receiver_scatter/average.comp", {});
	}
	return p_mask;
}

std::vector<std::string> ReceiverScatter::get_shader_files() const {
	return { "receiver_scatter/pack.comp", "receiver_scatter/spread.comp",
		"receiver_scatter/average.comp" };
}

} // namespace gnomon
