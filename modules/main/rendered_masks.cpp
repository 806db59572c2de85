#include "modules/main/rendered_masks.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/core/operating_system.h"
#include "modules/error_report/light_variant.h"
#include "modules/main/commands.h"
#include "modules/main/measure.h"
#include "modules/main/report_arguments.h"
#include "modules/renderer/renderer.h"
#include "modules/shadows/mask_filter.h"
#include "modules/shadows/shadow_registry.h"

#include <algorithm>
#include <thread>

namespace gnomon {

namespace {

// Limits for the timing of a report cell: at most 20 frames by default, or 3 s, but at least 5
// frames. No warm-up frames, because rendering the mask first has created the pipelines. measure()
// adds one warm-up frame if it renders no mask.
const MeasureLimits CELL_LIMITS = {
	.warm_up_count = 0, .frame_count = 20, .min_frame_count = 5, .seconds = 3.0, .median_error = 0
};
/// The light property <technique id>_samples is the reference's number of rays per pixel.
const char *const SAMPLES_SUFFIX = "_samples";

const ShadowTechniqueInfo &get_reference() {
	if (const ShadowTechniqueInfo *info = ShadowRegistry::find_reference()) {
		return *info;
	}
	fail("No technique of this build is a reference, so that there is nothing to compare with. ",
			"Enable the module of one; `gnomon modules` lists them.");
}

RenderRequest make_request(const MaskTask &p_task, const std::string &p_technique) {
	RenderRequest request;
	request.scene = p_task.scene;
	request.size_px = p_task.size_px;
	request.technique_override = p_technique;
	if (MaskFilterRegistry::find(p_technique) != nullptr) {
		// A mask filter is measured after the default technique, which find_techniques checks.
		request.technique_override = ShadowRegistry::find_default()->id;
	}
	request.mask_light = p_task.light;
	request.wants_mask = !p_task.light.empty();
	return request;
}

/// Returns 1 for each receiver pixel whose horizon, the plane of its surface, does not cut the
/// light's disc, else 0.
std::vector<uint8_t> find_pixels_seeing_whole_light(
		const MaskTask &p_task, const RenderResult &p_result) {
	const LightSnapshot &light = get_light(*p_task.scene, p_task.light);
	const glm::vec3 position = p_task.scene->to_camera_relative(light.position_world);
	std::vector<uint8_t> sees(p_result.surfaces.size());
	for (size_t index = 0; index < sees.size(); ++index) {
		const SurfacePoint &point = p_result.surfaces[index];
		sees[index] = point.is_valid && p_result.receiver[index] >= 0.5f &&
				is_light_disc_above_horizon(
						light, position, point.position, point.geometric_normal);
	}
	return sees;
}

} // namespace

ReportMachine RenderedMaskSource::get_machine() const {
	const DeviceInfo &info = device.get_info();
	return { info.name, info.driver, find_cpu_name(), std::thread::hardware_concurrency() };
}

TracedReference RenderedMaskSource::trace_reference(
		const MaskTask &p_task, uint32_t p_sample_count) {
	const ShadowTechniqueInfo &reference = get_reference();
	const std::string samples = reference.id + SAMPLES_SUFFIX;
	if (!ShadowRegistry::get_light_properties(reference.id).find(samples)) {
		fail("Technique \"", reference.id, "\" is the reference, but has no property ", samples,
				" that states how many rays it takes. Declare it.");
	}
	auto scene = std::make_shared<SceneSnapshot>(*p_task.scene);
	scene->lights.edit_all(
			[&](LightSnapshot &r_light) { r_light.properties[samples] = int64_t(p_sample_count); });
	RenderRequest request = make_request(p_task, reference.id);
	request.scene = scene;
	request.wants_surfaces = true;
	Renderer renderer(device);
	// Hides the two lines that the reference technique logs per mask; the report contains their
	// values.
	const LogFilterScope only_warnings(
			[](LogLevel p_level, const std::string &) { return p_level >= LogLevel::WARNING; });
	RenderResult result = renderer.render(request);
	TracedReference traced;
	traced.sees_whole_light = find_pixels_seeing_whole_light(p_task, result);
	traced.mask = { p_task.size_px, std::move(result.visibility), std::move(result.receiver) };
	for (const SurfacePoint &point : result.surfaces) {
		traced.receiver_positions.push_back(point.compute_receiver_position());
	}
	traced.standard_error = result.standard_error;
	for (const PassTiming &timing : result.timings) {
		traced.wall_ms += timing.is_on_host ? timing.wall_ms : 0;
	}
	return traced;
}

MeasuredMask RenderedMaskSource::measure(const MaskTask &p_task, const std::string &p_technique) {
	RenderRequest request = make_request(p_task, p_technique);
	Renderer renderer(device);
	MeasuredMask measured;
	if (request.wants_mask) {
		RenderResult result = renderer.render(request);
		measured.mask = { p_task.size_px, std::move(result.visibility),
			std::move(result.receiver) };
	}
	MeasureLimits limits = CELL_LIMITS;
	limits.frame_count = frame_count;
	limits.min_frame_count = std::min(limits.min_frame_count, frame_count);
	limits.warm_up_count = request.wants_mask ? 0 : 1;
	limits.median_error = median_error;
	request.may_reuse = false;
	measured.time = measure_mask_timing(renderer, request, limits, {});
	measured.bytes = device.get_memory_use().used_bytes;
	return measured;
}

std::vector<uint8_t> RenderedMaskSource::draw_scene(
		const std::shared_ptr<const SceneSnapshot> &p_scene, glm::uvec2 p_size_px) {
	RenderRequest request;
	request.scene = p_scene;
	request.size_px = p_size_px;
	request.antialiasing = 2; // the default of `gnomon run`
	request.wants_image = true;
	return Renderer(device).render(request).image;
}

DrawnMasks RenderedMaskSource::draw(
		std::span<const MaskTask> p_tasks, const std::string &p_technique) {
	DrawnMasks drawn;
	const unsigned message_count = get_validation_message_count();
	const LogFilterScope scope([&](LogLevel p_level, const std::string &p_line) {
		if (p_level == LogLevel::WARNING) {
			drawn.warnings.push_back(p_line);
		}
		return p_level != LogLevel::WARNING;
	});
	Renderer renderer(device);
	for (const MaskTask &task : p_tasks) {
		RenderRequest request = make_request(task, p_technique);
		if (task.scene->lights.size() > 1) {
			// Also draws all lights in one frame: it must end without validation messages, and its
			// warnings belong to the cell.
			RenderRequest whole_frame = request;
			whole_frame.mask_light.clear();
			whole_frame.wants_mask = false;
			renderer.render(whole_frame);
		}
		RenderResult result = renderer.render(request);
		drawn.frames.push_back(
				{ task.size_px, std::move(result.visibility), std::move(result.receiver) });
	}
	drawn.validation_message_count = get_validation_message_count() - message_count;
	return drawn;
}

namespace {

/// Returns the ids of all techniques, then those of all mask filters.
std::vector<std::string> list_ids() {
	std::vector<std::string> ids;
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		ids.push_back(info.id);
	}
	for (const MaskFilterInfo &info : MaskFilterRegistry::get_all()) {
		ids.push_back(info.id);
	}
	return ids;
}

bool contains(const std::vector<std::string> &p_ids, const std::string &p_id) {
	return std::ranges::find(p_ids, p_id) != p_ids.end();
}

MeasurableTechnique make_measurable_technique(const ShadowTechniqueInfo &p_info) {
	MeasurableTechnique source;
	source.info = { p_info.id, p_info.name, p_info.source, p_info.color, p_info.is_fallback };
	const std::shared_ptr<const ShadowTechnique> technique = p_info.make();
	source.get_settings = [technique](const LightSnapshot &p_light) {
		std::vector<QualitySetting> settings;
		technique->get_quality_settings(p_light, settings);
		return settings;
	};
	return source;
}

MeasurableTechnique make_measurable_technique(const MaskFilterInfo &p_info) {
	MeasurableTechnique source;
	source.info = { p_info.id, p_info.name, p_info.source, p_info.color, /*is_baseline=*/false };
	const std::shared_ptr<const MaskFilter> filter = p_info.make();
	source.get_settings = [filter](const LightSnapshot & /*p_light*/) {
		std::vector<QualitySetting> settings;
		filter->get_quality_settings(settings);
		return settings;
	};
	source.applies = [filter](const MaskTask &p_task) {
		return filter->may_change(*p_task.scene, p_task.size_px);
	};
	return source;
}

} // namespace

std::vector<MeasurableTechnique> RenderedMaskSource::find_techniques(
		const std::vector<std::string> &p_ids) {
	check_names("--techniques", p_ids, list_ids());
	std::vector<MeasurableTechnique> sources;
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		if (p_ids.empty() ? !info.is_reference && !info.is_example : contains(p_ids, info.id)) {
			sources.push_back(make_measurable_technique(info));
		}
	}
	for (const MaskFilterInfo &info : MaskFilterRegistry::get_all()) {
		if (!p_ids.empty() && contains(p_ids, info.id) &&
				ShadowRegistry::find_default() == nullptr) {
			fail("Mask filter \"", info.id,
					"\" has no technique to follow: this build has no default technique. ",
					"Enable the module of one; `gnomon modules` lists them.");
		}
		if (ShadowRegistry::find_default() != nullptr &&
				(p_ids.empty() || contains(p_ids, info.id))) {
			sources.push_back(make_measurable_technique(info));
		}
	}
	return sources;
}

} // namespace gnomon
