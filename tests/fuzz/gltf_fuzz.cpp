// fuzz: modules=gltf_scene
// Any bytes as a .gltf or .glb file, up to the snapshot that a renderer gets.
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/scene/node_properties.h"
#include "modules/scene/scene_snapshot.h"

#include "tests/fuzz/fuzz_target.h"

using namespace gnomon;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] {
		// A folder that does not exist: no input reads a file.
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
	});
}
