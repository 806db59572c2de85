// The command `gnomon run`: plays a scene in a window, or renders it headless.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/limits.h"
#include "modules/core/log.h"
#include "modules/core/path_option.h"
#include "modules/core/png.h"
#include "modules/main/commands.h"
#include "modules/main/run_part.h"
#include "modules/scene/frame_snapshots.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>

namespace gnomon {

namespace {

RunOptions options;
std::filesystem::path reference_path; // --reference
double speed = 1;					  // --speed

const double HEADLESS_FRAMES_PER_S = 60;

/// Chooses the animation that --animation names, else the one that project.cfg names in [defaults]
/// if the scene has it, else the first of the scene. An empty name in project.cfg means no
/// animation, or the first if --at is given.
AnimationPlayback choose_playback(const Scene &p_scene, const CommonOptions &p_common) {
	AnimationPlayback playback;
	const std::optional<std::string> of_project = find_project_default(options.scene, "animation");
	const auto has_name = [&](const std::shared_ptr<const Animation> &p_animation) {
		return of_project && p_animation->name == *of_project;
	};
	if (p_common.animation.empty() && of_project && of_project->empty()) {
		playback.animation = p_common.at_s ? find_animation(p_scene, "") : nullptr;
	} else if (p_common.animation.empty() &&
			std::any_of(p_scene.animations.begin(), p_scene.animations.end(), has_name)) {
		playback.animation = find_animation(p_scene, *of_project);
	} else {
		playback.animation = find_animation(p_scene, p_common.animation);
	}
	playback.speed = speed;
	if (playback.animation) {
		playback.time_s = playback.animation->wrap_time(p_common.at_s.value_or(0));
	}
	return playback;
}

/// Writes the files of --capture and --dot and prints the plan of --plan, as requested.
void write_outputs(const RenderResult &p_result, glm::uvec2 p_size_px) {
	if (!options.capture.empty()) {
		save_png(options.capture, p_size_px, /*p_channel_count=*/4, p_result.image);
	}
	if (!options.dot.empty()) {
		save_file_atomically(options.dot, p_result.dot);
	}
	if (options.prints_plan) {
		std::printf("%s", p_result.plan.to_text().c_str());
	}
}

void run_headless(Scene &r_scene, glm::uvec2 p_size_px, const CommonOptions &p_common) {
	const Camera3D &camera = choose_camera(r_scene, options.camera);
	const std::unique_ptr<RenderingDevice> device = create_device(p_common);
	Renderer renderer(*device);
	RenderRequest request;
	request.size_px = p_size_px;
	request.antialiasing = *options.antialiasing;
	request.technique_override = options.technique;
	request.debug_view = options.debug_view;
	request.reference = options.reference;
	request.may_skip = !options.skips_nothing;
	RenderResult result;
	FrameSnapshots snapshots;
	const uint32_t frame_count = std::max(options.frame_count, 1u);
	for (uint32_t index = 0; index < frame_count; ++index) {
		request.wants_image = index + 1 == frame_count;
		request.wants_graph = request.wants_image && !options.dot.empty();
		// A fixed time step, so that the images do not depend on the speed of the machine.
		const SceneChange change =
				options.playback.advance(r_scene, index == 0 ? 0.0 : 1.0 / HEADLESS_FRAMES_PER_S);
		request.scene = snapshots.build(r_scene, camera, change);
		result = renderer.render(request);
	}
	write_outputs(result, p_size_px);
	for (const PassTiming &timing : result.timings) {
		std::printf("%-40s %8.3f ms %s\n", timing.name.c_str(), timing.get_cost_ms(),
				timing.is_on_host ? "CPU" : "GPU");
	}
	std::printf("%-40s %8.3f ms GPU, %.3f ms wall\n", "frame", result.gpu_ms, result.wall_ms);
	if (!options.time_path.empty()) {
		request.wants_image = false;
		request.may_reuse = options.is_still || options.is_playing;
		const auto build_next = [&] {
			const SceneChange change = options.is_playing
					? options.playback.advance(r_scene, 1.0 / HEADLESS_FRAMES_PER_S)
					: options.is_still ? SceneChange::NONE
									   : SceneChange::ANY;
			return snapshots.build(r_scene, camera, change);
		};
		save_file_atomically(options.time_path,
				RunPartRegistry::find(MASKS_PART)
						->measure_time(renderer, request, WARM_UP_FRAME_COUNT, MEASURED_FRAME_COUNT,
								build_next));
	}
}

void run(const CommonOptions &p_common) {
	glm::uvec2 size_px = choose_size(options.size, options.scene);
	options.antialiasing = choose_antialiasing(options.antialiasing, options.scene);
	check_image_name("--capture", options.capture, ".png");
	for (const std::filesystem::path &path : { options.capture, options.dot, options.time_path }) {
		if (!path.empty()) {
			check_writable(path);
		}
	}
	if (!reference_path.empty()) { // then MASKS_PART exists, see add_run_command
		options.reference = RunPartRegistry::find(MASKS_PART)->load_reference(reference_path);
	}
	const std::unique_ptr<Scene> scene = load_scene(options.scene, p_common, size_px);
	const OutputFile outputs[] = { { "--capture", options.capture }, { "--dot", options.dot },
		{ "--time", options.time_path } };
	check_outputs(outputs);
	for (const std::string &setting : options.settings) {
		apply_setting(*scene, nullptr, setting);
	}
	if (scene->find_nodes<Light3D>().empty()) {
		log_warning("Scene ", scene->path, " has no light; only ambient light is seen. Add one ",
				"(KHR_lights_punctual).");
	}
	options.playback = choose_playback(*scene, p_common);
	if (options.is_headless) {
		run_headless(*scene, size_px, p_common);
	} else if (const RunPart *desktop = RunPartRegistry::find(DESKTOP_PART); desktop == nullptr) {
		fail("This build has no window, as it lacks the module desktop. Use --headless, or build ",
				"with module_desktop_enabled=yes.");
	} else {
		const RenderResult result = desktop->run_in_window(*scene, size_px, options, p_common);
		write_outputs(result, size_px);
	}
}

} // namespace

void add_run_command(CLI::App &r_app, CommonOptions &r_common) {
	CLI::App *command = r_app.add_subcommand("run",
			"Shows a scene: W A S D Q E and the right "
			"mouse button fly, T changes the technique");
	add_path_option(*command, "scene", options.scene, "A project's folder, or a .gltf or .glb file")
			->required();
	CLI::Option *headless =
			command->add_flag("--headless", options.is_headless, "Renders without a window");
	command->add_option("--frames", options.frame_count,
				   "Ends after this many frames; default: no limit, headless: 1")
			->check(CLI::Range(1u, 1000000u));
	add_path_option(*command, "--capture", options.capture, "Writes the last frame as a PNG");
	command->add_option("--size", options.size, "Default: the project's, else 512x512");
	command->add_option("--antialiasing", options.antialiasing,
				   "Supersampling: draws the image this many times as wide and high, then "
				   "averages; default: the project's, else 2")
			->check(CLI::Range(1u, MAX_ANTIALIASING));
	command->add_option("--camera", options.camera, "Default: the first");
	add_stage_option(*command, r_common);
	add_animation_options(*command, r_common);
	command->add_option("--speed", speed,
				   "How fast the animation plays: 1 as it was made, 0 not at all, below 0 "
				   "backwards")
			->check(CLI::Range(-1000.0, 1000.0));
	command->add_option("--technique", options.technique, "Replaces that of every light");
	command->add_option("--debug-view", options.debug_view,
			"Shows an intermediate image of the first light that casts a shadow: mask, map, ...");
	if (RunPartRegistry::find(MASKS_PART) != nullptr) {
		add_path_option(*command, "--reference,--truth", reference_path,
				"Reference mask of the first light that casts a shadow, an .exr of `gnomon "
				"visibility`; enables "
				"--debug-view error");
		CLI::Option *time = add_path_option(*command, "--time", options.time_path,
				"Writes the times of 20 frames after 5 to warm up as JSON")
									->needs(headless);
		CLI::Option *still =
				command->add_flag("--still", options.is_still,
							   "--time measures frames in which nothing moves, so that techniques "
							   "reuse their caches")
						->needs(time);
		command->add_flag("--playing", options.is_playing,
					   "--time measures whole frames in which the animation plays and techniques "
					   "reuse their caches, as in a window")
				->needs(time)
				->excludes(still);
	}
	command->add_flag("--skip-nothing,--leave-out-nothing", options.skips_nothing,
				   "Also runs passes that the image does not need (for comparison)")
			->needs(headless);
	command->add_option("--set", options.settings,
				   "light.NAME.property=value or technique.ID.NAME=value; repeatable")
			->take_all()
			->allow_extra_args(false);
	command->add_flag("--plan", options.prints_plan, "Prints what ran and what was skipped");
	add_path_option(*command, "--dot", options.dot, "Writes the frame's graph for Graphviz");
	command->add_option("--device", r_common.device, "Index or part of the name");
	command->add_flag("--validation", r_common.validation, "Validation layers on");
	command->callback([&r_common] { run(r_common); });
}

} // namespace gnomon
