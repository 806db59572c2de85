#include "modules/shadow_volume/volume_settings.h"

#include "modules/rendering_device/rendering_device.h"

namespace gnomon {

namespace {

const std::string GROUP = "Shadow volume";

const std::string &read_choice(const PropertyValues &p_properties, const std::string &p_name) {
	return std::get<std::string>(p_properties.at(p_name));
}

} // namespace

void add_volume_properties(const std::string &p_id, bool p_is_on_cpu, PropertyList &r_list) {
	r_list.add({ p_id + "_method", PropertyType::ENUM, {}, "auto,z_pass,z_fail",
			"How volumes are counted: in front of what is seen, which is faster, or behind it, "
			"which needs caps and holds inside a shadow; auto chooses for each caster. z_pass "
			"alone is wrong where the camera is in a shadow.",
			"", GROUP });
	r_list.add({ p_id + "_robust", PropertyType::ENUM, {}, "auto,always",
			"Connected parts of a mesh that are open, not manifold or inside out have the shadow "
			"of "
			"each of their triangles; auto does that for those alone, always for all.",
			"", GROUP });
	r_list.add({ p_id + "_scissor", PropertyType::BOOL, true, "",
			"Draw each volume only where its shadow can be seen. The picture is the same.", "",
			GROUP });
	if (!p_is_on_cpu) {
		r_list.add({ p_id + "_extrusion", PropertyType::ENUM, {}, "auto,geometry_shader,compute",
				"How volumes are made: by a geometry shader, or by compute shaders and indirect "
				"draws; auto takes the first for meshes of up to 4096 triangles. The picture is "
				"the same.",
				"", GROUP });
		r_list.add({ p_id + "_culling", PropertyType::ENUM, {}, "auto,on,off",
				"Leave out casters that others hide from the light; auto does so where it pays. "
				"The picture is the same.",
				"", GROUP });
	}
}

VolumeSettings read_volume_settings(
		const std::string &p_id, bool p_is_on_cpu, const ShadowTechnique::Inputs &p_inputs) {
	const PropertyValues &properties = p_inputs.properties;
	VolumeSettings settings;
	const std::string &count = read_choice(properties, p_id + "_method");
	if (count != "auto") {
		settings.count = count == "z_pass" ? VolumeCount::Z_PASS : VolumeCount::Z_FAIL;
	}
	settings.is_always_robust = read_choice(properties, p_id + "_robust") == "always";
	settings.has_scissor =
			std::get<bool>(properties.at(p_id + "_scissor")) && p_inputs.may_leave_out;
	if (p_is_on_cpu) {
		settings.maker = VolumeMaker::CPU;
	} else {
		const std::string &extrusion = read_choice(properties, p_id + "_extrusion");
		if (extrusion == "geometry_shader" && p_inputs.device.get_features().geometry_shader) {
			settings.maker = VolumeMaker::GEOMETRY_SHADER;
		} else if (extrusion != "auto") {
			settings.maker = VolumeMaker::COMPUTE;
		}
		const std::string &culling = read_choice(properties, p_id + "_culling");
		// Counted in front alone, volumes are wrong where the camera is in a shadow, hidden ones
		// too.
		const bool may_be_wrong = settings.count == VolumeCount::Z_PASS;
		settings.culling = may_be_wrong ? CasterCulling::Wish::OFF
				: culling == "on"		? CasterCulling::Wish::ON
				: culling == "off"		? CasterCulling::Wish::OFF
										: CasterCulling::Wish::AUTO;
	}
	return settings;
}

} // namespace gnomon
