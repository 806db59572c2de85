// `gnomon compare`: prints the metrics of doc/glossary.md as JSON.

#include "modules/masks/command_compare.h"

#include "modules/core/error.h"
#include "modules/core/path_option.h"
#include "modules/masks/mask_image.h"
#include "modules/masks/mask_metrics.h"
#include "modules/masks/mask_png.h"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace gnomon {

namespace {

struct CompareOptions {
	std::filesystem::path reference;
	std::filesystem::path result;
	std::filesystem::path heatmap;
};

} // namespace

void add_compare_command(CLI::App &r_app, CommonOptions & /*r_common*/) {
	static CompareOptions options; // static: filled when the command line is parsed, later
	CLI::App *command = r_app.add_subcommand("compare", "Measures the error of a mask");
	add_path_option(*command, "reference_mask", options.reference, "EXR of the reference mask")
			->required();
	add_path_option(*command, "result", options.result, "EXR to measure")->required();
	add_path_option(*command, "--heatmap", options.heatmap,
			"Also writes a PNG of the signed error: blue too dark, red too light");
	command->callback([] {
		check_image_name("--heatmap", options.heatmap, ".png");
		const MaskImage reference = load_mask_exr(options.reference);
		const MaskImage result = load_mask_exr(options.result);
		const OutputFile heatmap = { "--heatmap", options.heatmap };
		check_outputs({ &heatmap, 1 });
		const MaskMetrics metrics = compute_mask_metrics(
				reference, result, options.reference.string(), options.result.string());
		if (!options.heatmap.empty()) {
			save_error_png(options.heatmap, reference, result);
		}
		std::printf("%s\n", to_json(metrics).c_str());
	});
}

} // namespace gnomon
