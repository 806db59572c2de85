#pragma once

#include "modules/core/property.h"

#include <type_traits>

namespace gnomon {

/// A property's value as JSON: a vector is a list of three numbers.
template <typename Json> Json property_to_json(const PropertyValue &p_value) {
	return std::visit(
			[](const auto &p_held) {
				if constexpr (std::is_same_v<std::decay_t<decltype(p_held)>, glm::dvec3>) {
					return Json::array({ p_held.x, p_held.y, p_held.z });
				} else {
					return Json(p_held);
				}
			},
			p_value);
}

} // namespace gnomon
