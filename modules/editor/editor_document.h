#pragma once

#include "modules/core/project.h"
#include "modules/editor/timeline.h"
#include "modules/editor/undo_history.h"
#include "modules/scene/nodes.h"
#include "modules/scene/stage.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace gnomon {

/// The edited scene: its file, its changes and the selection. It has no drawing code.
class EditorDocument {
public:
	using Clock = std::chrono::steady_clock;
	static constexpr std::chrono::seconds AUTOSAVE_INTERVAL{ 20 }; // the default

	/// p_path: see find_project_scene. A scene that does not exist is an Error. One that cannot be
	/// read opens empty and is reported in the log, see get_failure. p_stage: see stage_scene;
	/// staged nodes do not count as changes.
	explicit EditorDocument(
			const std::filesystem::path &p_path, StageMode p_stage = StageMode::OFF);
	/// Removes this document's recovery file unless unsaved changes would be lost.
	~EditorDocument();
	EditorDocument(const EditorDocument &) = delete;
	EditorDocument &operator=(const EditorDocument &) = delete;

	Scene &get_scene() { return *scene; }
	const Project &get_project() const { return project; }
	const std::filesystem::path &get_path() const { return path; }
	UndoHistory &get_history() { return history; }
	/// Returns which of the scene's animations is shown, and when; it is not a change of the scene.
	Timeline &get_timeline() { return timeline; }
	const Timeline &get_timeline() const { return timeline; }
	/// Returns why the file could not be read; empty: it was read. Such a document cannot be saved,
	/// because that would overwrite the file; it is reloaded when the file changes.
	const std::string &get_failure() const { return failure; }
	StageMode get_stage() const { return stage; }
	/// Describes in one line what was added to the file's scene; empty: nothing.
	const std::string &get_staged() const { return staged; }
	/// Lists the names of nodes that saving skips; empty: none.
	std::string list_staged() const;
	bool is_changed() const { return is_recovered || !history.is_saved(); }

	/// Null: nothing is selected.
	Node3D *get_selected() const { return selected; }
	void select(Node3D *p_node) { selected = p_node; }
	/// Returns the bounds of the selected node, enlarged to at least a small box around its centre;
	/// if nothing is selected, those of the scene's casters.
	Bounds compute_selected_bounds() const;

	/// Sets a property, or resets it if p_value is empty, as one undoable step. An invalid value is
	/// an Error and changes nothing. p_is_drag: steps of the same property are merged until
	/// end_drag().
	void set_property(Node3D &r_node, const std::string &p_name,
			const std::optional<PropertyValue> &p_value, bool p_is_drag = false);
	void end_drag() { history.close(); }
	/// Renames a node. An empty name, or one that another node has, is an Error.
	void rename(Node3D &r_node, const std::string &p_name);
	void remove(Node3D &r_node);
	/// Duplicates the node next to itself under a new name, and selects the copy.
	void duplicate(Node3D &r_node);
	/// Undoes a step, selects the node that changed and returns the step's name; empty: nothing to
	/// undo.
	std::string undo();
	std::string redo();

	/// Switches a module in this program and in the project, and writes its project.cfg. Not
	/// undoable.
	void set_module_enabled(const std::string &p_name, bool p_is_enabled);

	/// Saves atomically. After an Error the old file and all changes are intact.
	void save();
	void save_as(const std::filesystem::path &p_path);
	/// Path of the recovery file, next to the scene, that autosave writes.
	std::filesystem::path get_recovery_path() const;
	/// Writes the recovery file if the changes are old enough. Returns false on failure; it retries
	/// after another interval.
	bool autosave(Clock::time_point p_now);
	void set_autosave_interval(std::chrono::seconds p_interval) { autosave_interval = p_interval; }
	/// Writes the recovery file now if there are changes, before the program ends.
	void save_aside();
	/// Whether an earlier program left a recovery file with unsaved changes.
	bool has_recovery() const;
	/// Loads the recovery file; the document then counts as changed. If it cannot be read, it is
	/// preserved under another name, and an Error is thrown.
	void recover();
	/// Deletes the recovery file, even one of another program.
	void discard_recovery();
	/// Deletes the recovery file if this document wrote or loaded it.
	void discard_own_recovery();

	/// Whether another program has written the file, or one that it references, since it was read
	/// or saved.
	bool is_file_newer() const;
	/// Ignores the newer file: the next save overwrites it.
	void keep_over_file() { note_file_time(); }
	/// Reloads the file. Changes and history are lost; the node with the name of the selected one
	/// is selected. An Error leaves everything unchanged.
	void reload();

private:
	void open(const std::filesystem::path &p_file);
	void read_file();
	void note_file_time();
	/// Modification times of the scene's files. A scene that could not be read may merely lack its
	/// .bin.
	using FileTimes = std::map<std::filesystem::path, std::filesystem::file_time_type>;
	FileTimes read_file_times() const;

	Project project;
	std::filesystem::path path;
	StageMode stage;
	std::unique_ptr<Scene> scene;
	std::string failure;
	std::string staged;
	UndoHistory history;
	Timeline timeline;
	Node3D *selected = nullptr;
	bool is_recovered = false;
	bool owns_recovery = false; // the recovery file is this document's, not an earlier program's
	FileTimes file_times;
	std::chrono::seconds autosave_interval = AUTOSAVE_INTERVAL;
	uint64_t autosaved_serial = 0;
	std::optional<Clock::time_point> changed_since;
};

} // namespace gnomon
