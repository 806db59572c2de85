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

/// The edited scene: its file, its unsaved changes, its undo history and the selection. It does not
/// depend on the user interface.
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
	/// Returns the timeline, which selects the animation and the time at which the scene is shown.
	/// Using it is not a change of the scene.
	Timeline &get_timeline() { return timeline; }
	const Timeline &get_timeline() const { return timeline; }
	/// Returns why the file could not be read; empty: it was read. A document with a failure cannot
	/// be saved, because that would overwrite the file; it is reloaded when the file changes.
	const std::string &get_failure() const { return failure; }
	StageMode get_stage() const { return stage; }
	/// Returns one line that lists what stage_scene added to the scene; empty: nothing.
	const std::string &get_staged() const { return staged; }
	/// Returns the names of the staged nodes, which saving skips, separated by commas; empty: none.
	std::string list_staged() const;
	/// Whether there are unsaved changes.
	bool is_changed() const { return is_recovered || !history.is_saved(); }

	/// Returns the selected node; null: none.
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
	/// Removes a node with its descendants. Removing the root is an Error.
	void remove(Node3D &r_node);
	/// Copies the node with its descendants, gives the copies new names, and selects the copy.
	/// Duplicating the root is an Error.
	void duplicate(Node3D &r_node);
	/// Undoes a step, selects the node that changed (nothing, if that left the tree or is the root)
	/// and returns the step's name; empty: nothing to undo.
	std::string undo();
	/// Repeats an undone step; otherwise like undo.
	std::string redo();

	/// Switches a module on or off, in this process and in the project's project.cfg. Not undoable.
	void set_module_enabled(const std::string &p_name, bool p_is_enabled);

	/// Saves atomically. After an Error the old file and all changes are intact.
	void save();
	/// Like save, to another file, which becomes the document's file.
	void save_as(const std::filesystem::path &p_path);
	/// Returns the path of the recovery file, which autosave writes next to the scene.
	std::filesystem::path get_recovery_path() const;
	/// Writes the recovery file once new changes are as old as the autosave interval. Call it once
	/// a frame. Returns false on failure, which is logged; it retries after another interval.
	bool autosave(Clock::time_point p_now);
	void set_autosave_interval(std::chrono::seconds p_interval) { autosave_interval = p_interval; }
	/// Writes the recovery file at once if there are unsaved changes.
	void save_recovery();
	/// Whether there is a recovery file. When the document was just opened, it contains unsaved
	/// changes of an earlier session.
	bool has_recovery() const;
	/// Loads the recovery file; the document then counts as changed. If it cannot be read, it is
	/// preserved under another name, and an Error is thrown.
	void recover();
	/// Deletes the recovery file, even that of an earlier session.
	void discard_recovery();
	/// Deletes the recovery file if this document wrote or loaded it.
	void discard_own_recovery();

	/// Whether another program has written the file, or one that it references, since it was read
	/// or saved.
	bool is_file_newer() const;
	/// Ignores the newer file: the next save overwrites it.
	void ignore_newer_file() { record_file_times(); }
	/// Reloads the file. Changes and history are lost; the selection is restored by name. An Error
	/// leaves scene and history unchanged; is_file_newer is then false until the file changes
	/// again.
	void reload();

private:
	/// Loads the scene from a file; clears the history and the selection.
	void open(const std::filesystem::path &p_file);
	/// Opens the document's file and records the modification times of its files.
	void read_file();
	/// Records the current modification times of the files.
	void record_file_times();
	/// Modification times of the scene's files, by path. The .bin of the scene's name is always
	/// checked: a scene that could not be read has not listed its files, and may merely lack that
	/// one.
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
	bool is_recovered = false;	// the scene comes from the recovery file and is not saved yet
	bool owns_recovery = false; // this document wrote or loaded the recovery file
	FileTimes file_times;
	std::chrono::seconds autosave_interval = AUTOSAVE_INTERVAL;
	uint64_t autosaved_serial = 0; // UndoHistory::get_serial of the last saved or autosaved state
	std::optional<Clock::time_point> changed_since; // start of the wait for the next autosave
};

} // namespace gnomon
