#pragma once

#include "modules/mesh_tools/ray_tree.h"
#include "modules/scene/nodes.h"
#include "modules/scene/skin_transforms.h"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace gnomon {

/// Casts rays in world space against what the scene's nodes draw, for picking and for the penumbra
/// lines.
class SceneRays {
public:
	/// One surface of a node.
	struct Instance {
		MeshInstance3D *node = nullptr;
		std::shared_ptr<const Mesh> mesh; // posed, without parts that alpha cuts out, see CutMesh
		/// The transform of the node; for a skinned mesh that of its mesh space, see
		/// SkinTransforms::world_from_mesh.
		glm::dmat4 world_from_node = glm::dmat4(1.0);
		glm::dmat4 node_from_world = glm::dmat4(1.0);
		Bounds bounds_world;
		bool casts_shadow = true;
	};
	struct Hit {
		double t = 0;						// distance, in units of the direction's length
		const Instance *instance = nullptr; // valid until the next update_scene
	};

	/// Updates the instances from the scene in its current pose. Nodes that are scaled to zero
	/// along an axis are skipped, because their transform has no inverse, and so are nodes with an
	/// invalid pose. Ray trees of unchanged meshes and poses are reused.
	void update_scene(const Scene &p_scene);
	const std::vector<Instance> &get_instances() const { return instances; }
	/// Returns the number of meshes that have a ray tree, which is built when a ray first reaches
	/// the mesh's bounds.
	size_t get_tree_count() const { return trees.size(); }
	/// Returns the nearest hit with t > p_begin, or nothing. p_ignored: instance that the ray
	/// passes through; null: none.
	std::optional<Hit> find_nearest(const glm::dvec3 &p_origin_world,
			const glm::dvec3 &p_direction_world, double p_begin = 0.0,
			const Instance *p_ignored = nullptr);

private:
	void add_surface(MeshInstance3D &r_node, const MeshInstance3D::Surface &p_surface,
			const glm::dmat4 &p_world_from_node, const WorldTransforms &p_world_from_nodes);

	std::vector<Instance> instances;
	std::map<uint64_t, std::unique_ptr<RayTree>> trees; // by Mesh::id
};

} // namespace gnomon
