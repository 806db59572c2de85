#pragma once

#include "modules/renderer/gbuffer.h"
#include "modules/renderer/light_limits.h"
#include "modules/renderer/mask_filter.h"
#include "modules/renderer/shadow_registry.h"
#include "modules/renderer/translucent_casters.h"

#include <map>
#include <memory>
#include <set>
#include <string>

namespace gnomon {

/// Which technique a light gets, and why another than it asks for.
struct TechniqueChoice {
	const ShadowTechniqueInfo *info = nullptr; // null: no shadow, v = 1
	std::string warning;					   // empty when the light gets what it asks for
};
/// p_override: an id that replaces every light's own; must exist when not empty.
TechniqueChoice choose_technique(const LightSnapshot &p_light, const std::string &p_override);

/// Makes and keeps the technique of each light, culls its casters, and calls its hooks in order.
class LightShadows {
public:
	LightShadows(RenderingDevice &p_device, MeshStore &p_meshes) :
			device(p_device), meshes(p_meshes) {}

	struct Request {
		const SceneSnapshot &scene;
		const LightSnapshot &light;
		const GBuffer &gbuffer;
		RGTexture receivers;
		RGBuffer frame;
		RGBuffer light_constants;
		glm::uvec2 size_px;
		std::string technique_override;
		bool may_leave_out = true;
		bool may_keep = true;
		bool wants_debug_views = false;
		VisibleReceivers lit_receivers = {}; // of the light
	};
	/// Records everything between the G-buffer and the lighting of one light. Returns its mask.
	/// r_debug_views: gets those that there are, when the request wants them.
	RGTexture add_passes(RenderGraph &r_graph, const Request &p_request, FramePlan &r_plan,
			std::vector<ShadowTechnique::DebugView> &r_debug_views);
	/// Drops techniques of lights that are gone or were not asked for in many frames, and all when
	/// a registry changed. Once a frame.
	void collect_garbage(const SceneSnapshot &p_scene);
	/// Of the light's mask of the last frame; see ShadowTechnique.
	float get_standard_error(const std::string &p_light_name) const;
	/// Forgets every technique and what it kept; after a frame that failed half-way.
	void drop_techniques() { slots.clear(); }

private:
	struct Slot {
		std::string technique_id;
		std::unique_ptr<ShadowTechnique> technique;
		LightLimits limits;
		/// Of the last frame, where casters are translucent: other than the frame's own.
		std::shared_ptr<const SceneSnapshot> scene;
		uint64_t last_frame = 0; // in which it was asked for
	};
	/// Of a light: 0, and 1 + i for its group i of translucent casters.
	using SlotKey = std::pair<std::string, size_t>;
	/// What the runs of one technique for one light share.
	struct Work;
	Slot &get_slot(const SlotKey &p_key, const ShadowTechniqueInfo &p_info);
	/// p_run: empty for the opaque casters, else the name of the translucent ones.
	RGTexture add_technique(const Work &p_work, ShadowTechnique &r_technique,
			const SceneSnapshot &p_scene, const std::string &p_run);
	RGTexture add_translucent_casters(
			const Work &p_work, const TranslucentCasters &p_casters, RGTexture p_opaque);
	void warn_once(const std::string &p_warning); // empty: nothing
	/// Not again for the same key, whatever the warning says.
	void warn_once(const std::string &p_key, const std::string &p_warning);
	/// p_is_exact: the mask is a reference's, which has done already what filters approximate.
	RGTexture add_filters(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			bool p_is_exact, RGTexture p_mask, TechniquePlan &r_plan);

	RenderingDevice &device;
	MeshStore &meshes;
	std::map<SlotKey, Slot> slots;
	std::vector<std::unique_ptr<MaskFilter>> filters; // in the registry's order
	std::set<std::string> warned;
	uint64_t frame = 0;
	uint64_t technique_revision = 0;
	uint64_t filter_revision = 0;
};

} // namespace gnomon
