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

/// The scene that is edited: its file, its changes, what is selected. Nothing here draws.
class EditorDocument {
public:
	using Clock = std::chrono::steady_clock;
	static constexpr std::chrono::seconds AUTOSAVE_INTERVAL{ 20 }; // the default

	/// p_path: as find_project_scene. A scene that is not there is an Error. One that cannot be
	/// read opens empty and is reported in the log, see get_failure. p_stage: see stage_scene; what
	/// is added is no change.
	explicit EditorDocument(
			const std::filesystem::path &p_path, StageMode p_stage = StageMode::OFF);
	/// What this document put aside is removed when nothing of it would be lost.
	~EditorDocument();
	EditorDocument(const EditorDocument &) = delete;
	EditorDocument &operator=(const EditorDocument &) = delete;

	Scene &get_scene() { return *scene; }
	const Project &get_project() const { return project; }
	const std::filesystem::path &get_path() const { return path; }
	UndoHistory &get_history() { return history; }
	/// What is shown of the scene's animations; no change of it.
	Timeline &get_timeline() { return timeline; }
	const Timeline &get_timeline() const { return timeline; }
	/// Why there is nothing of the file: what is wrong with it. Empty: it was read. Such a document
	/// is not saved, for the file would be lost; it is read again once it has changed.
	const std::string &get_failure() const { return failure; }
	StageMode get_stage() const { return stage; }
	/// What was added to the file's scene, in one line; empty: nothing.
	const std::string &get_staged() const { return staged; }
	/// The names of nodes that a save skips; empty: none.
	std::string list_staged() const;
	bool is_changed() const { return is_recovered || !history.is_saved(); }

	/// Null: nothing.
	Node3D *get_selected() const { return selected; }
	void select(Node3D *p_node) { selected = p_node; }
	/// What the selected node shows, or a little space about it; of the scene's casters when
	/// nothing is selected.
	Bounds compute_selected_bounds() const;

	/// One step that can be undone. A refused value is an Error, and nothing changes. p_is_drag:
	/// steps of the same property are joined until end_drag().
	void set_property(Node3D &r_node, const std::string &p_name,
			const std::optional<PropertyValue> &p_value, bool p_is_drag = false);
	void end_drag() { history.close(); }
	/// An empty name, or one that another node has, is an Error.
	void rename(Node3D &r_node, const std::string &p_name);
	void remove(Node3D &r_node);
	/// Next to the node, with a name of its own; it is selected then.
	void duplicate(Node3D &r_node);
	/// Selects what changed, and returns what it was; empty: nothing to undo.
	std::string undo();
	std::string redo();

	/// Of this program and of the project, whose project.cfg is written. Not a step to undo.
	void set_module_enabled(const std::string &p_name, bool p_is_enabled);

	/// The file is the old one or the new one. An Error loses nothing.
	void save();
	void save_as(const std::filesystem::path &p_path);
	/// Where the changes go from time to time, next to the file.
	std::filesystem::path get_recovery_path() const;
	/// Writes the changes aside when they have waited long enough. False: that failed; once a while
	/// it is tried again.
	bool autosave(Clock::time_point p_now);
	void set_autosave_interval(std::chrono::seconds p_interval) { autosave_interval = p_interval; }
	/// Writes changes aside now; for when the program is about to end.
	void save_aside();
	/// True when an earlier program ended without saving what is there.
	bool has_recovery() const;
	/// Takes over what was saved aside; it counts as changed. Where it cannot be read it stays
	/// under another name, and that is an Error.
	void recover();
	/// Whosever it is.
	void discard_recovery();
	/// What this document itself put aside or took over is no longer needed.
	void discard_own_recovery();

	/// True when another program has written the file, or one that it refers to, since it was read
	/// or saved.
	bool is_file_newer() const;
	/// The file's newer state is not needed: the next save writes over it.
	void keep_over_file() { note_file_time(); }
	/// Reads the file again. Changes and history are lost; what has the selected node's name is
	/// selected. An Error leaves everything as it is.
	void reload();

private:
	void open(const std::filesystem::path &p_file);
	void read_file();
	void note_file_time();
	/// When the scene's files were written. A scene that could not be read may lack its .bin only.
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
	bool owns_recovery = false; // what was put aside is this document's, not an earlier one's
	FileTimes file_times;
	std::chrono::seconds autosave_interval = AUTOSAVE_INTERVAL;
	uint64_t autosaved_serial = 0;
	std::optional<Clock::time_point> changed_since;
};

} // namespace gnomon
