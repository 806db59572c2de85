#pragma once

#include "modules/shadows/tests/mask_fixture.h"

#include <memory>
#include <string>

namespace gnomon {

inline std::shared_ptr<const Material> make_wax(float p_scatter, float p_distance_m) {
	auto material = std::make_shared<Material>();
	material->scatter = p_scatter;
	material->scatter_distance_m = p_distance_m;
	return material;
}

/// A technique with sharp edges, so that all softness is the filter's.
inline std::string find_technique() {
	return ShadowRegistry::find_default()->id;
}

} // namespace gnomon
