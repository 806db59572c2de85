#pragma once

#include "modules/godot_addon/detail_levels.h"
#include "modules/godot_addon/shadow_node.h"
#include "modules/scene/scene_snapshot.h"

#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// A row of the table of lights that materials read, see gnomon.gdshaderinc.
struct ReceiverLight {
	uint32_t row = 0;	// 1 to RECEIVER_ROW_COUNT - 1
	float specular = 0; // of the light's StandInLight; its last bits are the row
	int32_t mask = -1;	// layer of its mask; -1: none
	float mask_opacity = 1;
	/// In metres. For a directional light 1 - the cosine of light_angular_distance: with a shadow,
	/// Godot lights surfaces as if the cosine to the light were larger by that.
	float size = 0;
	bool has_godot_shadow = false;
	bool is_directional = false;
	glm::dvec3 position_world = glm::dvec3(0.0);
	glm::dvec3 direction_world = glm::dvec3(0.0); // from the light
	float range_m = 1;
	float distance_exponent = 1;
	float cone_cosine = -1; // of the cone's half angle; -1: not a spot light
	float cone_exponent = 1;
	/// The shadow fades over this range of distances between camera and light, for omni and spot
	/// lights, or of depths in the view, for directional lights, and ends at its end. In metres;
	/// negative: it does not fade.
	float fade_begin_m = -1;
	float fade_end_m = -1;
};
/// Returns the factor of an omni or spot light's shadow by its distance from the camera; 0: it has
/// no shadow there.
float compute_shadow_fade(const ReceiverLight &p_light, const glm::dvec3 &p_camera_world);

/// What the main thread passes to the render thread in each frame about one world (a scenario of
/// Godot's RenderingServer). It does not change afterwards.
struct ScenarioFrame {
	uint64_t number = 0;						// counts Godot's frames
	std::shared_ptr<const SceneSnapshot> scene; // each view replaces its camera
	std::vector<InstanceDetail> details;
	std::vector<ViewDetail> views;
	std::vector<ReceiverLight> receiver_lights;
	float mask_scale = 1;	// mask width / view width
	bool has_faded = false; // see WorldReceivers::has_faded
	/// How many pipelines may be compiled for it, see GodotDevice::compile_only. Empty: all.
	std::optional<uint32_t> max_compilations;
	std::set<std::string> shown_lights; // lights whose masks are drawn over the image
	std::vector<std::shared_ptr<MaskRequest>> requests;
};

/// Passes ScenarioFrames from the main thread to the render thread.
class ScenarioFrameSlot {
public:
	void set(std::shared_ptr<const ScenarioFrame> p_frame) {
		const std::lock_guard lock(mutex);
		frame = std::move(p_frame);
	}
	/// Returns the frame that was set last; null: none was set yet.
	std::shared_ptr<const ScenarioFrame> get() const {
		const std::lock_guard lock(mutex);
		return frame;
	}

private:
	mutable std::mutex mutex;
	std::shared_ptr<const ScenarioFrame> frame;
};

} // namespace gnomon
