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

inline constexpr const char *PROJECT_SCENES_SWEEP = "scenes"; // see ReportOptions::stability_scenes

/// A scene of a project, or why it could not be loaded.
struct ReportScene {
	std::string name;
	std::shared_ptr<const Scene> scene;
	std::string failure;
};

/// The camera and the lights of a scene that are measured.
struct ReportView {
	Camera3D *camera = nullptr;
	std::vector<Light3D *> lights; // those that cast shadows; at least one
};
/// Throws an Error when the scene was not loaded, has no camera, or no light that casts shadows.
ReportView find_report_view(const ReportScene &p_scene);

struct ReportOptions {
	std::string project;
	std::string program;			   // version and hash; other programs measure again
	std::vector<double> sizes_m;	   // R in metres; empty: 0.02, 0.1 and 0.3 S of each scene
	bool has_own_sizes = false;		   // instead of those: the size that each light has
	bool has_default_settings = false; // true: only each technique's default quality level
	/// Types that the first shadow-casting light of each scene takes in turn. Empty: all lights
	/// that cast shadows, as they are.
	std::vector<LightType> light_types;
	glm::uvec2 size_px = glm::uvec2(256u);
	uint32_t sample_count = 1024; // of the reference
	double precision_percent = 5; // see Report; a third of what a comparison calls a change
	uint64_t filter_hash = 0;	  // see MaskQuestion
	ReportExtent scaling = ReportExtent::QUICK;
	ReportExtent stability = ReportExtent::QUICK; // NONE where no module adds the sweeps
	std::vector<std::string> sweeps;			  // of stability; empty: all
	std::vector<ReportScene> stability_scenes;	  // of the sweep "scenes"
	ReportExtent animation = ReportExtent::QUICK;
	std::vector<ReportScene> animated_scenes; // those without an animation are skipped

	bool has_sweep(const std::string &p_id) const;
};

/// The planned measurements: a report whose references and cells are still missing, and how to
/// compute each. Questions are built on demand, since a scene may have a million triangles.
struct ReportPlan {
	Report report;
	std::vector<std::shared_ptr<const SceneSnapshot>> shown_scenes; // of Report::scene_images
	/// One per configuration; throws an Error where the scene cannot be shown. The properties
	/// replace those of the light.
	using MakeQuestion = std::function<MaskQuestion(const PropertyValues &)>;
	std::vector<MakeQuestion> questions;
	std::vector<PropertyValues> settings; // one per cell
};

/// Plans the whole matrix in a fixed order: scenes, lights, sizes, techniques, settings. Names each
/// record after what it depends on, so that a later run finds it again.
ReportPlan make_report_plan(const ReportOptions &p_options,
		const std::vector<ReportScene> &p_scenes, const std::vector<TechniqueSource> &p_techniques);

} // namespace gnomon
