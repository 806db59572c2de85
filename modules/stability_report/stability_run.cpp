#include "modules/core/error.h"
#include "modules/error_report/light_variant.h"
#include "modules/stability_report/stability_curves.h"
#include "modules/stability_report/stability_part.h"
#include "modules/stability_report/visibility_condition.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gnomon {

namespace {

const double MOTION_SHARE = 1e-3;					  // of R, a frame
const uint64_t MOST_RAYS = uint64_t(1) << 30;		  // of a reference; some minutes of two cores
const uint64_t MOST_MOVED_PIXELS = uint64_t(1) << 18; // that are traced a second time
const uint32_t LEAST_SAMPLES = 16;
const size_t CONDITION_POINT_COUNT = 16;
const size_t CHECKED_RECEIVERS = 128; // of a reference, in double
// Mean difference that 256 rays on a spiral and 1024 stratified ones do not have: about 0.004 in
// penumbras.
const double MOST_REFERENCE_ERROR = 0.009;
const double REFERENCE_NOISE_ERRORS = 3.0;	// standard errors of a reference with fewer rays
const double DOUBLE_STANDARD_ERROR = 0.004; // of 256 rays on a spiral, in a penumbra

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

/// The pixels that are worst, as points to be computed in double.
std::vector<ConditionPoint> find_worst_points(
		const TracedReference &p_reference, const MaskImage &p_mask) {
	std::vector<ConditionPoint> points;
	for (size_t index = 0; index < p_mask.visibility.size(); ++index) {
		if (p_reference.mask.is_receiver(index) && index < p_reference.positions.size()) {
			const double reference = p_reference.mask.visibility[index];
			points.push_back({ p_reference.positions[index], p_reference.normals[index], reference,
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

/// The reference is traced in float32. Where that is not enough for the question, it is traced
/// again in double; tested at some receivers, evenly spread. ALWAYS: as another frame's was.
enum class DoubleReference { WHERE_NEEDED, ALWAYS };
void correct_reference(
		const MaskQuestion &p_question, DoubleReference p_when, TracedReference &r_reference) {
	MaskImage &mask = r_reference.mask;
	std::vector<size_t> receivers;
	for (size_t index = 0; index < mask.visibility.size(); ++index) {
		if (mask.is_receiver(index)) {
			receivers.push_back(index);
		}
	}
	if (receivers.empty() || r_reference.positions.size() != mask.visibility.size()) {
		return;
	}
	const DoubleVisibility exact(*p_question.scene, get_light(*p_question.scene, p_question.light));
	const auto compute = [&](size_t p_index) {
		return exact.compute(p_question.scene->camera.position_world +
						glm::dvec3(r_reference.positions[p_index]),
				r_reference.normals[p_index]);
	};
	// Shadows that are missing show anywhere, blurred ones in penumbras, of which there may be few.
	std::vector<size_t> soft;
	std::copy_if(receivers.begin(), receivers.end(), std::back_inserter(soft),
			[&](size_t p_index) { return is_penumbra(mask.visibility[p_index]); });
	const auto compute_error = [&](const std::vector<size_t> &p_pixels) {
		const size_t step = std::max<size_t>(1, p_pixels.size() / CHECKED_RECEIVERS);
		double sum = 0;
		size_t count = 0;
		for (size_t index = step / 2; index < p_pixels.size(); index += step, ++count) {
			sum += std::abs(compute(p_pixels[index]) - double(mask.visibility[p_pixels[index]]));
		}
		return count == 0 ? 0.0 : sum / double(count);
	};
	const double most =
			std::max(MOST_REFERENCE_ERROR, REFERENCE_NOISE_ERRORS * r_reference.standard_error);
	if (p_when == DoubleReference::WHERE_NEEDED && compute_error(receivers) <= most &&
			compute_error(soft) <= most) {
		return;
	}
	for (const size_t index : receivers) {
		mask.visibility[index] = float(compute(index));
	}
	r_reference.is_double = true;
	r_reference.standard_error = DOUBLE_STANDARD_ERROR;
}

} // namespace

MaskQuestion move_light(const MaskQuestion &p_question) {
	auto scene = std::make_shared<SceneSnapshot>(*p_question.scene);
	for (LightSnapshot &light : scene->lights) {
		if (light.name != p_question.light) {
			continue;
		}
		const double radius = light.get_disc_radius();
		if (light.type == LightType::DIRECTIONAL) {
			const double angle = MOTION_SHARE * (radius > 0 ? std::atan(radius) : MOTION_SHARE);
			const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, light.world_from_light[1]);
			light.world_from_light = glm::dmat3(turn) * light.world_from_light;
		} else {
			const double least = MOTION_SHARE * scene->scene_size_m;
			light.position_world +=
					MOTION_SHARE * (radius > 0 ? radius : least) * light.world_from_light[0];
		}
	}
	MaskQuestion moved = p_question;
	moved.scene = scene;
	return moved;
}

std::vector<TracedReference> StabilityPart::trace_references(
		MaskSource &r_source, const MaskQuestion &p_question, uint32_t p_sample_count) const {
	const uint64_t pixel_count = uint64_t(p_question.size_px.x) * p_question.size_px.y;
	const uint32_t sample_count = static_cast<uint32_t>(std::clamp<uint64_t>(
			MOST_RAYS / pixel_count, std::min(LEAST_SAMPLES, p_sample_count), p_sample_count));
	std::vector<TracedReference> references;
	references.push_back(r_source.trace_reference(p_question, sample_count));
	if (pixel_count > MOST_MOVED_PIXELS) {
		return references;
	}
	correct_reference(p_question, DoubleReference::WHERE_NEEDED, references[0]);
	const MaskQuestion moved = move_light(p_question);
	references.push_back(r_source.trace_reference(moved, sample_count));
	if (references[0].is_double) {
		correct_reference(moved, DoubleReference::ALWAYS, references[1]);
	}
	return references;
}

MaskImage StabilityPart::run_cell(MaskSource &r_source, const MaskQuestion &p_question,
		std::span<const TracedReference> p_references, Report &r_report, size_t p_cell) const {
	ReportCell &cell = r_report.cells[p_cell];
	const TracedReference &still = p_references.front();
	const TracedReference *moved = p_references.size() > 1 ? &p_references[1] : nullptr;
	ReportStability stability;
	std::vector<MaskQuestion> questions = { p_question };
	if (moved != nullptr) {
		questions.push_back(move_light(p_question));
	}
	DrawnMasks drawn;
	try {
		drawn = r_source.draw(questions, cell.technique);
	} catch (const DeviceLost &) {
		throw; // no answer: the run ends, and goes on with --resume
	} catch (const Error &error) {
		stability.refusal = error.what();
		cell.stability = stability;
		return {};
	}
	stability.warnings = drawn.warnings;
	if (drawn.validation_message_count > 0) {
		fail(drawn.validation_message_count, " validation messages.");
	}
	check_values(drawn.frames);
	const MaskImage &mask = drawn.frames.front();
	cell.error = ReportError{ compute_mask_metrics(still.mask, mask), {} };
	cell.error->whole_light = cell.error->all;
	stability.wrong_share = compute_wrong_share(still.mask, mask);
	if (moved != nullptr && still.mask.receiver == moved->mask.receiver) {
		const MaskImage references[] = { still.mask, moved->mask };
		stability.temporal_rmse = compute_temporal_metrics(references, drawn.frames).penumbra_rmse;
	}
	cell.stability = stability;
	ReportCell judged = cell;
	judged.status = ReportStatus::OK;
	const std::optional<size_t> center = find_stability_center(r_report, cell);
	const StabilityState state =
			judge_stability(judged, r_report.configurations[cell.configuration_index].reference,
					center ? &r_report.cells[*center] : nullptr);
	if (state == StabilityState::DOUBLED || state == StabilityState::NONSENSE) {
		cell.stability->condition = compute_visibility_condition(*p_question.scene,
				get_light(*p_question.scene, p_question.light), find_worst_points(still, mask));
	}
	const bool is_worth_seeing = state == StabilityState::NONSENSE || center == p_cell;
	return is_worth_seeing ? std::move(drawn.frames.front()) : MaskImage();
}

bool StabilityPart::is_unusable(const ReportCell &p_cell) const {
	const StabilityState state = judge_stability(p_cell, {}, nullptr);
	return state == StabilityState::REFUSED || state == StabilityState::NONSENSE;
}

} // namespace gnomon
