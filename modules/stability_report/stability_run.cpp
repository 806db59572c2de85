#include "modules/core/error.h"
#include "modules/error_report/light_variant.h"
#include "modules/stability_report/stability_curves.h"
#include "modules/stability_report/stability_part.h"
#include "modules/stability_report/stability_result.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gnomon {

namespace {

const double MOTION_FRACTION = 1e-3; // motion of the light between two frames, as a fraction of R
const uint64_t MAX_RAY_COUNT = uint64_t(1) << 30; // per reference; some minutes on two cores
/// Images with more pixels have no reference of the moved light.
const uint64_t MAX_MOVED_PIXEL_COUNT = uint64_t(1) << 18;
const uint32_t MIN_SAMPLE_COUNT = 16;	   // rays per pixel of a reference
const size_t CONDITION_POINT_COUNT = 16;   // pixels for compute_visibility_condition
const size_t CHECKED_RECEIVER_COUNT = 128; // pixels of a reference that are checked in double
// A reference with a larger mean error is traced again in double. Sampling noise is smaller: 256
// rays on a spiral and 1024 stratified rays differ by about 0.004 in penumbras.
const double MAX_REFERENCE_ERROR = 0.009;
// The same limit for noisier references with fewer rays, in standard errors.
const double REFERENCE_NOISE_STANDARD_ERRORS = 3.0;
const double DOUBLE_STANDARD_ERROR = 0.004; // of 256 rays on a spiral, in penumbras

/// Throws an Error if a visibility is not finite or outside 0..1.
void check_values(const std::vector<MaskImage> &p_frames) {
	size_t bad_count = 0;
	for (const MaskImage &frame : p_frames) {
		for (const float value : frame.visibility) {
			bad_count += value >= 0.0f && value <= 1.0f ? 0 : 1; // also counts NaN
		}
	}
	if (bad_count > 0) {
		fail(bad_count, " values of the mask are not finite or outside 0..1.");
	}
}

/// See StabilityResult::wrong_share.
double compute_wrong_share(const MaskImage &p_reference, const MaskImage &p_mask) {
	uint64_t wrong_count = 0;
	uint64_t receiver_count = 0;
	for (size_t index = 0; index < p_reference.visibility.size(); ++index) {
		if (!p_reference.is_receiver(index)) {
			continue;
		}
		++receiver_count;
		const float reference = p_reference.visibility[index];
		const bool is_wrong = std::abs(p_mask.visibility[index] - reference) > 0.5f;
		wrong_count += is_wrong && !is_penumbra(reference) ? 1 : 0;
	}
	return receiver_count == 0 ? 0.0 : double(wrong_count) / double(receiver_count);
}

/// Returns the receivers with the largest errors, up to CONDITION_POINT_COUNT.
std::vector<ConditionPoint> find_worst_points(
		const TracedReference &p_reference, const MaskImage &p_mask) {
	std::vector<ConditionPoint> points;
	for (size_t index = 0; index < p_mask.visibility.size(); ++index) {
		if (p_reference.mask.is_receiver(index) && index < p_reference.receiver_positions.size()) {
			const double reference = p_reference.mask.visibility[index];
			points.push_back({ p_reference.receiver_positions[index], reference,
					std::abs(double(p_mask.visibility[index]) - reference) });
		}
	}
	const size_t count = std::min(points.size(), CONDITION_POINT_COUNT);
	std::partial_sort(points.begin(), points.begin() + long(count), points.end(),
			[](const ConditionPoint &p_first, const ConditionPoint &p_second) {
				return p_first.error > p_second.error;
			});
	points.resize(count);
	return points;
}

/// When correct_reference traces in double. WHERE_NEEDED: if a check of evenly spaced receivers in
/// double shows that float32 is too inaccurate. ALWAYS: for the second frame, if the first was
/// traced in double.
enum class DoubleReference { WHERE_NEEDED, ALWAYS };
/// Replaces the visibility of a reference, which is traced in float32, by that of DoubleVisibility,
/// under the condition p_when.
void correct_reference(
		const MaskTask &p_task, DoubleReference p_when, TracedReference &r_reference) {
	MaskImage &mask = r_reference.mask;
	std::vector<size_t> receivers;
	for (size_t index = 0; index < mask.visibility.size(); ++index) {
		if (mask.is_receiver(index)) {
			receivers.push_back(index);
		}
	}
	if (receivers.empty() || r_reference.receiver_positions.size() != mask.visibility.size()) {
		return;
	}
	for (const InstanceSnapshot &instance : p_task.scene->instances) {
		if (instance.casts_shadow && instance.compute_transmittance() != glm::vec3(0.0f)) {
			return; // DoubleVisibility treats all casters as opaque
		}
	}
	const DoubleVisibility exact(*p_task.scene, get_light(*p_task.scene, p_task.light));
	const auto compute = [&](size_t p_index) {
		return exact.compute(p_task.scene->camera.position_world +
				glm::dvec3(r_reference.receiver_positions[p_index]));
	};
	// Missing shadows show in a check of all receivers. Blurred ones show only in penumbras, which
	// may have few pixels, so these are checked separately.
	std::vector<size_t> penumbra_receivers;
	std::copy_if(receivers.begin(), receivers.end(), std::back_inserter(penumbra_receivers),
			[&](size_t p_index) { return is_penumbra(mask.visibility[p_index]); });
	const auto compute_error = [&](const std::vector<size_t> &p_pixels) {
		const size_t step = std::max<size_t>(1, p_pixels.size() / CHECKED_RECEIVER_COUNT);
		double sum = 0;
		size_t count = 0;
		for (size_t index = step / 2; index < p_pixels.size(); index += step, ++count) {
			sum += std::abs(compute(p_pixels[index]) - double(mask.visibility[p_pixels[index]]));
		}
		return count == 0 ? 0.0 : sum / double(count);
	};
	const double max_error = std::max(
			MAX_REFERENCE_ERROR, REFERENCE_NOISE_STANDARD_ERRORS * r_reference.standard_error);
	if (p_when == DoubleReference::WHERE_NEEDED && compute_error(receivers) <= max_error &&
			compute_error(penumbra_receivers) <= max_error) {
		return;
	}
	for (const size_t index : receivers) {
		mask.visibility[index] = float(compute(index));
	}
	r_reference.is_double = true;
	r_reference.standard_error = DOUBLE_STANDARD_ERROR;
}

} // namespace

MaskTask move_light(const MaskTask &p_task) {
	auto scene = std::make_shared<SceneSnapshot>(*p_task.scene);
	scene->lights.edit_all([&](LightSnapshot &r_light) {
		if (r_light.name != p_task.light) {
			return;
		}
		const double radius = r_light.get_disc_radius();
		if (r_light.type == LightType::DIRECTIONAL) {
			const double angle =
					MOTION_FRACTION * (radius > 0 ? std::atan(radius) : MOTION_FRACTION);
			const glm::dmat4 rotation =
					glm::rotate(glm::dmat4(1.0), angle, r_light.world_from_light[1]);
			r_light.world_from_light = glm::dmat3(rotation) * r_light.world_from_light;
		} else {
			const double fallback_radius = MOTION_FRACTION * scene->scene_size_m;
			r_light.position_world += MOTION_FRACTION * (radius > 0 ? radius : fallback_radius) *
					r_light.world_from_light[0];
		}
	});
	MaskTask moved = p_task;
	moved.scene = scene;
	return moved;
}

std::vector<TracedReference> StabilityPart::trace_references(
		MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const {
	const uint64_t pixel_count = uint64_t(p_task.size_px.x) * p_task.size_px.y;
	const uint32_t sample_count =
			static_cast<uint32_t>(std::clamp<uint64_t>(MAX_RAY_COUNT / pixel_count,
					std::min(MIN_SAMPLE_COUNT, p_sample_count), p_sample_count));
	std::vector<TracedReference> references;
	references.push_back(r_source.trace_reference(p_task, sample_count));
	if (pixel_count > MAX_MOVED_PIXEL_COUNT) {
		return references;
	}
	correct_reference(p_task, DoubleReference::WHERE_NEEDED, references[0]);
	const MaskTask moved = move_light(p_task);
	references.push_back(r_source.trace_reference(moved, sample_count));
	if (references[0].is_double) {
		correct_reference(moved, DoubleReference::ALWAYS, references[1]);
	}
	return references;
}

MaskImage StabilityPart::run_cell(MaskSource &r_source, const MaskTask &p_task,
		std::span<const TracedReference> p_references, Report &r_report, size_t p_cell) const {
	ReportCell &cell = r_report.cells[p_cell];
	const TracedReference &unmoved = p_references.front();
	const TracedReference *moved = p_references.size() > 1 ? &p_references[1] : nullptr;
	const auto result = std::make_shared<StabilityResult>();
	cell.part_result = result;
	std::vector<MaskTask> tasks = { p_task };
	if (moved != nullptr) {
		tasks.push_back(move_light(p_task));
	}
	DrawnMasks drawn;
	try {
		drawn = r_source.draw(tasks, cell.technique);
	} catch (const DeviceLost &) {
		throw; // not a refusal: it ends the run, which --resume continues
	} catch (const Error &error) {
		result->refusal = error.what();
		return {};
	}
	result->warnings = drawn.warnings;
	if (drawn.validation_message_count > 0) {
		fail(drawn.validation_message_count, " validation messages.");
	}
	check_values(drawn.frames);
	const MaskImage &mask = drawn.frames.front();
	cell.error = ReportError{ compute_mask_metrics(unmoved.mask, mask), {} };
	cell.error->whole_light = cell.error->all; // not measured separately in report parts
	result->wrong_share = compute_wrong_share(unmoved.mask, mask);
	if (moved != nullptr && unmoved.mask.receiver == moved->mask.receiver) {
		const MaskImage references[] = { unmoved.mask, moved->mask };
		result->temporal_rmse = compute_temporal_metrics(references, drawn.frames).penumbra_rmse;
	}
	ReportCell judged = cell; // run_report sets the cell's status only after this function
	judged.status = ReportStatus::OK;
	const std::optional<size_t> center = find_stability_center(r_report, cell);
	const StabilityState state =
			classify_stability(judged, r_report.configurations[cell.configuration_index].reference,
					center ? &r_report.cells[*center] : nullptr);
	if (state == StabilityState::DOUBLED || state == StabilityState::NONSENSE) {
		result->condition = compute_visibility_condition(*p_task.scene,
				get_light(*p_task.scene, p_task.light), find_worst_points(unmoved, mask));
	}
	const bool keeps_image = state == StabilityState::NONSENSE || center == p_cell;
	return keeps_image ? std::move(drawn.frames.front()) : MaskImage();
}

std::optional<std::string> StabilityPart::find_problem(const ReportCell &p_cell) const {
	// Without the centre, since a doubled error is usable.
	const StabilityState state =
			classify_stability(p_cell, /*p_reference=*/{}, /*p_center=*/nullptr);
	return state == StabilityState::REFUSED || state == StabilityState::NONSENSE
			? std::optional(p_cell.find_result<StabilityResult>()->refusal)
			: std::nullopt;
}

} // namespace gnomon
