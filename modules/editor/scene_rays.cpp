#include "modules/editor/scene_rays.h"

#include "modules/core/error.h"
#include "modules/core/text.h"
#include "modules/scene/cut_mesh.h"
#include "modules/scene/mesh_pose.h"

#include <cmath>
#include <limits>

namespace gnomon {

void SceneRays::update_scene(const Scene &p_scene) {
	instances.clear();
	const WorldTransforms world_from_nodes = compute_world_transforms(*p_scene.root);
	for (MeshInstance3D *node : p_scene.find_nodes<MeshInstance3D>()) {
		const glm::dmat4 world_from_node = node->compute_world_from_node();
		for (const MeshInstance3D::Surface &surface : node->surfaces) {
			try {
				add_surface(*node, surface, world_from_node, world_from_nodes);
			} catch (const Error &) {
				// The pose is invalid. Drawing the scene fails too, and reports why.
			}
		}
	}
	std::map<uint64_t, std::unique_ptr<RayTree>> used_trees;
	for (const Instance &instance : instances) {
		if (std::unique_ptr<RayTree> &tree = trees[instance.mesh->id]) {
			used_trees[instance.mesh->id] = std::move(tree);
		}
	}
	trees = std::move(used_trees);
}

void SceneRays::add_surface(MeshInstance3D &r_node, const MeshInstance3D::Surface &p_surface,
		const glm::dmat4 &p_world_from_node, const WorldTransforms &p_world_from_nodes) {
	if (!p_surface.mesh) {
		return;
	}
	std::shared_ptr<const Mesh> mesh = get_cut_mesh(p_surface.mesh, p_surface.material).mesh;
	if (!mesh || mesh->bounds_node.is_empty()) {
		return;
	}
	SkinTransforms transforms = compute_surface_transforms(
			r_node, *p_surface.mesh, p_world_from_node, p_world_from_nodes);
	const double determinant = glm::determinant(transforms.world_from_mesh);
	if (!(std::abs(determinant) > 0.0 && std::isfinite(determinant))) {
		return;
	}
	if (p_surface.mesh->attributes.rig) {
		// The same posed mesh as in the scene's snapshot.
		mesh = r_node.get_pose_slot(p_surface.mesh)
					   ->make_pose(std::move(transforms.joints), r_node.get_morph_weights(),
							   text("Node \"", r_node.name, "\""))
					   ->get_mesh(mesh);
	}
	instances.push_back({ &r_node, mesh, transforms.world_from_mesh,
			glm::inverse(transforms.world_from_mesh),
			transform_bounds(mesh->bounds_node, transforms.world_from_mesh), r_node.casts_shadow });
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
