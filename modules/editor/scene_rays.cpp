#include "modules/editor/scene_rays.h"

#include "modules/scene/cut_mesh.h"

#include <cmath>
#include <limits>

namespace gnomon {

void SceneRays::follow(const Scene &p_scene) {
	instances.clear();
	std::map<uint64_t, std::unique_ptr<RayTree>> used_trees;
	for (MeshInstance3D *node : p_scene.find_nodes<MeshInstance3D>()) {
		const glm::dmat4 world_from_node = node->compute_world_from_node();
		const double determinant = glm::determinant(world_from_node);
		if (!(std::abs(determinant) > 0.0 && std::isfinite(determinant))) {
			continue;
		}
		for (const MeshInstance3D::Surface &surface : node->surfaces) {
			const std::shared_ptr<const Mesh> mesh =
					get_cut_mesh(surface.mesh, surface.material).mesh;
			if (!mesh || mesh->bounds_node.is_empty()) {
				continue;
			}
			instances.push_back({ node, mesh, world_from_node, glm::inverse(world_from_node),
					transform_bounds(mesh->bounds_node, world_from_node), node->casts_shadow });
			if (std::unique_ptr<RayTree> &tree = trees[mesh->id]) {
				used_trees[mesh->id] = std::move(tree);
			}
		}
	}
	trees = std::move(used_trees);
}

std::optional<SceneRays::Hit> SceneRays::find_nearest(const glm::dvec3 &p_origin_world,
		const glm::dvec3 &p_direction_world, double p_begin, const Instance *p_ignored) {
	Hit nearest{ std::numeric_limits<double>::infinity(), nullptr };
	for (const Instance &instance : instances) {
		if (&instance == p_ignored ||
				!find_box_entry(instance.bounds_world, p_origin_world, p_direction_world, p_begin,
						nearest.t)) {
			continue;
		}
		std::unique_ptr<RayTree> &tree = trees[instance.mesh->id];
		if (!tree) {
			tree = std::make_unique<RayTree>(instance.mesh);
		}
		const glm::dvec3 origin(instance.node_from_world * glm::dvec4(p_origin_world, 1.0));
		const glm::dvec3 direction(instance.node_from_world * glm::dvec4(p_direction_world, 0.0));
		const std::optional<double> t = tree->find_nearest(origin, direction, p_begin);
		if (t && *t < nearest.t) {
			nearest = { *t, &instance };
		}
	}
	return nearest.instance != nullptr ? std::optional<Hit>(nearest) : std::nullopt;
}

} // namespace gnomon
