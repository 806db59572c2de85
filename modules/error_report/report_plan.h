#pragma once

#include "modules/error_report/light_variant.h"
#include "modules/error_report/mask_source.h"
#include "modules/error_report/report.h"
#include "modules/error_report/scaling_scenes.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// Id of the stability sweep over ReportOptions::stability_scenes.
inline constexpr const char *PROJECT_SCENES_SWEEP = "scenes";

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
	ReportExtent stability = ReportExtent::QUICK; // NONE if the build has no stability_report
	std::vector<std::string> sweeps;			  // ids of stability sweeps; empty: all
	std::vector<ReportScene> stability_scenes;	  // scenes of the sweep PROJECT_SCENES_SWEEP
	ReportExtent animation = ReportExtent::QUICK; // of ANIMATION_GROUP; the option --change
	std::vector<ReportScene> animated_scenes;	  // scenes without an animation are skipped

	/// Returns whether the stability sweep is to be measured.
	bool has_sweep(const std::string &p_id) const;
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
