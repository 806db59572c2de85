#include "modules/shadow_volume/cached_edges.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/shadows/mesh_store.h"

namespace gnomon {

namespace {

uint64_t compute_edges_key(
		const ShadowTechnique::Inputs &p_inputs, const SilhouetteCasters &p_casters) {
	uint64_t key = 1;
	for (const SilhouetteCaster &caster : p_casters.casters) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[caster.instance_index];
		key = compute_value_hash(instance.caster_mesh->id, key);
		key = compute_value_hash(instance.get_pose_hash(), key);
		key = compute_value_hash(caster.light_position_node, key);
		key = compute_value_hash(caster.vertices_per_edge, key);
	}
	return key;
}

} // namespace

void CachedEdges::plan(const ShadowTechnique::Inputs &p_inputs, const SilhouetteCasters &p_casters,
		bool p_are_all_drawn, TechniquePlan &r_plan) {
	last_key = key;
	key = 0;
	is_cached = is_unchanged = false;
	if (p_casters.casters.empty()) {
		return reset();
	}
	if (p_inputs.may_skip && p_inputs.may_reuse && p_are_all_drawn) {
		key = compute_edges_key(p_inputs, p_casters);
		is_cached = key == cached_key;
		is_unchanged = key == last_key;
	}
	const std::string pass = text("find edges, casters: ", p_casters.casters.size());
	if (is_cached) {
		r_plan.skip(pass, "cached: neither the light nor a caster moved");
	} else {
		r_plan.run(pass);
	}
}

void CachedEdges::reset() {
	list.reset();
	draws.reset();
	cached_key = 0;
}

SilhouetteLists CachedEdges::add_passes(RenderGraph &r_graph,
		const ShadowTechnique::Inputs &p_inputs, const SilhouetteCasters &p_casters,
		const DrawPredicates &p_predicates) {
	if (is_cached) {
		return { r_graph.import_buffer(list.get()), r_graph.import_buffer(draws.get()) };
	}
	reset();
	if (!is_unchanged) {
		return add_silhouette_passes(r_graph, p_inputs.device, p_casters, p_predicates);
	}
	const std::string light = " of " + p_inputs.light.name;
	list = OwnedBuffer(p_inputs.device,
			p_inputs.device.create_buffer({ "silhouette edges" + light,
					p_casters.edge_count * sizeof(uint32_t), BufferUsage::STORAGE }));
	draws = OwnedBuffer(p_inputs.device,
			p_inputs.device.create_buffer({ "silhouette draws" + light,
					p_casters.casters.size() * sizeof(shader::SilhouetteDraw),
					BufferUsage::STORAGE | BufferUsage::INDIRECT }));
	cached_key = key;
	const SilhouetteLists lists = { r_graph.import_buffer(list.get()),
		r_graph.import_buffer(draws.get()) };
	return add_silhouette_passes(r_graph, p_inputs.device, p_casters, p_predicates, lists);
}

} // namespace gnomon
