#include "modules/scene/nodes.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/scene/mesh_pose.h"

#include <algorithm>
#include <atomic>

namespace gnomon {

namespace {

std::atomic<uint64_t> tree_revision = 1; // scenes are also loaded on other threads

} // namespace

Node3D::~Node3D() {
	++tree_revision;
}

uint64_t Node3D::get_tree_revision() {
	return tree_revision;
}

Node3D *Node3D::add_child(std::unique_ptr<Node3D> p_child) {
	return insert_child(std::move(p_child), children.size());
}

Node3D *Node3D::insert_child(std::unique_ptr<Node3D> p_child, size_t p_index) {
	GNOMON_ASSERT(p_child, "node ", name, " was given no child");
	GNOMON_ASSERT(!p_child->parent, "node ", p_child->name, " has a parent already");
	p_child->parent = this;
	++tree_revision;
	const size_t index = std::min(p_index, children.size());
	return children.insert(children.begin() + ptrdiff_t(index), std::move(p_child))->get();
}

std::unique_ptr<Node3D> Node3D::remove_child(const Node3D &p_child) {
	const auto found = std::find_if(children.begin(), children.end(),
			[&](const auto &p_one) { return p_one.get() == &p_child; });
	GNOMON_ASSERT(found != children.end(), "node ", name, " has no child ", p_child.name);
	std::unique_ptr<Node3D> child = std::move(*found);
	children.erase(found);
	child->parent = nullptr;
	++tree_revision;
	return child;
}

glm::dmat4 Node3D::compute_world_from_node() const {
	glm::dmat4 world_from_node = get_parent_from_node();
	for (const Node3D *ancestor = parent; ancestor; ancestor = ancestor->parent) {
		world_from_node = ancestor->get_parent_from_node() * world_from_node;
	}
	return world_from_node;
}

std::shared_ptr<PoseSlot> MeshInstance3D::get_pose_slot(
		const std::shared_ptr<const Mesh> &p_mesh) const {
	std::erase_if(pose_slots, [&](const auto &p_item) { // of removed surfaces
		return std::none_of(surfaces.begin(), surfaces.end(), [&](const Surface &p_surface) {
			return p_surface.mesh && p_surface.mesh->id == p_item.first;
		});
	});
	std::shared_ptr<PoseSlot> &slot = pose_slots[p_mesh->id];
	if (!slot) {
		slot = std::make_shared<PoseSlot>(p_mesh);
	}
	return slot;
}

void Scene::fail_unknown_node(const char *p_kind, const std::string &p_name,
		const std::vector<std::string> &p_names) const {
	const std::string subject = path.empty() ? "The scene" : "Scene \"" + path + "\"";
	if (p_names.empty()) {
		fail(subject, " has no ", p_kind, " \"", p_name, "\", and no other ", p_kind,
				". Add one to the scene.");
	}
	const size_t SHOWN_COUNT = 20; // enough to choose from; a scene can hold thousands
	std::string list;
	for (size_t index = 0; index < p_names.size() && index < SHOWN_COUNT; ++index) {
		list += (index == 0 ? "\"" : ", \"") + p_names[index] + "\"";
	}
	if (p_names.size() > SHOWN_COUNT) {
		list += text(" and ", p_names.size() - SHOWN_COUNT, " more");
	}
	fail(subject, " has no ", p_kind, " \"", p_name, "\". Name one of these: ", list, ".");
}

const char *get_light_type_name(LightType p_type) {
	static const char *const NAMES[] = { "omni", "spot", "directional" };
	return NAMES[static_cast<int>(p_type)];
}

const PropertyList &Light3D::get_property_list() {
	static const PropertyList list = [] {
		PropertyList made;
		made.add({ "light_size", PropertyType::FLOAT, 0.1, LENGTH_HINT,
				"Radius R of a point or spot light, the size of its luminous disc. 0 makes a point "
				"with a hard shadow; a directional light ignores it.",
				"m", "Light" });
		made.add({ "light_angular_distance", PropertyType::FLOAT, 0.5, "0,90,0.1",
				"Apparent diameter of a directional light in the sky (the sun: 0.5). 0 makes a "
				"hard shadow; point and spot lights ignore it.",
				"deg", "Light" });
		made.add({ "shadow_enabled", PropertyType::BOOL, true, "",
				"Whether objects hide this light. Off, it shines through them and costs no shadow "
				"pass.",
				"", "Shadow" });
		made.add({ "shadow_technique", PropertyType::STRING, "", "",
				"Id of the technique that computes the shadow. Empty means the default; one that "
				"is not in this build falls back with a warning and stays stored.",
				"", "Shadow" });
		made.add({ "penumbra_outer_width", PropertyType::FLOAT, -1.0, LENGTH_HINT,
				"Outer penumbra width r, how far the soft edge reaches out of the hard shadow. -1 "
				"derives it from the light's size as suits the technique; 0 disables the outer "
				"part.",
				"m", "Shadow", /*special=*/"-1", "derived" });
		made.add({ "penumbra_inner_width", PropertyType::FLOAT, -1.0, LENGTH_HINT,
				"Inner penumbra width t, how far the soft edge reaches into the hard shadow. -1 "
				"derives it from the light's size as suits the technique; 0 disables the inner "
				"part.",
				"m", "Shadow", /*special=*/"-1", "derived" });
		return made;
	}();
	return list;
}

} // namespace gnomon
