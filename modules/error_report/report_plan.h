#pragma once

#include "modules/error_report/light_variant.h"
#include "modules/error_report/mask_source.h"
#include "modules/error_report/report.h"
#include "modules/error_report/scaling_scenes.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// A scene of a project, or the reason why it could not be loaded.
struct ReportScene {
	std::string name;
	std::shared_ptr<const Scene> scene; // null: loading failed
	std::string failure;				// error message if loading failed
};

/// The camera of a scene and the lights whose masks are measured.
struct ReportView {
	Camera3D *camera = nullptr;	   // the first of the scene
	std::vector<Light3D *> lights; // all that cast shadows; at least one
};
/// Throws an Error if the scene was not loaded, has no camera, or has no light that casts shadows.
ReportView find_report_view(const ReportScene &p_scene);

/// Selects what a report measures.
struct ReportOptions {
	std::string project;			   // name
	std::string program;			   // see Report; records of other programs are not reused
	std::vector<double> sizes_m;	   // light radii R in metres; empty: 0.02, 0.1 and 0.3
									   // times the scene size S
	bool has_own_sizes = false;		   // true: each light's own size, instead of sizes_m
	bool has_default_settings = false; // true: only the default quality of each technique
	/// The first shadow-casting light of each scene is measured once with each of these types.
	/// Empty: all shadow-casting lights with their own types.
	std::vector<LightType> light_types;
	glm::uvec2 size_px = glm::uvec2(256u);
	uint32_t sample_count = 1024; // rays per pixel of the references
	/// See Report::precision_percent. A third of the 15 % that compare_reports treats as noise.
	double precision_percent = 5;
	uint64_t filter_hash = 0; // see MaskTask::filter_hash
	ReportExtent scaling = ReportExtent::QUICK;
	/// Values of the options that report parts declare (ReportPart::list_options), by the option's
	/// name. Without any, no part measures anything.
	std::map<std::string, std::vector<std::string>> part_options;
	/// The scenes that the project names for a report part alone, by the part's id; only of parts
	/// for which ReportPart::needs_own_scenes is true.
	std::map<std::string, std::vector<ReportScene>> part_scenes;

	/// Returns the values of an option of a part; empty if it has none.
	std::vector<std::string> get_part_option(const std::string &p_name) const;
	/// Returns the value of an option of a part that has one of the values of parse_extent; NONE if
	/// it is not set.
	ReportExtent get_part_extent(const std::string &p_name) const;
};

/// The planned measurements: a report whose references and cells are MISSING, and functions that
/// build the scenes to measure. The scenes are built on demand, since each may have a million
/// triangles.
struct ReportPlan {
	Report report;
	std::vector<std::shared_ptr<const SceneSnapshot>> shown_scenes; // one per Report::scene_images
	/// Builds the task of a configuration; the argument overrides properties of the light in the
	/// matrix, and is ignored in other groups. Throws an Error if the scene could not be loaded or
	/// the light is invalid.
	using MakeTask = std::function<MaskTask(const PropertyValues &)>;
	std::vector<MakeTask> tasks;		  // one per configuration
	std::vector<PropertyValues> settings; // one per cell: the argument for its MakeTask
};

/// Plans all measurements in a fixed order: the matrix (scenes, lights, sizes, techniques,
/// settings), the scaling curves and the report parts (ReportPart). A record's name contains a hash
/// of everything that its result depends on, so that a resumed run finds it. Scenes that cannot be
/// measured become configurations with the status FAILED.
ReportPlan make_report_plan(const ReportOptions &p_options,
		const std::vector<ReportScene> &p_scenes,
		const std::vector<MeasurableTechnique> &p_techniques);

} // namespace gnomon
