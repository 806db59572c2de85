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

/// A ring or disc that a viewport draws for a node, in the node's space without its scale, and the
/// property that its handle changes.
struct NodeGizmo {
	glm::dvec3 center = glm::dvec3(0.0);	 // in the node's own space
	glm::dvec3 axis_x = glm::dvec3(1, 0, 0); // first axis of the gizmo's plane
	glm::dvec3 axis_y = glm::dvec3(0, 1, 0);
	double radius_m = 0;
	bool is_filled = false;
	std::string property;	// property that the handle changes; empty: no handle
	double value = 0;		// current value of that property
	double value_per_m = 1; // change of the property per metre of radius_m
};

/// A node of the scene tree. Transforms are double, so that a scene far from the origin keeps full
/// precision until it is made camera-relative.
class Node3D {
public:
	std::string name; // unique in its scene
	glm::dmat4 parent_from_node = glm::dmat4(1.0);
	/// Transform that an animation currently gives the node, instead of its own. Neither saved nor
	/// copied.
	std::optional<glm::dmat4> posed_parent_from_node;
	std::vector<std::unique_ptr<Node3D>> children;
	Node3D *parent = nullptr; // null at the root; set by add_child
	/// Index of this node in the source file, or -1. Saving uses it to preserve data that the
	/// program does not understand.
	int file_index = -1;
	/// True: stage_scene (stage.h) added the node, for example because the file lacks a camera or a
	/// light. Such nodes are saved only if a descendant is.
	bool is_staged = false;

	virtual ~Node3D();
	/// Returns the name of the class, such as "Light3D", for the editor's tree.
	virtual const char *get_class_name() const { return "Node3D"; }
	/// Members that can be read and set by name; those of the base class come first.
	virtual const std::vector<NodeField> &get_fields() const;
	/// Returns the values that the class stores by name in addition to its members; null: none.
	virtual PropertyValues *get_stored_properties() { return nullptr; }
	const PropertyValues *find_stored_properties() const {
		return const_cast<Node3D *>(this)->get_stored_properties();
	}
	/// Declares the stored properties that every node of the class has and that apply to this one.
	virtual void add_stored_properties(PropertyList & /*r_list*/) const {}
	/// Computes the world bounds of the node's own geometry, as posed; empty if it has none.
	virtual Bounds compute_bounds() const { return {}; }
	/// Appends what a viewport draws while the node is selected.
	virtual void add_gizmos(std::vector<NodeGizmo> & /*r_gizmos*/) const {}
	/// Returns a node of the same class and state, without parent and children.
	virtual std::unique_ptr<Node3D> copy() const;
	/// Copies the state of a node of the same class, but not its parent and children.
	virtual void assign(const Node3D &p_other);
	/// Takes ownership of a child, appends it, sets its parent and returns it.
	Node3D *add_child(std::unique_ptr<Node3D> p_child);
	/// Inserts a child before the one at the index; appends it if there is none.
	Node3D *insert_child(std::unique_ptr<Node3D> p_child, size_t p_index);
	/// Removes a child from the tree and returns it.
	std::unique_ptr<Node3D> remove_child(const Node3D &p_child);
	const glm::dmat4 &get_parent_from_node() const {
		return posed_parent_from_node ? *posed_parent_from_node : parent_from_node;
	}
	/// Computes the transform to the world, with the posed transforms.
	glm::dmat4 compute_world_from_node() const;
	/// Another value whenever a node of any tree was added, removed or destroyed. While it stays,
	/// pointers to nodes stay valid.
	static uint64_t get_tree_revision();
};

/// Joints, and their inverse bind matrices. Nodes are referenced by Node3D::file_index, so that
/// they are found even if the user renames or reparents them.
struct Skin {
	std::vector<int> joints;
	std::vector<glm::dmat4> joint_from_mesh; // inverse bind matrices, one per joint
	/// The closest common ancestor of all joints that is not a joint itself: when it moves, the
	/// mesh moves with it as a whole. Node3D::file_index; -1: the world.
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
	std::shared_ptr<const Skin> skin; // for the surfaces that have joints; null: none has
	std::vector<float> morph_weights; // morph target weights, for every surface
	/// Set by an animation; neither saved nor copied.
	std::optional<std::vector<float>> posed_morph_weights;
	bool casts_shadow = true;
	bool is_planar_receiver = false; // extras.shadow_planar_receiver

	const std::vector<float> &get_morph_weights() const {
		return posed_morph_weights ? *posed_morph_weights : morph_weights;
	}
	/// Returns the pose slot of a surface's mesh, which must have a rig; made at the first call.
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
/// Returns "omni", "spot" or "directional".
const char *get_light_type_name(LightType p_type);

/// The settings of a light without its transform: the base of Light3D and LightSnapshot, and what a
/// scene file stores of a light.
struct LightSettings {
	LightType type = LightType::OMNI;
	glm::vec3 color = glm::vec3(1.0f); // linear
	float intensity = 1.0f;			   // cd (omni, spot) or lx (directional)
	float range_m = 0.0f;			   // 0 = unlimited
	float inner_cone_rad = 0.0f;	   // half angles, 0 <= inner < outer <= pi/2
	float outer_cone_rad = 0.785398163f;
	/// Size, penumbra widths, technique (see Light3D::get_property_list) and the properties that
	/// techniques and filters declare. Contains only what was set, including properties that this
	/// build does not know: those are saved unchanged.
	PropertyValues properties;

	bool operator==(const LightSettings &) const = default;
};

/// A light of KHR_lights_punctual, which shines along -Z of its node, and its shadow.
class Light3D : public Node3D, public LightSettings {
public:
	/// JSON path of the properties in the file, for errors and for saving: "lights[0]". Empty:
	/// none.
	std::string file_path;

	const char *get_class_name() const override { return "Light3D"; }
	const std::vector<NodeField> &get_fields() const override;
	PropertyValues *get_stored_properties() override { return &properties; }
	void add_stored_properties(PropertyList &r_list) const override;
	/// Shows the light's true size; for a directional light, a ring at a distance of 1 m that spans
	/// its angular size.
	void add_gizmos(std::vector<NodeGizmo> &r_gizmos) const override;
	std::unique_ptr<Node3D> copy() const override;
	void assign(const Node3D &p_other) override;
	/// light_size, light_angular_distance, shadow_enabled, shadow_technique, penumbra_outer_width,
	/// penumbra_inner_width: the properties that every light has. A technique ignores those that it
	/// has no use for (doc/scene_files.md).
	static const PropertyList &get_property_list();
};

/// A perspective camera, looking along -Z of its node with +Y up.
class Camera3D : public Node3D {
public:
	float vertical_fov_rad = 0.785398163f; // pi / 4; above 0, below pi
	float near_m = 0.05f;				   // above 0. The far plane is at infinity (reversed depth)

	const char *get_class_name() const override { return "Camera3D"; }
	const std::vector<NodeField> &get_fields() const override;
	std::unique_ptr<Node3D> copy() const override;
	void assign(const Node3D &p_other) override;
};

class SceneDocument; // data that a file format keeps for saving; see gltf_scene

/// A tree of nodes and the data that belongs to the whole scene.
class Scene {
public:
	std::string path; // path of the source file; empty for a generated scene
	/// Other files that were read for its content, such as images.
	std::vector<std::filesystem::path> side_files;
	std::unique_ptr<Node3D> root = std::make_unique<Node3D>();
	/// S in metres (doc/glossary.md): extras.scene_size. 0 = the diagonal of the casters.
	double scene_size_m = 0;
	std::vector<std::shared_ptr<const Animation>> animations;
	std::shared_ptr<SceneDocument> document;

	/// Returns all nodes of a class, in tree order.
	template <typename T> std::vector<T *> find_nodes() const {
		std::vector<T *> found;
		visit(*root, [&](Node3D &p_node) {
			if (T *node = dynamic_cast<T *>(&p_node)) {
				found.push_back(node);
			}
		});
		return found;
	}
	/// Returns the node of that class and name. If it is absent: an Error that lists the existing
	/// names. p_kind: what the message calls the class, such as "light".
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
