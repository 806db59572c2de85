#include "modules/error_report/report_plan.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/error_report/report_part.h"
#include "modules/error_report/scaling_scenes.h"
#include "modules/mesh_tools/caster_counts.h"

#include <algorithm>
#include <cctype>

namespace gnomon {

namespace {

/// Default light radii R as fractions of the scene size S. In the benchmark scenes (S = 4 m) they
/// are 0.08, 0.4 and 1.2 m.
const double DEFAULT_SIZES[] = { 0.02, 0.1, 0.3 };
const char *const SCALING_SCENE_NAME = "torus_knot, generated";

using SceneCache = LastValue<ScalingScene, std::shared_ptr<const Scene>>;

/// Whether a configuration has cells of settings with QualitySetting::is_expensive.
enum class ExpensiveSettings { MEASURED, SKIPPED };

/// Returns a name as part of a file name: at most 40 letters, digits and underscores.
std::string make_slug(const std::string &p_text) {
	std::string slug;
	for (const char letter : p_text) {
		slug += std::isalnum(static_cast<unsigned char>(letter)) ? letter : '_';
	}
	return slug.substr(0, 40);
}

std::string make_record_name(
		const std::string &p_scene, const std::string &p_what, uint64_t p_hash) {
	return make_slug(p_scene) + "-" + make_slug(p_what) + "-" + format_hash(p_hash);
}

uint64_t hash_light(const LightSnapshot &p_light, uint64_t p_hash) {
	p_hash = p_light.compute_hash(p_hash);
	for (const float value : { p_light.inner_cone_rad, p_light.penumbra_outer_width_m,
				 p_light.penumbra_inner_width_m }) {
		p_hash = compute_value_hash(value, p_hash);
	}
	p_hash = compute_value_hash(p_light.casts_shadow, p_hash);
	for (const auto &[name, value] : p_light.properties) {
		p_hash = compute_text_hash(text(name, "=", format_property(value)), p_hash);
	}
	return p_hash;
}

uint64_t hash_instance(const InstanceSnapshot &p_instance, uint64_t p_hash) {
	p_hash = p_instance.compute_hash(p_hash);
	p_hash = compute_value_hash(p_instance.is_planar_receiver, p_hash);
	p_hash = compute_value_hash(p_instance.material->scatter, p_hash);
	p_hash = compute_value_hash(p_instance.material->scatter_distance_m, p_hash);
	return compute_value_hash(p_instance.material->is_double_sided, p_hash);
}

/// Hashes what only a lit image depends on: colours and intensities of lights, and parameters of
/// materials. The images of textures are not hashed.
uint64_t hash_appearance(const SceneSnapshot &p_scene, uint64_t p_hash) {
	for (const LightSnapshot &light : p_scene.lights) {
		p_hash = compute_value_hash(light.color, p_hash);
		p_hash = compute_value_hash(light.intensity, p_hash);
	}
	for (const InstanceSnapshot &instance : p_scene.instances) {
		const Material &material = *instance.material;
		p_hash = compute_value_hash(material.base_color, p_hash);
		p_hash = compute_value_hash(material.emissive, p_hash);
		p_hash = compute_value_hash(material.metallic, p_hash);
		p_hash = compute_value_hash(material.roughness, p_hash);
		p_hash = compute_value_hash(material.shading_model, p_hash);
		p_hash = compute_value_hash(material.normal_scale, p_hash);
		p_hash = compute_value_hash(material.occlusion_strength, p_hash);
	}
	return p_hash;
}

/// Returns a 64-bit hash of everything that the mask may depend on: meshes and their transforms,
/// scattering and transmission of materials, the camera, the scene size S, the light with all its
/// properties, mask filters and the size of the image; if next_scene is set also the meshes, lights
/// and camera one frame later. If the task names no light, its result (a lit image, or a run time)
/// depends on all lights; see also hash_appearance.
uint64_t compute_task_hash(const MaskTask &p_task) {
	const SceneSnapshot &scene = *p_task.scene;
	uint64_t hash = scene.camera.compute_hash(/*p_seed=*/1);
	hash = compute_value_hash(scene.scene_size_m, hash);
	for (const InstanceSnapshot &instance : scene.instances) {
		hash = hash_instance(instance, hash);
	}
	for (const LightSnapshot &light : scene.lights) {
		if (p_task.light.empty() || light.name == p_task.light) {
			hash = hash_light(light, hash);
		}
	}
	if (p_task.light.empty()) {
		hash = hash_appearance(scene, hash);
	}
	for (size_t index = 0; p_task.next_scene && index < p_task.next_scene->instances.size();
			++index) {
		hash = hash_instance(p_task.next_scene->instances[index], hash);
	}
	if (p_task.next_scene) {
		hash = p_task.next_scene->camera.compute_hash(hash);
		for (const LightSnapshot &light : p_task.next_scene->lights) {
			hash = hash_light(light, hash);
		}
	}
	hash = compute_value_hash(p_task.filter_hash, hash);
	return compute_value_hash(p_task.size_px, hash);
}

/// Returns the value -1 for both penumbra widths, r and t: it derives them from the light's size.
PropertyValues make_derived_widths() {
	return { { "penumbra_outer_width", -1.0 }, { "penumbra_inner_width", -1.0 } };
}

bool casts_shadow(const Light3D &p_light) {
	return get_bool(Light3D::get_property_list(), p_light.properties, "shadow_enabled");
}

/// Builds a ReportPlan, see make_report_plan.
class Planner {
public:
	Planner(const ReportOptions &p_options, const std::vector<MeasurableTechnique> &p_techniques) :
			options(p_options), techniques(p_techniques) {
		plan.report.project = options.project;
		plan.report.program = options.program;
		plan.report.sample_count = options.sample_count;
		plan.report.precision_percent = options.precision_percent;
		for (const MeasurableTechnique &technique : techniques) {
			plan.report.techniques.push_back(technique.info);
		}
	}

	void add_scene(const ReportScene &p_scene) {
		try {
			add_lights(p_scene);
		} catch (const Error &error) {
			add_failure(p_scene.name, error.what());
		}
	}

	void add_scaling() {
		const auto cache = std::make_shared<SceneCache>();
		for (const ScalingSeries &series : get_scaling_series(options.scaling)) {
			for (const double value : series.values) {
				add_scaling_configuration(series.group, value, cache);
			}
		}
	}

	void add_parts(std::span<const ReportScene> p_scenes) {
		for (const ReportPartInfo &info : ReportPartRegistry::get_all()) {
			info.part->plan(options, p_scenes,
					[this](ReportConfiguration p_configuration, ReportPlan::MakeTask p_make_task) {
						add_configuration(std::move(p_configuration), std::move(p_make_task),
								ExpensiveSettings::SKIPPED);
					});
		}
	}

	ReportPlan finish() { return std::move(plan); }

private:
	void add_failure(ReportConfiguration p_configuration, const std::string &p_message) {
		p_configuration.status = ReportStatus::FAILED;
		p_configuration.message = p_message;
		plan.report.configurations.push_back(std::move(p_configuration));
		plan.tasks.push_back([p_message](const PropertyValues &) -> MaskTask { fail(p_message); });
	}

	/// Adds a failed configuration for a scene that cannot be measured at all.
	void add_failure(const std::string &p_scene, const std::string &p_message) {
		ReportConfiguration configuration;
		configuration.id = p_scene;
		configuration.scene = p_scene;
		add_failure(std::move(configuration), p_message);
	}

	void add_lights(const ReportScene &p_scene) {
		const ReportView view = find_report_view(p_scene);
		const auto snapshot = build_snapshot(*p_scene.scene, *view.camera);
		const double scene_size_m = snapshot->scene_size_m;
		add_scene_image(p_scene.name, snapshot, /*p_has_shadows=*/true);
		add_scene_image(p_scene.name, snapshot, /*p_has_shadows=*/false);
		std::vector<double> sizes_m = options.sizes_m;
		if (sizes_m.empty()) {
			for (const double size : DEFAULT_SIZES) {
				sizes_m.push_back(size * scene_size_m);
			}
		}
		const auto get_sizes = [&](const Light3D &p_light) {
			return options.has_own_sizes ? std::vector{ compute_own_size(p_light, scene_size_m) }
										 : sizes_m;
		};
		if (options.light_types.empty()) {
			for (Light3D *light : view.lights) {
				add_sizes(p_scene.name, p_scene.scene, *view.camera, *light, light->type,
						get_sizes(*light));
			}
		}
		for (const LightType type : options.light_types) {
			add_sizes(p_scene.name, p_scene.scene, *view.camera, *view.lights[0], type,
					get_sizes(*view.lights[0]));
		}
	}

	/// Plans a lit image of the scene, with the shadows of all its lights or without any shadows.
	void add_scene_image(const std::string &p_scene,
			const std::shared_ptr<const SceneSnapshot> &p_snapshot, bool p_has_shadows) {
		auto shown = std::make_shared<SceneSnapshot>(*p_snapshot);
		shown->lights.edit_all([&](LightSnapshot &r_light) {
			r_light.casts_shadow = r_light.casts_shadow && p_has_shadows;
		});
		ReportSceneImage image;
		image.scene = p_scene;
		image.has_shadows = p_has_shadows;
		const uint64_t hash = compute_value_hash(p_has_shadows,
				compute_task_hash({ p_snapshot, "", options.size_px, options.filter_hash }));
		image.record = make_record_name(p_scene, p_has_shadows ? "with_shadows" : "without_shadows",
				compute_text_hash(options.program, hash));
		plan.report.scene_images.push_back(std::move(image));
		plan.shown_scenes.push_back(std::move(shown));
	}

	void add_sizes(const std::string &p_name, const std::shared_ptr<const Scene> &p_scene,
			const Camera3D &p_camera, Light3D &r_light, LightType p_type,
			const std::vector<double> &p_sizes_m) {
		for (size_t index = 0; index < p_sizes_m.size(); ++index) {
			const LightVariant variant = { p_type, p_sizes_m[index] };
			const glm::uvec2 size_px = options.size_px;
			ReportConfiguration configuration;
			configuration.scene = p_name;
			configuration.light = r_light.name;
			configuration.value = variant.size_m;
			configuration.size_px = size_px;
			configuration.id = p_name + "/" + r_light.name +
					(p_type == r_light.type ? "" : text(" as ", get_light_type_name(p_type))) +
					"/" + format_number(variant.size_m);
			add_configuration(
					configuration,
					[=, &p_camera, &r_light, filter_hash = options.filter_hash](
							const PropertyValues &p_properties) {
						return MaskTask{ build_variant(*p_scene, p_camera, r_light, variant,
												 p_properties),
							r_light.name, size_px, filter_hash };
					},
					index == p_sizes_m.size() / 2 ? ExpensiveSettings::MEASURED
												  : ExpensiveSettings::SKIPPED);
		}
	}

	void add_scaling_configuration(const std::string &p_group, double p_value,
			const std::shared_ptr<SceneCache> &p_cache) {
		ScalingScene description;
		glm::uvec2 size_px = options.size_px;
		if (p_group == TRIANGLES_GROUP) {
			description.triangle_count = static_cast<uint32_t>(p_value);
		} else if (p_group == LIGHT_SIZE_GROUP) {
			description.light_size_m = p_value;
		} else if (p_group == LIGHTS_GROUP) {
			description.light_count = static_cast<uint32_t>(p_value);
		} else {
			size_px = glm::uvec2(static_cast<uint32_t>(p_value));
		}
		ReportConfiguration configuration;
		configuration.group = p_group;
		configuration.value = p_value;
		configuration.id = text(p_group, "/", format_number(p_value));
		configuration.scene = SCALING_SCENE_NAME;
		configuration.light_count = description.light_count;
		configuration.size_px = size_px;
		const bool has_many_lights = description.light_count > 1;
		configuration.light = has_many_lights ? "" : "Light 1";
		add_configuration(
				configuration,
				[=](const PropertyValues &) {
					const auto scene = p_cache->get(
							description, [&] { return make_scaling_scene(description); });
					return MaskTask{ build_snapshot(*scene, *scene->find_nodes<Camera3D>().front()),
						has_many_lights ? "" : "Light 1", size_px };
				},
				ExpensiveSettings::SKIPPED);
	}

	/// Sets the data of the configuration that follow from its scene, and plans its cells.
	void add_configuration(ReportConfiguration p_configuration, ReportPlan::MakeTask p_make_task,
			ExpensiveSettings p_expensive) {
		MaskTask task;
		try {
			task = p_make_task(make_derived_widths());
		} catch (const Error &error) {
			add_failure(std::move(p_configuration), error.what());
			return;
		}
		const LightSnapshot &light = p_configuration.light.empty()
				? task.scene->lights.front()
				: get_light(*task.scene, p_configuration.light);
		p_configuration.light_type = get_light_type_name(light.type);
		if (light.type == LightType::DIRECTIONAL) {
			p_configuration.light_angular_distance_deg = light.light_angular_distance_deg;
		} else {
			// Where it is known, the exact size: the snapshot rounds it to float32.
			p_configuration.light_size_m =
					p_configuration.group == LIGHT_SIZE_GROUP || p_configuration.is_matrix()
					? p_configuration.value
					: light.light_size_m;
		}
		p_configuration.scene_size_m = task.scene->scene_size_m;
		const CasterCounts casters = count_casters(*task.scene, &light);
		p_configuration.triangle_count = casters.triangle_count;
		p_configuration.edge_count = casters.edge_count;
		// A configuration without a reference has nothing to trace, so it is never MISSING.
		p_configuration.status =
				p_configuration.has_reference() ? ReportStatus::MISSING : ReportStatus::OK;
		if (p_configuration.has_reference()) {
			const uint64_t hash =
					compute_text_hash(text(options.sample_count), compute_task_hash(task));
			p_configuration.record = make_record_name(p_configuration.scene, "reference_mask",
					compute_text_hash(options.program, hash));
		}
		const size_t index = plan.report.configurations.size();
		plan.report.configurations.push_back(p_configuration);
		plan.tasks.push_back(p_make_task);
		for (const MeasurableTechnique &technique : techniques) {
			if (technique.applies && !technique.applies(task)) {
				continue;
			}
			std::vector<QualitySetting> settings = technique.get_settings(light);
			if (options.has_default_settings) {
				settings.clear();
			}
			if (!p_configuration.is_matrix()) {
				// Outside the matrix only default settings are measured. A technique with expensive
				// settings is a brute-force one; quick scaling curves omit it.
				const bool is_expensive = std::any_of(settings.begin(), settings.end(),
						[](const QualitySetting &p_setting) { return p_setting.is_expensive; });
				if (is_expensive && !p_configuration.has_reference() &&
						options.scaling == ReportExtent::QUICK) {
					continue;
				}
				settings.clear();
			}
			if (settings.empty()) {
				settings.push_back({ "default", {} });
			}
			for (const QualitySetting &setting : settings) {
				if (!setting.is_expensive || p_expensive == ExpensiveSettings::MEASURED) {
					add_cell(index, technique.info.id, setting);
				}
			}
		}
	}

	void add_cell(size_t p_configuration, const std::string &p_technique,
			const QualitySetting &p_setting) {
		const ReportConfiguration &configuration = plan.report.configurations[p_configuration];
		PropertyValues properties = make_derived_widths(); // only tasks of the matrix use them
		ReportCell cell;
		cell.configuration_index = p_configuration;
		cell.technique = p_technique;
		cell.setting = p_setting.name;
		for (const auto &[name, value] : p_setting.properties) {
			properties[name] = value;
			cell.properties[name] = format_property(value);
		}
		uint64_t hash = compute_task_hash(plan.tasks[p_configuration](properties));
		for (const std::string &part : { p_technique, p_setting.name, options.program,
					 text(options.precision_percent),
					 configuration.has_reference() ? text(options.sample_count) : std::string() }) {
			hash = compute_text_hash(part, hash);
		}
		cell.record = make_record_name(configuration.scene, p_technique, hash);
		plan.report.cells.push_back(std::move(cell));
		plan.settings.push_back(std::move(properties));
	}

	const ReportOptions &options;
	const std::vector<MeasurableTechnique> &techniques;
	ReportPlan plan;
};

} // namespace

std::vector<std::string> ReportOptions::get_part_option(const std::string &p_name) const {
	const auto found = part_options.find(p_name);
	return found == part_options.end() ? std::vector<std::string>() : found->second;
}

ReportExtent ReportOptions::get_part_extent(const std::string &p_name) const {
	const std::vector<std::string> values = get_part_option(p_name);
	return values.empty() ? ReportExtent::NONE : parse_extent(values.front());
}

ReportView find_report_view(const ReportScene &p_scene) {
	if (!p_scene.scene) {
		fail(p_scene.failure);
	}
	const std::vector<Camera3D *> cameras = p_scene.scene->find_nodes<Camera3D>();
	if (cameras.empty()) {
		fail("Scene \"", p_scene.name, "\" has no perspective camera. Add one, and export it too.");
	}
	ReportView view = { cameras.front(), p_scene.scene->find_nodes<Light3D>() };
	std::erase_if(view.lights, [](const Light3D *p_light) { return !casts_shadow(*p_light); });
	if (view.lights.empty()) {
		fail("Scene \"", p_scene.name, "\" has no light that casts shadows. Add one ",
				"(KHR_lights_punctual) with extras.shadow_enabled true.");
	}
	return view;
}

ReportPlan make_report_plan(const ReportOptions &p_options,
		const std::vector<ReportScene> &p_scenes,
		const std::vector<MeasurableTechnique> &p_techniques) {
	Planner planner(p_options, p_techniques);
	for (const ReportScene &scene : p_scenes) {
		planner.add_scene(scene);
	}
	planner.add_scaling();
	planner.add_parts(p_scenes);
	return planner.finish();
}

} // namespace gnomon
