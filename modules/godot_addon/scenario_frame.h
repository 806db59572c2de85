#pragma once

#include "modules/godot_addon/detail_levels.h"
#include "modules/godot_addon/shadow_node.h"
#include "modules/scene/scene_snapshot.h"

#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// What materials know of a light: a row of their table, see gnomon.gdshaderinc.
struct ReceiverLight {
	uint32_t row = 0;	// 1 to RECEIVER_ROW_COUNT - 1
	float specular = 0; // of the stand-in: ends with the row
	int32_t mask = -1;	// the layer; -1: none
	float mask_opacity = 1;
	float size_m = 0; // 0 for directional lights
	bool has_godot_shadow = false;
	glm::dvec3 position_world = glm::dvec3(0.0);
	glm::dvec3 direction_world = glm::dvec3(0.0); // in which it shines
	float range_m = 1;
	float distance_exponent = 1;
	float cone_cosine = -1; // -1: no spot light
	float cone_exponent = 1;
};

/// What the main thread hands to the render thread of one world (a scenario of Godot's
/// RenderingServer), new in each frame. Never changes once handed over.
struct ScenarioFrame {
	uint64_t number = 0;						// counts Godot's frames
	std::shared_ptr<const SceneSnapshot> scene; // its camera is each view's own
	std::vector<InstanceDetail> details;
	std::vector<ViewDetail> views;
	std::vector<ReceiverLight> receiver_lights;
	float mask_scale = 1;				// pixels of a mask to those of the view, along each side
	std::set<std::string> shown_lights; // whose masks are drawn over the image
	std::vector<std::shared_ptr<MaskRequest>> requests;
};

/// Where it is handed over.
class ScenarioFrameSlot {
public:
	void set(std::shared_ptr<const ScenarioFrame> p_frame) {
		const std::lock_guard lock(mutex);
		frame = std::move(p_frame);
	}
	/// Null: nothing was handed over yet.
	std::shared_ptr<const ScenarioFrame> get() const {
		const std::lock_guard lock(mutex);
		return frame;
	}

private:
	mutable std::mutex mutex;
	std::shared_ptr<const ScenarioFrame> frame;
};

} // namespace gnomon
