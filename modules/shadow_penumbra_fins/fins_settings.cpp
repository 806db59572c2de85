#include "modules/shadow_penumbra_fins/fins_settings.h"

#include "modules/rendering_device/rendering_device.h"
#include "modules/shadows/shadow_registry.h"

#include <algorithm>

namespace gnomon {

namespace {

// Beta, as a fraction of the scene size S, when the property is -1.
constexpr float DEFAULT_BETA_PER_SCENE_SIZE = 0.25f;
// From about this number of triangles in a view on, one pass is faster than three peels on a
// software driver: three peels are faster at 7,692 triangles, one pass is at 30,012
// (doc/benchmarks.md). Not measured on a GPU.
constexpr uint64_t ONE_PASS_MIN_TRIANGLES = 20000;

FinMethod choose_method(const std::string &p_choice, const DeviceFeatures &p_features) {
	// "auto" is compute: on a software driver it is faster from 7,692 triangles on, and takes about
	// as long at 1,996 (doc/benchmarks.md). Not measured on a GPU.
	return p_choice == "geometry_shader" && p_features.geometry_shader ? FinMethod::GEOMETRY_SHADER
																	   : FinMethod::COMPUTE;
}

} // namespace

void add_fins_properties(const std::string &p_id, bool p_has_inner_half, PropertyList &r_list) {
	const std::string group = p_has_inner_half ? "Penumbra fins" : "Outer fins";
	r_list.add({ p_id + "_map_size", PropertyType::INT, int64_t(1024), "16,8192,16",
			"Width and height of the depth layers and of the penumbra maps. Larger maps have finer "
			"edges and cost memory.",
			"px", group });
	if (p_has_inner_half) {
		r_list.add({ p_id + "_beta", PropertyType::FLOAT, -1.0, "0,10000,0.01",
				"How far behind the surface nearest to the light an inner fin may be; what is "
				"farther belongs to an edge that the light does not see. -1 means a quarter of the "
				"scene's size.",
				"m", group, /*special=*/"-1", "derived" });
		r_list.add({ p_id + "_layers", PropertyType::INT, int64_t(3), "1,3,1",
				"Depth layers peeled from the light. 2 skips the test of what is behind the "
				"inner penumbra, 1 also that of hidden inner fins.",
				"", group });
	}
	r_list.add({ p_id + "_curve", PropertyType::ENUM, {}, "sine,linear",
			"How the light falls off across the penumbra: in two smooth curves, or evenly.", "",
			group });
	if (p_has_inner_half) {
		add_moved_setting(p_id, "peeling", r_list);
	}
	add_moved_setting(p_id, "method", r_list);
}

void add_fins_settings(bool p_has_inner_half, PropertyList &r_list) {
	const std::string group = p_has_inner_half ? "Penumbra fins" : "Outer fins";
	if (p_has_inner_half) {
		r_list.add({ "peeling", PropertyType::ENUM, {}, "auto,passes,one_pass",
				"How the layers are found: one pass after the other, all in one pass with atomics, "
				"or whichever is faster here.",
				"", group });
	}
	r_list.add({ "method", PropertyType::ENUM, {}, "auto,geometry_shader,compute",
			"How silhouette edges and fins are made: by a geometry shader, by compute shaders and "
			"an indirect draw, or whichever is faster here.",
			"", group });
}

FinsSettings read_fins_view_settings(const std::string &p_id, bool p_has_inner_half,
		const LightSnapshot &p_light, const PropertyValues &p_properties) {
	FinsSettings settings;
	settings.has_inner_half = p_has_inner_half;
	settings.outer_width_m = p_light.penumbra_outer_width_m;
	settings.inner_width_m = p_has_inner_half ? p_light.penumbra_inner_width_m : 0.0f;
	settings.map_size_px = read_count(p_properties, p_id + "_map_size");
	return settings;
}

FinsSettings read_fins_settings(
		const std::string &p_id, bool p_has_inner_half, const ShadowTechnique::Inputs &p_inputs) {
	const PropertyValues &properties = p_inputs.properties;
	FinsSettings settings =
			read_fins_view_settings(p_id, p_has_inner_half, p_inputs.light, properties);
	settings.curve = read_choice(properties, p_id + "_curve") == "linear" ? FINS_CURVE_LINEAR
																		  : FINS_CURVE_SINE;
	settings.method =
			choose_method(read_choice(p_inputs.settings, "method"), p_inputs.device.get_features());
	if (p_has_inner_half) {
		const float beta_m = read_float(properties, p_id + "_beta");
		settings.beta_m = beta_m >= 0
				? beta_m
				: DEFAULT_BETA_PER_SCENE_SIZE * static_cast<float>(p_inputs.scene.scene_size_m);
		settings.layer_count = read_count(properties, p_id + "_layers");
		const std::string &peeling = read_choice(p_inputs.settings, "peeling");
		if (peeling != "auto") {
			settings.peeling = peeling == "passes" ? Peeling::PASSES : Peeling::ONE_PASS;
		}
	}
	return settings;
}

bool FinsSettings::gives_same_maps(const FinsSettings &p_other) const {
	return outer_width_m == p_other.outer_width_m && inner_width_m == p_other.inner_width_m &&
			beta_m == p_other.beta_m && map_size_px == p_other.map_size_px &&
			layer_count == p_other.layer_count && curve == p_other.curve &&
			has_inner_half == p_other.has_inner_half;
}

Peeling choose_peeling(const FinsSettings &p_settings, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index) {
	const DeviceFeatures &features = p_inputs.device.get_features();
	const uint64_t bytes = uint64_t(p_settings.map_size_px) * p_settings.map_size_px *
			sizeof(uint32_t) * p_settings.layer_count;
	const bool is_possible = features.fragment_stores && features.copies_to_textures &&
			p_settings.layer_count > 1 && bytes <= features.max_storage_buffer_bytes;
	if (!is_possible || p_settings.peeling) {
		return is_possible ? *p_settings.peeling : Peeling::PASSES;
	}
	uint64_t triangle_count = 0;
	for (uint32_t index : p_inputs.casters[p_view_index].instances) {
		triangle_count += p_inputs.scene.instances[index].caster_mesh->get_triangle_count();
	}
	return triangle_count >= ONE_PASS_MIN_TRIANGLES ? Peeling::ONE_PASS : Peeling::PASSES;
}

} // namespace gnomon
