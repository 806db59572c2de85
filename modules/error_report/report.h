#pragma once

#include "modules/masks/mask_metrics.h"
#include "modules/masks/mask_timing.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

// The data that `gnomon report` measures and writes; doc/report_format.md describes the file.

/// The machine that measured.
struct ReportMachine {
	std::string device;
	std::string driver;
	std::string cpu;
	uint32_t threads = 0;

	bool operator==(const ReportMachine &) const = default;
};

struct ReportTechnique {
	std::string id;
	std::string name;
	std::string source;
	std::string color;		  // "#rrggbb"
	bool is_baseline = false; // the fallback technique, to which time ratios refer
};

enum class ReportStatus { OK, FAILED, MISSING };
/// "ok", "failed", "missing".
const char *get_name(ReportStatus p_status);

/// The exact mask of a configuration, as far as the report keeps it.
struct ReportReference {
	double standard_error = 0;
	bool is_double = false; // of a stability sweep: in double, as float32 was not enough
	double wall_ms = 0;		// time to trace it, or to load it from the cache
	std::string image;		// grey and alpha (0 = no receiver); empty where there is none
	uint64_t receiver_pixel_count = 0;
	uint64_t penumbra_pixel_count = 0;
};

/// Names of the groups of configurations that ReportConfiguration::group distinguishes.
inline constexpr const char *MATRIX_GROUP = "matrix";
inline constexpr const char *TRIANGLES_GROUP = "triangles";
inline constexpr const char *LIGHT_SIZE_GROUP = "light_size";
inline constexpr const char *LIGHTS_GROUP = "lights";
inline constexpr const char *RESOLUTION_GROUP = "resolution";
inline constexpr const char *ANIMATION_GROUP = "animation"; // value: the time in s
inline constexpr const char *STABILITY_GROUP = "stability"; // points of sweeps, see StabilitySweep

/// A scene, a light and its size: one task for all techniques.
struct ReportConfiguration {
	std::string id;		// unique in the report
	std::string record; // of its reference, see RecordStore; empty without one
	std::string group = MATRIX_GROUP;
	double value = 0;  // abscissa of its group: R in m, triangles, lights, image side in px
	std::string sweep; // stability group: the sweep that `value` belongs to; else empty
	std::string scene;
	std::string light;
	std::string light_type;				   // "spot", "omni", "directional"
	double light_size_m = 0;			   // R; 0 for directional
	double light_angular_distance_deg = 0; // apparent diameter; directional
	uint32_t light_count = 1;
	double scene_size_m = 0; // S
	glm::uvec2 size_px = glm::uvec2(0u);
	uint64_t triangle_count = 0;
	uint64_t edge_count = 0;
	ReportStatus status = ReportStatus::MISSING; // of its reference
	std::string message;						 // why it failed
	ReportReference reference;

	bool is_matrix() const { return group == MATRIX_GROUP; }
	bool is_stability() const { return group == STABILITY_GROUP; }
	/// False for the scaling curves, which only measure cost.
	bool has_reference() const {
		return group != TRIANGLES_GROUP && group != LIGHT_SIZE_GROUP && group != LIGHTS_GROUP &&
				group != RESOLUTION_GROUP;
	}
};

/// Errors over all receivers, and over those for which the whole light is above their horizon.
struct ReportError {
	MaskMetrics all;
	MaskMetrics whole_light;
};

/// The cause of an error.
enum class ErrorCause {
	METHOD,	   // exact arithmetic would leave it
	ROUNDING,  // the question itself changes as much when its input is rounded to float32
	REFERENCE, // the reference in float32 is off by as much
};
/// "method", "rounding", "reference_mask".
const char *get_name(ErrorCause p_cause);

/// The condition of visibility v at some points, in double precision: means over the points.
struct VisibilityCondition {
	/// Condition number: change of v divided by the relative change of the receiver's position P,
	/// |dv| rho / |dP|, with rho the distance to the light (directional: S).
	double number = 0;
	double rounding = 0;		// change of v when P moves by the rounding of float32
	double reference_error = 0; // |v in double - v of the reference|
	double error = 0;			// |v of the technique - v of the reference|
	ErrorCause cause = ErrorCause::METHOD;
};

/// Additional results of a point of a stability sweep or an animation, filled in by a ReportPart.
struct ReportStability {
	/// RMS error of the change over penumbra pixels when the light moves by R / 1000 (directional:
	/// turns by a thousandth of its angular radius), or an animation advances by a frame: see
	/// TemporalMetrics. None when the image is too large to trace twice, or the receivers change.
	std::optional<double> temporal_rmse;
	/// Fraction of the receivers whose reference visibility is 0 or 1 and whose error exceeds 0.5.
	double wrong_share = 0;
	std::vector<std::string> warnings; // that the program gave
	std::string refusal; // the error with which it refused to draw; then there are no numbers
	std::optional<VisibilityCondition> condition; // where the error is far above the centre's
};

/// One technique with one setting in one configuration.
struct ReportCell {
	size_t configuration_index = 0;
	std::string technique;
	std::string setting; // its name
	std::string record;	 // see RecordStore
	std::map<std::string, std::string> properties;
	ReportStatus status = ReportStatus::MISSING;
	std::string message; // why it failed
	size_t machine_index = 0;
	std::optional<ReportError> error;
	std::optional<ReportStability> stability;
	MaskTiming time;
	uint64_t bytes = 0;
	std::string image; // grey

	bool is_ok() const { return status == ReportStatus::OK; }
};

/// A scene as its camera sees it, for the page.
struct ReportSceneImage {
	std::string scene;
	bool has_shadows = true; // true: all lights as in the file; false: none cast shadows
	std::string record;		 // see RecordStore
	ReportStatus status = ReportStatus::MISSING;
	std::string message; // why it failed
	std::string image;	 // colours
};

struct Report {
	std::string project;
	std::string program;		  // version and hash of the program that measured
	uint32_t sample_count = 0;	  // of the references
	double precision_percent = 0; // requested precision of median times; 0: that of 20 frames
	std::vector<ReportMachine> machines;
	std::vector<ReportTechnique> techniques;
	std::vector<ReportSceneImage> scene_images;
	std::vector<ReportConfiguration> configurations;
	std::vector<ReportCell> cells;

	/// Indices of the cells of one configuration, in order.
	std::vector<size_t> find_cells(size_t p_configuration) const;
	/// The baseline's cell in the same configuration; null when it was not measured.
	const ReportCell *find_baseline(const ReportCell &p_cell) const;
	/// Cost as a multiple of the baseline's; none when either was not measured, or by another
	/// machine.
	std::optional<double> compute_time_ratio(const ReportCell &p_cell) const;
	/// Number of cells, references and scene images with that status.
	size_t count(ReportStatus p_status) const;
};

} // namespace gnomon
