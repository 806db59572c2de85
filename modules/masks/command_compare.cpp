// `gnomon compare`: the metrics of TECHNIQUES.md section 0, as JSON.

#include "modules/masks/command_compare.h"

#include "modules/core/error.h"
#include "modules/masks/mask_image.h"
#include "modules/masks/mask_metrics.h"
#include "modules/masks/mask_png.h"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace gnomon {

namespace {

struct CompareOptions {
	std::string truth;
	std::string result;
	std::string heatmap;
};

} // namespace

void add_compare_command(CLI::App &r_app, CommonOptions & /*r_common*/) {
	static CompareOptions options;
	CLI::App *command = r_app.add_subcommand("compare", "How far a mask is from the truth");
	command->add_option("truth", options.truth, "EXR of the exact mask")->required();
	command->add_option("result", options.result, "EXR to measure")->required();
	command->add_option("--heatmap", options.heatmap,
			"Also writes a PNG of the signed error: blue too dark, red too light");
	command->callback([] {
		const MaskImage truth = load_mask_exr(options.truth);
		const MaskImage result = load_mask_exr(options.result);
		const MaskMetrics metrics =
				compute_mask_metrics(truth, result, options.truth, options.result);
		if (!options.heatmap.empty()) {
			save_error_png(options.heatmap, truth, result);
		}
		std::printf("%s\n", to_json(metrics).c_str());
	});
}

} // namespace gnomon
