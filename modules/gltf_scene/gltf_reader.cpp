#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_lights.h"
#include "modules/gltf_scene/gltf_meshes.h"
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/gltf_scene/gltf_tree.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <unordered_map>

namespace gnomon {

namespace {

const double MAX_NEAR_M = 1e9;
const double MAX_FOV_RAD = 3.14159;
const double MIN_FOV_RAD = 1e-4; // narrower, and one pixel sees nothing
const double MIN_NEAR_M = 1e-6;

/// Extensions that change nothing that is read here, or are read.
bool is_known_extension(std::string_view p_name) {
	return p_name == GLTF_PUNCTUAL || p_name == GLTF_AREA || p_name.starts_with("KHR_materials_") ||
			p_name == "KHR_texture_transform" || p_name == "KHR_mesh_quantization";
}

/// Fails on another version than 2.x and on a required extension that is neither read nor harmless;
/// warns of what is not read.
void check_header(const GltfObject &p_root) {
	const GltfObject asset = p_root.require_object("asset");
	const std::string version = asset.get_text("version");
	if (!version.starts_with("2.")) {
		asset.fail_value("version", "\"2.0\"");
	}
	if (asset.find("minVersion") && asset.get_text("minVersion") != "2.0") {
		asset.fail_value("minVersion", "\"2.0\"");
	}
	const size_t required_count = p_root.get_count("extensionsRequired");
	for (size_t index = 0; index < required_count; ++index) {
		const Json &name = (*p_root.find("extensionsRequired"))[index];
		if (!name.is_string() || !is_known_extension(name.get_ref<const std::string &>())) {
			p_root.fail_at(text("extensionsRequired[", index, "]"),
					text("is ", describe_json(name),
							", which is not supported. Export the file without it."));
		}
	}
	GltfMessages &messages = p_root.get_messages();
	if (p_root.get_count("animations") > 0) {
		messages.warn("animations", "animations", "are not read.");
	}
	if (p_root.get_count("skins") > 0) {
		messages.warn("skins", "skins", "are not read.");
	}
}

/// Gives every node of the scene its own name.
class UniqueNames {
public:
	std::string make(const std::string &p_wanted) {
		std::string name = p_wanted;
		while (!taken.insert(name).second) {
			name = text(p_wanted, "_", ++counts.try_emplace(p_wanted, 1).first->second);
		}
		return name;
	}

private:
	std::set<std::string> taken;
	std::unordered_map<std::string, unsigned> counts;
};

class GltfReader {
public:
	GltfReader(
			GltfDocument &r_document, GltfMessages &r_messages, const GltfLoadOptions &p_options) :
			document(r_document),
			options(p_options), root(r_document.container.json, "", r_messages),
			buffers(root, r_document.place, get_bin_chunk()), accessors(root, buffers),
			meshes(root, accessors) {}

	void read(Scene &r_scene);

private:
	const std::vector<uint8_t> *get_bin_chunk() const {
		return document.container.bin_chunk ? &*document.container.bin_chunk : nullptr;
	}
	std::vector<size_t> choose_scene(const GltfTree &p_tree, Scene &r_scene);
	Node3D *read_node(size_t p_index, const GltfTree &p_tree, Node3D &r_parent);
	std::unique_ptr<Node3D> read_mesh_node(const GltfObject &p_node);
	std::unique_ptr<Light3D> read_light_node(
			size_t p_index, const GltfObject &p_node, const GltfTree &p_tree, std::string &r_name);
	std::unique_ptr<Camera3D> read_camera_node(const GltfObject &p_node, std::string &r_name);
	std::optional<GltfObject> find_area_light(const GltfObject &p_node) const;
	void remember(size_t p_index, const Node3D &p_node);

	GltfDocument &document;
	const GltfLoadOptions &options;
	GltfObject root;
	GltfBuffers buffers;
	GltfAccessors accessors;
	GltfMeshes meshes;
	UniqueNames names;
	uint64_t surface_count = 0; // of all nodes so far, as are the values of lights
	uint64_t light_value_count = 0;
};

void GltfReader::read(Scene &r_scene) {
	check_header(root);
	const GltfTree tree = build_gltf_tree(root);
	document.nodes.resize(tree.parents.size());
	// A stack of our own visits children in order: those of a node are pushed last first.
	std::vector<std::pair<size_t, Node3D *>> pending;
	const auto push = [&](const std::vector<size_t> &p_indices, Node3D *p_parent) {
		for (size_t place = p_indices.size(); place-- > 0;) {
			pending.emplace_back(p_indices[place], p_parent);
		}
	};
	push(choose_scene(tree, r_scene), r_scene.root.get());
	while (!pending.empty()) {
		const auto [index, parent] = pending.back();
		pending.pop_back();
		push(tree.children[index], read_node(index, tree, *parent));
	}
	for (const auto &[index, material] : meshes.get_materials()) {
		document.material_indices[material.get()] = index;
	}
	document.primitive_indices = meshes.get_primitive_indices();
	for (size_t index = 0; index < document.nodes.size(); ++index) {
		document.shares_materials |= !document.nodes[index].is_loaded &&
				root.get_element("nodes", index).find("mesh") != nullptr;
	}
	r_scene.side_files = buffers.get_files();
}

std::vector<size_t> GltfReader::choose_scene(const GltfTree &p_tree, Scene &r_scene) {
	const size_t scene_count = root.get_count("scenes");
	if (scene_count == 0) {
		return p_tree.roots;
	}
	const size_t scene_index = root.find_index("scene", scene_count).value_or(0);
	document.scene_index = scene_index;
	const GltfObject scene = root.get_element("scenes", scene_index);
	if (const std::optional<GltfObject> extras = scene.find_extras()) {
		if (const Json *size = extras->find("scene_size")) {
			const double size_m = size->is_number() ? size->get<double>() : 0.0;
			if (size_m > 0 && std::isfinite(size_m)) {
				r_scene.scene_size_m = size_m;
			} else {
				extras->report_value(
						"scene_size", "a finite number above 0 m", "the casters' size");
			}
		}
	}
	document.scene_size_m = r_scene.scene_size_m;
	std::vector<size_t> roots;
	std::set<size_t> seen;
	const size_t count = scene.get_count("nodes");
	for (size_t place = 0; place < count; ++place) {
		const size_t index = scene.require_index_at("nodes", place, p_tree.parents.size());
		if (p_tree.parents[index] != GltfTree::NONE || !seen.insert(index).second) {
			scene.fail_at(text("nodes[", place, "]"),
					text("is ", index,
							", which stands elsewhere in the tree too. Export it again."));
		}
		roots.push_back(index);
	}
	return roots;
}

Node3D *GltfReader::read_node(size_t p_index, const GltfTree &p_tree, Node3D &r_parent) {
	const GltfObject node = root.get_element("nodes", p_index);
	// A node of the file may be a mesh, a light and a camera at once. The first of them becomes the
	// node, the others its children.
	std::vector<std::unique_ptr<Node3D>> parts;
	std::vector<std::string> part_names;
	if (node.find("mesh")) {
		parts.push_back(read_mesh_node(node));
		part_names.push_back(text("Node ", p_index));
	}
	std::string name;
	if (auto light = read_light_node(p_index, node, p_tree, name)) {
		parts.push_back(std::move(light));
		part_names.push_back(name);
	}
	if (auto camera = read_camera_node(node, name)) {
		parts.push_back(std::move(camera));
		part_names.push_back(name);
	}
	if (parts.empty()) {
		parts.push_back(std::make_unique<Node3D>());
		part_names.push_back(text("Node ", p_index));
	}
	part_names[0] = node.get_name(part_names[0]);
	parts[0]->parent_from_node = read_transform(node);
	Node3D *first = nullptr;
	for (size_t part = 0; part < parts.size(); ++part) {
		parts[part]->name = names.make(part_names[part]);
		parts[part]->file_index = static_cast<int>(p_index);
		remember(p_index, *parts[part]);
		if (part > 0) {
			document.part_names[p_index].insert(parts[part]->name);
		}
		Node3D *added = (first ? *first : r_parent).add_child(std::move(parts[part]));
		first = first ? first : added;
	}
	return first;
}

std::unique_ptr<Node3D> GltfReader::read_mesh_node(const GltfObject &p_node) {
	auto instance = std::make_unique<MeshInstance3D>();
	const size_t mesh_index = p_node.require_index("mesh", root.get_count("meshes"));
	const std::vector<MeshInstance3D::Surface> &surfaces = meshes.load_mesh(mesh_index);
	surface_count += surfaces.size();
	if (surface_count > GLTF_MAX_SURFACE_COUNT) {
		p_node.fail_at("mesh",
				text("makes ", surface_count, " primitives in all nodes, must be at most ",
						GLTF_MAX_SURFACE_COUNT, ". Split the scene."));
	}
	instance->surfaces = surfaces;
	if (!instance->surfaces.empty()) {
		const auto key = GltfDocument::make_key(instance->surfaces);
		if (document.mesh_indices.emplace(key, mesh_index).second) {
			document.kept_surfaces.push_back(instance->surfaces);
		}
	}
	if (const std::optional<GltfObject> extras = p_node.find_extras()) {
		instance->casts_shadow = extras->read_bool("casts_shadow", true);
		instance->is_planar_receiver = extras->read_bool("shadow_planar_receiver", false);
	}
	return instance;
}

std::optional<GltfObject> GltfReader::find_area_light(const GltfObject &p_node) const {
	const std::optional<GltfObject> reference = p_node.find_extension(GLTF_AREA);
	if (!reference) {
		return std::nullopt;
	}
	const std::optional<GltfObject> area = root.find_extension(GLTF_AREA);
	const size_t count = area ? area->get_count("lights") : 0;
	return area->get_element("lights", reference->require_index("light", count));
}

std::unique_ptr<Light3D> GltfReader::read_light_node(
		size_t p_index, const GltfObject &p_node, const GltfTree &p_tree, std::string &r_name) {
	const std::optional<GltfObject> reference = p_node.find_extension(GLTF_PUNCTUAL);
	const std::optional<GltfObject> area = find_area_light(p_node);
	if (!reference) {
		if (area) {
			p_node.get_messages().warn("area light", p_node.get_path(),
					"has an area light alone; only one beside a KHR_lights_punctual light is "
					"read.");
		}
		return nullptr;
	}
	const std::optional<GltfObject> punctual = root.find_extension(GLTF_PUNCTUAL);
	const size_t count = punctual ? punctual->get_count("lights") : 0;
	const size_t light_index = reference->require_index("light", count);
	GltfLightPlaces places{ light_index, punctual->get_element("lights", light_index), area,
		{ p_node } };
	if (const std::optional<size_t> owner = find_blender_owner(p_index, p_tree, root)) {
		places.nodes.push_back(root.get_element("nodes", *owner));
		document.blender_owners[p_index] = *owner;
	}
	auto light = std::make_unique<Light3D>();
	if (!read_light(places, options, *light)) {
		return nullptr;
	}
	for (const auto &[name, value] : light->properties) {
		const std::string *words = std::get_if<std::string>(&value);
		light_value_count += 1 + (name.size() + (words ? words->size() : 0)) / 64;
	}
	if (light_value_count > GLTF_MAX_LIGHT_VALUE_COUNT) {
		places.light.fail_at("extras",
				text("make more than ", GLTF_MAX_LIGHT_VALUE_COUNT,
						" values in all nodes with lights. Shorten them, or split the scene."));
	}
	r_name = places.light.get_name(text("Light ", light_index));
	return light;
}

std::unique_ptr<Camera3D> GltfReader::read_camera_node(
		const GltfObject &p_node, std::string &r_name) {
	const std::optional<size_t> index = p_node.find_index("camera", root.get_count("cameras"));
	if (!index) {
		return nullptr;
	}
	const GltfObject camera = root.get_element("cameras", *index);
	const std::optional<GltfObject> perspective = camera.find_object("perspective");
	if (camera.get_text("type") != "perspective" || !perspective) {
		GltfMessages &messages = camera.get_messages();
		messages.warn("camera", camera.get_path(), "is not perspective; it is left out.");
		return nullptr;
	}
	auto node = std::make_unique<Camera3D>();
	node->vertical_fov_rad = static_cast<float>(perspective->read_number(
			"yfov", node->vertical_fov_rad, MIN_FOV_RAD, MAX_FOV_RAD, "rad"));
	node->near_m = static_cast<float>(
			perspective->read_number("znear", node->near_m, MIN_NEAR_M, MAX_NEAR_M, "m"));
	r_name = camera.get_name(text("Camera ", *index));
	return node;
}

/// Notes what the node is now, so that saving knows what has changed.
void GltfReader::remember(size_t p_index, const Node3D &p_node) {
	GltfNodeState &state = document.nodes[p_index];
	if (!state.is_loaded) {
		state.is_loaded = true;
		state.name = p_node.name;
		state.parent_from_node = p_node.parent_from_node;
	}
	if (const auto *instance = dynamic_cast<const MeshInstance3D *>(&p_node)) {
		state.casts_shadow = instance->casts_shadow;
		state.is_planar_receiver = instance->is_planar_receiver;
		document.node_surfaces[p_index] = GltfDocument::make_key(instance->surfaces);
	} else if (const auto *light = dynamic_cast<const Light3D *>(&p_node)) {
		document.lights.emplace(p_index, *light);
	} else if (const auto *camera = dynamic_cast<const Camera3D *>(&p_node)) {
		document.cameras[p_index] = { camera->vertical_fov_rad, camera->near_m };
	}
}

/// Where the file stands, and what it may refer to.
GltfPlace find_place(const std::filesystem::path &p_path, const GltfLoadOptions &p_options) {
	GltfPlace place;
	place.folder = std::filesystem::absolute(p_path).parent_path();
	place.project_folder =
			p_options.project_folder.empty() ? place.folder : p_options.project_folder;
	if (!is_inside_folder(p_path, place.project_folder)) {
		fail("\"", p_path.string(), "\" lies outside of the project folder ", place.project_folder,
				". Move it into the project.");
	}
	return place;
}

} // namespace

std::unique_ptr<Scene> load_gltf(
		const std::filesystem::path &p_path, const GltfLoadOptions &p_options) {
	find_place(p_path, p_options); // refuses a file elsewhere before it is read
	return parse_gltf(load_file(p_path, GLTF_MAX_FILE_BYTES), p_path, p_options);
}

std::unique_ptr<Scene> parse_gltf(std::span<const uint8_t> p_bytes,
		const std::filesystem::path &p_path, const GltfLoadOptions &p_options) {
	GltfMessages messages{ p_path.string(), {} };
	auto document = std::make_shared<GltfDocument>();
	document->file = p_path.string();
	document->place = find_place(p_path, p_options);
	document->container = parse_gltf_container(p_bytes, messages);
	auto scene = std::make_unique<Scene>();
	scene->path = p_path.string();
	scene->document = document;
	try {
		GltfReader(*document, messages, p_options).read(*scene);
	} catch (const std::bad_alloc &) {
		fail(messages.describe("the scene", "does not fit into memory. Split it."));
	}
	return scene;
}

} // namespace gnomon
