#pragma once

#include "modules/shadows/light_limits.h"
#include "modules/shadows/mask_filter.h"
#include "modules/shadows/mesh_store.h"
#include "modules/shadows/shadow_registry.h"
#include "modules/shadows/visible_receivers.h"

#include <map>
#include <memory>
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
	/// Destroys all techniques and their caches, for example after shaders were replaced.
	void clear_caches() { slots.clear(); }

private:
	friend class ShadowFrame;
	/// The technique of one light, or of one group of the light's translucent casters.
	struct Slot {
		std::string technique_id;
		std::unique_ptr<ShadowTechnique> technique;
		LightLimits limits;
		uint64_t last_frame = 0; // the last frame that used the slot
	};
	/// The light's name, and 0 for its opaque casters or 1 + i for its group i of translucent ones.
	using SlotKey = std::pair<std::string, size_t>;
	Slot &get_slot(const SlotKey &p_key, const ShadowTechniqueInfo &p_info);
	void warn_once(const std::string &p_warning); // does nothing when p_warning is empty
	/// Warns only once per key, even when the text differs.
	void warn_once(const std::string &p_key, const std::string &p_warning);
	/// Drops the techniques of lights that no longer exist or that were unused for
	/// MAX_UNUSED_FRAMES frames, and all techniques or filters when their registry changed. Warns
	/// about a scene size that does not fit. Called once a frame.
	void begin_frame(const SceneSnapshot &p_scene);

	RenderingDevice &device;
	std::shared_ptr<MeshStore> meshes;
	std::map<SlotKey, Slot> slots;
	std::vector<std::unique_ptr<MaskFilter>> filters; // in the registry's order
	std::set<std::string> warned;					  // keys of the warnings that were logged
	uint64_t frame = 0;
	// Registry::get_revision() for which slots and filters were made.
	uint64_t technique_revision = 0;
	uint64_t filter_revision = 0;
};

} // namespace gnomon
