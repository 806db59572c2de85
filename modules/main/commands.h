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

/// Of `--time`: frames that are drawn first, and frames that are measured.
inline constexpr uint32_t WARM_UP_COUNT = 5;
inline constexpr uint32_t MEASURED_COUNT = 20;

// See CommandInfo::add.
void add_run_command(CLI::App &r_app, CommonOptions &r_common);
void add_visibility_command(CLI::App &r_app, CommonOptions &r_common);
// `techniques`, `filters`, `modules` and `info`.
void register_list_commands();
void unregister_list_commands();

/// A whole number of digits alone; false for any other text.
bool parse_whole(std::string_view p_text, uint32_t &r_value);
/// "640x480" to a size of 1..16384 each; else a UsageError.
glm::uvec2 parse_size(const std::string &p_text);
/// The size that the command line names, else [defaults] size of the scene's project, else 512x512.
glm::uvec2 choose_size(
		const std::optional<std::string> &p_text, const std::filesystem::path &p_scene_path);

/// The scene of a .gltf or .glb file, or the start scene of a project's folder or project.cfg. The
/// project's disabled modules are switched off.
std::unique_ptr<Scene> load_scene(const std::filesystem::path &p_path);
/// The camera of that name, or the first. None: an Error that says how to add one.
Camera3D &choose_camera(const Scene &p_scene, const std::string &p_name);
/// The light of that name, or the first that casts shadows.
Light3D &choose_light(const Scene &p_scene, const std::string &p_name);
/// Applies "prop=value" (to p_light) or "light.Name.prop=value". Unknown lights and properties and
/// values out of range are an Error.
void apply_setting(const Scene &p_scene, Light3D *p_light, const std::string &p_setting);
/// Creates the device that the options ask for.
std::unique_ptr<RenderingDevice> create_device(const CommonOptions &p_common);
/// The processor's name as the system knows it.
std::string find_cpu_name();
/// Version and hash of this program, so that results of another build are told apart.
std::string describe_program();
/// An Error now rather than after minutes of work: the file's folder must exist and be writable.
void check_writable(const std::filesystem::path &p_path);

} // namespace gnomon
