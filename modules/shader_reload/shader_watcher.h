#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// The result of recompiling an entry point after its source or one of its includes has changed.
struct ShaderChange {
	std::string name;			 // name of the embedded shader, EmbeddedShader::name
	std::vector<uint32_t> spirv; // empty on failure
	std::string failure;		 // error message of the compiler; empty on success
};

/// Watches the source files of the shaders that are embedded in this build, and recompiles them
/// when they change.
class ShaderWatcher {
public:
	/// p_folder: root of the shader sources. Embedded shaders without a source file there are not
	/// watched. If the folder does not exist, nothing is watched.
	explicit ShaderWatcher(std::filesystem::path p_folder);

	/// Recompiles the entry points whose files have changed since the last call, or since
	/// construction. A deleted file counts as changed only after it exists again, with another
	/// modification time, because editors may replace a file by deleting and recreating it. An
	/// entry point's own file that is deleted during a call, after the call has found it
	/// changed, is not watched any more; the call reports it as a failure.
	std::vector<ShaderChange> poll();
	/// Number of watched entry points.
	size_t get_watched_count() const { return entry_points.size(); }

private:
	struct File {
		std::filesystem::file_time_type time;
		std::vector<std::string> includes;
	};
	/// Starts to watch a file and, recursively, its includes.
	void add_file(const std::string &p_name);
	/// Returns the file itself and all files that it includes directly or indirectly.
	std::set<std::string> find_all_files(const std::string &p_name) const;
	/// Returns the files that were modified, and missing includes that now exist. Starts to watch
	/// the latter.
	std::set<std::string> find_changed_files();

	std::filesystem::path folder;
	std::vector<std::string> entry_points;
	std::map<std::string, File> files; // by path relative to the folder
};

} // namespace gnomon
