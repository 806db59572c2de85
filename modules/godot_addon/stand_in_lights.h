#pragma once

#include "modules/godot_addon/scenario_frame.h"

#include <array>
#include <map>
#include <span>

namespace gnomon {

/// A light of the RenderingServer that shines instead of a Light3D, with the same values but for
/// two: the last bits of its specular amount encode for materials which light it is, and its shadow
/// is Gnomon's. The node, its properties and the scene that is saved stay as they are. Main thread
/// only.
class StandInLight {
public:
	StandInLight(const godot::Light3D &p_node, godot::RID p_scenario);
	/// The node's own light shines again.
	~StandInLight();
	StandInLight(const StandInLight &) = delete;
	StandInLight &operator=(const StandInLight &) = delete;

	/// Once a frame. p_row: see ReceiverLight.
	void update(uint32_t p_row, bool p_has_godot_shadow);
	godot::RID get_scenario() const { return scenario; }
	/// Empty where it is gone or hidden, or in another world.
	godot::Light3D find_visible_node() const;

private:
	static const size_t PARAM_COUNT = size_t(godot::Light3D::PARAM_MAX);
	/// What a light of the RenderingServer has.
	struct Values {
		std::array<double, PARAM_COUNT> params = {};
		glm::vec4 color = glm::vec4(0.0f);
		bool has_shadow = false;
		bool is_negative = false;
		bool is_reversed = false; // its shadow's casters
		bool fades = false;
		double fade_begin_m = 0;
		double fade_shadow_m = 0;
		double fade_length_m = 0;
		int64_t cull_mask = 0;
		int64_t caster_mask = 0;
		int64_t layers = 0;
		int64_t bake_mode = 0;
		int64_t shadow_mode = 0; // of omni and directional lights
		int64_t sky_mode = 0;
		bool blends_splits = false;
		godot::RID projector;
		bool operator==(const Values &) const = default;
	};
	Values read() const;
	void apply(const Values &p_values) const;

	godot::RenderingServer server;
	uint64_t id; // of the node
	godot::Light3D node;
	godot::OmniLight3D omni; // those it is not are empty
	godot::DirectionalLight3D directional;
	godot::RID scenario;
	godot::RID light;
	godot::RID instance;
	Values applied;
	bool is_applied = false;
};

/// The specular amount that encodes a row for materials.
float tag_specular(float p_specular, uint32_t p_row);

/// A light whose stand-in is needed in a frame.
struct NeededStandIn {
	godot::Light3D node;
	int32_t mask = -1; // its layer; -1: Gnomon makes none
	bool needs_godot_shadow = true;
};

/// The stand-ins of all worlds. Main thread only.
class StandInLights {
public:
	/// Once a frame and world. p_others: the specular amounts of its other lights, which no row's
	/// may equal. Lights beyond RECEIVER_ROW_COUNT - 1 stay Godot's, with one warning.
	std::vector<ReceiverLight> update(godot::RID p_scenario,
			std::span<const NeededStandIn> p_needed, const std::set<float> &p_others);
	/// The nodes that shine through stand-ins in this world and are visible still. Queries of the
	/// RenderingServer find them no more, as their own lights are hidden.
	std::vector<godot::Light3D> find_nodes(godot::RID p_scenario) const;
	/// Those that were not updated in this frame end.
	void end_frame();

private:
	struct Entry {
		std::unique_ptr<StandInLight> light;
		uint32_t row = 0;
		bool is_used = false;
	};
	std::map<uint64_t, Entry> lights; // by the node's id
	bool has_warned = false;
};

} // namespace gnomon
