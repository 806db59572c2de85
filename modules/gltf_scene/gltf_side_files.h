#pragma once

#include "modules/gltf_scene/gltf_document.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace gnomon {

/// Collects the buffer and image files that saving a scene writes into p_folder, the folder of the
/// scene file. Nothing is written before save().
class GltfSideFiles {
public:
	explicit GltfSideFiles(std::filesystem::path p_folder);
	/// Adds a file to write and returns its name: the requested one, with a number appended if a
	/// file with that name and other content was added before or is in the folder.
	std::string add(const std::string &p_requested_name, std::vector<uint8_t> p_bytes);
	/// Returns the name that add tries in attempt p_number: "desk.bin" for 1, "desk_2.bin" for 2,
	/// and so on.
	static std::string make_numbered_name(const std::string &p_name, size_t p_number);
	/// Returns whether a file with that name was added.
	bool contains(const std::string &p_name) const { return files.count(p_name) > 0; }
	/// Writes the added files into the folder.
	void save() const;

private:
	bool is_name_taken(const std::string &p_name, const std::vector<uint8_t> &p_bytes) const;

	std::filesystem::path folder;
	std::map<std::string, std::vector<uint8_t>> files;
};

/// Changes r_json and r_container, the document's JSON and a copy of its container, so that they
/// can be saved as the file p_target in the format p_format: moves buffer 0 into or out of the BIN
/// chunk and drops other chunks from a text file. If p_target is not in the document's folder, it
/// also adds the files that URIs reference to r_files. A missing buffer file throws an Error; a
/// missing image file is only logged.
void relocate_container(const GltfDocument &p_document, const std::filesystem::path &p_target,
		GltfFormat p_format, Json &r_json, GltfContainer &r_container, GltfSideFiles &r_files);

} // namespace gnomon
