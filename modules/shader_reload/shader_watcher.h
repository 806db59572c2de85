#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// An entry point whose source, or something that it includes, has changed.
struct ShaderChange {
	std::string name; // as the build embeds it
	std::vector<uint32_t> spirv;
	std::string failure; // what the compiler reports; empty: it compiled
};

/// Follows the sources of the shaders that this build embeds.
class ShaderWatcher {
public:
	/// p_folder: that of the shaders' sources. What it lacks is not watched; a folder that is not
	/// there watches nothing.
	explicit ShaderWatcher(std::filesystem::path p_folder);

	/// Compiles what has changed since the last call, or since the watcher was made. A file that is
	/// away for the moment counts when it is back.
	std::vector<ShaderChange> poll();
	size_t get_watched_count() const { return entry_points.size(); }

private:
	struct File {
		std::filesystem::file_time_type time;
		std::vector<std::string> includes;
	};
	void add_file(const std::string &p_name);
	/// The file itself, and all that it includes in the end.
	std::set<std::string> find_all_files(const std::string &p_name) const;
	std::set<std::string> find_changed_files();

	std::filesystem::path folder;
	std::vector<std::string> entry_points;
	std::map<std::string, File> files; // by path below the folder
};

} // namespace gnomon
