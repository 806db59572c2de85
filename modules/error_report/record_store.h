#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// The results measured so far, one record per cell, in files that survive an interruption. A
/// record is complete or absent: a damaged one is reported and counts as absent.
class RecordStore {
public:
	/// Creates the folder. Throws an Error when it cannot be created, or is not a folder.
	explicit RecordStore(std::filesystem::path p_folder);

	/// p_image: bytes of a PNG that belongs to the record; may be empty.
	void save(const std::string &p_name, const nlohmann::ordered_json &p_content,
			std::span<const uint8_t> p_image = {});
	std::optional<nlohmann::ordered_json> load(const std::string &p_name) const;
	/// The record's PNG; empty where it has none.
	std::vector<uint8_t> load_image(const std::string &p_name) const;
	/// Copies a record from another store.
	void copy_from(const RecordStore &p_other, const std::string &p_name);
	void remove(const std::string &p_name);
	/// Removes records whose names are not in the list: leftovers of other plans.
	void remove_others(const std::vector<std::string> &p_names);
	const std::filesystem::path &get_folder() const { return folder; }

private:
	std::filesystem::path folder;
};

} // namespace gnomon
