#pragma once

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/gltf_scene/gltf_container.h"
#include "modules/gltf_scene/gltf_scene.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gnomon {

/// A temporary folder, which is removed with its files at the end of the test.
struct GltfTestFolder : TemporaryFolder {
	/// Writes the document to "scene.gltf" and loads it.
	std::unique_ptr<Scene> load(const Json &p_json, const GltfLoadOptions &p_options = {}) const {
		write("scene.gltf", p_json.dump());
		return load_gltf(path / "scene.gltf", p_options);
	}
	/// Writes a file without the disk sync of save_file_atomically, which is slow for thousands of
	/// files.
	void write(const std::string &p_name, std::string_view p_text) const {
		std::ofstream(path / p_name, std::ios::binary) << p_text;
	}
	void write(const std::string &p_name, std::span<const uint8_t> p_bytes) const {
		write(p_name,
				std::string_view(reinterpret_cast<const char *>(p_bytes.data()), p_bytes.size()));
	}
	Json read_json(const std::string &p_name) const {
		return Json::parse(load_text_file(path / p_name));
	}
};

/// Collects the log's lines during its lifetime instead of printing them.
struct GltfTestLog {
	std::vector<std::string> errors;
	std::vector<std::string> warnings;
	LogSink before;
	GltfTestLog() {
		before = set_log_sink([this](LogLevel p_level, const std::string &p_line) {
			(p_level == LogLevel::ERROR ? errors : warnings).push_back(p_line);
		});
	}
	~GltfTestLog() { set_log_sink(before); }
	GltfTestLog(const GltfTestLog &) = delete;
	GltfTestLog &operator=(const GltfTestLog &) = delete;

	static bool contains(const std::vector<std::string> &p_lines, std::string_view p_text_part) {
		for (const std::string &line : p_lines) {
			if (line.find(p_text_part) != std::string::npos) {
				return true;
			}
		}
		return false;
	}
};

/// Sorts the keys alphabetically for a comparison, because elements that a save adds have their
/// keys in the writer's order.
inline nlohmann::json sort_keys(const Json &p_json) {
	return nlohmann::json::parse(p_json.dump());
}

/// Returns the message of the Error that loading throws; empty if it succeeds.
inline std::string get_load_error(
		const GltfTestFolder &p_folder, const Json &p_json, const GltfLoadOptions &p_options = {}) {
	try {
		p_folder.load(p_json, p_options);
	} catch (const Error &error) {
		return error.what();
	}
	return "";
}

/// Builds a buffer with its views and accessors, to which values are appended.
struct GltfTestBuffer {
	std::vector<uint8_t> bytes;
	Json views = Json::array();
	Json accessors = Json::array();

	template <typename T> size_t add_view(const std::vector<T> &p_values, size_t p_stride = 0) {
		Json view = { { "buffer", 0 }, { "byteOffset", bytes.size() },
			{ "byteLength", p_values.size() * sizeof(T) } };
		if (p_stride > 0) {
			view["byteStride"] = p_stride;
		}
		const auto *first = reinterpret_cast<const uint8_t *>(p_values.data());
		bytes.insert(bytes.end(), first, first + p_values.size() * sizeof(T));
		bytes.resize((bytes.size() + 3) / 4 * 4);
		views.push_back(view);
		return views.size() - 1;
	}
	size_t add_accessor(size_t p_view, int p_component_type, const char *p_type, size_t p_count,
			size_t p_offset = 0) {
		accessors.push_back({ { "bufferView", p_view }, { "componentType", p_component_type },
				{ "type", p_type }, { "count", p_count }, { "byteOffset", p_offset } });
		return accessors.size() - 1;
	}
	/// Writes buffer, views and accessors into the document, and the bytes to "data.bin".
	void store(Json &r_json, const GltfTestFolder &p_folder) const {
		p_folder.write("data.bin", bytes);
		r_json["buffers"] = Json::array();
		r_json["buffers"].push_back({ { "uri", "data.bin" }, { "byteLength", bytes.size() } });
		r_json["bufferViews"] = views;
		r_json["accessors"] = accessors;
	}
};

// Component types of glTF.
const int GLTF_TEST_BYTE = 5120, GLTF_TEST_SHORT = 5122, GLTF_TEST_USHORT = 5123,
		  GLTF_TEST_UBYTE = 5121, GLTF_TEST_UINT = 5125, GLTF_TEST_FLOAT = 5126;

/// Returns a document without content.
inline Json make_empty_document() {
	return Json::parse(R"({"asset": {"version": "2.0"}})");
}

/// Returns a document of one node with a mesh of one triangle, whose buffer is "data.bin".
inline Json make_triangle(const GltfTestFolder &p_folder) {
	GltfTestBuffer buffer;
	const std::vector<float> positions = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
	buffer.add_accessor(buffer.add_view(positions), GLTF_TEST_FLOAT, "VEC3", 3);
	buffer.add_accessor(
			buffer.add_view(std::vector<uint16_t>{ 0, 1, 2 }), GLTF_TEST_USHORT, "SCALAR", 3);
	Json json = Json::parse(R"({
		"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
		"nodes": [{"name": "Triangle", "mesh": 0}],
		"meshes": [{"name": "triangle", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]
	})");
	buffer.store(json, p_folder);
	return json;
}

/// Returns a document of one spot light, which tests modify.
inline Json make_spot_light_document() {
	return Json::parse(R"({
		"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
		"extensionsUsed": ["KHR_lights_punctual"],
		"extensions": {"KHR_lights_punctual": {"lights": [
			{"type": "spot", "name": "Bulb", "intensity": 20, "color": [1, 0.5, 0.25],
			 "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}]}},
		"nodes": [{"name": "Lamp", "extensions": {"KHR_lights_punctual": {"light": 0}}}]
	})");
}

/// Returns a description of the first difference between two scenes, or "" if there is none.
/// Compares scene size, names, transforms, triangles, lights, cameras and materials, but not their
/// textures, alpha, transmission and shading model, and no skins, morph targets and animations.
std::string find_difference(const Scene &p_first, const Scene &p_second);

} // namespace gnomon
