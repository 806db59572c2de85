#include "modules/mesh_tools/caster_counts.h"

#include "modules/mesh_tools/topology.h"

namespace gnomon {

CasterCounts count_casters(const SceneSnapshot &p_scene, const LightSnapshot *p_light) {
	const std::shared_ptr<const SceneSnapshot> selection =
			p_light ? p_scene.select_casters(*p_light) : nullptr;
	CasterCounts counts;
	for (const InstanceSnapshot &instance : (selection ? *selection : p_scene).instances) {
		if (instance.casts_shadow) {
			counts.triangle_count += instance.caster_mesh->get_triangle_count();
			counts.edge_count += get_topology(instance.caster_mesh)->edges.size();
		}
	}
	return counts;
}

} // namespace gnomon
