#include "modules/animation_report/register_types.h"

#include "modules/animation_report/animation_part.h"

namespace gnomon {

void initialize_animation_report_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ReportPartRegistry::add({ ANIMATION_GROUP, std::make_shared<AnimationPart>() });
	}
}

void uninitialize_animation_report_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ReportPartRegistry::remove(ANIMATION_GROUP);
	}
}

} // namespace gnomon
