#include "modules/stability_report/register_types.h"

#include "modules/stability_report/stability_part.h"

namespace gnomon {

void initialize_stability_report_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ReportPartRegistry::add({ STABILITY_GROUP, std::make_shared<StabilityPart>() });
	}
}

void uninitialize_stability_report_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ReportPartRegistry::remove(STABILITY_GROUP);
	}
}

} // namespace gnomon
