#pragma once

#include "modules/shadows/light_view.h"
#include "modules/shadows/scene_summary.h"
#include "modules/shadows/shadow_technique.h"

#include <vector>

namespace gnomon {

/// The casters that one light view may see. From frame to frame it culls again only those of the
/// pages of instances that have changed.
class ViewCulling {
public:
	/// p_summary: of p_scene. p_casts: by instance, whether it casts. p_may_cull: false = the list
	/// has all that cast. Leaves CasterList::has_receivers true.
	CasterList update(const SceneSnapshot &p_scene, const SceneSummary &p_summary,
			const CasterFlags &p_casts, const LightView &p_view, bool p_may_cull);

private:
	struct Page {
		uint32_t seen = 0; // bit i: the page's instance i
		uint64_t hash = 0;
	};
	Page cull_page(uint32_t p_page, const SceneSummary &p_summary) const;

	// Of the last update.
	SharedVector<InstanceSnapshot> instances;
	CasterFlags casts;
	LightView view;
	bool may_cull = false;
	std::vector<Page> pages;
};

} // namespace gnomon
