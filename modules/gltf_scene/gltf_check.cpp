#include "modules/gltf_scene/gltf_check.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_check_motion.h"
#include "modules/gltf_scene/gltf_document.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double LAST_ROW_TOLERANCE = 1e-6;		 // for exporters that compute in float
const uint64_t MAX_OFFSET_BYTES = INT32_MAX; // tinygltf's limit
const uint64_t MAX_STRIDE_BYTES = 252;		 // limit of glTF 2.0
const double MIN_QUATERNION_LENGTH = 1e-6;	 // longer ones are normalized, see read_node_transform

/// Returns whether a file may require the extension: it is supported, or (other KHR_materials_
/// extensions) only affects how surfaces look, and is ignored.
bool is_supported_extension(std::string_view p_name) {
	return p_name == GLTF_PUNCTUAL || p_name == GLTF_AREA || p_name.starts_with("KHR_materials_") ||
			p_name == GLTF_TEXTURE_TRANSFORM || p_name == "KHR_mesh_quantization";
}

/// Checks one document, see check_gltf.
class GltfChecker {
public:
	explicit GltfChecker(const GltfObject &p_root) : root(p_root) {}
	void check();

private:
	size_t count(const char *p_list) const { return root.get_count(p_list); }
	void check_header() const;
	void check_buffers() const;
	void check_accessor(const GltfObject &p_accessor) const;
	void check_mesh(const GltfObject &p_mesh) const;
	void check_attributes(const GltfObject &p_attributes) const;
	void check_node(const GltfObject &p_node) const;
	static void check_transform(const GltfObject &p_node);

	GltfObject root;
};

void GltfChecker::check() {
	check_header();
	check_buffers();
	root.for_each("accessors", [&](const GltfObject &p_accessor) { check_accessor(p_accessor); });
	root.for_each("meshes", [&](const GltfObject &p_mesh) { check_mesh(p_mesh); });
	if (const auto area = root.find_extension(GLTF_AREA)) {
		area->for_each("lights", [](const GltfObject &) {}); // they must be objects
	}
	if (count("nodes") > GLTF_MAX_NODE_COUNT) {
		root.fail_at("nodes",
				text("has ", count("nodes"), " elements, must be at most ", GLTF_MAX_NODE_COUNT,
						". Split the scene."));
	}
	root.for_each("nodes", [&](const GltfObject &p_node) { check_node(p_node); });
	check_skins(root);
	check_animations(root);
	root.for_each("scenes",
			[&](const GltfObject &p_scene) { p_scene.check_indices("nodes", count("nodes")); });
	if (count("scenes") > 0) {
		root.find_index("scene", count("scenes"));
	}
}

void GltfChecker::check_header() const {
	const GltfObject asset = root.require_object("asset");
	const std::string version = asset.get_text("version");
	if (!version.starts_with("2.")) {
		asset.fail_value("version", "\"2.0\"");
	}
	if (asset.find("minVersion") && asset.get_text("minVersion") != "2.0") {
		asset.fail_value("minVersion", "\"2.0\"");
	}
	const size_t required_count = root.get_count("extensionsRequired");
	for (size_t index = 0; index < required_count; ++index) {
		const Json &name = (*root.find("extensionsRequired"))[index];
		if (!name.is_string() || !is_supported_extension(name.get_ref<const std::string &>())) {
			root.fail_at(text("extensionsRequired[", index, "]"),
					text("is ", describe_json(name),
							", which is not supported. Export the file without it."));
		}
	}
}

/// Checks buffers and buffer views. Whether a buffer has enough bytes
/// is checked when it is loaded.
void GltfChecker::check_buffers() const {
	root.for_each("buffers", [](const GltfObject &p_buffer) {
		p_buffer.require_integer("byteLength", 1, GLTF_MAX_BUFFER_BYTES);
		if (const Json *uri = p_buffer.find("uri"); uri && !uri->is_string()) {
			p_buffer.fail_value("uri", "text");
		}
	});
	root.for_each("bufferViews", [&](const GltfObject &p_view) {
		p_view.require_index("buffer", count("buffers"));
		p_view.find_integer("byteOffset", 0, GLTF_MAX_BUFFER_BYTES);
		p_view.require_integer("byteLength", 1, GLTF_MAX_BUFFER_BYTES);
		const auto stride = p_view.find_integer("byteStride", 4, MAX_STRIDE_BYTES);
		if (stride && *stride % 4 != 0) {
			p_view.fail_value("byteStride", text("a multiple of 4 in 4..", MAX_STRIDE_BYTES));
		}
	});
}

void GltfChecker::check_accessor(const GltfObject &p_accessor) const {
	p_accessor.find_index("bufferView", count("bufferViews"));
	p_accessor.find_integer("byteOffset", 0, MAX_OFFSET_BYTES);
	p_accessor.require_integer("count", 1, GLTF_MAX_INDEX_COUNT);
	p_accessor.require_integer(
			"componentType", TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_COMPONENT_TYPE_FLOAT);
	const std::string type = p_accessor.get_text("type");
	if (type != "SCALAR" && type != "VEC2" && type != "VEC3" && type != "VEC4" && type != "MAT2" &&
			type != "MAT3" && type != "MAT4") {
		p_accessor.fail_value("type", "\"SCALAR\", \"VEC2\"..\"VEC4\" or \"MAT2\"..\"MAT4\"");
	}
	if (p_accessor.find("normalized")) {
		p_accessor.set("normalized", p_accessor.read_bool("normalized", false));
	}
	const auto sparse = p_accessor.find_object("sparse");
	if (!sparse) {
		p_accessor.erase("sparse"); // it may be null
		return;
	}
	sparse->require_integer(
			"count", 1, p_accessor.require_integer("count", 1, GLTF_MAX_INDEX_COUNT));
	for (const char *part : { "indices", "values" }) {
		const GltfObject object = sparse->require_object(part);
		object.require_index("bufferView", count("bufferViews"));
		object.find_integer("byteOffset", 0, MAX_OFFSET_BYTES);
	}
	sparse->require_object("indices").require_integer(
			"componentType", TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_COMPONENT_TYPE_FLOAT);
}

void GltfChecker::check_attributes(const GltfObject &p_attributes) const {
	for (auto item = p_attributes.get_json().begin(); item != p_attributes.get_json().end();
			++item) {
		p_attributes.require_index(item.key(), count("accessors"));
	}
}

void GltfChecker::check_mesh(const GltfObject &p_mesh) const {
	check_morph_weights(p_mesh);
	p_mesh.for_each("primitives", [&](const GltfObject &p_primitive) {
		p_primitive.find_integer("mode", TINYGLTF_MODE_POINTS, TINYGLTF_MODE_TRIANGLE_FAN);
		check_attributes(p_primitive.require_object("attributes"));
		p_primitive.for_each(
				"targets", [&](const GltfObject &p_target) { check_attributes(p_target); });
		p_primitive.find_index("material", count("materials"));
		if (const auto indices = p_primitive.find_index("indices", count("accessors"))) {
			const GltfObject accessor = root.get_element("accessors", *indices);
			if (!accessor.find("bufferView")) { // tinygltf needs it
				accessor.fail_value("bufferView", "set, because indices are read from here");
			}
		}
	});
}

void GltfChecker::check_transform(const GltfObject &p_node) {
	double matrix[16];
	if (p_node.find_numbers("matrix", matrix)) {
		const double last_row_error = std::abs(matrix[3]) + std::abs(matrix[7]) +
				std::abs(matrix[11]) + std::abs(matrix[15] - 1);
		if (last_row_error > LAST_ROW_TOLERANCE) {
			p_node.fail_value("matrix", "affine: its last row 0, 0, 0, 1");
		}
		return;
	}
	double vector[3];
	p_node.find_numbers("translation", vector);
	p_node.find_numbers("scale", vector);
	double quaternion[4];
	if (p_node.find_numbers("rotation", quaternion)) {
		const double length = std::hypot(
				std::hypot(quaternion[0], quaternion[1]), std::hypot(quaternion[2], quaternion[3]));
		if (!(length > MIN_QUATERNION_LENGTH) || !std::isfinite(length)) {
			p_node.fail_value("rotation", "a unit quaternion");
		}
	}
}

void GltfChecker::check_node(const GltfObject &p_node) const {
	p_node.find_index("mesh", count("meshes"));
	p_node.find_index("camera", count("cameras"));
	p_node.find_index("skin", count("skins"));
	check_morph_weights(p_node);
	p_node.check_indices("children", count("nodes"));
	check_transform(p_node);
	for (const char *name : { GLTF_PUNCTUAL, GLTF_AREA }) {
		if (const auto reference = p_node.find_extension(name)) {
			const auto lights = root.find_extension(name);
			reference->require_index("light", lights ? lights->get_count("lights") : 0);
		}
	}
}

} // namespace

void check_gltf(Json &r_json, GltfMessages &r_messages) {
	GltfChecker(GltfObject(r_json, "", r_messages)).check();
}

} // namespace gnomon
