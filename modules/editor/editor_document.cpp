#include "modules/editor/editor_document.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/core/module_registry.h"
#include "modules/core/project.h"
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/scene/node_properties.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/light_properties.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

namespace fs = std::filesystem;

namespace {

/// Finds a node by name in a tree. Returns null if there is none.
Node3D *find_node(Node3D &r_root, const std::string &p_name) {
	if (r_root.name == p_name) {
		return &r_root;
	}
	for (const std::unique_ptr<Node3D> &child : r_root.children) {
		if (Node3D *node = find_node(*child, p_name)) {
			return node;
		}
	}
	return nullptr;
}

/// Appends the smallest number from 2 that makes the name unique.
std::string make_free_name(Node3D &r_root, const std::string &p_name) {
	for (int number = 2;; ++number) {
		const std::string name = text(p_name, " ", number);
		if (find_node(r_root, name) == nullptr) {
			return name;
		}
	}
}

/// Copies the node with its descendants, and gives each copy a unique name.
std::unique_ptr<Node3D> copy_tree(const Node3D &p_node, Node3D &r_root) {
	std::unique_ptr<Node3D> copy = p_node.copy();
	copy->file_index = -1;
	copy->name = make_free_name(r_root, p_node.name);
	for (const std::unique_ptr<Node3D> &child : p_node.children) {
		copy->add_child(copy_tree(*child, r_root));
	}
	return copy;
}

} // namespace

EditorDocument::EditorDocument(const fs::path &p_path, StageMode p_stage) : stage(p_stage) {
	const ProjectScene found = find_project_scene(p_path);
	project = found.project;
	path = fs::absolute(found.scene_path);
	if (const auto name = project.defaults.find("animation"); name != project.defaults.end()) {
		timeline = Timeline(name->second);
	}
	disable_modules(project);
	apply_technique_settings(project);
	std::error_code code;
	if (!fs::exists(path, code)) {
		fail("Scene ", path, " does not exist. Check the path.");
	}
	try {
		read_file();
	} catch (const Error &error) {
		scene = std::make_unique<Scene>();
		timeline.set_scene(*scene);
		failure = error.what();
		log_error(failure);
	}
}

EditorDocument::~EditorDocument() {
	if (!is_changed()) {
		discard_own_recovery();
	}
}

void EditorDocument::open(const fs::path &p_file) {
	GltfLoadOptions options;
	options.project_folder = project.folder;
	options.find_technique_property = &find_added_light_property;
	std::unique_ptr<Scene> loaded = load_gltf(p_file, options);
	staged = stage_scene(*loaded, stage);
	if (!staged.empty()) {
		log_info(staged, " Untick \"staged\" on the nodes that should be saved.");
	}
	selected = nullptr;
	history = UndoHistory();
	scene = std::move(loaded);
	timeline.set_scene(*scene);
	failure.clear();
	autosaved_serial = 0;
	changed_since.reset();
}

void EditorDocument::read_file() {
	const FileTimes before = read_file_times();
	file_times = before; // even if reading fails, so that it is not retried before a change
	open(path);
	record_file_times(); // the scene may refer to other files now
	for (auto &[file, time] : file_times) {
		if (const auto previous = before.find(file); previous != before.end()) {
			time = previous->second; // a file written during the reading counts as newer
		}
	}
}

void EditorDocument::record_file_times() {
	file_times = read_file_times();
}

EditorDocument::FileTimes EditorDocument::read_file_times() const {
	std::vector<fs::path> files = scene ? scene->side_files : std::vector<fs::path>();
	files.push_back(path);
	files.push_back(fs::path(path).replace_extension(".bin"));
	FileTimes times;
	for (const fs::path &file : files) {
		std::error_code code;
		const fs::file_time_type time = fs::last_write_time(file, code);
		if (!code) {
			times[file] = time;
		}
	}
	return times;
}

Bounds EditorDocument::compute_selected_bounds() const {
	const double MIN_HALF_SIZE_FRACTION = 0.05; // half the smallest box, as a fraction of S
	const auto snapshot = build_snapshot(*scene, Camera3D());
	if (selected == nullptr) {
		return snapshot->compute_caster_bounds();
	}
	Bounds bounds = selected->compute_bounds();
	// Not simply the node's position: the bounds of a skinned mesh follow its joints, not its node.
	const glm::dvec3 center = bounds.is_empty() ? glm::dvec3(selected->compute_world_from_node()[3])
												: 0.5 * (bounds.minimum + bounds.maximum);
	bounds.add(center - glm::dvec3(MIN_HALF_SIZE_FRACTION * snapshot->scene_size_m));
	bounds.add(center + glm::dvec3(MIN_HALF_SIZE_FRACTION * snapshot->scene_size_m));
	return bounds;
}

void EditorDocument::set_property(Node3D &r_node, const std::string &p_name,
		const std::optional<PropertyValue> &p_value, bool p_is_drag) {
	history.change(r_node, text(p_value ? "Set " : "Reset ", p_name, " of ", r_node.name),
			p_is_drag ? p_name : std::string(),
			[&] { set_node_property(r_node, p_name, p_value); });
	timeline.pose();
}

void EditorDocument::rename(Node3D &r_node, const std::string &p_name) {
	if (p_name.empty()) {
		fail(r_node.get_class_name(), " \"", r_node.name,
				"\": its name cannot be empty. Type at least one letter.");
	}
	if (p_name != r_node.name && find_node(*scene->root, p_name) != nullptr) {
		fail(r_node.get_class_name(), " \"", r_node.name, "\": another node is named \"", p_name,
				"\" already. Choose another name.");
	}
	history.change(r_node, text("Rename ", r_node.name), {}, [&] { r_node.name = p_name; });
}

void EditorDocument::remove(Node3D &r_node) {
	if (&r_node == scene->root.get()) {
		fail("The scene's root cannot be deleted. Select one of its children.");
	}
	history.remove(r_node, text("Delete ", r_node.name));
	timeline.pose();
	selected = nullptr;
}

void EditorDocument::duplicate(Node3D &r_node) {
	if (&r_node == scene->root.get()) {
		fail("The scene's root cannot be duplicated. Select one of its children.");
	}
	std::unique_ptr<Node3D> copy = copy_tree(r_node, *scene->root);
	Node3D *copied_node = copy.get();
	copied_node->is_staged = false; // the copy is the user's node and is saved
	history.add(*r_node.parent, std::move(copy), text("Duplicate ", r_node.name));
	timeline.pose();
	selected = copied_node;
}

std::string EditorDocument::undo() {
	if (!history.can_undo()) {
		return {};
	}
	const std::string name = history.get_undo_name();
	Node3D *node = history.undo();
	timeline.pose();
	// Without a parent it has left the tree, or is the root.
	selected = node->parent != nullptr ? node : nullptr;
	return name;
}

std::string EditorDocument::redo() {
	if (!history.can_redo()) {
		return {};
	}
	const std::string name = history.get_redo_name();
	Node3D *node = history.redo();
	timeline.pose();
	selected = node->parent != nullptr ? node : nullptr;
	return name;
}

void EditorDocument::set_module_enabled(const std::string &p_name, bool p_is_enabled) {
	ModuleRegistry::set_enabled(p_name, p_is_enabled);
	for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
		// Names of modules that this build lacks stay in the list.
		std::erase(project.disabled_modules, module.name);
		if (!module.is_enabled) {
			project.disabled_modules.push_back(module.name);
		}
	}
	project.save_disabled_modules();
}

std::string EditorDocument::list_staged() const {
	std::string names;
	for (const Node3D *node : scene->find_nodes<Node3D>()) {
		if (node->is_staged) {
			names += (names.empty() ? "" : ", ") + node->name;
		}
	}
	return names;
}

void EditorDocument::save() {
	save_as(path);
}

void EditorDocument::save_as(const fs::path &p_path) {
	if (!failure.empty()) {
		fail("Scene ", path, " was not read, so there is nothing to save: ", failure);
	}
	save_gltf(*scene, p_path);
	discard_own_recovery();
	path = fs::absolute(p_path);
	history.set_saved();
	autosaved_serial = history.get_serial();
	is_recovered = false;
	changed_since.reset();
	record_file_times();
}

fs::path EditorDocument::get_recovery_path() const {
	return path.parent_path() /
			("." + path.stem().string() + ".recovery" + path.extension().string());
}

bool EditorDocument::autosave(Clock::time_point p_now) {
	if (!is_changed() || history.get_serial() == autosaved_serial) {
		changed_since.reset();
		return true;
	}
	if (!changed_since) {
		changed_since = p_now;
	}
	if (p_now - *changed_since < autosave_interval) {
		return true;
	}
	changed_since = p_now;
	try {
		save_recovery();
	} catch (const Error &error) {
		log_error("Changes cannot be saved in the recovery file: ", error.what());
		return false;
	}
	return true;
}

void EditorDocument::save_recovery() {
	if (!is_changed()) {
		return;
	}
	save_gltf(*scene, get_recovery_path());
	owns_recovery = true;
	autosaved_serial = history.get_serial();
	changed_since.reset();
}

bool EditorDocument::has_recovery() const {
	std::error_code code;
	return fs::exists(get_recovery_path(), code);
}

void EditorDocument::recover() {
	try {
		open(get_recovery_path());
	} catch (const Error &error) {
		const fs::path moved = get_recovery_path().string() + ".unread";
		std::error_code code;
		fs::rename(get_recovery_path(), moved, code);
		fail("The recovery file ", get_recovery_path(), " cannot be read",
				code ? std::string() : text(" and was renamed to ", moved), ": ", error.what());
	}
	is_recovered = true;
	owns_recovery = true;
}

void EditorDocument::discard_recovery() {
	std::error_code code;
	fs::remove(get_recovery_path(), code);
	owns_recovery = false;
}

void EditorDocument::discard_own_recovery() {
	if (owns_recovery) {
		discard_recovery();
	}
}

bool EditorDocument::is_file_newer() const {
	const FileTimes now = read_file_times();
	// While the scene file does not exist, another program is still writing it.
	return now != file_times && now.contains(path);
}

void EditorDocument::reload() {
	const std::string name = selected != nullptr ? selected->name : std::string();
	read_file();
	selected = name.empty() ? nullptr : find_node(*scene->root, name);
	is_recovered = false;
}

} // namespace gnomon
