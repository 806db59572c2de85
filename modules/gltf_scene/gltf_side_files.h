#pragma once

#include "modules/gltf_scene/gltf_document.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace gnomon {

enum class GltfForm { TEXT, BINARY };

/// The files that one save writes next to its scene. Nothing is written before save().
class GltfSideFiles {
public:
	explicit GltfSideFiles(std::filesystem::path p_folder);
	/// Notes a file to write and returns the name it gets: the requested one, or where another file
	/// has that name already, one with a number.
	std::string add(const std::string &p_requested_name, std::vector<uint8_t> p_bytes);
	/// The names that add tries: "desk.bin", "desk_2.bin", and so on.
	static std::string number_name(const std::string &p_name, size_t p_number);
	bool contains(const std::string &p_name) const { return files.count(p_name) > 0; }
	void save() const;

private:
	bool is_taken(const std::string &p_name, const std::vector<uint8_t> &p_bytes) const;

	std::filesystem::path folder;
	std::map<std::string, std::vector<uint8_t>> files;
};

/// Makes a copy of a document ready for another form or folder: buffer 0 moves into the BIN chunk
/// or out of it, and what URIs name is copied along. A missing file is an Error for a buffer that
/// must move, and left as it is for an image.
void relocate_container(const GltfDocument &p_document, const std::filesystem::path &p_target,
		GltfForm p_form, GltfContainer &r_container, GltfSideFiles &r_files);

} // namespace gnomon
