// Implements find_difference, which the tests of several files use.

#include "modules/gltf_scene/tests/gltf_test_files.h"

namespace gnomon {

namespace {

std::string compare_surfaces(const MeshInstance3D &p_first, const MeshInstance3D &p_second) {
	if (p_first.surfaces.size() != p_second.surfaces.size()) {
		return "surface count";
	}
	for (size_t index = 0; index < p_first.surfaces.size(); ++index) {
		const Mesh &mesh = *p_first.surfaces[index].mesh;
		const Mesh &other_mesh = *p_second.surfaces[index].mesh;
		const Material plain;
		const Material &material =
				p_first.surfaces[index].material ? *p_first.surfaces[index].material : plain;
		const Material &other =
				p_second.surfaces[index].material ? *p_second.surfaces[index].material : plain;
		if (mesh.name != other_mesh.name || mesh.positions_node != other_mesh.positions_node ||
				mesh.normals_node != other_mesh.normals_node ||
				mesh.indices != other_mesh.indices) {
			return "mesh " + mesh.name;
		}
		if (material.name != other.name || material.base_color != other.base_color ||
				material.emissive != other.emissive || material.metallic != other.metallic ||
				material.roughness != other.roughness || material.scatter != other.scatter ||
				material.scatter_distance_m != other.scatter_distance_m ||
				material.is_double_sided != other.is_double_sided) {
			return "material " + material.name;
		}
	}
	const bool is_same = p_first.casts_shadow == p_second.casts_shadow &&
			p_first.is_planar_receiver == p_second.is_planar_receiver;
	return is_same ? "" : "shadow flags";
}

std::string compare_lights(const Light3D &p_first, const Light3D &p_second) {
	const bool is_same = p_first.type == p_second.type && p_first.color == p_second.color &&
			p_first.intensity == p_second.intensity && p_first.range_m == p_second.range_m &&
			p_first.inner_cone_rad == p_second.inner_cone_rad &&
			p_first.outer_cone_rad == p_second.outer_cone_rad &&
			p_first.properties == p_second.properties;
	return is_same ? "" : "light";
}

std::string compare_nodes(const Node3D &p_first, const Node3D &p_second) {
	const std::string location = "node \"" + p_first.name + "\": ";
	if (typeid(p_first) != typeid(p_second) || p_first.name != p_second.name) {
		return location + "class or name, \"" + p_second.name + "\"";
	}
	// A rotation is written as a quaternion, which adds rounding errors.
	for (int column = 0; column < 4; ++column) {
		if (glm::length(p_first.parent_from_node[column] - p_second.parent_from_node[column]) >
				1e-12) {
			return location + "transform";
		}
	}
	std::string difference;
	if (const auto *instance = dynamic_cast<const MeshInstance3D *>(&p_first)) {
		difference = compare_surfaces(*instance, dynamic_cast<const MeshInstance3D &>(p_second));
	} else if (const auto *light = dynamic_cast<const Light3D *>(&p_first)) {
		difference = compare_lights(*light, dynamic_cast<const Light3D &>(p_second));
	} else if (const auto *camera = dynamic_cast<const Camera3D *>(&p_first)) {
		const auto &other = dynamic_cast<const Camera3D &>(p_second);
		difference =
				camera->vertical_fov_rad == other.vertical_fov_rad && camera->near_m == other.near_m
				? ""
				: "camera";
	}
	if (!difference.empty()) {
		return location + difference;
	}
	if (p_first.children.size() != p_second.children.size()) {
		return location + "child count";
	}
	for (size_t index = 0; index < p_first.children.size(); ++index) {
		difference = compare_nodes(*p_first.children[index], *p_second.children[index]);
		if (!difference.empty()) {
			return difference;
		}
	}
	return "";
}

} // namespace

std::string find_difference(const Scene &p_first, const Scene &p_second) {
	if (p_first.scene_size_m != p_second.scene_size_m) {
		return "scene size";
	}
	return compare_nodes(*p_first.root, *p_second.root);
}

} // namespace gnomon
