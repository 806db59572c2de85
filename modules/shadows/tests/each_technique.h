// Helpers of tests that check requirements for every registered technique.

#pragma once

#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

namespace gnomon {

template <typename Function> void for_each_technique(Function p_function) {
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		CAPTURE(info.id);
		p_function(info);
	}
}

template <typename Function> void for_each_technique_and_type(Function p_function) {
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		for (LightType type : ALL_TYPES) {
			CAPTURE(get_light_type_name(type));
			p_function(p_info, type);
		}
	});
}

/// Sets properties that make a technique slow to cheap values (few reference rays, small maps), for
/// tests that do not check precision. Finds them by the ending of their names.
inline void use_cheap_settings(Light3D &r_light) {
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		for (const PropertyInfo &property :
				ShadowRegistry::get_light_properties(info.id).get_properties()) {
			if (property.name.ends_with("_samples")) {
				r_light.properties[property.name] = int64_t(64);
			} else if (property.name.ends_with("_count")) {
				r_light.properties[property.name] = int64_t(4);
			} else if (property.name.ends_with("_map_size")) {
				r_light.properties[property.name] = int64_t(256);
			}
		}
	}
}

} // namespace gnomon
