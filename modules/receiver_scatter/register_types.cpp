#include "modules/receiver_scatter/register_types.h"

#include "modules/receiver_scatter/dipole_spread.h"
#include "modules/receiver_scatter/receiver_scatter.h"
#include "modules/shadows/mask_filter.h"

namespace gnomon {

void initialize_receiver_scatter_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		MaskFilterRegistry::add({ "receiver_scatter", "Scatter in translucent receivers",
				"Wang, Xiao 2015; Jensen et al. 2001", "#5254a3",
				[] { return std::make_unique<ReceiverScatter>(); },
				std::make_shared<DipoleSpread>() });
	}
}

void uninitialize_receiver_scatter_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		MaskFilterRegistry::remove("receiver_scatter");
	}
}

} // namespace gnomon
