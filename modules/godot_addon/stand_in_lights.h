#pragma once

#include "modules/godot_addon/scenario_frame.h"

#include <array>
#include <map>
#include <span>

namespace gnomon {

/// A light of the RenderingServer that replaces that of a Light3D. Two of its values differ: the
/// last bits of its specular amount are its row in the table of lights, by which materials identify
/// it, and it has no Godot shadow where Gnomon's mask suffices. The node, its properties and the
/// saved scene do not change. Main thread only.
class StandInLight {
public:
	StandInLight(const godot::Light3D &p_node, godot::RID p_scenario);
	/// Shows the node's own light again.
	~StandInLight();
	StandInLight(const StandInLight &) = delete;
	StandInLight &operator=(const StandInLight &) = delete;

	/// Copies the node's values and hides its own light. Call once per frame. p_row: see
	/// ReceiverLight. p_has_godot_shadow: it also has Godot's shadow, if the node has one.
	void update(uint32_t p_row, bool p_has_godot_shadow);
	godot::RID get_scenario() const { return scenario; }
	/// Returns the node; empty if it was freed, is hidden or is in another world.
	godot::Light3D find_visible_node() const;

private:
	static const size_t PARAM_COUNT = size_t(godot::Light3D::PARAM_MAX);
	/// The values of a light of the RenderingServer.
	struct Values {
		std::array<double, PARAM_COUNT> params = {};
		glm::vec4 color = glm::vec4(0.0f);
		bool has_shadow = false;
		bool is_negative = false;
		bool reverses_cull_face = false; // shadow_reverse_cull_face
		bool fades = false;
		double fade_begin_m = 0;
		double fade_shadow_m = 0;
		double fade_length_m = 0;
		int64_t cull_mask = 0;
		int64_t caster_mask = 0;
		int64_t layers = 0;
		int64_t bake_mode = 0;
		int64_t shadow_mode = 0; // for omni and directional lights
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
	godot::OmniLight3D omni; // empty for other types
	godot::DirectionalLight3D directional;
	godot::RID scenario;
	godot::RID light;
	godot::RID instance;
	Values applied;
	bool is_applied = false;
};

/// Returns the specular amount with its last bits replaced by p_row, which is below
/// RECEIVER_ROW_COUNT.
float tag_specular(float p_specular, uint32_t p_row);

/// A light that needs a stand-in in a frame.
struct NeededStandIn {
	godot::Light3D node;
	int32_t mask = -1; // layer of its mask; -1: it has none
	/// True: surfaces or effects that do not read the mask need Godot's shadow.
	bool needs_godot_shadow = true;
};

/// The stand-ins of all worlds. Main thread only.
class StandInLights {
public:
	/// Updates the stand-ins of a world and returns their rows. Call once per frame and world.
	/// p_others: specular amounts of the world's other lights; a stand-in never gets one of them.
	/// At most RECEIVER_ROW_COUNT - 1 lights get stand-ins; if there are more, one warning is
	/// logged and the others keep Godot's shadows.
	std::vector<ReceiverLight> update(godot::RID p_scenario,
			std::span<const NeededStandIn> p_needed, const std::set<float> &p_others);
	/// Returns the visible nodes in this world that have a stand-in. Queries of the RenderingServer
	/// do not find them, because their own lights are hidden.
	std::vector<godot::Light3D> find_nodes(godot::RID p_scenario) const;
	/// Removes the stand-ins that were not updated in this frame.
	void end_frame();
	/// Removes all stand-ins.
	void clear() { lights.clear(); }

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
