#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// A folder of records: the results of cells, references and scene images, each in a JSON file and
/// optionally a PNG. Files are written atomically and contain checksums, so that an interrupted run
/// can be resumed. A damaged record is logged as a warning and treated as absent.
class RecordStore {
public:
	/// Creates the folder. Throws an Error when it cannot be created, or is not a folder.
	explicit RecordStore(std::filesystem::path p_folder);

	/// Writes a record; replaces an existing one. p_name: file name without extension. p_image: the
	/// bytes of the record's PNG, or empty. Throws an Error if writing fails.
	void save(const std::string &p_name, const nlohmann::ordered_json &p_content,
			std::span<const uint8_t> p_image = {});
	/// Returns the content of a record; nullopt if it is absent or damaged.
	std::optional<nlohmann::ordered_json> load(const std::string &p_name) const;
	/// Returns the bytes of the record's PNG; empty if it has none.
	std::vector<uint8_t> load_image(const std::string &p_name) const;
	/// Copies a record from another store; does nothing if it is absent there.
	void copy_from(const RecordStore &p_other, const std::string &p_name);
	/// Deletes a record, if it exists.
	void remove(const std::string &p_name);
	/// Deletes all records whose names are not in p_names: they belong to other plans. Files whose
	/// names do not have the form of a record stay.
	void remove_others(const std::vector<std::string> &p_names);
	const std::filesystem::path &get_folder() const { return folder; }

private:
	std::filesystem::path folder;
};

} // namespace gnomon
