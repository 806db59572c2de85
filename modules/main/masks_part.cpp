// Registers the features that need the module masks: the command `visibility`, and --reference,
// --time and --still of `run`.

#include "modules/core/command_registry.h"
#include "modules/main/commands.h"
#include "modules/main/measure.h"
#include "modules/main/run_part.h"
#include "modules/masks/mask_image.h"

namespace gnomon {

namespace {

const char *const COMMAND = "visibility";

std::shared_ptr<const ReferenceMask> load_reference(const std::filesystem::path &p_path) {
	MaskImage image = load_mask_exr(p_path);
	return std::make_shared<ReferenceMask>(
			image.size_px, std::move(image.visibility), std::move(image.receiver));
}

} // namespace

void initialize_masks_part() {
	CommandRegistry::add({ COMMAND, &add_visibility_command });
	RunPartRegistry::add({ MASKS_PART, /*run_in_window=*/nullptr, &load_reference, &measure_time });
}

void uninitialize_masks_part() {
	RunPartRegistry::remove(MASKS_PART);
	CommandRegistry::remove(COMMAND);
}

} // namespace gnomon
