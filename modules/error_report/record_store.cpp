#include "modules/error_report/record_store.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"

#include <nlohmann/json.hpp>

#include <set>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

/// Serializes JSON on one line. Replaces bytes that are not UTF-8, since messages may contain file
/// names in another encoding.
std::string dump_content(const Json &p_json) {
	return p_json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Returns true for names that end in a dash and 16 hexadecimal digits, as report_plan.cpp names
/// records. Only such files are deleted.
bool is_record_name(const std::string &p_stem) {
	const size_t dash = p_stem.rfind('-');
	return dash != std::string::npos && p_stem.size() == dash + 17 &&
			p_stem.find_first_not_of("0123456789abcdef", dash + 1) == std::string::npos;
}

} // namespace

RecordStore::RecordStore(fs::path p_folder) : folder(std::move(p_folder)) {
	std::error_code code;
	fs::create_directories(folder, code);
	if (code || !fs::is_directory(folder)) {
		fail("Folder ", folder, " cannot be created: ", code.message(),
				". Choose another location with --out.");
	}
}

void RecordStore::save(
		const std::string &p_name, const Json &p_content, std::span<const uint8_t> p_image) {
	// The image is written before the JSON, so that a record whose JSON exists is complete.
	if (!p_image.empty()) {
		save_file_atomically(folder / make_path(p_name + ".png"), p_image);
	}
	const Json record = { { "checksum", format_hash(compute_text_hash(dump_content(p_content))) },
		{ "image_checksum", p_image.empty() ? "" : format_hash(compute_hash(p_image)) },
		{ "content", p_content } };
	save_file_atomically(folder / make_path(p_name + ".json"), dump_content(record) + "\n");
}

std::optional<Json> RecordStore::load(const std::string &p_name) const {
	const fs::path path = folder / make_path(p_name + ".json");
	std::error_code code;
	if (!fs::exists(path, code)) {
		return std::nullopt;
	}
	std::string damage;
	try {
		const Json record = Json::parse(load_text_file(path));
		const std::string image_checksum = record.at("image_checksum").get<std::string>();
		if (record.at("checksum") !=
				format_hash(compute_text_hash(dump_content(record.at("content"))))) {
			damage = "its checksum is wrong";
		} else if (!image_checksum.empty() &&
				format_hash(compute_hash(load_file(folder / make_path(p_name + ".png")))) !=
						image_checksum) {
			damage = "the checksum of its image is wrong";
		} else {
			return record.at("content");
		}
	} catch (const Json::exception &error) {
		damage = error.what();
	} catch (const Error &error) {
		damage = error.what();
	}
	log_warning("Record ", path, " is damaged (", damage, ") and is measured again.");
	return std::nullopt;
}

std::vector<uint8_t> RecordStore::load_image(const std::string &p_name) const {
	const fs::path path = folder / make_path(p_name + ".png");
	std::error_code code;
	return fs::exists(path, code) ? load_file(path) : std::vector<uint8_t>();
}

void RecordStore::copy_from(const RecordStore &p_other, const std::string &p_name) {
	if (const std::optional<Json> content = p_other.load(p_name)) {
		save(p_name, *content, p_other.load_image(p_name));
	}
}

void RecordStore::remove(const std::string &p_name) {
	std::error_code code;
	fs::remove(folder / make_path(p_name + ".json"), code);
	fs::remove(folder / make_path(p_name + ".png"), code);
}

void RecordStore::remove_others(const std::vector<std::string> &p_names) {
	const std::set<std::string> names(p_names.begin(), p_names.end());
	for (const fs::directory_entry &entry : fs::directory_iterator(folder)) {
		const fs::path path = entry.path();
		const bool is_record = (path.extension() == ".json" || path.extension() == ".png") &&
				is_record_name(path.stem().string());
		if (is_record && names.count(path.stem().string()) == 0) {
			remove(path.stem().string());
		}
	}
}

} // namespace gnomon
