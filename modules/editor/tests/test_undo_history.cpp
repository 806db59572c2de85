#include "modules/core/error.h"
#include "modules/editor/undo_history.h"
#include "modules/scene/node_properties.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// A light of intensity 1, the default, with a child; and a camera.
struct SmallTree {
	Node3D root;
	Light3D *light = nullptr;
	Node3D *child = nullptr;
	UndoHistory history;

	SmallTree() {
		light = static_cast<Light3D *>(root.add_child(std::make_unique<Light3D>()));
		light->name = "Lamp";
		child = light->add_child(std::make_unique<Node3D>());
		child->name = "Shade";
		root.add_child(std::make_unique<Camera3D>())->name = "Camera";
	}
	void set(double p_intensity, const char *p_key = "") {
		history.change(*light, "Set intensity", p_key,
				[&] { set_node_property(*light, "intensity", p_intensity); });
	}
};

} // namespace

TEST_CASE("[UndoHistory] changes are undone and redone one by one") {
	SmallTree tree;
	tree.set(2);
	tree.set(3);
	CHECK(tree.history.get_undo_name() == "Set intensity");
	CHECK(tree.history.undo() == tree.light);
	CHECK(tree.light->intensity == 2);
	tree.history.undo();
	CHECK(tree.light->intensity == 1);
	CHECK_FALSE(tree.history.can_undo());
	tree.history.redo();
	tree.history.redo();
	CHECK(tree.light->intensity == 3);
	CHECK_FALSE(tree.history.can_redo());
	tree.history.undo();
	tree.set(5); // discards the undone step
	CHECK_FALSE(tree.history.can_redo());
	CHECK(tree.light->children.size() == 1); // a state is restored without its children
}

TEST_CASE("[UndoHistory] a drag is one step until it ends") {
	SmallTree tree;
	for (int value = 2; value < 40; ++value) {
		tree.set(value, "intensity");
	}
	tree.history.close();
	tree.set(50, "intensity");
	tree.history.undo();
	CHECK(tree.light->intensity == 39);
	tree.history.undo();
	CHECK(tree.light->intensity == 1);
	CHECK_FALSE(tree.history.can_undo());
}

TEST_CASE("[UndoHistory] a change that has no effect or fails adds no step") {
	SmallTree tree;
	tree.set(1);
	CHECK_FALSE(tree.history.can_undo());
	CHECK_THROWS_AS(tree.history.change(*tree.light, "Two", "",
							[&] {
								tree.light->name = "Half done";
								set_node_property(*tree.light, "intensity", -1.0);
							}),
			Error);
	CHECK(tree.light->name == "Lamp");
	CHECK_FALSE(tree.history.can_undo());
}

TEST_CASE("[UndoHistory] undo and redo restore nodes at their position, with their descendants") {
	SmallTree tree;
	tree.history.remove(*tree.light, "Delete Lamp");
	CHECK(tree.root.children.size() == 1);
	tree.history.undo();
	REQUIRE(tree.root.children.size() == 2);
	CHECK(tree.root.children[0].get() == tree.light);
	CHECK(tree.light->children.at(0).get() == tree.child);
	auto added_node = std::make_unique<Light3D>();
	added_node->name = "Other";
	tree.history.add(tree.root, std::move(added_node), "Add Other");
	CHECK(tree.root.children.size() == 3);
	tree.history.undo();
	CHECK(tree.root.children.size() == 2);
	tree.history.redo();
	CHECK(tree.root.children[2]->name == "Other");
}

TEST_CASE("[UndoHistory] is_saved is true only in the state that was saved") {
	SmallTree tree;
	CHECK(tree.history.is_saved());
	tree.set(2, "intensity");
	CHECK_FALSE(tree.history.is_saved());
	tree.history.set_saved();
	tree.set(3, "intensity"); // the same drag goes on after the save
	CHECK_FALSE(tree.history.is_saved());
	tree.history.undo();
	CHECK_FALSE(tree.history.is_saved()); // the drag was one step
	tree.set(4);
	tree.history.set_saved();
	tree.history.undo();
	CHECK_FALSE(tree.history.is_saved());
	tree.history.redo();
	CHECK(tree.history.is_saved());
}

TEST_CASE("[UndoHistory] a change of the second material is a step, although properties show the "
		  "first") {
	auto grey = std::make_shared<Material>();
	auto shiny = std::make_shared<Material>();
	shiny->shading_model = ShadingModel::PHONG;
	MeshInstance3D node;
	node.surfaces = { { nullptr, grey }, { nullptr, shiny } };
	UndoHistory history;
	const std::string plain = get_shading_model_name(ShadingModel::METALLIC_ROUGHNESS);
	history.change(node, "Set", "", [&] { set_node_property(node, "shading_model", plain); });
	CHECK(node.surfaces[1].material->shading_model == ShadingModel::METALLIC_ROUGHNESS);
	REQUIRE(history.can_undo());
	CHECK_FALSE(history.is_saved());
	history.undo();
	CHECK(node.surfaces[1].material == shiny);
	CHECK(node.surfaces[0].material == grey);
	history.redo();
	history.change(node, "Again", "", [&] { set_node_property(node, "shading_model", plain); });
	CHECK_FALSE(history.can_redo());
	CHECK(history.get_undo_name() == "Set"); // the second change had no effect
}
