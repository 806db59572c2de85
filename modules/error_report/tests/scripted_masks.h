#pragma once

#include "modules/core/error.h"
#include "modules/error_report/report_plan.h"
#include "modules/error_report/scaling_scenes.h"

#include <map>
#include <new>
#include <string>
#include <vector>

namespace gnomon {

/// Thrown to simulate a killed process. It is no std::exception, so the report must not catch it.
struct Killed {};

/// A fake MaskSource without a GPU. The reference repeats a ramp of eight values, 0 to 7 / 8; a
/// technique's visibility is the reference minus a constant fraction of it, given by `errors`.
class ScriptedMaskSource : public MaskSource {
public:
	/// Relative errors by technique id.
	std::map<std::string, float> errors = { { "hard", 0.25f }, { "soft", 0.125f } };
	std::string failing_technique;
	bool fails_reference = false;
	bool runs_out_of_memory = false;		   // failures are out-of-memory errors
	size_t lose_device_after_count = SIZE_MAX; // calls of measure() before the device is lost
	size_t kill_after_count = SIZE_MAX;		   // calls of measure() before Killed is thrown
	std::string device = "scripted";
	size_t lose_device_after_draw_count = SIZE_MAX; // calls of draw() before the device is lost
	size_t draw_count = 0;
	std::vector<std::string> warnings; // returned by draw()
	unsigned validation_message_count = 0;
	std::optional<float> invalid_value; // written to one pixel of drawn masks
	size_t reference_count = 0;
	size_t measure_count = 0;
	std::vector<PropertyValues> requested; // properties of the first light, per call of measure()

	ReportMachine get_machine() const override { return { device, "driver", "cpu", 2 }; }

	TracedReference trace_reference(const MaskTask &p_task, uint32_t p_sample_count) override {
		++reference_count;
		if (fails_reference) {
			fail("no rays today");
		}
		TracedReference reference;
		reference.mask = make_mask(p_task, 0.0f);
		reference.sees_whole_light.assign(reference.mask.get_pixel_count(), 1);
		reference.sees_whole_light[0] = 0;
		reference.standard_error = 1.0 / p_sample_count;
		reference.wall_ms = 12;
		return reference;
	}

	std::vector<uint8_t> draw_scene(const std::shared_ptr<const SceneSnapshot> & /*p_scene*/,
			glm::uvec2 p_size_px) override {
		return std::vector<uint8_t>(size_t(4) * p_size_px.x * p_size_px.y, 128);
	}

	MeasuredMask measure(const MaskTask &p_task, const std::string &p_technique) override {
		if (measure_count == kill_after_count) {
			throw Killed();
		}
		if (measure_count == lose_device_after_count) {
			throw DeviceLost("The device was lost. Restart it.");
		}
		++measure_count;
		requested.push_back(p_task.scene->lights.front().properties);
		if (p_technique == failing_technique && runs_out_of_memory) {
			throw std::bad_alloc();
		}
		if (p_technique == failing_technique) {
			fail("the device is sad");
		}
		MeasuredMask measured;
		if (!p_task.light.empty()) {
			measured.mask = make_mask(p_task, errors.at(p_technique));
		}
		TimingSamples samples;
		samples.add_frame({ { "depth view 0", 1.0 / 3.0, 0.5 }, { "resolve", 2.0 / 3.0, 1.0 } });
		measured.time = samples.compute();
		measured.bytes = 1000;
		return measured;
	}

	DrawnMasks draw(std::span<const MaskTask> p_tasks, const std::string &p_technique) override {
		if (draw_count++ == lose_device_after_draw_count) {
			throw DeviceLost("The device was lost. Restart it.");
		}
		if (p_technique == failing_technique) {
			fail("the device is sad");
		}
		DrawnMasks drawn;
		drawn.warnings = warnings;
		drawn.validation_message_count = validation_message_count;
		for (const MaskTask &task : p_tasks) {
			drawn.frames.push_back(make_mask(task, errors.at(p_technique)));
			if (invalid_value) {
				drawn.frames.back().visibility[1] = *invalid_value;
			}
		}
		return drawn;
	}

private:
	static MaskImage make_mask(const MaskTask &p_task, float p_error) {
		MaskImage mask;
		mask.size_px = p_task.size_px;
		mask.receiver.assign(mask.get_pixel_count(), 1.0f);
		for (size_t index = 0; index < mask.get_pixel_count(); ++index) {
			const float reference = float(index % 8) / 8.0f;
			mask.visibility.push_back(reference == 0.0f ? 0.0f : reference - p_error * reference);
		}
		return mask;
	}
};

/// Returns "hard", the baseline, without quality settings, and "soft" with two, of which the second
/// is expensive.
inline std::vector<MeasurableTechnique> make_scripted_techniques() {
	const auto no_settings = [](const LightSnapshot &) { return std::vector<QualitySetting>(); };
	const auto two_settings = [](const LightSnapshot &) {
		return std::vector<QualitySetting>{ { "few", { { "soft_taps", int64_t(4) } } },
			{ "many", { { "soft_taps", int64_t(64) } }, /*is_expensive=*/true } };
	};
	return { { { "hard", "Hard", "Test", "#000000", true }, no_settings },
		{ { "soft", "Soft", "Test", "#ff0000", false }, two_settings } };
}

/// Returns options for masks of 16 x 16 pixels, without scaling curves and report parts.
inline ReportOptions make_scripted_options() {
	ReportOptions options;
	options.project = "scripted";
	options.program = "test 1";
	options.size_px = glm::uvec2(16u);
	options.sample_count = 64;
	options.scaling = ReportExtent::NONE;
	return options;
}

/// Returns small scenes with one light each.
inline std::vector<ReportScene> make_scripted_scenes(size_t p_count = 2) {
	std::vector<ReportScene> scenes;
	for (size_t index = 0; index < p_count; ++index) {
		scenes.push_back({ text("scene_", index),
				make_scaling_scene({ .triangle_count = 1000 + 100 * uint32_t(index) }),
				/*failure=*/{} });
	}
	return scenes;
}

/// Per scene the plan has 3 light sizes, thus 3 references; 7 cells, as "hard" and "soft" with
/// "few" are measured at each size, but "many" only at the middle one; and 2 scene images.
inline ReportPlan make_scripted_plan(size_t p_scene_count = 2) {
	return make_report_plan(make_scripted_options(), make_scripted_scenes(p_scene_count),
			make_scripted_techniques());
}

} // namespace gnomon
