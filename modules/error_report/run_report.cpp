#include "modules/error_report/run_report.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/progress.h"
#include "modules/error_report/report_folder.h"
#include "modules/error_report/report_json.h"
#include "modules/error_report/report_part.h"
#include "modules/masks/mask_png.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <set>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

/// Masks of report parts (ReportPart) with more pixels are not stored as images.
const size_t MAX_SHOWN_PIXEL_COUNT = size_t(1) << 20;

/// Returns the mask without the receivers whose p_is_included is 0.
MaskImage restrict_mask(const MaskImage &p_mask, const std::vector<uint8_t> &p_is_included) {
	MaskImage restricted = p_mask;
	for (size_t index = 0; index < restricted.receiver.size(); ++index) {
		if (!p_is_included[index]) {
			restricted.receiver[index] = 0.0f;
			restricted.visibility[index] = 0.0f;
		}
	}
	return restricted;
}

/// Encodes a mask as a PNG with grey and alpha; pixels without a receiver are transparent.
std::vector<uint8_t> encode_reference_png(const MaskImage &p_mask) {
	const std::vector<uint8_t> grey = compute_mask_pixels(p_mask);
	std::vector<uint8_t> pixels;
	for (size_t index = 0; index < grey.size(); ++index) {
		pixels.push_back(grey[index]);
		pixels.push_back(p_mask.is_receiver(index) ? 255 : 0);
	}
	return encode_png(p_mask.size_px, /*p_channel_count=*/2, pixels);
}

/// Calls p_work and returns the message of its exception, or nullopt on success. DeviceLost is
/// rethrown.
template <typename Work> std::optional<std::string> try_run(Work p_work) {
	try {
		p_work();
		return std::nullopt;
	} catch (const DeviceLost &error) {
		// All remaining cells would fail too. They stay MISSING, so that a resumed run measures
		// them.
		throw DeviceLost(text(error.what(), " What was measured is saved: go on with --resume."));
	} catch (const std::exception &error) {
		return describe_failure(error);
	}
}

/// Measures a plan, see run_report.
class Runner {
public:
	Runner(const ReportPlan &p_plan, MaskSource &r_source, RecordStore &r_store,
			const ReportRunOptions &p_options) :
			plan(p_plan),
			source(r_source), store(r_store), options(p_options), report(p_plan.report),
			machine(r_source.get_machine()) {}

	Report run() {
		load_existing_records();
		for (size_t index = 0; index < report.configurations.size(); ++index) {
			if (is_in_shard(index)) {
				run_scene_images(report.configurations[index].scene);
				run_configuration(index);
			}
		}
		return std::move(report);
	}

private:
	/// Returns whether this shard measures the configuration.
	bool is_in_shard(size_t p_configuration) const {
		const ReportConfiguration &configuration = plan.report.configurations[p_configuration];
		if (!configuration.sweep.empty()) {
			// A shard gets whole curves, see ReportConfiguration::sweep.
			const uint64_t hash = compute_text_hash(
					configuration.light_type, compute_text_hash(configuration.sweep, /*p_seed=*/1));
			return hash % options.shard_count == options.shard_index;
		}
		// From one block of shard_count configurations to the next, the shards rotate by one. The
		// sizes of a light are adjacent in the plan, and only the middle one has expensive
		// settings: with plain index modulo count, some shards might get all of these.
		return (p_configuration + p_configuration / options.shard_count) % options.shard_count ==
				options.shard_index;
	}

	/// Loads the existing records (resume) or deletes those of this shard, and counts the cells of
	/// this shard that remain to be measured.
	void load_existing_records() {
		if (options.resumes) {
			report = collect_report(plan.report, store, &machine);
			retry_failures();
		} else {
			remove_own_records();
		}
		size_t present_count = 0;
		for (const ReportCell &cell : report.cells) {
			if (is_in_shard(cell.configuration_index)) {
				(cell.status == ReportStatus::MISSING ? remaining_count : present_count) += 1;
			}
		}
		if (options.resumes) {
			log_info("Resuming: ", present_count, " cells are there, ", remaining_count,
					" are left.");
		}
	}

	/// Deletes this shard's records of references and cells, except those that a configuration of
	/// another shard shares.
	void remove_own_records() {
		std::set<std::string> own;
		std::set<std::string> others;
		for (size_t index = 0; index < report.configurations.size(); ++index) {
			(is_in_shard(index) ? own : others).insert(report.configurations[index].record);
		}
		for (const ReportCell &cell : report.cells) {
			(is_in_shard(cell.configuration_index) ? own : others).insert(cell.record);
		}
		for (const std::string &record : own) {
			if (others.count(record) == 0) {
				store.remove(record);
			}
		}
	}

	/// Resets failed references, images and cells to their planned state, so that they are measured
	/// again: the cause of the failure may be gone.
	void retry_failures() {
		const auto retry = [](auto &r_items, const auto &p_planned) {
			for (size_t index = 0; index < r_items.size(); ++index) {
				if (r_items[index].status == ReportStatus::FAILED) {
					r_items[index] = p_planned[index];
				}
			}
		};
		retry(report.configurations, plan.report.configurations);
		retry(report.scene_images, plan.report.scene_images);
		retry(report.cells, plan.report.cells);
	}

	/// Draws the images of a scene that are still missing.
	void run_scene_images(const std::string &p_scene) {
		for (size_t index = 0; index < report.scene_images.size(); ++index) {
			ReportSceneImage &shown = report.scene_images[index];
			if (shown.scene != p_scene || shown.status != ReportStatus::MISSING) {
				continue;
			}
			std::vector<uint8_t> image;
			const glm::uvec2 size_px = find_scene_size(p_scene);
			const std::optional<std::string> failure = try_run([&] {
				image = encode_png(size_px, /*p_channel_count=*/4,
						source.draw_scene(plan.shown_scenes[index], size_px));
			});
			shown.status = failure ? ReportStatus::FAILED : ReportStatus::OK;
			shown.message = failure.value_or("");
			shown.image = failure ? "" : shown.record + ".png";
			if (failure) {
				log_error("Image of ", p_scene, ": ", *failure);
			}
			store.save(shown.record, scene_image_result_to_json(shown), image);
		}
	}

	glm::uvec2 find_scene_size(const std::string &p_scene) const {
		return std::ranges::find(report.configurations, p_scene, &ReportConfiguration::scene)
				->size_px;
	}

	void run_configuration(size_t p_index) {
		ReportConfiguration &configuration = report.configurations[p_index];
		std::vector<size_t> missing = report.find_cells(p_index);
		std::erase_if(missing, [&](size_t p_cell) {
			return report.cells[p_cell].status != ReportStatus::MISSING;
		});
		// Without a record the scene or light could not be planned, so nothing can be traced.
		const bool needs_reference = configuration.has_reference() &&
				!configuration.record.empty() &&
				(!missing.empty() || configuration.status == ReportStatus::MISSING);
		references.clear();
		if (needs_reference) {
			run_reference(p_index);
		}
		for (const size_t cell : missing) {
			run_cell(cell);
			++done_count;
			progress.update(double(done_count) / double(remaining_count));
		}
		if (options.on_progress && !missing.empty()) {
			options.on_progress(report);
		}
	}

	void run_reference(size_t p_index) {
		ReportConfiguration &configuration = report.configurations[p_index];
		std::vector<uint8_t> image;
		const std::optional<std::string> failure = try_run([&] {
			const MaskTask task = plan.tasks[p_index]({});
			if (const ReportPart *part = ReportPartRegistry::find_part(configuration.group)) {
				references = part->trace_references(source, task, report.sample_count);
			} else {
				references.push_back(source.trace_reference(task, report.sample_count));
			}
			image = encode_reference_png(references.front().mask);
		});
		if (failure) {
			configuration.status = ReportStatus::FAILED;
			configuration.message = *failure;
			log_error("Reference of ", configuration.id, ": ", *failure);
		} else if (configuration.status == ReportStatus::MISSING) {
			const TracedReference &traced = references.front();
			const MaskMetrics metrics = compute_mask_metrics(traced.mask, traced.mask);
			configuration.status = ReportStatus::OK;
			configuration.message.clear();
			configuration.reference = { traced.standard_error, traced.is_double, traced.wall_ms,
				configuration.record + ".png", metrics.receiver.pixel_count,
				metrics.penumbra.pixel_count };
		} else {
			return; // an earlier run stored it; it was traced again only to measure cells
		}
		store.save(configuration.record, reference_result_to_json(configuration), image);
	}

	void run_cell(size_t p_index) {
		ReportCell &cell = report.cells[p_index];
		const ReportConfiguration &configuration = report.configurations[cell.configuration_index];
		// Curves may have a point in common; its record is measured only once.
		if (measured.count(cell.record) != 0) {
			if (const std::optional<Json> content = store.load(cell.record)) {
				read_cell_result(*content, report, cell);
				return;
			}
		}
		std::vector<uint8_t> image;
		const std::optional<std::string> failure = try_run([&] {
			if (configuration.has_reference() && configuration.status != ReportStatus::OK) {
				fail("Its reference failed: ", configuration.message);
			}
			measure(cell, image);
		});
		cell.status = failure ? ReportStatus::FAILED : ReportStatus::OK;
		if (failure) {
			cell.message = *failure;
			cell.error.reset();
			cell.part_result.reset();
			cell.image.clear();
			log_error(configuration.id, ", ", cell.technique, ", ", cell.setting, ": ", *failure);
		}
		const Json content = cell_result_to_json(cell, machine);
		store.save(cell.record, content, image);
		read_cell_result(content, report, cell); // also sets the index of this run's machine
		measured.insert(cell.record);
	}

	void measure(ReportCell &r_cell, std::vector<uint8_t> &r_image) {
		const size_t index = size_t(&r_cell - report.cells.data());
		const MaskTask task = plan.tasks[r_cell.configuration_index](plan.settings[index]);
		const ReportConfiguration &configuration =
				report.configurations[r_cell.configuration_index];
		if (const ReportPart *part = ReportPartRegistry::find_part(configuration.group)) {
			const MaskImage mask = part->run_cell(source, task, references, report, index);
			if (mask.get_pixel_count() > 0 && mask.get_pixel_count() <= MAX_SHOWN_PIXEL_COUNT) {
				r_image =
						encode_png(task.size_px, /*p_channel_count=*/1, compute_mask_pixels(mask));
				r_cell.image = r_cell.record + ".png";
			}
			return;
		}
		const MeasuredMask measured_mask = source.measure(task, r_cell.technique);
		if (configuration.has_reference()) {
			const TracedReference &reference = references.front();
			r_cell.error = ReportError{
				compute_mask_metrics(reference.mask, measured_mask.mask),
				compute_mask_metrics(restrict_mask(reference.mask, reference.sees_whole_light),
						restrict_mask(measured_mask.mask, reference.sees_whole_light)),
			};
			r_image = encode_png(
					task.size_px, /*p_channel_count=*/1, compute_mask_pixels(measured_mask.mask));
			r_cell.image = r_cell.record + ".png";
		}
		r_cell.time = measured_mask.time;
		r_cell.bytes = measured_mask.bytes;
	}

	const ReportPlan &plan;
	MaskSource &source;
	RecordStore &store;
	const ReportRunOptions &options;
	Report report;
	const ReportMachine machine;
	std::vector<TracedReference> references; // see ReportPart::trace_references
	std::set<std::string> measured;			 // names of the records that this run has stored
	size_t remaining_count = 0;				 // cells that this run has to measure
	size_t done_count = 0;					 // of these, measured so far
	Progress progress{ "Report" };
};

} // namespace

Report run_report(const ReportPlan &p_plan, MaskSource &r_source, RecordStore &r_store,
		const ReportRunOptions &p_options) {
	if (!p_options.resumes) {
		r_store.remove_others(list_records(p_plan.report));
	}
	return Runner(p_plan, r_source, r_store, p_options).run();
}

} // namespace gnomon
