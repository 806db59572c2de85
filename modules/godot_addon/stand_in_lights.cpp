#include "modules/godot_addon/stand_in_lights.h"

#include "modules/core/log.h"
#include "modules/godot_addon/addon_settings.h"
#include "modules/godot_addon/scene_body.h"

#include "godot_addon/godot_addon_shared.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gnomon {

namespace {

using godot::RenderingServer;

const float MAX_FADE_START = 0.999f; // of directional_shadow_fade_start, as in Godot
const float MIN_SPECULAR = 1e-6f;	 // instead of 0, which with a row would be denormal

RenderingServer find_server() {
	return RenderingServer(godot::find_singleton("RenderingServer"));
}

/// Shows the node's own light, or hides it, whatever the node's visibility is.
void set_own_visible(
		const RenderingServer &p_server, const godot::Light3D &p_node, bool p_is_visible) {
	p_server.instance_set_visible(p_node.get_instance(), p_is_visible);
}

// The transfer functions of sRGB (IEC 61966-2-1).
glm::vec4 to_linear(const glm::vec4 &p_color) {
	const glm::vec4 curved = glm::pow((p_color + 0.055f) / 1.055f, glm::vec4(2.4f));
	return glm::mix(curved, p_color / 12.92f, glm::lessThan(p_color, glm::vec4(0.04045f)));
}

glm::vec4 to_srgb(const glm::vec4 &p_color) {
	const glm::vec4 curved = 1.055f * glm::pow(p_color, glm::vec4(1.0f / 2.4f)) - 0.055f;
	return glm::mix(curved, 12.92f * p_color, glm::lessThan(p_color, glm::vec4(0.0031308f)));
}

/// Returns 0 if no row is free.
uint32_t find_free_row(
		float p_specular, const std::set<uint32_t> &p_taken, const std::set<float> &p_others) {
	for (uint32_t row = 1; row < RECEIVER_ROW_COUNT; ++row) {
		if (!p_taken.contains(row) && !p_others.contains(tag_specular(p_specular, row))) {
			return row;
		}
	}
	return 0;
}

float get_param(const godot::Light3D &p_node, int64_t p_param) {
	return static_cast<float>(p_node.get_param(p_param));
}

ReceiverLight make_receiver_light(const NeededStandIn &p_needed, uint32_t p_row) {
	const godot::Light3D &node = p_needed.node;
	ReceiverLight light;
	light.row = p_row;
	light.specular = tag_specular(get_param(node, godot::Light3D::PARAM_SPECULAR), p_row);
	light.mask = p_needed.mask;
	light.mask_opacity = get_param(node, godot::Light3D::PARAM_SHADOW_OPACITY);
	light.has_godot_shadow = p_needed.needs_godot_shadow && node.has_shadow();
	if (godot::cast<godot::DirectionalLight3D>(node)) {
		light.is_directional = true;
		light.size = 1.0f - std::cos(glm::radians(get_param(node, godot::Light3D::PARAM_SIZE)));
		light.fade_end_m = get_param(node, godot::Light3D::PARAM_SHADOW_MAX_DISTANCE);
		light.fade_begin_m = light.fade_end_m *
				std::min(get_param(node, godot::Light3D::PARAM_SHADOW_FADE_START), MAX_FADE_START);
		return light;
	}
	if (node.is_distance_fade_enabled()) {
		light.fade_begin_m = static_cast<float>(node.get_distance_fade_shadow());
		light.fade_end_m = light.fade_begin_m + static_cast<float>(node.get_distance_fade_length());
	}
	const glm::dmat4 world_from_light = get_drawn_transform(node).to_matrix();
	light.size = get_param(node, godot::Light3D::PARAM_SIZE);
	light.position_world = glm::dvec3(world_from_light[3]);
	light.direction_world = -glm::normalize(glm::dvec3(world_from_light[2]));
	light.range_m = get_param(node, godot::Light3D::PARAM_RANGE);
	light.distance_exponent = get_param(node, godot::Light3D::PARAM_ATTENUATION);
	if (godot::cast<godot::SpotLight3D>(node)) {
		light.cone_cosine =
				std::cos(glm::radians(get_param(node, godot::Light3D::PARAM_SPOT_ANGLE)));
		light.cone_exponent = get_param(node, godot::Light3D::PARAM_SPOT_ATTENUATION);
	}
	return light;
}

} // namespace

float compute_shadow_fade(const ReceiverLight &p_light, const glm::dvec3 &p_camera_world) {
	if (p_light.fade_end_m < 0) {
		return 1;
	}
	const float distance_m =
			static_cast<float>(glm::distance(p_light.position_world, p_camera_world));
	if (distance_m <= p_light.fade_begin_m) {
		return 1;
	}
	return distance_m >= p_light.fade_end_m
			? 0.0f
			: 1.0f - glm::smoothstep(p_light.fade_begin_m, p_light.fade_end_m, distance_m);
}

float tag_specular(float p_specular, uint32_t p_row) {
	const uint32_t bits = std::bit_cast<uint32_t>(std::max(p_specular, MIN_SPECULAR));
	return std::bit_cast<float>((bits & ~uint32_t(RECEIVER_ROW_COUNT - 1)) | p_row);
}

StandInLight::StandInLight(const godot::Light3D &p_node, godot::RID p_scenario) :
		server(find_server()), id(godot::get_instance_id(p_node.get_object())), node(p_node),
		omni(godot::cast<godot::OmniLight3D>(p_node)),
		directional(godot::cast<godot::DirectionalLight3D>(p_node)), scenario(p_scenario) {
	light = directional ? server.directional_light_create()
			: omni		? server.omni_light_create()
						: server.spot_light_create();
	instance = server.instance_create2(light, scenario);
}

StandInLight::~StandInLight() {
	server.free_rid(instance);
	server.free_rid(light);
	if (godot::get_instance(id)) {
		set_own_visible(server, node, node.is_inside_tree() && node.is_visible_in_tree());
	}
}

godot::Light3D StandInLight::find_visible_node() const {
	if (!godot::get_instance(id) || !node.is_inside_tree() || !node.is_visible_in_tree()) {
		return {};
	}
	const godot::Ref<godot::World3D> world = node.get_world_3d();
	return world && world.get_scenario() == scenario ? node : godot::Light3D();
}

StandInLight::Values StandInLight::read() const {
	static const bool is_physical = uses_physical_light_units();
	Values values;
	for (size_t param = 0; param < PARAM_COUNT; ++param) {
		values.params[param] = node.get_param(int64_t(param));
	}
	values.color = node.get_color();
	if (is_physical) {
		values.color = to_srgb(to_linear(values.color) * to_linear(node.get_correlated_color()));
	}
	values.has_shadow = node.has_shadow();
	values.is_negative = node.is_negative();
	values.reverses_cull_face = node.get_shadow_reverse_cull_face();
	values.fades = node.is_distance_fade_enabled();
	values.fade_begin_m = node.get_distance_fade_begin();
	values.fade_shadow_m = node.get_distance_fade_shadow();
	values.fade_length_m = node.get_distance_fade_length();
	values.cull_mask = node.get_cull_mask();
	values.caster_mask = node.get_shadow_caster_mask();
	values.layers = node.get_layer_mask();
	values.bake_mode = node.get_bake_mode();
	if (omni) {
		values.shadow_mode = omni.get_shadow_mode();
	}
	if (directional) {
		values.shadow_mode = directional.get_shadow_mode();
		values.sky_mode = directional.get_sky_mode();
		values.blends_splits = directional.is_blend_splits_enabled();
	}
	if (const godot::Ref<godot::Texture2D> projector = node.get_projector()) {
		values.projector = projector.get_rid();
	}
	return values;
}

void StandInLight::apply(const Values &p_values) const {
	for (size_t param = 0; param < PARAM_COUNT; ++param) {
		if (!is_applied || p_values.params[param] != applied.params[param]) {
			server.light_set_param(light, int64_t(param), p_values.params[param]);
		}
	}
	server.light_set_color(light, p_values.color);
	server.light_set_shadow(light, p_values.has_shadow);
	server.light_set_negative(light, p_values.is_negative);
	server.light_set_reverse_cull_face_mode(light, p_values.reverses_cull_face);
	server.light_set_distance_fade(light, p_values.fades, p_values.fade_begin_m,
			p_values.fade_shadow_m, p_values.fade_length_m);
	server.light_set_cull_mask(light, p_values.cull_mask);
	server.light_set_shadow_caster_mask(light, p_values.caster_mask);
	server.light_set_bake_mode(light, p_values.bake_mode);
	server.light_set_projector(light, p_values.projector);
	server.instance_set_layer_mask(instance, p_values.layers);
	if (omni) {
		server.light_omni_set_shadow_mode(light, p_values.shadow_mode);
	}
	if (directional) {
		server.light_directional_set_shadow_mode(light, p_values.shadow_mode);
		server.light_directional_set_sky_mode(light, p_values.sky_mode);
		server.light_directional_set_blend_splits(light, p_values.blends_splits);
	}
}

void StandInLight::update(uint32_t p_row, bool p_has_godot_shadow) {
	Values values = read();
	const float specular = static_cast<float>(values.params[godot::Light3D::PARAM_SPECULAR]);
	values.params[godot::Light3D::PARAM_SPECULAR] = double(tag_specular(specular, p_row));
	values.has_shadow = values.has_shadow && p_has_godot_shadow;
	if (!is_applied || values != applied) {
		apply(values);
		applied = values;
		is_applied = true;
	}
	server.instance_set_transform(instance, get_drawn_transform(node));
	set_own_visible(server, node, /*p_is_visible=*/false); // again, as the node may have shown it
}

std::vector<ReceiverLight> StandInLights::update(godot::RID p_scenario,
		std::span<const NeededStandIn> p_needed, const std::set<float> &p_others) {
	// Stand-ins keep their rows. One that changed worlds, or whose specular amount another light
	// has, is replaced.
	std::set<uint32_t> taken;
	for (const NeededStandIn &needed : p_needed) {
		const auto found = lights.find(godot::get_instance_id(needed.node.get_object()));
		if (found == lights.end()) {
			continue;
		}
		Entry &entry = found->second;
		const float specular = get_param(needed.node, godot::Light3D::PARAM_SPECULAR);
		entry.is_used = entry.light->get_scenario() == p_scenario &&
				!p_others.contains(tag_specular(specular, entry.row)) &&
				taken.insert(entry.row).second;
		if (!entry.is_used) {
			lights.erase(found);
		}
	}
	std::vector<ReceiverLight> rows;
	for (const NeededStandIn &needed : p_needed) {
		Entry &entry = lights[godot::get_instance_id(needed.node.get_object())];
		if (!entry.light) {
			const float specular = get_param(needed.node, godot::Light3D::PARAM_SPECULAR);
			entry.row = find_free_row(specular, taken, p_others);
			if (entry.row == 0) {
				lights.erase(godot::get_instance_id(needed.node.get_object()));
				if (!std::exchange(has_warned, true)) {
					log_warning("A world has more than ", taken.size(), " lights with shadows of ",
							"Gnomon or a light_size. The rest of them keep Godot's shadows.");
				}
				continue;
			}
			taken.insert(entry.row);
			entry.light = std::make_unique<StandInLight>(needed.node, p_scenario);
			entry.is_used = true;
		}
		rows.push_back(make_receiver_light(needed, entry.row));
		entry.light->update(entry.row, rows.back().has_godot_shadow);
	}
	return rows;
}

std::vector<godot::Light3D> StandInLights::find_nodes(godot::RID p_scenario) const {
	std::vector<godot::Light3D> nodes;
	for (const auto &[id, entry] : lights) {
		const godot::Light3D node = entry.light->find_visible_node();
		if (node && entry.light->get_scenario() == p_scenario) {
			nodes.push_back(node);
		}
	}
	return nodes;
}

void StandInLights::end_frame() {
	std::erase_if(lights, [](const auto &p_entry) { return !p_entry.second.is_used; });
	for (auto &[id, entry] : lights) {
		entry.is_used = false;
	}
}

} // namespace gnomon
