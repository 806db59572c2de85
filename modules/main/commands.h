#pragma once

#include "modules/core/command_registry.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

inline constexpr const char *PROGRAM_VERSION = "0.1.0";

/// Default frame counts of `--time`: warm-up frames, which are not measured, then measured frames.
inline constexpr uint32_t WARM_UP_FRAME_COUNT = 5;
inline constexpr uint32_t MEASURED_FRAME_COUNT = 20;

// Each adds a subcommand to the CLI11 parser; see CommandInfo::add.
void add_run_command(CLI::App &r_app, CommonOptions &r_common);
void add_visibility_command(CLI::App &r_app, CommonOptions &r_common);
// Register and unregister the commands `techniques`, `filters`, `modules` and `info`.
void register_list_commands();
void unregister_list_commands();

/// Parses an unsigned 32-bit decimal integer. Returns false if the text contains anything but
/// digits, is empty or exceeds the range.
bool parse_uint32(std::string_view p_text, uint32_t &r_value);
/// Parses "WIDTHxHEIGHT", in pixels, such as "640x480". Throws a UsageError if the text has another
/// form or a side is outside 1..16384.
glm::uvec2 parse_size(const std::string &p_text);
/// Returns the image size in pixels: p_text (--size) if given, else the key "size" in [defaults] of
/// the scene's project.cfg, else 512x512. Throws like parse_size; an invalid size in project.cfg is
/// an Error.
glm::uvec2 choose_size(
		const std::optional<std::string> &p_text, const std::filesystem::path &p_scene_path);
/// Returns the value of a key in [defaults] of the project.cfg that belongs to the path: a
/// project's folder or a scene file in a project. Returns nullopt if there is no project or no such
/// key.
std::optional<std::string> find_project_default(
		const std::filesystem::path &p_scene_path, const std::string &p_key);
/// Returns the supersampling factor per axis, 1..4: p_option (--antialiasing) if given, else the
/// key "antialiasing" in [defaults] of the scene's project.cfg, else 2. A value of project.cfg that
/// is out of range is an Error.
uint32_t choose_antialiasing(
		const std::optional<uint32_t> &p_option, const std::filesystem::path &p_scene_path);

/// Loads a .gltf or .glb file, or the start scene of a project (its folder or project.cfg).
/// Disables the modules and applies the technique settings that the project lists. Poses the scene
/// as --animation and --at request, and adds a missing camera, light and ground as --stage
/// requests; p_size_px decides the aspect ratio of the added camera. A scene without triangles is
/// an Error.
std::unique_ptr<Scene> load_scene(
		const std::filesystem::path &p_path, const CommonOptions &p_common, glm::uvec2 p_size_px);
/// Adds the options `--animation` and `--at` to a command that draws scenes.
void add_animation_options(CLI::App &r_command, CommonOptions &r_common);
/// Poses the scene as `--animation` and `--at` request; if neither is given, it stays at rest.
/// Throws a UsageError for a time that is negative or not finite, and an Error for an unknown
/// animation or a scene without animations.
void pose_as_requested(Scene &r_scene, const CommonOptions &p_common);
/// Adds the option `--stage` to a command that draws scenes.
void add_stage_option(CLI::App &r_command, CommonOptions &r_common);
/// Returns the camera with that name, or the first camera if the name is empty. Throws an Error if
/// there is none.
Camera3D &choose_camera(const Scene &p_scene, const std::string &p_name);
/// Returns the light with that name, or the first light that casts shadows if the name is empty.
/// Throws an Error if there is none.
Light3D &choose_light(const Scene &p_scene, const std::string &p_name);
/// Applies an argument of --set: "property=value" (to p_light, which may be null: then a
/// UsageError), "light.NAME.property=value" or "technique.ID.NAME=value". Throws an Error for an
/// unknown light, property or setting, and for a value out of range.
void apply_setting(const Scene &p_scene, Light3D *p_light, const std::string &p_setting);
/// Creates the device that --device selects, with validation layers if --validation is given. The
/// other fields of p_options are passed through.
std::unique_ptr<RenderingDevice> create_device(
		const CommonOptions &p_common, DeviceOptions p_options = {});
/// Returns the program's version and a hash of its executable, such as "0.1.0 5f2c9a7710e3b4d8", so
/// that results of different builds can be distinguished. If the program finds no such file, the
/// hash is omitted.
std::string describe_program();
/// Throws an Error if the file cannot be written: its folder does not exist or is not writable, or
/// the path is a folder. Called before long measurements, so that they do not fail at the end.
void check_writable(const std::filesystem::path &p_path);

/// Runs the program and returns its exit code. The arguments are UTF-8, as those of main. Called by
/// entry_posix.cpp and entry_windows.cpp.
int run_gnomon(int p_argument_count, char **p_arguments);

// Register and unregister the commands, and the features of `run`, that need the named module.
void initialize_desktop_part();
void uninitialize_desktop_part();
void initialize_masks_part();
void uninitialize_masks_part();
void initialize_error_report_part();
void uninitialize_error_report_part();

// Generated by SCsub: they call the functions above for each of these modules in this build.
void initialize_optional_parts();
void uninitialize_optional_parts();

/// An option of `gnomon report` that needs a module.
struct MissingOption {
	const char *name; // with its dashes
	const char *module;
};
/// Generated by SCsub: returns the options of report parts whose modules this build lacks, as their
/// config.py lists them.
std::vector<MissingOption> get_missing_report_options();

} // namespace gnomon
