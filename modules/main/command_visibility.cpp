// The command `gnomon visibility`: writes the visibility mask of one light as an EXR, and its run
// time as JSON.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/path_option.h"
#include "modules/main/commands.h"
#include "modules/main/measure.h"
#include "modules/main/probe.h"
#include "modules/masks/mask_image.h"
#include "modules/masks/mask_png.h"
#include "modules/renderer/renderer.h"
#include "modules/shadows/shadow_registry.h"

#include <CLI/CLI.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

/// The options of `gnomon visibility`.
struct VisibilityOptions {
	fs::path scene;
	std::string technique;
	fs::path out;
	fs::path png;
	fs::path surfaces;
	std::string light;
	std::string camera;
	std::optional<std::string> size;
	std::vector<std::string> settings;
	uint32_t frame_count = 1;
	uint32_t timed_frame_count = MEASURED_FRAME_COUNT;
	std::vector<double> motion;
	std::optional<std::string> probe; // --probe: the pixel
	fs::path probe_path;			  // --probe-json: the file to write; empty: none
	fs::path time_path;				  // --time: the JSON file to write; empty: none
	bool prints_plan = false;
	bool skips_nothing = false;
	bool has_depth_only = false;
	bool is_still = false; // --still: the frames of --time may reuse caches
};

/// Inserts the frame number before the extension: mask.exr, 12 -> mask.0012.exr.
fs::path number_output(const fs::path &p_path, uint32_t p_index, bool p_is_numbered) {
	if (!p_is_numbered || p_path.empty()) {
		return p_path;
	}
	char number[16];
	std::snprintf(number, sizeof(number), ".%04u", p_index);
	fs::path name = p_path.stem();
	name += number;
	name += p_path.extension();
	return p_path.parent_path() / name;
}

/// Moves the light by an offset in world space, in metres.
void move_light(Light3D &r_light, const glm::dvec3 &p_offset_world) {
	const glm::dmat4 world_from_parent =
			r_light.parent ? r_light.parent->compute_world_from_node() : glm::dmat4(1.0);
	const glm::dmat4 parent_from_world = glm::inverse(world_from_parent);
	r_light.parent_from_node = parent_from_world * glm::translate(glm::dmat4(1.0), p_offset_world) *
			world_from_parent * r_light.parent_from_node;
}

void run_visibility(const VisibilityOptions &p_options, const CommonOptions &p_common) {
	const glm::uvec2 size_px = choose_size(p_options.size, p_options.scene);
	if (p_options.out.empty() && !p_options.probe) {
		throw UsageError("`gnomon visibility` needs --out MASK.exr, or --probe X,Y.");
	}
	check_image_name(
			"--out", p_options.out, ".exr", " --png FILE also writes the mask as a grey PNG.");
	check_image_name("--png", p_options.png, ".png");
	const std::optional<glm::uvec2> probed_pixel =
			p_options.probe ? parse_pixel(*p_options.probe, size_px) : std::nullopt;
	if (!p_options.surfaces.empty()) {
		check_writable(p_options.surfaces / "depth.f32");
	}
	for (const fs::path &path :
			{ p_options.out, p_options.png, p_options.time_path, p_options.probe_path }) {
		if (!path.empty()) {
			check_writable(path);
		}
	}
	const std::unique_ptr<Scene> scene = load_scene(p_options.scene, p_common, size_px);
	const bool moves = !p_options.motion.empty();
	std::vector<OutputFile> outputs = { { "--time", p_options.time_path },
		{ "--probe-json", p_options.probe_path } };
	for (uint32_t index = 0; index < (moves ? p_options.frame_count : 1u); ++index) {
		outputs.push_back({ "--out", number_output(p_options.out, index, moves) });
		outputs.push_back({ "--png", number_output(p_options.png, index, moves) });
	}
	for (const char *name : { "depth.f32", "normal.u32" }) {
		outputs.push_back({ "--surfaces",
				p_options.surfaces.empty() ? fs::path() : p_options.surfaces / name });
	}
	check_outputs(outputs);
	Light3D &light = choose_light(*scene, p_options.light);
	const Camera3D &camera = choose_camera(*scene, p_options.camera);
	for (const std::string &setting : p_options.settings) {
		apply_setting(*scene, &light, setting);
	}
	const std::unique_ptr<RenderingDevice> device = create_device(p_common);
	Renderer renderer(*device);
	RenderRequest request;
	request.size_px = size_px;
	request.technique_override = p_options.technique;
	request.mask_light = light.name;
	request.wants_mask = true;
	request.may_skip = !p_options.skips_nothing;
	request.has_depth_only = p_options.has_depth_only;
	request.wants_surfaces = !p_options.surfaces.empty();

	for (uint32_t index = 0; index < p_options.frame_count; ++index) {
		if (moves && index > 0) {
			move_light(light, { p_options.motion[0], p_options.motion[1], p_options.motion[2] });
		}
		request.scene = build_snapshot(*scene, camera);
		RenderResult result = renderer.render(request);
		if (!moves && index + 1 < p_options.frame_count) {
			continue;
		}
		const MaskImage mask = { size_px, std::move(result.visibility),
			std::move(result.receiver) };
		if (!p_options.out.empty()) {
			save_mask_exr(number_output(p_options.out, index, moves), mask);
		}
		if (std::all_of(mask.receiver.begin(), mask.receiver.end(),
					[](float p_receiver) { return p_receiver <= 0.0f; })) {
			log_warning("Light \"", light.name, "\" lights nothing that camera \"", camera.name,
					"\" sees: the mask has no receivers, and no error can be measured. Check ",
					"their positions and the light's range and cone.");
		}
		if (!p_options.png.empty()) {
			save_mask_png(number_output(p_options.png, index, moves), mask);
		}
		if (!p_options.surfaces.empty()) {
			save_file_atomically(p_options.surfaces / "depth.f32", result.depth_texels);
			save_file_atomically(p_options.surfaces / "normal.u32", result.normal_texels);
		}
		if (p_options.prints_plan) {
			std::printf("%s", result.plan.to_text().c_str());
		}
	}
	if (p_options.probe) {
		const ProbeEntry explanation = explain_pixel(renderer, request, probed_pixel);
		std::printf("%s", probe_to_text(explanation).c_str());
		if (!p_options.probe_path.empty()) {
			save_file_atomically(p_options.probe_path, probe_to_json(explanation).dump(2) + "\n");
		}
	}
	if (!p_options.time_path.empty()) {
		request.may_reuse = p_options.is_still;
		// The reference takes seconds per frame and is no real-time technique: one frame without
		// warm-up suffices.
		const bool is_reference = ShadowRegistry::get(p_options.technique).is_reference;
		save_file_atomically(p_options.time_path,
				measure_time(renderer, request,
						is_reference ? 0
									 : std::min(WARM_UP_FRAME_COUNT, p_options.timed_frame_count),
						is_reference ? 1 : p_options.timed_frame_count,
						/*p_build_snapshot=*/{}));
	}
}

} // namespace

void add_visibility_command(CLI::App &r_app, CommonOptions &r_common) {
	static VisibilityOptions options;
	CLI::App *command = r_app.add_subcommand(
			"visibility", "Writes one light's visibility mask, and its run time");
	add_path_option(*command, "scene", options.scene, "A .gltf or .glb file, or a project")
			->required();
	command->add_option("--technique", options.technique, "Its id; see `gnomon techniques`")
			->required();
	add_path_option(*command, "--out", options.out,
			"The EXR to write: channels Y and receiver. May be omitted with --probe");
	add_path_option(*command, "--png", options.png, "Also writes the mask as a grey PNG");
	CLI::Option *probe = command->add_option("--probe", options.probe,
			"X,Y, from 0,0 at the top left, or worst: prints how the visibility of that pixel "
			"came about");
	add_path_option(*command, "--probe-json", options.probe_path, "Also writes that as JSON")
			->needs(probe);
	add_stage_option(*command, r_common);
	add_animation_options(*command, r_common);
	command->add_option("--light", options.light, "Default: the first that casts shadows");
	command->add_option("--camera", options.camera, "Default: the first");
	command->add_option("--size", options.size, "Default: the project's, else 512x512");
	command->add_option("--set", options.settings,
				   "property=value of the light, or technique.ID.NAME=value; repeatable")
			->take_all()
			->allow_extra_args(false);
	command->add_option("--frames", options.frame_count,
				   "Frames to draw; the last is written (with --motion each)")
			->check(CLI::Range(1u, 100000u));
	command->add_option("--motion", options.motion,
				   "dx,dy,dz in metres a frame: moves the light, writes one EXR a frame")
			->delimiter(',')
			->expected(3);
	CLI::Option *time = add_path_option(*command, "--time", options.time_path,
			"Writes the times of 20 frames after 5 to warm up as JSON");
	command->add_option("--timed-frames", options.timed_frame_count,
				   "How many frames --time measures; default 20. Fewer are for tests of the "
				   "program")
			->check(CLI::Range(1u, 100000u));
	command->add_flag("--still", options.is_still,
				   "--time measures frames in which nothing moves, so that techniques reuse their "
				   "caches")
			->needs(time);
	command->add_flag("--plan", options.prints_plan, "Prints what ran and what was skipped");
	add_path_option(*command, "--surfaces", options.surfaces,
			"An existing folder: also writes the inputs of shadows, depth.f32 and normal.u32 (see "
			"doc/embedding.md)");
	command->add_flag("--depth-alone", options.has_depth_only,
			"Derives geometric normals from the depth, as for a host that provides none");
	command->add_flag("--skip-nothing,--leave-out-nothing", options.skips_nothing,
			"Also runs passes that the image does not need (for comparison)");
	command->add_option("--device", r_common.device, "Index or part of the name");
	command->add_flag("--validation", r_common.validation, "Validation layers on");
	command->callback([&r_common] { run_visibility(options, r_common); });
}

} // namespace gnomon
