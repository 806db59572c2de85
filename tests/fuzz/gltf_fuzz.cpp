// fuzz: modules=gltf_scene
// Parses arbitrary bytes as a .gltf or .glb file, builds the snapshot that a renderer gets, and
// plays the animations.
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/scene/animation.h"
#include "modules/scene/mesh_pose.h"
#include "modules/scene/node_properties.h"
#include "modules/scene/scene_snapshot.h"

#include "tests/fuzz/fuzz_target.h"

#include <algorithm>

using namespace gnomon;

namespace {

/// Checks that the vertices of each pose are within its bounds, up to rounding.
void check_poses(const SceneSnapshot &p_snapshot) {
	for (const InstanceSnapshot &instance : p_snapshot.instances) {
		if (!instance.pose) {
			continue;
		}
		const Bounds &bounds = instance.pose->get_bounds();
		const double size = std::max(glm::length(bounds.minimum), glm::length(bounds.maximum));
		for (const glm::vec3 &position : instance.get_posed_mesh()->positions_node) {
			const double beyond = bounds.compute_distance(glm::dvec3(position));
			GNOMON_ASSERT(beyond <= 1e-5 * size, "a vertex is ", beyond, " m beyond its bounds");
		}
		instance.get_posed_caster_mesh(); // only checks that it does not crash
	}
}

/// Poses the scene with the first animations, each before, at the start of, within and at the end
/// of its time range, and then at rest. A pose beyond the range of float is an Error.
void play(Scene &r_scene) {
	const size_t MAX_ANIMATION_COUNT = 4; // more would only repeat the same checks
	const Camera3D camera;
	for (size_t index = 0; index < std::min(r_scene.animations.size(), MAX_ANIMATION_COUNT);
			++index) {
		const Animation &animation = *r_scene.animations[index];
		for (const double fraction : { -1.0, 0.0, 0.3, 1.0 }) {
			pose_scene(r_scene, &animation, fraction * animation.duration_s);
			check_poses(*build_snapshot(r_scene, camera));
		}
	}
	pose_scene(r_scene, nullptr, 0);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] {
		// The folder does not exist, so that no input can read a file.
		const auto scene = parse_gltf({ p_data, p_size }, "/nonexistent/scene.gltf");
		for (const Node3D *node : scene->find_nodes<Node3D>()) {
			const PropertyList list = list_node_properties(*node);
			for (const PropertyInfo &info : list.get_properties()) {
				const PropertyValue value = get_node_property(*node, info.name);
				GNOMON_ASSERT(value.index() == info.default_value.index(), info.name, " has type ",
						value.index());
			}
		}
		for (const Camera3D *camera : scene->find_nodes<Camera3D>()) {
			const auto snapshot = build_snapshot(*scene, *camera);
			GNOMON_ASSERT(snapshot->scene_size_m > 0, "scene size is ", snapshot->scene_size_m);
		}
		play(*scene);
	});
}
