#include "modules/shadows/view_culling.h"

#include "modules/core/files.h"

#include <bit>

namespace gnomon {

namespace {

constexpr uint32_t PAGE_SIZE = SharedVector<InstanceSnapshot>::PAGE_SIZE;
static_assert(PAGE_SIZE <= 32, "ViewCulling::Page::seen has a bit for each instance of a page");

uint64_t hash_view(const LightView &p_view) {
	// Field by field: the struct has padding.
	uint64_t hash = compute_value_hash(p_view.view_from_world, /*p_seed=*/1);
	hash = compute_value_hash(p_view.half_extent, hash);
	hash = compute_value_hash(p_view.size_px, hash);
	hash = compute_value_hash(p_view.near_m, hash);
	return compute_value_hash(p_view.far_m, hash);
}

} // namespace

ViewCulling::Page ViewCulling::cull_page(uint32_t p_page, const SceneSummary &p_summary) const {
	Page page;
	uint32_t index = p_page * PAGE_SIZE;
	for (const InstanceSnapshot &instance : instances.get_page(p_page)) {
		if (casts[index] != 0 && (!may_cull || view.may_see(instance))) {
			page.seen |= 1u << index % PAGE_SIZE;
			page.hash = compute_value_hash(p_summary.get_caster_hashes()[index], page.hash);
		}
		++index;
	}
	return page;
}

CasterList ViewCulling::update(const SceneSnapshot &p_scene, const SceneSummary &p_summary,
		const CasterFlags &p_casts, const LightView &p_view, bool p_may_cull) {
	if (!(view == p_view) || may_cull != p_may_cull || casts != p_casts) {
		instances = {};
	}
	const std::vector<uint32_t> changed = p_scene.instances.find_changed_pages(instances);
	instances = p_scene.instances;
	casts = p_casts;
	view = p_view;
	may_cull = p_may_cull;
	pages.resize(instances.get_page_count());
	for (const uint32_t page : changed) {
		pages[page] = cull_page(page, p_summary);
	}
	CasterList list;
	list.content_hash = hash_view(view);
	list.instances.reserve(instances.size());
	for (uint32_t page = 0; page < pages.size(); ++page) {
		for (uint32_t seen = pages[page].seen; seen != 0; seen &= seen - 1) {
			list.instances.push_back(
					page * PAGE_SIZE + static_cast<uint32_t>(std::countr_zero(seen)));
		}
		list.content_hash = compute_value_hash(pages[page].hash, list.content_hash);
	}
	return list;
}

} // namespace gnomon
