#include "modules/shadow_volume/volume_settings.h"

#include "modules/rendering_device/rendering_device.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

namespace {

const std::string GROUP = "Shadow volume";

} // namespace

void add_volume_settings(bool p_is_on_cpu, PropertyList &r_list) {
	r_list.add({ "method", PropertyType::ENUM, {}, "auto,z_pass,z_fail",
			"How volumes are counted: in front of what is seen, or behind it with caps; auto "
			"chooses for each caster. z_pass alone is wrong where the camera is in a shadow.",
			"", TEST_SETTINGS_GROUP });
	r_list.add({ "robust", PropertyType::ENUM, {}, "auto,always",
			"Which connected parts of a mesh get the shadow of each of their triangles: those that "
			"are open, not manifold or inside out, or all.",
			"", TEST_SETTINGS_GROUP });
	r_list.add({ "scissor", PropertyType::BOOL, true, "",
			"Draw each volume only where its shadow can be seen.", "", GROUP });
	if (!p_is_on_cpu) {
		r_list.add({ "extrusion", PropertyType::ENUM, {}, "auto,geometry_shader,compute",
				"How volumes are made: by a geometry shader, or by compute shaders and indirect "
				"draws; auto takes the first for meshes of up to 4096 triangles.",
				"", GROUP });
		r_list.add({ "culling", PropertyType::ENUM, {}, "auto,on,off",
				"Cull casters that others hide from the light; auto does so where it pays.", "",
				GROUP });
	}
}

void add_removed_volume_properties(const std::string &p_id, PropertyList &r_list) {
	for (const char *name : { "method", "robust", "scissor", "extrusion", "culling" }) {
		add_moved_setting(p_id, name, r_list);
	}
}

VolumeSettings read_volume_settings(bool p_is_on_cpu, const ShadowTechnique::Inputs &p_inputs) {
	const PropertyValues &values = p_inputs.settings;
	VolumeSettings settings;
	const std::string &stencil_method = read_choice(values, "method");
	if (stencil_method != "auto") {
		settings.stencil_method =
				stencil_method == "z_pass" ? StencilMethod::Z_PASS : StencilMethod::Z_FAIL;
	}
	settings.is_always_robust = read_choice(values, "robust") == "always";
	settings.has_scissor = read_switch(values, "scissor") && p_inputs.may_skip;
	if (p_is_on_cpu) {
		settings.extruder = VolumeExtruder::CPU;
	} else {
		const std::string &extrusion = read_choice(values, "extrusion");
		if (extrusion == "geometry_shader" && p_inputs.device.get_features().geometry_shader) {
			settings.extruder = VolumeExtruder::GEOMETRY_SHADER;
		} else if (extrusion != "auto") {
			settings.extruder = VolumeExtruder::COMPUTE;
		}
		const std::string &culling = read_choice(values, "culling");
		// With z-pass for all casters, volumes that contain the camera are counted wrong, hidden
		// casters' too: culling these would change the image.
		const bool may_be_wrong = settings.stencil_method == StencilMethod::Z_PASS;
		settings.culling = may_be_wrong ? CasterCulling::Mode::OFF
				: culling == "on"		? CasterCulling::Mode::ON
				: culling == "off"		? CasterCulling::Mode::OFF
										: CasterCulling::Mode::AUTO;
	}
	return settings;
}

} // namespace gnomon
