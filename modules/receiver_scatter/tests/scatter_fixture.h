#pragma once

#include "modules/shadows/tests/mask_fixture.h"

#include <memory>
#include <string>

namespace gnomon {

/// Makes a translucent material. p_scatter: s; p_distance_m: the scatter distance, 0: not given.
inline std::shared_ptr<const Material> make_translucent_material(
		float p_scatter, float p_distance_m) {
	auto material = std::make_shared<Material>();
	material->scatter = p_scatter;
	material->scatter_distance_m = p_distance_m;
	return material;
}

/// Returns the id of the default technique. Its shadow edges are sharp if the light has no size:
/// then all blur comes from the filter.
inline std::string get_sharp_technique() {
	return ShadowRegistry::find_default()->id;
}

} // namespace gnomon
