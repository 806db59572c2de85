#include "modules/editor/error_meter.h"

#include "modules/core/text.h"
#include "modules/masks/mask_png.h"
#include "modules/shadows/mask_filter.h"
#include "modules/shadows/shadow_registry.h"

#include <utility>

namespace gnomon {

namespace {

// The cost is measured over COST_FRAME_COUNT frames. For a slow technique it stops earlier: after
// COST_TIME_LIMIT_MS, but not before MIN_COST_FRAME_COUNT frames.
const uint32_t COST_FRAME_COUNT = 20;
const uint32_t MIN_COST_FRAME_COUNT = 3;
const double COST_TIME_LIMIT_MS = 1500;

/// Returns a key that changes with everything that the cost of a mask depends on.
std::string describe_cost(const LightSnapshot &p_light, uint64_t p_reference_hash) {
	const ShadowTechniqueInfo *technique = choose_technique(p_light, /*p_override=*/{}).info;
	std::string description =
			text(p_reference_hash, " ", technique != nullptr ? technique->id : std::string(), " ",
					ShadowRegistry::get_revision(), " ", MaskFilterRegistry::get_revision(), " ",
					p_light.penumbra_outer_width_m, " ", p_light.penumbra_inner_width_m);
	for (const auto &[name, value] : p_light.properties) {
		description += text(" ", name, "=", format_property(value));
	}
	return description;
}

} // namespace

void ErrorMeter::update(EditorContext &r_context, uint32_t p_image_count) {
	ErrorState &state = r_context.error;
	const bool is_watched = state.is_shown || r_context.viewport.debug_view == "error";
	const bool is_playing = r_context.document.get_timeline().is_playing();
	if (!is_watched || state.is_stopped || is_playing) {
		if (background_reference.is_running()) {
			traced_sample_count = 0; // restarts the trace later; the last result stays
		}
		background_reference.stop();
	}
	state.is_tracing = background_reference.is_running();
	// A mask, its cost and its reference take longer than a frame: during an animation, none of
	// them would match the frame that is shown.
	if (!is_watched || is_playing || p_image_count == 0) {
		measured_image = 0;
		return;
	}
	try {
		const bool needs_reference = !state.is_stopped && state.refusal.empty() &&
				(state.reference_hash == 0 || state.sample_count != traced_sample_count);
		const bool is_other_light = r_context.find_light_name() != state.light;
		if (p_image_count != measured_image || needs_reference || is_other_light) {
			measured_image = p_image_count;
			measure_mask(r_context);
		} else if (!has_cost()) {
			if (state.refusal.empty() &&
					!background_reference.is_running()) { // a trace would slow the frames down
				measure_cost(r_context);
			}
		} else if (requested_reference && !state.is_stopped) {
			background_reference.start(
					std::exchange(requested_reference, nullptr), state.sample_count);
		}
		std::optional<ReferenceRound> round = background_reference.take();
		// After a restart, a round replaces the current reference only if it has at least as many
		// rays per pixel.
		if (round && !(state.reference && round->sample_count < state.round.sample_count)) {
			state.round = std::move(*round);
			state.reference = std::make_shared<const ReferenceMask>(ReferenceMask{
					state.mask.size_px, state.round.visibility, state.mask.receiver });
			compare(state);
			r_context.viewport.needs_redraw |= r_context.viewport.debug_view == "error";
		}
	} catch (const std::exception &error) {
		refuse(state, describe_failure(error));
	}
	r_context.viewport.needs_redraw |=
			std::exchange(is_error_stale, false) && r_context.viewport.debug_view == "error";
	state.is_tracing = background_reference.is_running();
	state.progress = background_reference.get_progress();
	state.round_sample_count = background_reference.get_sample_count();
}

bool ErrorMeter::has_cost() const {
	const uint32_t count = timings.get_frame_count();
	return count >= COST_FRAME_COUNT ||
			(count >= MIN_COST_FRAME_COUNT && timed_ms > COST_TIME_LIMIT_MS);
}

void ErrorMeter::refuse(ErrorState &r_state, std::string p_text) {
	background_reference.stop();
	requested_reference = nullptr;
	r_state.refusal = std::move(p_text);
	is_error_stale |= r_state.reference != nullptr; // without a reference, the view showed no error
	r_state.reference_hash = 0;
	r_state.reference.reset();
	r_state.metrics.reset();
}

void ErrorMeter::forget_cost() {
	timed_key.clear();
	measured_image = 0;
}

void ErrorMeter::measure_mask(EditorContext &r_context) {
	ErrorState &state = r_context.error;
	state.refusal.clear();
	const Light3D *node = r_context.find_light();
	state.light = r_context.find_light_name();
	if (node == nullptr) {
		refuse(state,
				"No light of the scene casts a shadow. Add one, or set shadow_enabled of an "
				"existing one.");
		return;
	}
	request = {};
	request.scene = r_context.build_viewport_snapshot();
	light = *request.scene->find_light(node->name);
	if (!light.casts_shadow) {
		refuse(state, text("Light \"", node->name, "\" casts no shadow. Set its shadow_enabled."));
		return;
	}
	const ShadowTechniqueInfo *technique = choose_technique(light, /*p_override=*/{}).info;
	state.technique = technique != nullptr ? technique->id : "";
	request.size_px = r_context.viewport.size_px;
	request.mask_light = node->name;
	request.wants_mask = true;
	const uint64_t hash = compute_reference_hash(*request.scene, light, request.size_px);
	const bool needs_reference = !state.is_stopped &&
			(hash != state.reference_hash || state.sample_count != traced_sample_count);
	request.wants_surfaces = needs_reference;
	RenderResult result = renderer.render(request);
	state.mask = { request.size_px, std::move(result.visibility), result.receiver };
	mask_texture = upload_texture(
			"mask", request.size_px, /*p_channel_count=*/1, compute_mask_pixels(state.mask));
	if (const std::string key = describe_cost(light, hash); key != timed_key) {
		timed_key = key;
		timings = TimingSamples();
		timed_ms = 0;
		state.cost = {};
	}
	if (hash != state.reference_hash) {
		state.reference.reset();
		state.metrics.reset();
		state.reference_hash = 0;
		requested_reference = nullptr;
	}
	if (needs_reference) {
		state.reference_hash = hash;
		traced_sample_count = state.sample_count;
		request_reference(r_context, std::move(result));
	} else if (state.reference) {
		compare(state);
	}
}

void ErrorMeter::request_reference(EditorContext &r_context, RenderResult p_result) {
	background_reference.stop();
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	if (reference == nullptr || !reference->make_reference_source) {
		refuse(r_context.error,
				"There is no reference to compare with. Enable a module that has one, in the tab "
				"Modules.");
		return;
	}
	ReferenceRequest trace_request = { request.scene, light, request.size_px,
		std::move(p_result.surfaces), std::move(p_result.receiver), find_surface_spread() };
	requested_reference = [make = reference->make_reference_source,
								  trace_request = std::move(trace_request)] {
		return make(trace_request);
	};
}

/// Measures one frame of the light's mask passes, which run one at a time and reuse nothing from
/// earlier frames, as if the light had moved.
void ErrorMeter::measure_cost(EditorContext &r_context) {
	RenderRequest timed = request;
	timed.wants_mask = false;
	timed.wants_surfaces = false;
	timed.may_reuse = false;
	timed.mode = RenderGraph::Mode::ONE_BY_ONE;
	std::vector<PassCost> passes;
	for (const PassTiming &pass : renderer.render(timed).find_light_passes(light.name)) {
		passes.push_back({ pass.name, pass.gpu_ms, pass.wall_ms, pass.is_on_host });
		timed_ms += pass.wall_ms;
	}
	timings.add_frame(passes);
	r_context.error.cost = timings.compute();
}

void ErrorMeter::compare(ErrorState &r_state) {
	const MaskImage reference_image = { r_state.reference->size_px, r_state.reference->visibility,
		r_state.reference->receiver };
	r_state.metrics = compute_mask_metrics(reference_image, r_state.mask);
	reference_texture = upload_texture("reference mask", reference_image.size_px,
			/*p_channel_count=*/1, compute_mask_pixels(reference_image));
	error_texture = upload_texture("error", reference_image.size_px, /*p_channel_count=*/3,
			compute_error_pixels(reference_image, r_state.mask));
}

OwnedTexture ErrorMeter::upload_texture(const std::string &p_name, glm::uvec2 p_size_px,
		uint32_t p_channel_count, const std::vector<uint8_t> &p_pixels) {
	const size_t pixel_count = size_t(p_size_px.x) * p_size_px.y;
	std::vector<uint8_t> texels(4 * pixel_count, 255);
	for (size_t pixel = 0; pixel < pixel_count; ++pixel) {
		for (size_t channel = 0; channel < 3; ++channel) {
			texels[4 * pixel + channel] =
					p_pixels[p_channel_count * pixel + (p_channel_count == 1 ? 0 : channel)];
		}
	}
	return OwnedTexture(device,
			device.create_texture_with_data(
					{ "editor " + p_name, Format::RGBA8_UNORM, p_size_px, /*layer_count=*/1,
							TextureUsage::SAMPLED | TextureUsage::COPY_TARGET },
					texels));
}

} // namespace gnomon
