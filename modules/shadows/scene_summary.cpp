#include "modules/shadows/scene_summary.h"

#include "modules/core/files.h"

namespace gnomon {

namespace {

/// Hashes everything that the instance's shadow depends on.
uint64_t hash_caster(const InstanceSnapshot &p_instance) {
	uint64_t hash = p_instance.compute_hash(/*p_seed=*/1);
	hash = compute_value_hash(p_instance.caster_mesh->id, hash);
	return compute_value_hash(p_instance.caster_levels != nullptr, hash);
}

/// Adds what is in p_page.
void add(SceneSummary::Page &r_whole, const SceneSummary::Page &p_page) {
	if (p_page.largest_diagonal_m > r_whole.largest_diagonal_m) {
		r_whole.other_caster_bounds_world = r_whole.caster_bounds_world;
		r_whole.other_caster_bounds_world.add(p_page.other_caster_bounds_world);
		r_whole.largest_caster = p_page.largest_caster;
		r_whole.largest_diagonal_m = p_page.largest_diagonal_m;
	} else {
		r_whole.other_caster_bounds_world.add(p_page.caster_bounds_world);
	}
	r_whole.bounds_world.add(p_page.bounds_world);
	r_whole.caster_bounds_world.add(p_page.caster_bounds_world);
	r_whole.caster_triangle_count += p_page.caster_triangle_count;
	r_whole.posed_count += p_page.posed_count;
	r_whole.cut_block_count += p_page.cut_block_count;
	r_whole.has_translucent_casters |= p_page.has_translucent_casters;
	r_whole.may_scatter |= p_page.may_scatter;
}

} // namespace

SceneSummary::Page SceneSummary::derive_page(uint32_t p_page) {
	Page page;
	size_t index = p_page * SharedVector<InstanceSnapshot>::PAGE_SIZE;
	for (const InstanceSnapshot &instance : instances.get_page(p_page)) {
		Page one;
		one.bounds_world = instance.bounds_world;
		one.posed_count = instance.pose ? 1 : 0;
		one.may_scatter = instance.material->scatter > 0;
		if (instance.casts_shadow) {
			one.caster_bounds_world = instance.bounds_world;
			one.largest_caster = &instance;
			one.largest_diagonal_m = instance.bounds_world.get_diagonal();
			one.caster_triangle_count = instance.caster_mesh->get_triangle_count();
			one.cut_block_count = instance.cut_block_size_px > 0 ? 1 : 0;
			one.has_translucent_casters = instance.compute_transmittance() != glm::vec3(0.0f);
		}
		add(page, one);
		caster_hashes[index] = hash_caster(instance);
		casts_shadow[index] = instance.casts_shadow ? 1 : 0;
		++index;
	}
	return page;
}

void SceneSummary::update(const SharedVector<InstanceSnapshot> &p_instances) {
	const std::vector<uint32_t> changed = p_instances.find_changed_pages(instances);
	if (changed.empty() && p_instances.size() == instances.size()) {
		return;
	}
	instances = p_instances;
	pages.resize(instances.get_page_count());
	caster_hashes.resize(instances.size());
	casts_shadow.resize(instances.size());
	for (const uint32_t page : changed) {
		pages[page] = derive_page(page);
	}
	whole = {};
	for (const Page &page : pages) {
		add(whole, page);
	}
}

} // namespace gnomon
