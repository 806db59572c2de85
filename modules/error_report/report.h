#pragma once

#include "modules/masks/mask_metrics.h"
#include "modules/masks/mask_timing.h"

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

// The data of a report. doc/report_format.md describes report.json, which has the same structure.

/// The machine on which cells were measured.
struct ReportMachine {
	std::string device;
	std::string driver;
	std::string cpu;
	uint32_t threads = 0; // hardware threads of the CPU

	bool operator==(const ReportMachine &) const = default;
};

/// A technique or mask filter of the report.
struct ReportTechnique {
	std::string id;
	std::string name;
	std::string source;
	std::string color;		  // "#rrggbb"
	bool is_baseline = false; // the fallback technique; time ratios are relative to its time
};

/// MISSING: not measured yet, or measured by another shard.
enum class ReportStatus { OK, FAILED, MISSING };
/// Returns "ok", "failed" or "missing".
const char *get_name(ReportStatus p_status);

/// Data of a configuration's reference mask. The mask itself is an image file.
struct ReportReference {
	double standard_error = 0; // of visibility
	bool is_double = false;	   // traced in double precision, because float32 was too inaccurate
	double wall_ms = 0;		   // time to trace the mask or to load it from the cache
	std::string image;		   // name of a PNG with grey and alpha (0 = no receiver); empty: none
	uint64_t receiver_pixel_count = 0;
	uint64_t penumbra_pixel_count = 0;
};

/// Values of ReportConfiguration::group. The matrix is all combinations of scene, light, light
/// size, technique and setting; the next four are scaling curves (scaling_scenes.h). Other groups
/// are those of report parts, whose ids they are (ReportPartInfo::id).
inline constexpr const char *MATRIX_GROUP = "matrix";
inline constexpr const char *TRIANGLES_GROUP = "triangles";
inline constexpr const char *LIGHT_SIZE_GROUP = "light_size";
inline constexpr const char *LIGHTS_GROUP = "lights";
inline constexpr const char *RESOLUTION_GROUP = "resolution";

/// A scene with a light of one size, for which all techniques are measured.
struct ReportConfiguration {
	std::string id;		// unique in the report
	std::string record; // name of its reference in the RecordStore; empty without a reference
	std::string group = MATRIX_GROUP;
	/// Abscissa in plots. By group: light radius in metres (matrix, light size), number of
	/// triangles or lights, image width in pixels, or what the report part defines.
	double value = 0;
	/// Id of the sweep of a report part; empty if it belongs to none. The configurations of a sweep
	/// with one light_type form a curve, whose points the part may compare with each other.
	std::string sweep;
	std::string scene;					   // name
	std::string light;					   // name; empty: all lights
	std::string light_type;				   // "spot", "omni", "directional"
	double light_size_m = 0;			   // R, the radius; 0 for directional lights
	double light_angular_distance_deg = 0; // apparent diameter; 0 for other lights
	uint32_t light_count = 1;
	double scene_size_m = 0; // S, see SceneSnapshot::scene_size_m
	glm::uvec2 size_px = glm::uvec2(0u);
	uint64_t triangle_count = 0;				 // of the shadow casters
	uint64_t edge_count = 0;					 // of the shadow casters
	ReportStatus status = ReportStatus::MISSING; // of the reference; OK if none is needed
	std::string message;						 // error message if the status is FAILED
	ReportReference reference;

	bool is_matrix() const { return group == MATRIX_GROUP; }
	/// False for the scaling curves, which measure only run time.
	bool has_reference() const {
		return group != TRIANGLES_GROUP && group != LIGHT_SIZE_GROUP && group != LIGHTS_GROUP &&
				group != RESOLUTION_GROUP;
	}
};

/// Errors over all receiver pixels, and over those with the whole light above their horizon (see
/// is_light_disc_above_horizon).
struct ReportError {
	MaskMetrics all;
	MaskMetrics whole_light; // in groups of report parts a copy of `all`
};

/// Results of a cell that only the ReportPart of its group defines, next to ReportCell::error.
class PartResult {
public:
	virtual ~PartResult() = default;
	virtual nlohmann::ordered_json to_json() const = 0;
};

/// One technique with one setting in one configuration.
struct ReportCell {
	size_t configuration_index = 0;
	std::string technique;
	std::string setting;						   // name of the quality setting
	std::string record;							   // name in the RecordStore
	std::map<std::string, std::string> properties; // light properties that the setting changes
	ReportStatus status = ReportStatus::MISSING;
	std::string message;						   // error message if the status is FAILED
	size_t machine_index = 0;					   // in Report::machines
	std::optional<ReportError> error;			   // unset in scaling curves
	std::shared_ptr<const PartResult> part_result; // set by ReportPart::run_cell, else null
	MaskTiming time;							   // not measured if `part_result` is set
	uint64_t bytes = 0;							   // device memory in use while measured
	std::string image;							   // name of a grey PNG; empty: none

	bool is_ok() const { return status == ReportStatus::OK; }
	/// Returns the part_result if it is one of that class, else null.
	template <typename Result> const Result *find_result() const {
		return dynamic_cast<const Result *>(part_result.get());
	}
};

/// A lit image of a scene as its camera sees it, for the HTML page.
struct ReportSceneImage {
	std::string scene;
	bool has_shadows = true; // true: all lights as in the file; false: no light casts shadows
	std::string record;		 // name in the RecordStore
	ReportStatus status = ReportStatus::MISSING;
	std::string message; // error message if the status is FAILED
	std::string image;	 // name of an RGBA PNG; empty: none
};

/// A whole report, complete or in progress.
struct Report {
	std::string project;
	std::string program;	   // version and hash of the program, see describe_program
	uint32_t sample_count = 0; // rays per pixel of the references
	/// Timing of a cell ends early once the standard error of its median is at most this; 0: never.
	double precision_percent = 0;
	std::vector<ReportMachine> machines;
	std::vector<ReportTechnique> techniques;
	std::vector<ReportSceneImage> scene_images;
	std::vector<ReportConfiguration> configurations;
	std::vector<ReportCell> cells;

	/// Returns the indices of the cells of a configuration, ascending.
	std::vector<size_t> find_cells(size_t p_configuration) const;
	/// Returns the cell of the baseline technique in the same configuration; null if it was not
	/// measured successfully.
	const ReportCell *find_baseline(const ReportCell &p_cell) const;
	/// Returns cost_ms divided by that of find_baseline; nullopt if one of the two was not
	/// measured, if they were measured on different machines, or if the baseline's is 0.
	std::optional<double> compute_time_ratio(const ReportCell &p_cell) const;
	/// Returns the number of cells, references and scene images with that status.
	size_t count(ReportStatus p_status) const;
};

} // namespace gnomon
