// Compares vertices that skins and morph targets deform on the GPU with an independent computation
// in double precision, which reads the glTF files without the engine's importer.

#include "modules/core/files.h"
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/renderer/tests/render_fixture.h"
#include "modules/scene/animation.h"
#include "modules/scene/mesh_pose.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>

using namespace gnomon;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const char SKIN[] = "/usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf";
const char MORPH[] = "/usr/share/assimp/models/glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/"
					 "AnimatedMorphCube.gltf";
const char COURTYARD[] = "demo_project/scenes/courtyard.gltf";

/// A glTF file and its buffers, read without the engine's importer.
struct RawFile {
	Json json;
	std::vector<std::vector<uint8_t>> buffers;

	explicit RawFile(const fs::path &p_path) {
		json = Json::parse(load_text_file(p_path));
		for (const Json &buffer : json["buffers"]) {
			const std::string uri = buffer["uri"];
			const size_t comma = uri.find(',');
			buffers.push_back(uri.starts_with("data:") ? decode_base64(uri.substr(comma + 1))
													   : load_file(p_path.parent_path() / uri));
		}
	}
	static std::vector<uint8_t> decode_base64(const std::string &p_text) {
		const std::string letters =
				"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
		std::vector<uint8_t> bytes;
		uint32_t bits = 0;
		int count = 0;
		for (const char letter : p_text) {
			if (const size_t value = letters.find(letter); value != std::string::npos) {
				bits = bits << 6 | uint32_t(value);
				count += 6;
				if (count >= 8) {
					count -= 8;
					bytes.push_back(uint8_t(bits >> count));
				}
			}
		}
		return bytes;
	}
	/// Returns one row of numbers per element of the accessor. Component types: 5126 float, 5123
	/// 16-bit and 5121 8-bit unsigned integers.
	std::vector<std::vector<double>> read(size_t p_accessor) const {
		const Json &accessor = json["accessors"][p_accessor];
		const Json &view = json["bufferViews"][size_t(accessor["bufferView"])];
		const std::map<std::string, size_t> sizes = { { "SCALAR", 1 }, { "VEC3", 3 }, { "VEC4", 4 },
			{ "MAT4", 16 } };
		const size_t width = sizes.at(accessor["type"]);
		const int kind = accessor["componentType"];
		const size_t bytes = kind == 5126 || kind == 5125 ? 4 : kind == 5123 ? 2 : 1;
		const size_t stride = view.value("byteStride", size_t(0));
		const uint8_t *first = buffers[size_t(view["buffer"])].data() +
				view.value("byteOffset", size_t(0)) + accessor.value("byteOffset", size_t(0));
		std::vector<std::vector<double>> rows;
		for (size_t row = 0; row < size_t(accessor["count"]); ++row) {
			std::vector<double> &values = rows.emplace_back();
			for (size_t i = 0; i < width; ++i) {
				const uint8_t *bytes_at =
						first + row * (stride ? stride : width * bytes) + i * bytes;
				float number = 0;
				uint16_t short_value = 0;
				std::memcpy(&number, bytes_at, kind == 5126 ? 4 : 0);
				std::memcpy(&short_value, bytes_at, kind == 5123 ? 2 : 0);
				values.push_back(kind == 5126  ? double(number)
								: kind == 5123 ? short_value
											   : *bytes_at);
			}
		}
		return rows;
	}
};

/// Returns the value of an animation channel at p_time (s), as in glTF 2.0, appendix C. p_width:
/// numbers per value. With CUBICSPLINE a key has three parts: in-tangent, value and out-tangent.
std::vector<double> evaluate(
		const RawFile &p_file, const Json &p_sampler, double p_time, size_t p_width) {
	const auto times = p_file.read(p_sampler["input"]);
	std::vector<double> flat;
	for (const auto &row : p_file.read(p_sampler["output"])) {
		flat.insert(flat.end(), row.begin(), row.end());
	}
	const std::string kind = p_sampler.value("interpolation", "LINEAR");
	// Of a key's parts, the one at values_per_key / 2 is the value.
	const size_t values_per_key = kind == "CUBICSPLINE" ? 3 : 1;
	const auto get = [&](size_t p_key, size_t p_part, size_t p_i) {
		return flat[(p_key * values_per_key + p_part) * p_width + p_i];
	};
	size_t key = 0;
	while (key + 1 < times.size() && times[key + 1][0] <= p_time) {
		++key;
	}
	std::vector<double> result(p_width);
	const bool is_between = key + 1 < times.size() && p_time >= times[key][0];
	const double h = is_between ? times[key + 1][0] - times[key][0] : 1;
	const double t = is_between ? (p_time - times[key][0]) / h : 0;
	const auto compute_length =
			[&](size_t p_key) { // length of a key's quaternion, which should be 1
				double square = 0;
				for (size_t i = 0; i < p_width; ++i) {
					square += get(p_key, values_per_key / 2, i) * get(p_key, values_per_key / 2, i);
				}
				return std::sqrt(square);
			};
	const bool is_rotation = p_width == 4 && kind == "LINEAR" && is_between;
	const double length_a = is_rotation ? compute_length(key) : 1;
	const double length_b = is_rotation ? compute_length(key + 1) : 1;
	double dot = 0;
	for (size_t i = 0; i < p_width; ++i) {
		dot += is_between ? get(key, values_per_key / 2, i) * get(key + 1, values_per_key / 2, i)
						  : 1;
	}
	for (size_t i = 0; i < p_width; ++i) {
		const double a = get(key, values_per_key / 2, i);
		if (!is_between || kind == "STEP") {
			result[i] = a;
		} else if (kind == "CUBICSPLINE") {
			const double b = get(key + 1, 1, i);
			result[i] = (1 + 2 * t) * (1 - t) * (1 - t) * a +
					h * t * (1 - t) * (1 - t) * get(key, 2, i) + t * t * (3 - 2 * t) * b +
					h * t * t * (t - 1) * get(key + 1, 0, i);
		} else if (p_width == 4) { // a rotation: along the great circle
			const double angle = std::acos(std::min(std::abs(dot) / (length_a * length_b), 1.0));
			const double unit_a = a / length_a;
			const double b = (dot < 0 ? -1 : 1) * get(key + 1, 0, i) / length_b;
			result[i] = angle < 1e-9
					? unit_a + t * (b - unit_a)
					: (std::sin((1 - t) * angle) * unit_a + std::sin(t * angle) * b) /
							std::sin(angle);
		} else {
			result[i] = a + t * (get(key + 1, 0, i) - a);
		}
	}
	return result;
}

glm::dmat4 compose(const std::vector<double> &p_translation, const std::vector<double> &p_rotation,
		const std::vector<double> &p_scale) {
	const double length = std::sqrt(p_rotation[0] * p_rotation[0] + p_rotation[1] * p_rotation[1] +
			p_rotation[2] * p_rotation[2] + p_rotation[3] * p_rotation[3]);
	const double x = p_rotation[0] / length, y = p_rotation[1] / length, z = p_rotation[2] / length,
				 w = p_rotation[3] / length;
	const glm::dvec3 columns[] = { { 1 - 2 * (y * y + z * z), 2 * (x * y + z * w),
										   2 * (x * z - y * w) },
		{ 2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w) },
		{ 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y) } };
	glm::dmat4 matrix(1.0);
	for (int axis = 0; axis < 3; ++axis) {
		matrix[axis] = glm::dvec4(columns[axis] * p_scale[size_t(axis)], 0);
		matrix[3][axis] = p_translation[size_t(axis)];
	}
	return matrix;
}

/// Returns the world positions (m) of the vertices of a node's first primitive at p_time (s).
std::vector<glm::dvec3> compute_expected(const RawFile &p_file, size_t p_node, double p_time) {
	const Json &nodes = p_file.json["nodes"];
	std::vector<std::vector<double>> translations, rotations, scales;
	for (const Json &node : nodes) {
		translations.push_back(node.value("translation", std::vector<double>{ 0, 0, 0 }));
		rotations.push_back(node.value("rotation", std::vector<double>{ 0, 0, 0, 1 }));
		scales.push_back(node.value("scale", std::vector<double>{ 1, 1, 1 }));
	}
	const Json &node = nodes[p_node];
	const Json &primitive = p_file.json["meshes"][size_t(node["mesh"])]["primitives"][0];
	std::vector<double> weights(primitive.value("targets", Json::array()).size(), 0.0);
	for (const Json &channel : p_file.json["animations"][0]["channels"]) {
		const Json &sampler = p_file.json["animations"][0]["samplers"][size_t(channel["sampler"])];
		const size_t target = channel["target"]["node"];
		const std::string path = channel["target"]["path"];
		if (path == "rotation") {
			rotations[target] = evaluate(p_file, sampler, p_time, 4);
		} else if (path == "weights") {
			weights =
					target == p_node ? evaluate(p_file, sampler, p_time, weights.size()) : weights;
		} else {
			(path == "scale" ? scales : translations)[target] =
					evaluate(p_file, sampler, p_time, 3);
		}
	}
	std::vector<size_t> parents(nodes.size(), SIZE_MAX);
	for (size_t index = 0; index < nodes.size(); ++index) {
		for (const Json &child : nodes[index].value("children", Json::array())) {
			parents[size_t(child)] = index;
		}
	}
	const auto compute_world = [&](size_t p_index) {
		glm::dmat4 world(1.0);
		for (size_t index = p_index; index != SIZE_MAX; index = parents[index]) {
			world = compose(translations[index], rotations[index], scales[index]) * world;
		}
		return world;
	};
	auto points = p_file.read(primitive["attributes"]["POSITION"]);
	for (size_t target = 0; target < weights.size(); ++target) {
		const auto deltas = p_file.read(primitive["targets"][target]["POSITION"]);
		for (size_t vertex = 0; vertex < points.size(); ++vertex) {
			for (size_t axis = 0; axis < 3; ++axis) {
				points[vertex][axis] += weights[target] * deltas[vertex][axis];
			}
		}
	}
	std::vector<glm::dvec3> world;
	if (!node.contains("skin")) {
		for (const auto &point : points) {
			world.emplace_back(compute_world(p_node) * glm::dvec4(point[0], point[1], point[2], 1));
		}
		return world;
	}
	const Json &skin = p_file.json["skins"][size_t(node["skin"])];
	const auto inverse_binds = p_file.read(skin["inverseBindMatrices"]);
	std::vector<glm::dmat4> joints;
	for (size_t joint = 0; joint < skin["joints"].size(); ++joint) {
		glm::dmat4 bind;
		for (int element = 0; element < 16; ++element) {
			bind[element / 4][element % 4] = inverse_binds[joint][size_t(element)];
		}
		joints.push_back(compute_world(skin["joints"][joint]) * bind);
	}
	const auto indices = p_file.read(primitive["attributes"]["JOINTS_0"]);
	const auto joint_weights = p_file.read(primitive["attributes"]["WEIGHTS_0"]);
	for (size_t vertex = 0; vertex < points.size(); ++vertex) {
		glm::dvec4 sum(0.0);
		for (size_t i = 0; i < 4; ++i) {
			sum += joint_weights[vertex][i] *
					(joints[size_t(indices[vertex][i])] *
							glm::dvec4(points[vertex][0], points[vertex][1], points[vertex][2], 1));
		}
		world.emplace_back(sum / sum.w);
	}
	return world;
}

/// Returns the world positions (m) of the instance's vertices, as deformed on the GPU.
std::vector<glm::dvec3> read_gpu(
		MaskFixture &r_fixture, const SceneSnapshot &p_scene, const InstanceSnapshot &p_instance) {
	RenderGraph graph(*r_fixture.device, *r_fixture.transients);
	r_fixture.shadows->get_meshes().add_deform_pass(graph, p_scene);
	std::vector<glm::vec3> positions(p_instance.mesh->positions_node.size());
	graph.add_pass("read").keep().execute([&](PassContext &p_context) {
		p_context.get_device().read_back(
				r_fixture.shadows->get_meshes().get(p_instance.mesh).positions.get(),
				[&](std::span<const uint8_t> p_bytes) {
					REQUIRE(p_bytes.size() == positions.size() * sizeof(glm::vec3));
					std::memcpy(positions.data(), p_bytes.data(), p_bytes.size());
				});
	});
	graph.execute(RenderGraph::Mode::WAIT);
	std::vector<glm::dvec3> world;
	for (const glm::vec3 &position : positions) {
		world.emplace_back(p_instance.world_from_node * glm::dvec4(position, 1.0));
	}
	return world;
}

/// Checks at ten times from 0 to p_duration_s that vertices from the GPU and the CPU are within
/// 1e-5 of the mesh's diagonal from the expected positions, and that the instance's bounds contain
/// them. p_name: the node's name in the engine. p_node: its name in the file, "" if it has none.
void check_file(MaskFixture &r_fixture, const char *p_path, const std::string &p_name,
		const char *p_node, double p_duration_s) {
	const RawFile file(p_path);
	size_t node_index = 0;
	for (size_t index = 0; index < file.json["nodes"].size(); ++index) {
		const Json &node = file.json["nodes"][index];
		const bool is_match = node.contains("mesh") && node.value("name", "") == p_node;
		node_index = is_match ? index : node_index;
	}
	const std::unique_ptr<Scene> scene = load_gltf(p_path);
	REQUIRE(scene->animations.size() == 1);
	Camera3D camera;
	for (int step = 0; step < 10; ++step) {
		const double time_s = p_duration_s * step / 9;
		CAPTURE(time_s);
		pose_scene(*scene, scene->animations[0].get(), time_s);
		const auto snapshot = build_snapshot(*scene, camera);
		for (const InstanceSnapshot &instance : snapshot->instances) {
			if (!instance.pose || instance.node_name != p_name) {
				continue;
			}
			const std::vector<glm::dvec3> expected = compute_expected(file, node_index, time_s);
			const std::vector<glm::dvec3> found = read_gpu(r_fixture, *snapshot, instance);
			const std::shared_ptr<const Mesh> on_cpu = instance.get_posed_mesh();
			REQUIRE(found.size() == expected.size());
			Bounds bounds;
			double max_distance_m = 0;
			for (size_t vertex = 0; vertex < found.size(); ++vertex) {
				const glm::dvec3 cpu(instance.world_from_node *
						glm::dvec4(glm::dvec3(on_cpu->positions_node[vertex]), 1.0));
				bounds.add(expected[vertex]);
				max_distance_m =
						std::max({ max_distance_m, glm::distance(found[vertex], expected[vertex]),
								glm::distance(cpu, expected[vertex]) });
			}
			CHECK(max_distance_m <= 1e-5 * bounds.get_diagonal());
			for (int corner = 0; corner < 8; ++corner) { // the culling bounds contain the mesh
				CHECK(instance.bounds_world.compute_distance(bounds.get_corner(corner)) <=
						1e-5 * bounds.get_diagonal());
			}
		}
	}
}

} // namespace

TEST_CASE("deformation: vertices agree with a computation in double at ten times") {
	MaskFixture fixture;
	if (fs::exists(SKIN)) { // files of package assimp-testmodels
		check_file(fixture, SKIN, "Node 0", "", 5.5);
		check_file(fixture, MORPH, "AnimatedMorphCube", "AnimatedMorphCube", 4.2);
	} else {
		MESSAGE("Skipped: package assimp-testmodels is not installed.");
	}
	if (fs::exists(COURTYARD)) { // written by the demo's scripts
		check_file(fixture, COURTYARD, "Figure", "Figure", 6);
		check_file(fixture, COURTYARD, "Flag", "Flag", 6);
	} else {
		MESSAGE("Skipped: ", COURTYARD, " does not exist.");
	}
}
