#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/gltf_scene/gltf_animations.h"
#include "modules/gltf_scene/gltf_check.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_lights.h"
#include "modules/gltf_scene/gltf_meshes.h"
#include "modules/gltf_scene/gltf_rigs.h"
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/gltf_scene/gltf_tree.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <unordered_map>

namespace gnomon {

namespace {

const double MAX_NEAR_M = 1e9;
const double MIN_NEAR_M = 1e-6;
const double MAX_FOV_RAD = 3.14159; // must be below pi
const double MIN_FOV_RAD = 1e-4;	// a narrower view would show nothing

/// Makes the names of the scene's nodes unique by appending numbers.
class UniqueNames {
public:
	std::string make(const std::string &p_requested) {
		std::string name = p_requested;
		while (!taken.insert(name).second) {
			name = text(p_requested, "_", ++counts.try_emplace(p_requested, 1).first->second);
		}
		return name;
	}

private:
	std::set<std::string> taken;
	std::unordered_map<std::string, unsigned> counts;
};

/// Reads and checks a camera. An invalid value is reported, and its default used. Returns nothing
/// for a camera that is not perspective.
std::optional<GltfCamera> read_camera(const GltfObject &p_camera) {
	const auto perspective = p_camera.find_object("perspective");
	if (p_camera.get_text("type") != "perspective" || !perspective) {
		p_camera.get_messages().warn(
				"camera", p_camera.get_path(), "is not perspective; it is skipped.");
		return std::nullopt;
	}
	GltfCamera camera;
	camera.vertical_fov_rad = static_cast<float>(perspective->read_number(
			"yfov", camera.vertical_fov_rad, MIN_FOV_RAD, MAX_FOV_RAD, "rad"));
	camera.near_m = static_cast<float>(
			perspective->read_number("znear", camera.near_m, MIN_NEAR_M, MAX_NEAR_M, "m"));
	return camera;
}

std::vector<std::optional<GltfCamera>> read_cameras(const GltfObject &p_root) {
	std::vector<std::optional<GltfCamera>> cameras;
	p_root.for_each("cameras",
			[&](const GltfObject &p_camera) { cameras.push_back(read_camera(p_camera)); });
	return cameras;
}

/// Builds the scene from a parsed document, and records in the document what saving needs.
class GltfReader {
public:
	/// p_root: the document's JSON, which has passed check_gltf. p_model: tinygltf's model of it.
	GltfReader(GltfDocument &r_document, const GltfObject &p_root, const tinygltf::Model &p_model,
			const GltfLoadOptions &p_options) :
			document(r_document),
			root(p_root), model(p_model), options(p_options), messages(p_root.get_messages()),
			lights(read_light_definitions(root)), cameras(read_cameras(root)),
			buffers(root, r_document.location, get_bin_chunk()),
			accessors(model, buffers, messages), textures(root, model, buffers),
			meshes(root, model, accessors, textures) {}

	void read(Scene &r_scene);

private:
	const std::vector<uint8_t> *get_bin_chunk() const {
		return document.container.bin_chunk ? &*document.container.bin_chunk : nullptr;
	}
	std::vector<size_t> choose_scene(const GltfTree &p_tree, Scene &r_scene);
	Node3D *read_node(size_t p_index, const GltfTree &p_tree, Node3D &r_parent);
	std::unique_ptr<Node3D> read_mesh_node(size_t p_index, const GltfTree &p_tree);
	void read_motion(const tinygltf::Node &p_node, const std::string &p_path,
			const GltfTree &p_tree, MeshInstance3D &r_instance);
	std::unique_ptr<Light3D> read_light_node(
			size_t p_index, const GltfTree &p_tree, std::string &r_name);
	std::unique_ptr<Camera3D> read_camera_node(size_t p_index, std::string &r_name);
	std::optional<GltfObject> find_area_light(const GltfObject &p_node) const;
	GltfObject get_node(size_t p_index) const { return root.get_element("nodes", p_index); }
	void record_node_state(size_t p_index, const Node3D &p_node);

	GltfDocument &document;
	const GltfObject root;
	const tinygltf::Model &model;
	const GltfLoadOptions &options;
	GltfMessages &messages;
	std::vector<std::optional<LightSettings>> lights; // by index in the file; null: not read
	std::vector<std::optional<GltfCamera>> cameras;	  // in the same way
	GltfBuffers buffers;
	GltfAccessors accessors;
	GltfTextures textures;
	GltfMeshes meshes;
	std::map<int, std::shared_ptr<const Skin>> skins;
	UniqueNames names;
	uint64_t surface_count = 0;		// of all nodes so far
	uint64_t light_value_count = 0; // of all nodes so far
};

void GltfReader::read(Scene &r_scene) {
	const GltfTree tree = build_gltf_tree(model, messages);
	document.nodes.resize(tree.parents.size());
	// An explicit stack. The children of a node are pushed in reverse, so that they are visited in
	// order.
	std::vector<std::pair<size_t, Node3D *>> pending;
	const auto push = [&](const std::vector<size_t> &p_indices, Node3D *p_parent) {
		for (size_t index = p_indices.size(); index-- > 0;) {
			pending.emplace_back(p_indices[index], p_parent);
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
		document.shares_materials |=
				!document.nodes[index].is_loaded && model.nodes[index].mesh >= 0;
	}
	r_scene.animations = read_animations(model, accessors, messages);
	r_scene.side_files = buffers.get_files();
}

/// Chooses the default scene, else the first. Reads its size, and returns its root nodes. A file
/// without scenes has all nodes without a parent as roots.
std::vector<size_t> GltfReader::choose_scene(const GltfTree &p_tree, Scene &r_scene) {
	if (model.scenes.empty()) {
		return p_tree.roots;
	}
	const size_t scene_index = static_cast<size_t>(std::max(model.defaultScene, 0));
	document.scene_index = scene_index;
	const tinygltf::Scene &scene = model.scenes[scene_index];
	const GltfObject scene_json = root.get_element("scenes", scene_index);
	if (const auto extras = scene_json.find_extras()) {
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
	for (size_t i = 0; i < scene.nodes.size(); ++i) {
		const size_t index = static_cast<size_t>(scene.nodes[i]);
		if (p_tree.parents[index] != GltfTree::NONE || !seen.insert(index).second) {
			messages.fail(text(scene_json.get_path(), ".nodes[", i, "]"),
					text("is ", index,
							", must be a node without a parent that is listed once. Export the "
							"file again."));
		}
		roots.push_back(index);
	}
	return roots;
}

/// Adds a node of the file to r_parent, without the node's children, and returns it.
Node3D *GltfReader::read_node(size_t p_index, const GltfTree &p_tree, Node3D &r_parent) {
	const tinygltf::Node &node = model.nodes[p_index];
	// A node of the file may have a mesh, a light and a camera at once. The first of them becomes
	// the node of the scene, and the others become its children.
	std::vector<std::unique_ptr<Node3D>> attachments;
	std::vector<std::string> attachment_names;
	if (node.mesh >= 0) {
		attachments.push_back(read_mesh_node(p_index, p_tree));
		attachment_names.push_back(text("Node ", p_index));
	}
	std::string name;
	if (auto light = read_light_node(p_index, p_tree, name)) {
		attachments.push_back(std::move(light));
		attachment_names.push_back(name);
	}
	if (auto camera = read_camera_node(p_index, name)) {
		attachments.push_back(std::move(camera));
		attachment_names.push_back(name);
	}
	if (attachments.empty()) {
		attachments.push_back(std::make_unique<Node3D>());
		attachment_names.push_back(text("Node ", p_index));
	}
	attachment_names[0] = make_name(node.name, attachment_names[0]);
	attachments[0]->parent_from_node = read_transform(node);
	Node3D *first = nullptr;
	for (size_t attachment = 0; attachment < attachments.size(); ++attachment) {
		attachments[attachment]->name = names.make(attachment_names[attachment]);
		attachments[attachment]->file_index = static_cast<int>(p_index);
		record_node_state(p_index, *attachments[attachment]);
		if (attachment > 0) {
			document.attachment_names[p_index].insert(attachments[attachment]->name);
		}
		Node3D *added = (first ? *first : r_parent).add_child(std::move(attachments[attachment]));
		first = first ? first : added;
	}
	return first;
}

std::unique_ptr<Node3D> GltfReader::read_mesh_node(size_t p_index, const GltfTree &p_tree) {
	auto instance = std::make_unique<MeshInstance3D>();
	const tinygltf::Node &node = model.nodes[p_index];
	const std::string path = text("nodes[", p_index, "]");
	const size_t mesh_index = static_cast<size_t>(node.mesh);
	const std::vector<MeshInstance3D::Surface> &surfaces = meshes.load_mesh(mesh_index);
	surface_count += surfaces.size();
	if (surface_count > GLTF_MAX_SURFACE_COUNT) {
		messages.fail(path + ".mesh",
				text("makes ", surface_count, " primitives in all nodes, must be at most ",
						GLTF_MAX_SURFACE_COUNT, ". Split the scene."));
	}
	instance->surfaces = surfaces;
	if (!instance->surfaces.empty()) {
		const auto key = GltfDocument::make_key(instance->surfaces);
		if (document.mesh_indices.emplace(key, mesh_index).second) {
			document.retained_surfaces.push_back(instance->surfaces);
		}
	}
	read_motion(node, path, p_tree, *instance);
	if (const auto extras = get_node(p_index).find_extras()) {
		instance->casts_shadow = extras->read_bool("casts_shadow", true);
		instance->is_planar_receiver = extras->read_bool("shadow_planar_receiver", false);
	}
	return instance;
}

/// Reads the node's skin and its morph target weights.
void GltfReader::read_motion(const tinygltf::Node &p_node, const std::string &p_path,
		const GltfTree &p_tree, MeshInstance3D &r_instance) {
	const std::vector<double> &mesh_weights =
			model.meshes[static_cast<size_t>(p_node.mesh)].weights;
	const std::vector<double> &weights = p_node.weights.empty() ? mesh_weights : p_node.weights;
	uint32_t joint_count = 0;
	size_t target_count = 0;
	for (const MeshInstance3D::Surface &surface : r_instance.surfaces) {
		if (const MeshRig *rig = surface.mesh->attributes.rig.get()) {
			joint_count = std::max(joint_count, rig->joint_count);
			target_count = std::max(target_count, rig->targets.size());
		}
	}
	for (size_t index = 0; index < std::min(weights.size(), target_count); ++index) {
		r_instance.morph_weights.push_back(static_cast<float>(weights[index]));
	}
	r_instance.morph_weights.resize(target_count, 0.0f);
	if (p_node.skin < 0) {
		return;
	}
	std::shared_ptr<const Skin> &skin = skins[p_node.skin];
	if (!skin) {
		const size_t index = static_cast<size_t>(p_node.skin);
		skin = read_skin(model, index, p_tree, accessors, messages);
		document.skin_indices[skin.get()] = index;
		document.retained_skins.push_back(skin);
	}
	if (joint_count > skin->joints.size()) {
		messages.fail(p_path + ".skin",
				text("is ", p_node.skin, ", which has ", skin->joints.size(),
						" joints, but the mesh uses joint ", joint_count - 1,
						". Export the file again."));
	}
	r_instance.skin = skin;
}

std::optional<GltfObject> GltfReader::find_area_light(const GltfObject &p_node) const {
	const auto reference = p_node.find_extension(GLTF_AREA);
	const auto area = root.find_extension(GLTF_AREA);
	if (!reference || !area) {
		return std::nullopt;
	}
	return area->get_element(
			"lights", reference->require_index("light", area->get_count("lights")));
}

/// Returns null if the node has no light that can be read. r_name: receives the name of the light's
/// definition. read_camera_node does the same for a camera.
std::unique_ptr<Light3D> GltfReader::read_light_node(
		size_t p_index, const GltfTree &p_tree, std::string &r_name) {
	const GltfObject node = get_node(p_index);
	const auto reference = node.find_extension(GLTF_PUNCTUAL);
	const std::optional<GltfObject> area = find_area_light(node);
	if (!reference) {
		if (area) {
			messages.warn("area light", node.get_path(),
					"has an area light without a KHR_lights_punctual light, which is "
					"required; it is skipped.");
		}
		return nullptr;
	}
	const size_t index = reference->require_index("light", lights.size());
	GltfLightSources sources{ root.find_extension(GLTF_PUNCTUAL)->get_element("lights", index),
		area, { node } };
	if (const std::optional<size_t> owner = find_blender_owner(p_index, p_tree, model)) {
		sources.nodes.push_back(get_node(*owner));
		document.blender_owners[p_index] = *owner;
	}
	if (!lights[index]) {
		return nullptr;
	}
	auto light = std::make_unique<Light3D>();
	static_cast<LightSettings &>(*light) = *lights[index];
	light->file_path = text("lights[", index, "]");
	read_light_properties(sources, options, light->properties);
	for (const auto &[name, value] : light->properties) { // see GLTF_MAX_LIGHT_VALUE_COUNT
		const std::string *string_value = std::get_if<std::string>(&value);
		light_value_count += 1 + (name.size() + (string_value ? string_value->size() : 0)) / 64;
	}
	if (light_value_count > GLTF_MAX_LIGHT_VALUE_COUNT) {
		messages.fail(sources.definition.get_member_path("extras"),
				text("make more than ", GLTF_MAX_LIGHT_VALUE_COUNT,
						" values in all nodes with lights. Shorten them, or split the scene."));
	}
	r_name = make_name(sources.definition.get_text("name"), text("Light ", index));
	return light;
}

std::unique_ptr<Camera3D> GltfReader::read_camera_node(size_t p_index, std::string &r_name) {
	const int node_camera = model.nodes[p_index].camera;
	if (node_camera < 0 || !cameras[static_cast<size_t>(node_camera)]) {
		return nullptr;
	}
	const size_t index = static_cast<size_t>(node_camera);
	auto node = std::make_unique<Camera3D>();
	node->vertical_fov_rad = cameras[index]->vertical_fov_rad;
	node->near_m = cameras[index]->near_m;
	r_name = make_name(root.get_element("cameras", index).get_text("name"), text("Camera ", index));
	return node;
}

/// Records the node's state, with which saving finds what has changed.
void GltfReader::record_node_state(size_t p_index, const Node3D &p_node) {
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
		document.lights.emplace(p_index, *light); // only its LightSettings
	} else if (const auto *camera = dynamic_cast<const Camera3D *>(&p_node)) {
		document.cameras[p_index] = { camera->vertical_fov_rad, camera->near_m };
	}
}

/// Returns the folders of the file. Throws an Error if it is outside of the project folder.
GltfLocation find_location(const std::filesystem::path &p_path, const GltfLoadOptions &p_options) {
	GltfLocation location;
	location.folder = std::filesystem::absolute(p_path).parent_path();
	location.project_folder =
			p_options.project_folder.empty() ? location.folder : p_options.project_folder;
	if (!is_inside_folder(p_path, location.project_folder)) {
		fail("\"", p_path.string(), "\" is outside of the project folder ", location.project_folder,
				". Move it into the project.");
	}
	return location;
}

} // namespace

std::unique_ptr<Scene> load_gltf(
		const std::filesystem::path &p_path, const GltfLoadOptions &p_options) {
	find_location(p_path, p_options); // rejects a file outside of the project before reading it
	return parse_gltf(load_file(p_path, GLTF_MAX_FILE_BYTES), p_path, p_options);
}

std::unique_ptr<Scene> parse_gltf(std::span<const uint8_t> p_bytes,
		const std::filesystem::path &p_path, const GltfLoadOptions &p_options) {
	GltfMessages messages{ p_path.string(), {} };
	auto document = std::make_shared<GltfDocument>();
	document->file = p_path.string();
	document->location = find_location(p_path, p_options);
	document->container = parse_gltf_container(p_bytes, messages);
	auto scene = std::make_unique<Scene>();
	scene->path = p_path.string();
	scene->document = document;
	try {
		Json json = parse_gltf_json(document->container.json_text, messages);
		check_gltf(json, messages);
		const tinygltf::Model model = parse_gltf_model(json, messages);
		const GltfObject root(json, /*p_path=*/"", messages);
		GltfReader(*document, root, model, p_options).read(*scene);
	} catch (const std::bad_alloc &) {
		fail(messages.describe("the scene", "does not fit into memory. Split it."));
	}
	return scene;
}

} // namespace gnomon
