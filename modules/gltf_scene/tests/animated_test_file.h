#pragma once

#include "modules/gltf_scene/tests/gltf_test_files.h"

namespace gnomon {

/// Returns a document with two quads and two animations. The animation "Move" lasts 2 s and is
/// linear. The quad "Skinned" (x -0.5..0.5, y 0..1, z 0) follows the joint "Tip", a child of
/// "Base", which moves 10 m along x. The same quad at z -5, "Flag", moves 3 m up as the weight of
/// its morph target goes from 0 to 1. Without animation the weight is 0.25. The animation "Turn"
/// rotates "Base" and has one key.
inline Json make_animated(const GltfTestFolder &p_folder) {
	GltfTestBuffer buffer;
	const auto add = [&](const auto &p_values, int p_component, const char *p_type,
							 size_t p_count) {
		return buffer.add_accessor(buffer.add_view(p_values), p_component, p_type, p_count);
	};
	using Floats = std::vector<float>;
	// Accessors 0 to 4: positions, indices, joints, weights, positions of the morph target.
	add(Floats{ -0.5f, 0, 0, 0.5f, 0, 0, 0.5f, 1, 0, -0.5f, 1, 0 }, GLTF_TEST_FLOAT, "VEC3", 4);
	add(std::vector<uint16_t>{ 0, 1, 2, 0, 2, 3 }, GLTF_TEST_USHORT, "SCALAR", 6);
	add(std::vector<uint16_t>{ 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 }, GLTF_TEST_USHORT,
			"VEC4", 4);
	add(Floats{ 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 }, GLTF_TEST_FLOAT, "VEC4", 4);
	add(Floats{ 0, 3, 0, 0, 3, 0, 0, 3, 0, 0, 3, 0 }, GLTF_TEST_FLOAT, "VEC3", 4);
	// 5 to 7: times, translations and morph weights of "Move". 8, 9: time and rotation of "Turn".
	add(Floats{ 0, 2 }, GLTF_TEST_FLOAT, "SCALAR", 2);
	add(Floats{ 0, 0, 0, 10, 0, 0 }, GLTF_TEST_FLOAT, "VEC3", 2);
	add(Floats{ 0, 1 }, GLTF_TEST_FLOAT, "SCALAR", 2);
	add(Floats{ 0 }, GLTF_TEST_FLOAT, "SCALAR", 1);
	add(Floats{ 0, 0, 1, 0 }, GLTF_TEST_FLOAT, "VEC4", 1);
	Json json = Json::parse(R"({
		"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2, 3]}],
		"nodes": [
			{"name": "Base", "children": [1]},
			{"name": "Tip"},
			{"name": "Skinned", "mesh": 0, "skin": 0},
			{"name": "Flag", "mesh": 1, "translation": [0, 0, -5], "weights": [0.25]}],
		"skins": [{"joints": [0, 1]}],
		"meshes": [
			{"name": "skinned", "primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1}]},
			{"name": "flag", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "targets": [{"POSITION": 4}]}]}],
		"animations": [
			{"name": "Move",
			 "samplers": [{"input": 5, "output": 6}, {"input": 5, "output": 7}],
			 "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
						  {"sampler": 1, "target": {"node": 3, "path": "weights"}}]},
			{"name": "Turn",
			 "samplers": [{"input": 8, "output": 9}],
			 "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]
	})");
	buffer.store(json, p_folder);
	return json;
}

} // namespace gnomon
