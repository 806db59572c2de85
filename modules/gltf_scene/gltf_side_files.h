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
	/// Adds a file to write and returns its name: the requested one, with a number appended if
	/// another file has that name already.
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

/// Prepares a copy of a document for another form or folder: moves buffer 0 into or out of the BIN
/// chunk and copies the files that URIs reference. A missing file is an Error for a buffer that
/// must move; for an image it is ignored.
void relocate_container(const GltfDocument &p_document, const std::filesystem::path &p_target,
		GltfForm p_form, GltfContainer &r_container, GltfSideFiles &r_files);

} // namespace gnomon
