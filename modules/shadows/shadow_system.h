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

// All that a host needs to get shadow masks (doc/embedding.md).

namespace gnomon {

class ShadowFrame;

/// What one host caches from frame to frame: the techniques of its lights with their maps, and the
/// meshes' buffers. One for each camera that is drawn in turn, so that each finds its maps again;
/// they may share the meshes.
class ShadowSystem {
public:
	/// p_meshes: empty = of its own.
	explicit ShadowSystem(RenderingDevice &p_device, std::shared_ptr<MeshStore> p_meshes = {});

	RenderingDevice &get_device() { return device; }
	MeshStore &get_meshes() { return *meshes; }
	/// Of the light's mask of the last frame; see ShadowTechnique.
	float get_standard_error(const std::string &p_light_name) const;
	/// Techniques start again, as after shaders were replaced.
	void forget_cached() { slots.clear(); }

private:
	friend class ShadowFrame;
	/// Of one light, or of one group of its translucent casters.
	struct Slot {
		std::string technique_id;
		std::unique_ptr<ShadowTechnique> technique;
		LightLimits limits;
		uint64_t last_frame = 0; // in which it was used
	};
	/// Of a light: 0, and 1 + i for its group i of translucent casters.
	using SlotKey = std::pair<std::string, size_t>;
	Slot &get_slot(const SlotKey &p_key, const ShadowTechniqueInfo &p_info);
	void warn_once(const std::string &p_warning); // empty: nothing
	/// Not again for the same key, whatever the warning states.
	void warn_once(const std::string &p_key, const std::string &p_warning);
	/// Drops techniques of lights that are gone or were not used in many frames, and all when
	/// a registry changed. Once a frame.
	void begin_frame(const SceneSnapshot &p_scene);

	RenderingDevice &device;
	std::shared_ptr<MeshStore> meshes;
	std::map<SlotKey, Slot> slots;
	std::vector<std::unique_ptr<MaskFilter>> filters; // in the registry's order
	std::set<std::string> warned;
	uint64_t frame = 0;
	uint64_t technique_revision = 0;
	uint64_t filter_revision = 0;
};

} // namespace gnomon
