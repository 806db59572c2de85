#pragma once

#include "modules/core/property.h"
#include "modules/scene/material.h"
#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct Animation;
struct NodeField;
class PoseSlot;

/// A ring or disc that a viewport draws for a node, in its space without its scale, and what a
/// handle on it changes.
struct NodeGizmo {
	glm::dvec3 center = glm::dvec3(0.0);	 // in the node's own space
	glm::dvec3 axis_x = glm::dvec3(1, 0, 0); // of its plane
	glm::dvec3 axis_y = glm::dvec3(0, 1, 0);
	double radius_m = 0;
	bool is_filled = false;
	std::string property; // that the handle changes; empty: it has none
	double value = 0;	  // of that property now
	double value_per_m = 1;
};

/// A node of the scene tree. Transforms are double, so that a scene far from the origin loses
/// nothing before it is made relative to the camera.
class Node3D {
public:
	std::string name; // unique in its scene
	glm::dmat4 parent_from_node = glm::dmat4(1.0);
	/// Where an animation has the node now, instead of the above. Not saved, nor copied.
	std::optional<glm::dmat4> posed_parent_from_node;
	std::vector<std::unique_ptr<Node3D>> children;
	Node3D *parent = nullptr; // null at the root; set by add_child
	/// Index of this node in the file it came from, or -1. Saving uses it to keep what the program
	/// does not understand.
	int file_index = -1;
	/// Added to a file that lacks a camera or a light (stage.h); not saved.
	bool is_staged = false;

	virtual ~Node3D() = default;
	/// "Light3D", for the editor's tree.
	virtual const char *get_class_name() const { return "Node3D"; }
	/// Members that can be read and set by name, those of the base class first.
	virtual const std::vector<NodeField> &get_fields() const;
	/// Values that the class keeps by name in addition to its members; null: none.
	virtual PropertyValues *get_stored_properties() { return nullptr; }
	const PropertyValues *find_stored_properties() const {
		return const_cast<Node3D *>(this)->get_stored_properties();
	}
	/// Declares those of them that every node of the class has and that matter to this one.
	virtual void add_stored_properties(PropertyList & /*r_list*/) const {}
	/// Of what the node itself shows, in the world; empty: nothing.
	virtual Bounds compute_bounds() const { return {}; }
	/// What a viewport draws while the node is selected.
	virtual void add_gizmos(std::vector<NodeGizmo> & /*r_gizmos*/) const {}
	/// Another node of the same class and state, without parent and children.
	virtual std::unique_ptr<Node3D> copy() const;
	/// Takes over the state of a node of the same class; parent and children stay.
	virtual void assign(const Node3D &p_other);
	/// Takes the child and sets its parent. Returns it.
	Node3D *add_child(std::unique_ptr<Node3D> p_child);
	/// As add_child, before the child at the index; at the end where there is none.
	Node3D *insert_child(std::unique_ptr<Node3D> p_child, size_t p_index);
	/// Takes a child out of the tree.
	std::unique_ptr<Node3D> remove_child(const Node3D &p_child);
	const glm::dmat4 &get_parent_from_node() const {
		return posed_parent_from_node ? *posed_parent_from_node : parent_from_node;
	}
	/// As posed.
	glm::dmat4 compute_world_from_node() const;
};

/// Joints, and what each takes to its own space. Nodes are named by Node3D::file_index: they are
/// found whatever the user calls them and wherever they hang.
struct Skin {
	std::vector<int> joints;
	std::vector<glm::dmat4> joint_from_mesh; // inverse bind matrices, one a joint
	/// The nearest node above all joints: as it moves, the mesh moves whole. -1: the world.
	int frame = -1;
};

/// One or more meshes with a transform; a mesh has one material.
class MeshInstance3D : public Node3D {
public:
	struct Surface {
		std::shared_ptr<const Mesh> mesh;
		std::shared_ptr<const Material> material;
	};
	std::vector<Surface> surfaces;
	std::shared_ptr<const Skin> skin; // of the surfaces that have joints; null: none has
	std::vector<float> morph_weights; // of the targets of each surface
	std::optional<std::vector<float>> posed_morph_weights; // by an animation; not saved, nor copied
	bool casts_shadow = true;
	bool is_planar_receiver = false; // extras.shadow_planar_receiver

	const std::vector<float> &get_morph_weights() const {
		return posed_morph_weights ? *posed_morph_weights : morph_weights;
	}
	/// The slot of a surface's mesh, which has a rig; made at the first call.
	std::shared_ptr<PoseSlot> get_pose_slot(const std::shared_ptr<const Mesh> &p_mesh) const;

	const char *get_class_name() const override { return "MeshInstance3D"; }
	Bounds compute_bounds() const override;
	const std::vector<NodeField> &get_fields() const override;
	std::unique_ptr<Node3D> copy() const override;
	void assign(const Node3D &p_other) override;

private:
	mutable std::map<uint64_t, std::shared_ptr<PoseSlot>> pose_slots; // by the mesh's id
};

enum class LightType { OMNI, SPOT, DIRECTIONAL };
/// "omni", "spot", "directional".
const char *get_light_type_name(LightType p_type);

/// What a light is, apart from its transform: its node, its file and a frame's snapshot hold one.
struct LightSettings {
	LightType type = LightType::OMNI;
	glm::vec3 color = glm::vec3(1.0f); // linear
	float intensity = 1.0f;			   // cd (omni, spot) or lx (directional)
	float range_m = 0.0f;			   // 0 = unlimited
	float inner_cone_rad = 0.0f;	   // half angles, 0 <= inner < outer <= pi/2
	float outer_cone_rad = 0.785398163f;
	/// Size, widths, technique (see Light3D::get_property_list) and what techniques and filters
	/// declare. Only what was set, also what nothing in this build declares: unknown properties
	/// survive a save untouched.
	PropertyValues properties;

	bool operator==(const LightSettings &) const = default;
};

/// A light of KHR_lights_punctual, which shines along -Z of its node, and its shadow.
class Light3D : public Node3D, public LightSettings {
public:
	/// Where the properties are in the file, for errors and for saving: "lights[0]". Empty =
	/// none.
	std::string file_path;

	const char *get_class_name() const override { return "Light3D"; }
	const std::vector<NodeField> &get_fields() const override;
	PropertyValues *get_stored_properties() override { return &properties; }
	void add_stored_properties(PropertyList &r_list) const override;
	/// Its true size: of a directional light, as a cone that a metre of distance opens.
	void add_gizmos(std::vector<NodeGizmo> &r_gizmos) const override;
	std::unique_ptr<Node3D> copy() const override;
	void assign(const Node3D &p_other) override;
	/// light_size, light_angular_distance, shadow_enabled, shadow_technique, penumbra_outer_width,
	/// penumbra_inner_width: what every technique must answer for (doc/scene_files.md).
	static const PropertyList &get_property_list();
};

/// A perspective camera, looking along -Z of its node with +Y up.
class Camera3D : public Node3D {
public:
	float vertical_fov_rad = 0.785398163f; // above 0, below pi
	float near_m = 0.05f;				   // above 0. The far plane is at infinity (reversed depth)

	const char *get_class_name() const override { return "Camera3D"; }
	const std::vector<NodeField> &get_fields() const override;
	std::unique_ptr<Node3D> copy() const override;
	void assign(const Node3D &p_other) override;
};

class SceneDocument; // what a file format keeps for saving; see gltf_scene

/// A tree of nodes and what belongs to the whole of it.
class Scene {
public:
	std::string path; // of the file it came from; empty for a generated one
	/// Other files that its content was read from.
	std::vector<std::filesystem::path> side_files;
	std::unique_ptr<Node3D> root = std::make_unique<Node3D>();
	/// S in metres (doc/glossary.md): extras.scene_size. 0 = the diagonal of the casters.
	double scene_size_m = 0;
	std::vector<std::shared_ptr<const Animation>> animations;
	std::shared_ptr<SceneDocument> document;

	/// Nodes of one class, in tree order.
	template <typename T> std::vector<T *> find_nodes() const {
		std::vector<T *> found;
		visit(*root, [&](Node3D &p_node) {
			if (T *node = dynamic_cast<T *>(&p_node)) {
				found.push_back(node);
			}
		});
		return found;
	}
	/// The node of that class and name. Absent: an Error that lists the names there are.
	template <typename T> T &find_node(const std::string &p_name, const char *p_kind) const {
		std::vector<std::string> names;
		for (T *node : find_nodes<T>()) {
			if (node->name == p_name) {
				return *node;
			}
			names.push_back(node->name);
		}
		fail_unknown_node(p_kind, p_name, names);
	}

private:
	template <typename Visitor> static void visit(Node3D &p_node, const Visitor &p_visitor) {
		p_visitor(p_node);
		for (const std::unique_ptr<Node3D> &child : p_node.children) {
			visit(*child, p_visitor);
		}
	}
	[[noreturn]] void fail_unknown_node(const char *p_kind, const std::string &p_name,
			const std::vector<std::string> &p_names) const;
};

class SceneDocument {
public:
	virtual ~SceneDocument() = default;
};

} // namespace gnomon
