#include "modules/gltf_scene/gltf_check.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/gltf_scene/gltf_check_motion.h"
#include "modules/gltf_scene/gltf_check_values.h"
#include "modules/gltf_scene/gltf_document.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace gnomon {

namespace {

const double MAX_NEAR_M = 1e9;
const double MIN_NEAR_M = 1e-6;
const double MAX_FOV_RAD = 3.14159;						 // must be below pi
const double MIN_FOV_RAD = 1e-4;						 // a narrower view would show nothing
const double DEFAULT_OUTER_CONE_RAD = 0.785398163397448; // KHR_lights_punctual: pi / 4
const double MAX_READ_CONE_RAD =
		1.57079632679490 + 1e-6;			 // exporters round pi / 2 up as often as down
const double MAX_EMISSIVE_CD_M2 = 1e9;		 // about the luminance of the sun's disc
const double LAST_ROW_TOLERANCE = 1e-6;		 // for exporters that compute in float
const uint64_t MAX_OFFSET_BYTES = INT32_MAX; // tinygltf's limit
const uint64_t MAX_STRIDE_BYTES = 252;		 // limit of glTF 2.0
// Offsets, scales and rotations of texture coordinates; a float has no useful precision above.
const double MAX_UV_TRANSFORM = 1e6;
const double MIN_QUATERNION_LENGTH = 1e-6; // longer ones are normalized, see read_node_transform

/// Returns whether a file may require the extension: it is supported, or (other KHR_materials_
/// extensions) only affects how surfaces look, and is ignored.
bool is_supported_extension(std::string_view p_name) {
	return p_name == GLTF_PUNCTUAL || p_name == GLTF_AREA || p_name.starts_with("KHR_materials_") ||
			p_name == GLTF_TEXTURE_TRANSFORM || p_name == "KHR_mesh_quantization";
}

/// Checks a number of a light, camera or material. An invalid one is reported and replaced by the
/// default.
void check_number(const GltfObject &p_object, std::string_view p_key, double p_default,
		double p_minimum, double p_maximum, std::string_view p_unit = "") {
	if (p_object.find(p_key)) {
		p_object.set(p_key, p_object.read_number(p_key, p_default, p_minimum, p_maximum, p_unit));
	}
}

void check_color(const GltfObject &p_object, std::string_view p_key, double p_maximum) {
	float color[3];
	if (p_object.find(p_key) && !p_object.read_color(p_key, p_maximum, color)) {
		p_object.erase(p_key);
	}
}

void check_bool(const GltfObject &p_object, std::string_view p_key) {
	if (p_object.find(p_key)) {
		p_object.set(p_key, p_object.read_bool(p_key, false));
	}
}

/// Checks an index in the definition of a texture. An invalid one is reported and removed.
/// p_fallback: what is used instead, for the message.
void check_texture_index(const GltfObject &p_object, std::string_view p_key, size_t p_count,
		std::string_view p_fallback) {
	const std::optional<uint64_t> index = p_object.find_whole_number(p_key);
	if (index && *index < p_count) {
		p_object.set(p_key, *index);
	} else if (p_object.find(p_key)) {
		p_object.report_value(p_key,
				p_count == 0 ? "absent, as there is nothing to refer to" : text("0..", p_count - 1),
				p_fallback);
		p_object.erase(p_key);
	}
}

/// Checks that a number is one of p_choices. Any other value is reported and removed. p_default:
/// what is used instead, for the message.
void check_choice(const GltfObject &p_object, std::string_view p_key,
		std::initializer_list<uint64_t> p_choices, const char *p_default) {
	const std::optional<uint64_t> number = p_object.find_whole_number(p_key);
	if (number && std::find(p_choices.begin(), p_choices.end(), *number) != p_choices.end()) {
		p_object.set(p_key, *number);
	} else if (p_object.find(p_key)) {
		std::string choices;
		for (const uint64_t choice : p_choices) {
			choices += (choices.empty() ? "" : ", ") + std::to_string(choice);
		}
		p_object.report_value(p_key, "one of " + choices, p_default);
		p_object.erase(p_key);
	}
}

/// Checks a pair of numbers of KHR_texture_transform. Any other value is reported and removed.
/// p_default: what is used instead, for the message.
void check_pair(const GltfObject &p_object, std::string_view p_key, const char *p_default) {
	const Json *value = p_object.find(p_key);
	const auto is_good = [](const Json &p_number) {
		return p_number.is_number() && std::abs(p_number.get<double>()) <= MAX_UV_TRANSFORM;
	};
	if (value &&
			!(value->is_array() && value->size() == 2 && is_good((*value)[0]) &&
					is_good((*value)[1]))) {
		p_object.report_value(p_key,
				text("two numbers in -", MAX_UV_TRANSFORM, "..", MAX_UV_TRANSFORM), p_default);
		p_object.erase(p_key);
	}
}

/// Checks one document, see check_gltf.
class GltfChecker {
public:
	explicit GltfChecker(const GltfObject &p_root) : root(p_root) {}
	void check();

private:
	size_t count(const char *p_list) const { return root.get_count(p_list); }
	void check_header() const;
	void check_buffers_and_textures() const;
	void check_accessor(const GltfObject &p_accessor) const;
	void check_mesh(const GltfObject &p_mesh) const;
	void check_attributes(const GltfObject &p_attributes) const;
	void check_texture(const GltfObject &p_parent, const char *p_key) const;
	void check_material(const GltfObject &p_material) const;
	void check_node(const GltfObject &p_node) const;
	static void check_transform(const GltfObject &p_node);
	static void check_camera(const GltfObject &p_camera);
	static void check_light(const GltfObject &p_light);
	static void check_cones(const GltfObject &p_light);

	GltfObject root;
};

void GltfChecker::check() {
	check_header();
	check_buffers_and_textures();
	check_elements(
			root, "accessors", [&](const GltfObject &p_accessor) { check_accessor(p_accessor); });
	check_elements(root, "meshes", [&](const GltfObject &p_mesh) { check_mesh(p_mesh); });
	check_elements(
			root, "materials", [&](const GltfObject &p_material) { check_material(p_material); });
	check_elements(root, "cameras", check_camera);
	if (const auto punctual = root.find_extension(GLTF_PUNCTUAL)) {
		check_elements(*punctual, "lights", check_light);
	}
	if (const auto area = root.find_extension(GLTF_AREA)) {
		check_elements(*area, "lights", [](const GltfObject &p_light) {
			// tinygltf drops empty objects, which would shift the indices.
			p_light.set("type", p_light.get_text("type"));
		});
	}
	if (count("nodes") > GLTF_MAX_NODE_COUNT) {
		root.fail_at("nodes",
				text("has ", count("nodes"), " elements, must be at most ", GLTF_MAX_NODE_COUNT,
						". Split the scene."));
	}
	check_elements(root, "nodes", [&](const GltfObject &p_node) { check_node(p_node); });
	check_skins(root);
	check_animations(root);
	check_elements(root, "scenes",
			[&](const GltfObject &p_scene) { check_indices(p_scene, "nodes", count("nodes")); });
	if (count("scenes") > 0) {
		check_index(root, "scene", count("scenes"));
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

/// Checks buffers, buffer views, images, samplers and textures. Whether a buffer has enough bytes
/// is checked when it is loaded.
void GltfChecker::check_buffers_and_textures() const {
	check_elements(root, "buffers", [](const GltfObject &p_buffer) {
		require_integer(p_buffer, "byteLength", 1, GLTF_MAX_BUFFER_BYTES);
		if (const Json *uri = p_buffer.find("uri"); uri && !uri->is_string()) {
			p_buffer.fail_value("uri", "text");
		}
	});
	check_elements(root, "bufferViews", [&](const GltfObject &p_view) {
		require_index(p_view, "buffer", count("buffers"));
		check_integer(p_view, "byteOffset", 0, GLTF_MAX_BUFFER_BYTES);
		require_integer(p_view, "byteLength", 1, GLTF_MAX_BUFFER_BYTES);
		const auto stride = p_view.find_integer("byteStride", 4, MAX_STRIDE_BYTES);
		if (stride && *stride % 4 != 0) {
			p_view.fail_value("byteStride", text("a multiple of 4 in 4..", MAX_STRIDE_BYTES));
		}
		check_integer(p_view, "byteStride", 4, MAX_STRIDE_BYTES);
	});
	check_elements(root, "images", [](const GltfObject &) {}); // they must be objects
	check_elements(root, "samplers", [](const GltfObject &p_sampler) {
		for (const char *key : { "wrapS", "wrapT" }) {
			check_choice(p_sampler, key,
					{ TINYGLTF_TEXTURE_WRAP_REPEAT, TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE,
							TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT },
					"repetition");
		}
		check_choice(p_sampler, "magFilter",
				{ TINYGLTF_TEXTURE_FILTER_NEAREST, TINYGLTF_TEXTURE_FILTER_LINEAR },
				"interpolation");
		check_choice(p_sampler, "minFilter",
				{ TINYGLTF_TEXTURE_FILTER_NEAREST, TINYGLTF_TEXTURE_FILTER_LINEAR,
						TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST,
						TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST,
						TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR,
						TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR },
				"interpolation with mip maps");
	});
	check_elements(root, "textures", [&](const GltfObject &p_texture) {
		check_texture_index(
				p_texture, "sampler", count("samplers"), "repetition with interpolation");
		check_texture_index(p_texture, "source", count("images"), "no image");
	});
}

void GltfChecker::check_accessor(const GltfObject &p_accessor) const {
	check_index(p_accessor, "bufferView", count("bufferViews"));
	check_integer(p_accessor, "byteOffset", 0, MAX_OFFSET_BYTES);
	require_integer(p_accessor, "count", 1, GLTF_MAX_INDEX_COUNT);
	require_integer(p_accessor, "componentType", TINYGLTF_COMPONENT_TYPE_BYTE,
			TINYGLTF_COMPONENT_TYPE_FLOAT);
	const std::string type = p_accessor.get_text("type");
	if (type != "SCALAR" && type != "VEC2" && type != "VEC3" && type != "VEC4" && type != "MAT2" &&
			type != "MAT3" && type != "MAT4") {
		p_accessor.fail_value("type", "\"SCALAR\", \"VEC2\"..\"VEC4\" or \"MAT2\"..\"MAT4\"");
	}
	check_bool(p_accessor, "normalized");
	const auto sparse = p_accessor.find_object("sparse");
	if (!sparse) {
		p_accessor.erase("sparse"); // it may be null
		return;
	}
	require_integer(
			*sparse, "count", 1, p_accessor.require_integer("count", 1, GLTF_MAX_INDEX_COUNT));
	for (const char *part : { "indices", "values" }) {
		const GltfObject object = sparse->require_object(part);
		require_index(object, "bufferView", count("bufferViews"));
		check_integer(object, "byteOffset", 0, MAX_OFFSET_BYTES);
	}
	require_integer(sparse->require_object("indices"), "componentType",
			TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_COMPONENT_TYPE_FLOAT);
}

void GltfChecker::check_attributes(const GltfObject &p_attributes) const {
	for (auto item = p_attributes.get_json().begin(); item != p_attributes.get_json().end();
			++item) {
		require_index(p_attributes, item.key(), count("accessors"));
	}
}

void GltfChecker::check_mesh(const GltfObject &p_mesh) const {
	check_morph_weights(p_mesh);
	check_elements(p_mesh, "primitives", [&](const GltfObject &p_primitive) {
		check_integer(p_primitive, "mode", TINYGLTF_MODE_POINTS, TINYGLTF_MODE_TRIANGLE_FAN);
		check_attributes(p_primitive.require_object("attributes"));
		check_elements(p_primitive, "targets",
				[&](const GltfObject &p_target) { check_attributes(p_target); });
		check_index(p_primitive, "material", count("materials"));
		check_index(p_primitive, "indices", count("accessors"));
		if (const auto indices = p_primitive.find_index("indices", count("accessors"))) {
			const GltfObject accessor = root.get_element("accessors", *indices);
			if (!accessor.find("bufferView")) { // tinygltf needs it
				accessor.fail_value("bufferView", "set, because indices are read from here");
			}
		}
	});
}

void GltfChecker::check_texture(const GltfObject &p_parent, const char *p_key) const {
	const Json *json = p_parent.find(p_key);
	if (!json) {
		return;
	}
	if (!json->is_object()) {
		p_parent.report_value(p_key, "an object", "no texture");
		p_parent.erase(p_key);
		return;
	}
	const GltfObject info = *p_parent.find_object(p_key);
	check_texture_index(info, "index", count("textures"), "no texture");
	if (!info.find("index")) {
		p_parent.erase(p_key);
		return;
	}
	check_choice(info, "texCoord", { 0, 1 }, "0");
	const auto extensions = info.find_object("extensions");
	const Json *written = extensions ? extensions->find(GLTF_TEXTURE_TRANSFORM) : nullptr;
	if (written && !written->is_object()) {
		extensions->report_value(GLTF_TEXTURE_TRANSFORM, "an object", "no transform");
		extensions->erase(GLTF_TEXTURE_TRANSFORM);
	} else if (const auto transform = info.find_extension(GLTF_TEXTURE_TRANSFORM)) {
		check_choice(*transform, "texCoord", { 0, 1 }, "that of the texture");
		check_pair(*transform, "offset", "0, 0");
		check_pair(*transform, "scale", "1, 1");
		check_number(*transform, "rotation", 0, -MAX_UV_TRANSFORM, MAX_UV_TRANSFORM, "rad");
	}
	check_number(info, "scale", 1, -FLT_MAX, FLT_MAX);
	check_number(info, "strength", 1, 0, 1);
}

void GltfChecker::check_material(const GltfObject &p_material) const {
	if (const auto surface = p_material.find_object("pbrMetallicRoughness")) {
		check_color(*surface, "baseColorFactor", 1.0);
		if (Json *color = surface->find("baseColorFactor")) {
			const double alpha = color->size() == 4 && (*color)[3].is_number()
					? (*color)[3].get<double>()
					: color->size() == 3 ? 1.0
										 : NAN;
			if (!(alpha >= 0 && alpha <= 1)) {
				surface->report_value("baseColorFactor", "four numbers in 0..1", "1 as alpha");
			}
			*color = { (*color)[0], (*color)[1], (*color)[2],
				alpha >= 0 && alpha <= 1 ? alpha : 1.0 };
		}
		check_texture(*surface, "baseColorTexture");
		check_texture(*surface, "metallicRoughnessTexture");
		check_number(*surface, "metallicFactor", 1, 0, 1);
		check_number(*surface, "roughnessFactor", 1, 0, 1);
	}
	check_color(p_material, "emissiveFactor", 1.0);
	check_bool(p_material, "doubleSided");
	for (const char *key : { "normalTexture", "occlusionTexture", "emissiveTexture" }) {
		check_texture(p_material, key);
	}
	check_number(p_material, "alphaCutoff", 0.5, 0, FLT_MAX);
	if (p_material.find("alphaMode")) {
		const std::string mode = p_material.get_text("alphaMode");
		if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND") {
			p_material.report_value("alphaMode", "\"OPAQUE\", \"MASK\" or \"BLEND\"", "\"OPAQUE\"");
			p_material.set("alphaMode", "OPAQUE");
		}
	}
	if (const auto strength = p_material.find_extension(GLTF_EMISSIVE_STRENGTH)) {
		check_number(*strength, "emissiveStrength", 1, 0, MAX_EMISSIVE_CD_M2);
	}
	if (const auto transmission = p_material.find_extension(GLTF_TRANSMISSION)) {
		check_number(*transmission, "transmissionFactor", 0, 0, 1);
	}
	if (const auto volume = p_material.find_extension(GLTF_VOLUME)) {
		check_number(*volume, "thicknessFactor", 0, 0, MAX_LENGTH_M, "m");
		check_color(*volume, "attenuationColor", 1.0);
		check_number(*volume, "attenuationDistance", 0, 0, MAX_LENGTH_M, "m");
	}
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
	check_index(p_node, "mesh", count("meshes"));
	check_index(p_node, "camera", count("cameras"));
	check_index(p_node, "skin", count("skins"));
	check_morph_weights(p_node);
	check_indices(p_node, "children", count("nodes"));
	check_transform(p_node);
	for (const char *name : { GLTF_PUNCTUAL, GLTF_AREA }) {
		if (const auto reference = p_node.find_extension(name)) {
			const auto lights = root.find_extension(name);
			require_index(*reference, "light", lights ? lights->get_count("lights") : 0);
		}
	}
}

void GltfChecker::check_camera(const GltfObject &p_camera) {
	const auto perspective = p_camera.find_object("perspective");
	if (p_camera.get_text("type") != "perspective" || !perspective) {
		p_camera.get_messages().warn(
				"camera", p_camera.get_path(), "is not perspective; it is skipped.");
		// A camera that tinygltf accepts and the reader skips.
		p_camera.set("type", "orthographic");
		p_camera.set(
				"orthographic", { { "xmag", 1 }, { "ymag", 1 }, { "zfar", 1 }, { "znear", 0 } });
		return;
	}
	const Camera3D defaults;
	perspective->set("yfov",
			perspective->read_number(
					"yfov", defaults.vertical_fov_rad, MIN_FOV_RAD, MAX_FOV_RAD, "rad"));
	perspective->set("znear",
			perspective->read_number("znear", defaults.near_m, MIN_NEAR_M, MAX_NEAR_M, "m"));
}

void GltfChecker::check_cones(const GltfObject &p_light) {
	if (const Json *json = p_light.find("spot"); json && !json->is_object()) {
		p_light.report_value("spot", "an object", "the default");
		p_light.erase("spot");
	}
	if (!p_light.find("spot")) { // the defaults apply
		p_light.set("spot", Json::object());
	}
	const GltfObject spot = *p_light.find_object("spot");
	double outer =
			spot.read_number("outerConeAngle", DEFAULT_OUTER_CONE_RAD, 0, MAX_READ_CONE_RAD, "rad");
	double inner = spot.read_number("innerConeAngle", 0, 0, MAX_READ_CONE_RAD, "rad");
	if (!(outer > 0)) {
		spot.report_value("outerConeAngle", "above 0", text(DEFAULT_OUTER_CONE_RAD));
		outer = DEFAULT_OUTER_CONE_RAD;
		inner = 0;
	} else if (inner > outer) {
		spot.report_value("innerConeAngle", text("at most outerConeAngle, ", outer), "0");
		inner = 0;
	}
	spot.set("outerConeAngle", outer);
	spot.set("innerConeAngle", inner);
}

void GltfChecker::check_light(const GltfObject &p_light) {
	const std::string type = p_light.get_text("type");
	if (type != "point" && type != "spot" && type != "directional") {
		p_light.report_value("type", "\"point\", \"spot\" or \"directional\"", "no light");
		p_light.set("type", "");
	}
	check_color(p_light, "color", FLT_MAX);
	check_number(p_light, "intensity", 1, 0, FLT_MAX);
	if (const Json *range = p_light.find("range")) {
		const double range_m = range->is_number() ? range->get<double>() : NAN;
		if (!(range_m > 0 && range_m <= FLT_MAX)) {
			p_light.report_value("range", "a finite number above 0 m", "no limit");
			p_light.erase("range");
		}
	}
	if (type == "spot") {
		check_cones(p_light);
	}
}

} // namespace

void check_gltf(Json &r_json, GltfMessages &r_messages) {
	GltfChecker(GltfObject(r_json, "", r_messages)).check();
}

} // namespace gnomon
