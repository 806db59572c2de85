// Functions of commands.h that several commands use: options, the scene, its settings, the device.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/limits.h"
#include "modules/core/log.h"
#include "modules/core/operating_system.h"
#include "modules/core/project.h"
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/main/commands.h"
#include "modules/scene/animation.h"
#include "modules/scene/light_setting.h"
#include "modules/scene/stage.h"
#include "modules/shadows/light_properties.h"
#include "modules/shadows/shadow_registry.h"

#include <CLI/CLI.hpp>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <charconv>
#include <cmath>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

const char *const DEFAULT_SIZE = "512x512";
const uint32_t DEFAULT_ANTIALIASING = 2;

const PropertyInfo *find_property(const std::string &p_name) {
	if (const PropertyInfo *info = Light3D::get_property_list().find(p_name)) {
		return info;
	}
	return find_added_light_property(p_name);
}

std::string list_properties() {
	std::string names;
	for (const PropertyInfo &info : Light3D::get_property_list().get_properties()) {
		names += (names.empty() ? "" : ", ") + info.name;
	}
	for (const std::string &name : list_added_light_properties()) {
		names += ", " + name;
	}
	return names;
}

/// Applies "technique.ID.NAME=value". Returns false if p_setting does not start with "technique.".
/// Throws a UsageError if the rest has another form.
bool apply_technique_setting(const std::string &p_setting) {
	constexpr std::string_view PREFIX = "technique.";
	if (!p_setting.starts_with(PREFIX)) {
		return false;
	}
	const size_t equals = p_setting.find('=');
	const size_t dot = p_setting.rfind('.', equals);
	if (equals == std::string::npos || dot <= PREFIX.size()) {
		throw UsageError(text("--set is \"", p_setting, "\", must be technique.ID.NAME=value."));
	}
	const std::string_view all = p_setting;
	ShadowRegistry::set_setting(all.substr(PREFIX.size(), dot - PREFIX.size()),
			all.substr(dot + 1, equals - dot - 1), all.substr(equals + 1));
	return true;
}

/// Keeps up to 64 MB of freed memory in the process. Software drivers allocate and free the
/// triangles of each pass; to return them to the system and get them back took a sixth of the time
/// of frames with 64 copies of a model of 16,000 triangles.
void keep_freed_memory() {
#ifdef __GLIBC__
	mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

} // namespace

std::optional<std::string> find_project_default(
		const fs::path &p_scene_path, const std::string &p_key) {
	if (p_scene_path.empty()) {
		fail("The scene's path is empty. Name a .gltf or .glb file, or a project's folder.");
	}
	std::error_code code;
	const fs::path folder = fs::is_directory(p_scene_path, code)
			? p_scene_path
			: Project::find_folder(p_scene_path);
	if (!fs::exists(folder / "project.cfg", code)) {
		return std::nullopt;
	}
	const Project project = Project::load(folder);
	const auto found = project.defaults.find(p_key);
	return found == project.defaults.end() ? std::nullopt : std::optional(found->second);
}

bool parse_uint32(std::string_view p_text, uint32_t &r_value) {
	const char *end = p_text.data() + p_text.size();
	const std::from_chars_result result = std::from_chars(p_text.data(), end, r_value);
	return result.ec == std::errc() && result.ptr == end;
}

namespace {

/// Empty if the text is no valid size.
std::optional<glm::uvec2> try_parse_size(const std::string &p_text) {
	glm::uvec2 size_px(0);
	const size_t cross = p_text.find('x');
	const bool is_valid = cross != std::string::npos &&
			parse_uint32(std::string_view(p_text).substr(0, cross), size_px.x) &&
			parse_uint32(std::string_view(p_text).substr(cross + 1), size_px.y);
	if (!is_valid || size_px.x < 1 || size_px.y < 1 || size_px.x > MAX_IMAGE_SIZE_PX ||
			size_px.y > MAX_IMAGE_SIZE_PX) {
		return {};
	}
	return size_px;
}

} // namespace

glm::uvec2 parse_size(const std::string &p_text) {
	const std::optional<glm::uvec2> size_px = try_parse_size(p_text);
	if (!size_px) {
		throw UsageError(text("--size is \"", p_text, "\", must be WIDTHxHEIGHT with 1..",
				MAX_IMAGE_SIZE_PX, " each, for example 512x512."));
	}
	return *size_px;
}

glm::uvec2 choose_size(const std::optional<std::string> &p_text, const fs::path &p_scene_path) {
	const std::string from_project =
			find_project_default(p_scene_path, "size").value_or(DEFAULT_SIZE);
	if (p_text) {
		return parse_size(*p_text);
	}
	const std::optional<glm::uvec2> size_px = try_parse_size(from_project);
	if (!size_px) {
		fail("The project of ", p_scene_path, ": size in [defaults] is \"", from_project,
				"\", must be WIDTHxHEIGHT with 1..", MAX_IMAGE_SIZE_PX,
				" each, for example 512x512. Correct project.cfg.");
	}
	return *size_px;
}

uint32_t choose_antialiasing(
		const std::optional<uint32_t> &p_option, const fs::path &p_scene_path) {
	if (p_option) {
		return *p_option;
	}
	const std::optional<std::string> text = find_project_default(p_scene_path, "antialiasing");
	if (!text) {
		return DEFAULT_ANTIALIASING;
	}
	uint32_t value = 0;
	if (!parse_uint32(*text, value) || value < 1 || value > MAX_ANTIALIASING) {
		fail("The project of ", p_scene_path, ": antialiasing in [defaults] is \"", *text,
				"\", must be 1..", MAX_ANTIALIASING, ". Correct project.cfg.");
	}
	return value;
}

void add_stage_option(CLI::App &r_command, CommonOptions &r_common) {
	r_command
			.add_option("--stage", r_common.stage,
					"auto (default): a scene without camera gets one, and a scene without light "
					"gets a light and a ground; on: it gets all three; off: nothing")
			->check(CLI::IsMember({ "auto", "on", "off" }));
}

void add_animation_options(CLI::App &r_command, CommonOptions &r_common) {
	r_command.add_option("--animation", r_common.animation,
			"The name of the animation that poses the scene; default: run takes that of the "
			"project, else the first; other commands the first if --at is given, else none");
	r_command.add_option("--at", r_common.at_s,
			"The time in s, from 0, at which the animation poses the scene (run plays it from "
			"there); a time after its end wraps around");
}

void pose_as_requested(Scene &r_scene, const CommonOptions &p_common) {
	if (!p_common.at_s && p_common.animation.empty()) {
		return;
	}
	const double at_s = p_common.at_s.value_or(0);
	if (!std::isfinite(at_s) || at_s < 0) {
		throw UsageError(text("--at is ", at_s, ", must be a finite time in s, 0 or more."));
	}
	const std::shared_ptr<const Animation> animation = find_animation(r_scene, p_common.animation);
	if (!animation) {
		fail("Scene ", r_scene.path, " has no animation. Omit --at, or export it with one.");
	}
	pose_scene(r_scene, animation.get(), animation->wrap_time(at_s));
}

std::unique_ptr<Scene> load_scene(
		const fs::path &p_path, const CommonOptions &p_common, glm::uvec2 p_size_px) {
	const ProjectScene found = find_project_scene(p_path);
	disable_modules(found.project);
	apply_technique_settings(found.project);
	GltfLoadOptions options;
	options.project_folder = found.project.folder;
	options.find_technique_property = &find_added_light_property;
	std::unique_ptr<Scene> scene = load_gltf(found.scene_path, options);
	const std::vector<MeshInstance3D *> meshes = scene->find_nodes<MeshInstance3D>();
	if (std::all_of(meshes.begin(), meshes.end(),
				[](const MeshInstance3D *p_mesh) { return p_mesh->compute_bounds().is_empty(); })) {
		fail("Scene ", found.scene_path, meshes.empty() ? " has no mesh" : " has no triangles",
				". Add some in the program that wrote the file.");
	}
	pose_as_requested(*scene, p_common);
	const std::string staged = stage_scene(
			*scene, parse_stage_mode(p_common.stage, "--stage"), double(p_size_px.x) / p_size_px.y);
	if (!staged.empty()) {
		log_info(staged);
	}
	return scene;
}

Camera3D &choose_camera(const Scene &p_scene, const std::string &p_name) {
	if (!p_name.empty()) {
		return p_scene.find_node<Camera3D>(p_name, "Camera");
	}
	const std::vector<Camera3D *> cameras = p_scene.find_nodes<Camera3D>();
	if (cameras.empty()) {
		fail("Scene ", p_scene.path,
				" has no perspective camera. Add one, and export it too, or use ", "--stage auto.");
	}
	return *cameras.front();
}

Light3D &choose_light(const Scene &p_scene, const std::string &p_name) {
	if (!p_name.empty()) {
		return p_scene.find_node<Light3D>(p_name, "Light");
	}
	const std::vector<Light3D *> lights = p_scene.find_nodes<Light3D>();
	for (Light3D *light : lights) {
		if (get_bool(Light3D::get_property_list(), light->properties, "shadow_enabled")) {
			return *light;
		}
	}
	if (lights.empty()) {
		fail("Scene ", p_scene.path,
				" has no light. Add a light (KHR_lights_punctual) with extras.shadow_enabled true, "
				"or use --stage auto.");
	}
	fail("Scene ", p_scene.path,
			" has no light that casts shadows. Set extras.shadow_enabled of a light to true, or "
			"name one with --light, or use --stage on.");
}

void apply_setting(const Scene &p_scene, Light3D *p_light, const std::string &p_setting) {
	if (apply_technique_setting(p_setting)) {
		return;
	}
	const LightSetting setting = parse_light_setting(p_setting);
	if (!setting.light_name.empty()) {
		p_light = &p_scene.find_node<Light3D>(setting.light_name, "Light");
	}
	if (!p_light) {
		throw UsageError(text("--set is \"", p_setting,
				"\", must be light.NAME.property=value or technique.ID.NAME=value."));
	}
	const PropertyInfo *info = find_property(setting.property);
	if (!info) {
		if (const RemovedProperty *removed = find_removed_light_property(setting.property)) {
			fail("Light \"", p_light->name, "\": ", setting.property, " is not used any more. ",
					removed->advice);
		}
		fail("Light \"", p_light->name, "\": there is no property \"", setting.property,
				"\". There are: ", list_properties(), ".");
	}
	p_light->properties[setting.property] =
			parse_property(*info, setting.value, text("Light \"", p_light->name, "\""));
}

std::unique_ptr<RenderingDevice> create_device(
		const CommonOptions &p_common, DeviceOptions p_options) {
	p_options.device = p_common.device;
	p_options.validation = p_common.validation;
	std::unique_ptr<RenderingDevice> device = create_rendering_device(p_options);
	if (device->get_info().type == "CPU") {
		keep_freed_memory();
	}
	return device;
}

void check_writable(const fs::path &p_path) {
	const fs::path folder = p_path.has_parent_path() ? p_path.parent_path() : fs::path(".");
	std::error_code code;
	if (!is_folder_writable(folder) || fs::is_directory(p_path, code)) {
		fail("Cannot write ", p_path,
				": its folder must exist and be writable, and it must not be ",
				"a folder itself. Choose another location.");
	}
}

std::string describe_program() {
	const fs::path program = find_program_path();
	std::error_code code; // it may have been replaced since it was started
	return std::string(PROGRAM_VERSION) +
			(fs::exists(program, code) ? " " + format_hash(compute_hash(load_file(program))) : "");
}

} // namespace gnomon
