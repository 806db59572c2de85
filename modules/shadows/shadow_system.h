#pragma once

#include "modules/scene/caster_selection.h"
#include "modules/shadows/light_limits.h"
#include "modules/shadows/mask_filter.h"
#include "modules/shadows/mesh_store.h"
#include "modules/shadows/scene_summary.h"
#include "modules/shadows/shadow_registry.h"
#include "modules/shadows/translucent_casters.h"
#include "modules/shadows/view_culling.h"
#include "modules/shadows/visible_receivers.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

// The interface for hosts that need shadow masks (doc/embedding.md).

namespace gnomon {

class ShadowFrame;

/// The state that a host keeps from frame to frame: the techniques of its lights with their maps,
/// and the meshes' buffers. A host that draws several cameras in turn needs one per camera, so that
/// the cached maps stay valid; these may share the meshes.
class ShadowSystem {
public:
	/// p_meshes: empty = creates its own store.
	explicit ShadowSystem(RenderingDevice &p_device, std::shared_ptr<MeshStore> p_meshes = {});

	RenderingDevice &get_device() { return device; }
	MeshStore &get_meshes() { return *meshes; }
	/// Standard error of the light's mask in the last frame, see ShadowTechnique.
	float get_standard_error(const std::string &p_light_name) const;
	/// Work that the light's technique counted for its opaque casters, see ShadowTechnique.
	std::vector<WorkCounter> get_counters(const std::string &p_light_name) const;
	/// Adds what the light's technique knows of a receiver of the last frame, whose option
	/// wants_explanation must have been true, see ShadowTechnique::explain.
	void explain(const std::string &p_light_name, const ProbedReceiver &p_receiver,
			ProbeEntry &r_explanation) const;
	/// Destroys all techniques and their caches, for example after shaders were replaced.
	void clear_caches() { slots.clear(); }

private:
	friend class ShadowFrame;
	// What a frame derives from its snapshot. A frame whose snapshot shares instances and lights
	// with that of the frame before (see FrameSnapshots) uses most of it again; one that shares
	// some pages of instances derives what belongs to the others.

	/// What does not depend on the camera.
	struct DerivedScene {
		/// From which it was derived. A copy, so that instances and lights that a host edits are
		/// others.
		std::optional<SceneSnapshot> scene;
		SceneSummary summary;
		std::vector<std::string> cut_out_lines; // of the plan
		uint64_t revision = 0;					// of this all
	};
	struct DerivedCamera {
		bool is_valid = false; // for this camera and size, and the DerivedScene
		uint64_t camera_hash = 0;
		glm::uvec2 size_px = glm::uvec2(0);
		SharedVector<InstanceSnapshot> instances; // of the scene
		double scene_size_m = 0;
		shader::FrameConstants constants = {};
		VisibleReceivers receivers; // all instances that the camera may see
		/// Those that each light may reach; lights of DerivedScene::scene.
		std::map<const LightSnapshot *, VisibleReceivers> lit_receivers;
	};
	/// Of one light; independent of the camera.
	struct DerivedLight {
		const LightSnapshot *light = nullptr; // of DerivedScene::scene; null: none
		uint64_t scene_revision = 0;		  // DerivedScene::revision
		CasterSelection casters;
		/// What `casters` returned, with the frame's camera; null: all casters of the scene.
		std::shared_ptr<const SceneSnapshot> selection;
		SceneSummary selection_summary; // unused without a selection
		TranslucentCasters translucent;

		const SceneSummary &get_summary(const DerivedScene &p_scene) const {
			return selection ? selection_summary : p_scene.summary;
		}
	};
	/// Of one run of a light's technique; depends on the camera.
	struct DerivedRun {
		const LightSnapshot *light = nullptr; // null: none
		bool may_skip = false;
		bool wants_debug_views = false;
		std::vector<LightView> views;
		std::vector<CasterList> casters; // of each view
		std::vector<ViewCulling> culling;
	};
	/// The technique of one light, or of one group of the light's translucent casters.
	struct Slot {
		std::string technique_id;
		std::unique_ptr<ShadowTechnique> technique;
		LightLimits limits;
		uint64_t last_frame = 0;	// the last frame that used the slot
		DerivedLight derived_light; // of the slot of the light's opaque casters
		DerivedRun derived_run;
	};
	/// The light's name, and 0 for its opaque casters or 1 + i for its group i of translucent ones.
	using SlotKey = std::pair<std::string, size_t>;
	Slot &get_slot(const SlotKey &p_key, const ShadowTechniqueInfo &p_info);
	void warn_once(const std::string &p_warning); // does nothing when p_warning is empty
	/// Warns only once per key, even when the text differs.
	void warn_once(const std::string &p_key, const std::string &p_warning);
	/// Drops the techniques of lights that no longer exist or that were unused for
	/// MAX_UNUSED_FRAMES frames, and all techniques or filters when their registry changed. Warns
	/// about a scene size that does not fit. Derives what has changed since the frame before.
	/// Called once a frame.
	void begin_frame(const SceneSnapshot &p_scene, glm::uvec2 p_size_px);

	void derive_scene(const SceneSnapshot &p_scene);
	void derive_camera(const SceneSnapshot &p_scene, glm::uvec2 p_size_px);
	const VisibleReceivers &derive_lit_receivers(const LightSnapshot &p_light);
	void derive_light(
			const SceneSnapshot &p_scene, const LightSnapshot &p_light, DerivedLight &r_light);

	RenderingDevice &device;
	std::shared_ptr<MeshStore> meshes;
	DerivedScene derived_scene;
	DerivedCamera derived_camera;
	std::map<SlotKey, Slot> slots;
	std::vector<std::unique_ptr<MaskFilter>> filters; // in the registry's order
	std::set<std::string> warned;					  // keys of the warnings that were logged
	uint64_t frame = 0;
	// Registry::get_revision() for which slots and filters were made.
	uint64_t technique_revision = 0;
	uint64_t filter_revision = 0;
};

} // namespace gnomon
