// Declares the members of nodes, meshes and cameras that are properties, and copies nodes.

#include "modules/core/error.h"
#include "modules/scene/mesh_rig.h"
#include "modules/scene/node_members.h"
#include "modules/scene/skin_transforms.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/euler_angles.hpp>

#include <algorithm>
#include <cmath>
#include <typeinfo>

namespace gnomon {

namespace {

const char POSITION_HINT[] = "-10000,10000,0.01";

/// A transform as the product position * rotation * scale = parent_from_node. A shear is lost.
/// The rotation is in degrees about y, then x, then z, as in Godot.
struct TransformComponents {
	glm::dvec3 position = glm::dvec3(0.0);
	glm::dvec3 rotation_deg = glm::dvec3(0.0);
	glm::dvec3 scale = glm::dvec3(1.0);

	explicit TransformComponents(const Node3D &p_node) : position(p_node.parent_from_node[3]) {
		glm::dmat3 axes(p_node.parent_from_node);
		for (int axis = 0; axis < 3; ++axis) {
			scale[axis] = glm::length(axes[axis]);
		}
		scale.x *= glm::determinant(axes) < 0 ? -1.0 : 1.0;
		for (int axis = 0; axis < 3; ++axis) {
			if (scale[axis] != 0) {
				axes[axis] /= scale[axis];
			}
		}
		for (int axis = 0; axis < 3; ++axis) {
			if (scale[axis] == 0) { // flat: the other two still give its rotation
				axes[axis] = glm::cross(axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
			}
		}
		if (!(std::abs(glm::determinant(axes) - 1.0) < 0.5)) {
			axes = glm::dmat3(1.0); // strongly sheared, or collapsed to a line or a point
		}
		double y = 0;
		double x = 0;
		double z = 0;
		glm::extractEulerAngleYXZ(glm::dmat4(axes), y, x, z);
		const double STEP_DEG = 1e-6; // floats in files give 1.5e-8 instead of 0: round that off
		const glm::dvec3 exact_deg = DEGREES_PER_RADIAN * glm::dvec3(x, y, z);
		rotation_deg = glm::round(exact_deg / STEP_DEG) * STEP_DEG + 0.0; // no -0
	}

	void apply(Node3D &r_node) const {
		const glm::dvec3 rotation_rad = rotation_deg / DEGREES_PER_RADIAN;
		r_node.parent_from_node = glm::scale(glm::translate(glm::dmat4(1.0), position) *
						glm::eulerAngleYXZ(rotation_rad.y, rotation_rad.x, rotation_rad.z),
				scale);
	}
};

template <glm::dvec3 TransformComponents::*COMPONENT>
PropertyValue read_component(const Node3D &p_node) {
	return TransformComponents(p_node).*COMPONENT;
}

template <glm::dvec3 TransformComponents::*COMPONENT>
void write_component(Node3D &r_node, const PropertyValue &p_value) {
	TransformComponents components(r_node);
	components.*COMPONENT = std::get<glm::dvec3>(p_value);
	components.apply(r_node);
}

PropertyValue read_position(const Node3D &p_node) {
	return glm::dvec3(p_node.parent_from_node[3]);
}

void write_position(Node3D &r_node, const PropertyValue &p_value) {
	r_node.parent_from_node[3] = glm::dvec4(std::get<glm::dvec3>(p_value), 1.0);
}

bool is_staged(const Node3D &p_node) {
	return p_node.is_staged;
}

std::vector<NodeField> make_node_fields() {
	return { { make_info("position", PropertyType::VECTOR3, glm::dvec3(0.0), POSITION_HINT,
					   "Position of the node in its parent.", "m", "Transform"),
					 &read_position, &write_position },
		{ make_info("rotation", PropertyType::VECTOR3, glm::dvec3(0.0), "-360,360,1",
				  "Rotation about y, then x, then z.", "deg", "Transform"),
				&read_component<&TransformComponents::rotation_deg>,
				&write_component<&TransformComponents::rotation_deg> },
		{ make_info("scale", PropertyType::VECTOR3, glm::dvec3(1.0), "-10000,10000,0.01",
				  "Size along each axis. 0 along one makes the node flat; along two, it vanishes.",
				  "", "Transform"),
				&read_component<&TransformComponents::scale>,
				&write_component<&TransformComponents::scale> },
		{ make_info("staged", PropertyType::BOOL, false, "",
				  "Added to show the scene, not read from its file, and not saved. Untick it to "
				  "save the node with the scene.",
				  "", "File"),
				&read_flag<Node3D, &Node3D::is_staged>, &write_flag<Node3D, &Node3D::is_staged>,
				&is_staged } };
}

std::vector<NodeField> make_mesh_fields() {
	std::vector<NodeField> fields = {
		{ make_info("cast_shadow", PropertyType::BOOL, true, "", "Whether the mesh casts shadows.",
				  "", "Shadow"),
				&read_flag<MeshInstance3D, &MeshInstance3D::casts_shadow>,
				&write_flag<MeshInstance3D, &MeshInstance3D::casts_shadow> },
		{ make_info("shadow_planar_receiver", PropertyType::BOOL, false, "",
				  "A flat mesh that planar shadows fall on.", "", "Shadow"),
				&read_flag<MeshInstance3D, &MeshInstance3D::is_planar_receiver>,
				&write_flag<MeshInstance3D, &MeshInstance3D::is_planar_receiver> }
	};
	for (NodeField &field : make_material_fields()) {
		fields.push_back(std::move(field));
	}
	return extend_node_fields(std::move(fields));
}

} // namespace

std::vector<NodeField> extend_node_fields(std::vector<NodeField> p_more) {
	std::vector<NodeField> fields = make_node_fields();
	std::move(p_more.begin(), p_more.end(), std::back_inserter(fields));
	return fields;
}

const std::vector<NodeField> &Node3D::get_fields() const {
	static const std::vector<NodeField> fields = make_node_fields();
	return fields;
}

std::unique_ptr<Node3D> Node3D::copy() const {
	return copy_as<Node3D>(*this);
}

void Node3D::assign(const Node3D &p_other) {
	GNOMON_ASSERT(typeid(*this) == typeid(p_other), get_class_name(), " is not a ",
			p_other.get_class_name());
	name = p_other.name;
	parent_from_node = p_other.parent_from_node;
	file_index = p_other.file_index;
	is_staged = p_other.is_staged;
}

const std::vector<NodeField> &MeshInstance3D::get_fields() const {
	static const std::vector<NodeField> fields = make_mesh_fields();
	return fields;
}

std::unique_ptr<Node3D> MeshInstance3D::copy() const {
	return copy_as<MeshInstance3D>(*this);
}

void MeshInstance3D::assign(const Node3D &p_other) {
	Node3D::assign(p_other);
	const MeshInstance3D &other = to<MeshInstance3D>(p_other);
	surfaces = other.surfaces;
	skin = other.skin;
	morph_weights = other.morph_weights;
	casts_shadow = other.casts_shadow;
	is_planar_receiver = other.is_planar_receiver;
}

Bounds MeshInstance3D::compute_bounds() const {
	Bounds bounds;
	WorldTransforms world_from_nodes;
	if (skin) {
		const Node3D *root = this;
		while (root->parent) {
			root = root->parent;
		}
		world_from_nodes = compute_world_transforms(*root);
	}
	const glm::dmat4 world_from_node = compute_world_from_node();
	for (const Surface &surface : surfaces) {
		if (!surface.mesh || surface.mesh->indices.empty()) {
			continue;
		}
		const SkinTransforms transforms =
				compute_surface_transforms(*this, *surface.mesh, world_from_node, world_from_nodes);
		const Bounds bounds_mesh = surface.mesh->attributes.rig
				? compute_deformed_bounds(*surface.mesh, transforms.joints, get_morph_weights())
				: surface.mesh->bounds_node;
		bounds.add(transform_bounds(bounds_mesh, transforms.world_from_mesh));
	}
	return bounds;
}

const std::vector<NodeField> &Camera3D::get_fields() const {
	static const std::vector<NodeField> fields =
			extend_node_fields({ { make_info("fov", PropertyType::FLOAT, 45.0, "1,179,0.1",
										   "Field of view from top to bottom.", "deg", "Camera"),
										 &read_degrees<Camera3D, &Camera3D::vertical_fov_rad>,
										 &write_degrees<Camera3D, &Camera3D::vertical_fov_rad> },
					{ make_info("near", PropertyType::FLOAT, 0.05, "0.0001,1000,0.001",
							  "Nothing nearer than this is drawn.", "m", "Camera"),
							&read_number<Camera3D, &Camera3D::near_m>,
							&write_number<Camera3D, &Camera3D::near_m> } });
	return fields;
}

std::unique_ptr<Node3D> Camera3D::copy() const {
	return copy_as<Camera3D>(*this);
}

void Camera3D::assign(const Node3D &p_other) {
	Node3D::assign(p_other);
	const Camera3D &other = to<Camera3D>(p_other);
	vertical_fov_rad = other.vertical_fov_rad;
	near_m = other.near_m;
}

} // namespace gnomon
