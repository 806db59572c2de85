#include "modules/editor/editor_document.h"
#include "modules/gltf_scene/tests/animated_test_file.h"
#include "modules/scene/node_properties.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

struct AnimatedProject : GltfTestFolder {
	Json json = make_animated(*this);

	AnimatedProject() {
		write("scene.gltf", json.dump());
		write("project.cfg", std::string("[project]\nstart_scene=\"scene.gltf\"\n"));
	}
};

struct AnimatedDocument : EditorDocument {
	explicit AnimatedDocument(const AnimatedProject &p_project) : EditorDocument(p_project.path) {}

	template <typename T = Node3D> T &find(const char *p_name) {
		return get_scene().find_node<T>(p_name, "node");
	}
	/// Returns the world X of the node Tip, which "Move" moves by 5 m/s; 0 at rest.
	double get_tip_x() { return find("Tip").compute_world_from_node()[3].x; }
};

} // namespace

TEST_CASE("[Timeline] a scene opens at rest, plays, pauses and seeks") {
	const AnimatedProject project;
	AnimatedDocument document(project);
	Timeline &timeline = document.get_timeline();
	CHECK(timeline.get_animation() == nullptr);
	CHECK_FALSE(timeline.is_playing());
	CHECK_FALSE(timeline.advance(1.0));
	timeline.seek(1.0); // without an animation
	CHECK(timeline.get_time_s() == 0);
	timeline.play(); // the first animation
	REQUIRE(timeline.get_animation() != nullptr);
	CHECK(timeline.get_animation()->name == "Move");
	CHECK(timeline.advance(0.5));
	CHECK(document.get_tip_x() == doctest::Approx(2.5));
	CHECK_FALSE(timeline.advance(0.0)); // no change of the pose
	timeline.pause();
	CHECK_FALSE(timeline.advance(0.5));
	CHECK(document.get_tip_x() == doctest::Approx(2.5));
	timeline.seek(1.5);
	CHECK(document.get_tip_x() == doctest::Approx(7.5));
	timeline.seek(99);
	CHECK(timeline.get_time_s() == 2);
	timeline.seek(-1);
	CHECK(timeline.get_time_s() == 0);
	timeline.seek(std::nan(""));
	CHECK(timeline.get_time_s() == 0);
	timeline.choose("");
	CHECK(document.get_tip_x() == 0);
	CHECK_FALSE(document.find("Tip").posed_parent_from_node);
	CHECK_FALSE(document.is_changed());
}

TEST_CASE("[Timeline] it loops, or pauses at its end and then plays from the other end") {
	const AnimatedProject project;
	AnimatedDocument document(project);
	Timeline &timeline = document.get_timeline();
	timeline.choose("Move");
	timeline.play();
	timeline.advance(2.5);
	CHECK(timeline.get_time_s() == doctest::Approx(0.5));
	timeline.set_loops(false);
	CHECK(timeline.advance(99));
	CHECK(timeline.get_time_s() == 2);
	CHECK_FALSE(timeline.is_playing());
	timeline.play();
	CHECK(timeline.get_time_s() == 0);
	timeline.set_speed(-0.5);
	CHECK(timeline.is_playing());
	timeline.advance(1); // already at the start
	CHECK(timeline.get_time_s() == 0);
	CHECK_FALSE(timeline.is_playing());
	timeline.play();
	CHECK(timeline.advance(1));
	CHECK(timeline.get_time_s() == 1.5);
	timeline.set_speed(0);
	CHECK_FALSE(timeline.advance(1));
	CHECK(timeline.is_playing());
}

TEST_CASE("[Timeline] an animation of one key is shown as a pose and does not play") {
	const AnimatedProject project;
	AnimatedDocument document(project);
	Timeline &timeline = document.get_timeline();
	timeline.choose("Turn");
	timeline.play();
	CHECK_FALSE(timeline.is_playing());
	CHECK(document.find("Base").compute_world_from_node()[0].x == doctest::Approx(-1));
}

TEST_CASE("[Timeline] at rest it plays the last shown animation, else the project's default") {
	const AnimatedProject project;
	project.write("project.cfg",
			std::string("[project]\nstart_scene=\"scene.gltf\"\n[defaults]\nanimation=\"Turn\"\n"));
	AnimatedDocument document(project);
	Timeline &timeline = document.get_timeline();
	timeline.play();
	CHECK(timeline.get_animation()->name == "Turn");
	timeline.choose("Move");
	timeline.choose("");
	timeline.play();
	CHECK(timeline.get_animation()->name == "Move");
	timeline.choose("no such animation");
	CHECK(timeline.get_animation() == nullptr);
}

TEST_CASE("[Timeline] a pose is saved neither in the scene file nor in the recovery file") {
	const AnimatedProject project;
	AnimatedDocument document(project);
	Timeline &timeline = document.get_timeline();
	document.save();
	const std::string at_rest = load_text_file(project.path / "scene.gltf");
	timeline.play();
	timeline.advance(0.7);
	document.save();
	CHECK(load_text_file(project.path / "scene.gltf") == at_rest);
	timeline.pause();
	timeline.seek(1.3);
	document.save();
	CHECK(load_text_file(project.path / "scene.gltf") == at_rest);
	// The same change gives the same file, made at rest or in a pose.
	Node3D &tip = document.find("Tip");
	timeline.choose("");
	document.set_property(tip, "scale", glm::dvec3(1, 2, 1));
	document.save_recovery();
	const std::string recovery_text = load_text_file(document.get_recovery_path());
	document.undo();
	timeline.choose("Move");
	timeline.seek(1.3);
	document.set_property(tip, "scale", glm::dvec3(1, 2, 1));
	document.save_recovery();
	CHECK(load_text_file(document.get_recovery_path()) == recovery_text);
	document.undo();
	document.save();
	CHECK(load_text_file(project.path / "scene.gltf") == at_rest);
}

TEST_CASE("[Timeline] editing a posed node changes its own transform and updates the pose") {
	const AnimatedProject project;
	AnimatedDocument document(project);
	document.get_timeline().choose("Move");
	document.get_timeline().seek(1);
	Node3D &tip = document.find("Tip");
	CHECK(std::get<glm::dvec3>(get_node_property(tip, "position")) == glm::dvec3(0));
	document.set_property(tip, "position", glm::dvec3(0, 4, 0)); // the animation overrides it
	CHECK(tip.parent_from_node[3] == glm::dvec4(0, 4, 0, 1));
	CHECK(tip.compute_world_from_node()[3] == glm::dvec4(5, 0, 0, 1));
	document.set_property(tip, "scale", glm::dvec3(2)); // the animation has no scale
	CHECK(tip.compute_world_from_node()[0].x == doctest::Approx(2));
	document.undo();
	CHECK(tip.compute_world_from_node()[0].x == doctest::Approx(1));
	document.undo();
	CHECK(tip.parent_from_node == glm::dmat4(1.0));
	CHECK(tip.compute_world_from_node()[3] == glm::dvec4(5, 0, 0, 1));
	document.redo();
	document.get_timeline().choose("");
	CHECK(tip.compute_world_from_node()[3] == glm::dvec4(0, 4, 0, 1));
}

TEST_CASE("[Timeline] animated nodes can be deleted, restored and duplicated while it plays") {
	const AnimatedProject project;
	AnimatedDocument document(project);
	Timeline &timeline = document.get_timeline();
	timeline.play();
	timeline.advance(0.5);
	for (const char *name : { "Base", "Tip", "Skinned", "Flag" }) {
		document.remove(document.find(name));
		timeline.advance(0.25);
		document.undo();
		CHECK(document.get_tip_x() == doctest::Approx(5 * timeline.get_time_s()));
	}
	// The copy of a skinned mesh uses the same joints; the copy of a joint is not animated.
	document.duplicate(document.find("Skinned"));
	CHECK(document.find("Skinned 2").compute_bounds().minimum.x ==
			doctest::Approx(5 * timeline.get_time_s() - 0.5));
	document.duplicate(document.find("Base"));
	timeline.advance(0.1);
	CHECK(document.find("Tip 2").compute_world_from_node()[3].x == 0);
	// The file without the animated joints is loaded and plays on: Flag is still animated.
	document.remove(document.find("Base"));
	document.save();
	document.reload();
	CHECK(timeline.is_playing());
	CHECK(timeline.advance(0.1));
	CHECK_NOTHROW(document.compute_selected_bounds());
}

TEST_CASE("[Timeline] a reloaded file shows the same animation and time, if it still has it") {
	const AnimatedProject project;
	AnimatedDocument document(project);
	Timeline &timeline = document.get_timeline();
	timeline.choose("Move");
	timeline.seek(1.5);
	document.reload();
	CHECK(document.get_tip_x() == doctest::Approx(7.5));
	CHECK_FALSE(timeline.is_playing());
	timeline.play();
	document.reload();
	CHECK(timeline.is_playing());
	Json still = project.json;
	still["animations"].erase(0);
	project.write("scene.gltf", still.dump());
	document.reload();
	CHECK(timeline.get_animation() == nullptr);
	CHECK_FALSE(timeline.is_playing());
	still.erase("animations");
	project.write("scene.gltf", still.dump());
	document.reload();
	timeline.play();
	CHECK_FALSE(timeline.is_playing());
	CHECK_FALSE(timeline.advance(1));
}

TEST_CASE("[Timeline] a scene that cannot be read has nothing to play") {
	const AnimatedProject project;
	project.write("scene.gltf", std::string("{ broken"));
	AnimatedDocument document(project);
	document.get_timeline().play();
	CHECK_FALSE(document.get_timeline().advance(1));
	CHECK(document.get_timeline().get_animation() == nullptr);
}

TEST_CASE("[Timeline] the bounds of a selected skinned mesh follow its joints") {
	const AnimatedProject project;
	AnimatedDocument document(project);
	document.select(&document.find("Skinned"));
	document.get_timeline().choose("Move");
	document.get_timeline().seek(2);
	const Bounds bounds = document.compute_selected_bounds();
	CHECK(bounds.minimum.x > 8); // not around the node, which stays at 0
	CHECK(bounds.maximum.x >= doctest::Approx(10.5));
}
