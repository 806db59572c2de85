#pragma once

#include "modules/mesh_tools/ray_tree.h"
#include "modules/scene/nodes.h"
#include "modules/scene/skin_transforms.h"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace gnomon {

/// Casts rays against the visible scene in world space: for picking and for guides.
class SceneRays {
public:
	struct Instance {
		MeshInstance3D *node = nullptr;
		std::shared_ptr<const Mesh> mesh; // its visible part, see CutMesh; as posed
		/// For a skinned mesh: the transform from mesh space, see compute_skin_transforms.
		glm::dmat4 world_from_node = glm::dmat4(1.0);
		glm::dmat4 node_from_world = glm::dmat4(1.0);
		Bounds bounds_world;
		bool casts_shadow = true;
	};
	struct Hit {
		double t = 0; // in units of the ray's direction
		const Instance *instance = nullptr;
	};

	/// Updates from the scene as it is posed. Flattened nodes are skipped, because their transform
	/// has no inverse, and so are nodes with an invalid pose. Ray trees of unchanged meshes and
	/// poses are reused.
	void follow(const Scene &p_scene);
	const std::vector<Instance> &get_instances() const { return instances; }
	/// Returns the number of meshes that a ray has come near.
	size_t get_tree_count() const { return trees.size(); }
	/// Returns the nearest hit beyond p_begin, ignoring one instance.
	std::optional<Hit> find_nearest(const glm::dvec3 &p_origin_world,
			const glm::dvec3 &p_direction_world, double p_begin = 0.0,
			const Instance *p_ignored = nullptr);

private:
	void add_surface(MeshInstance3D &r_node, const MeshInstance3D::Surface &p_surface,
			const glm::dmat4 &p_world_from_node, const WorldTransforms &p_world_from_nodes);

	std::vector<Instance> instances;
	std::map<uint64_t, std::unique_ptr<RayTree>> trees; // by Mesh::id; null: no ray came near yet
};

} // namespace gnomon
