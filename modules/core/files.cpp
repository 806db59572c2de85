#include "modules/core/files.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/core/operating_system.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <set>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

const char CACHE_MAGIC[8] = { 'G', 'N', 'O', 'M', 'O', 'N', 'C', '1' };
const size_t CACHE_HEADER_BYTES = sizeof(CACHE_MAGIC) + 2 * sizeof(uint64_t);

// Absolute paths of the files that load_file has loaded, for check_outputs.
std::mutex loaded_mutex;
std::set<fs::path> loaded_paths;

void remember_loaded(const fs::path &p_path) {
	std::error_code code;
	const fs::path path = fs::absolute(p_path, code);
	const std::lock_guard<std::mutex> lock(loaded_mutex);
	loaded_paths.insert(path);
}

/// Returns the folder that p_variable names, else the system's, else p_temporary below the folder
/// of temporary files, and creates it if absent. A failure to create it is reported by the first
/// write into it.
fs::path find_user_folder(const char *p_variable, UserFolderKind p_kind, const char *p_temporary) {
	const auto own = get_environment_variable(p_variable);
	fs::path folder = own ? make_path(*own) : find_system_user_folder(p_kind);
	if (folder.empty()) {
		folder = fs::temp_directory_path() / p_temporary;
	}
	std::error_code code;
	fs::create_directories(folder, code);
	return folder;
}

} // namespace

fs::path make_path(std::string_view p_text) {
	return { reinterpret_cast<const char8_t *>(p_text.data()),
		reinterpret_cast<const char8_t *>(p_text.data() + p_text.size()) };
}

std::vector<uint8_t> load_file(const fs::path &p_path, uint64_t p_limit_bytes) {
	std::error_code code;
	if (!fs::exists(p_path, code)) {
		fail("File ", p_path,
				code ? " cannot be accessed: " + code.message() : std::string(" does not exist"),
				". Check the path.");
	}
	if (!fs::is_regular_file(p_path, code)) {
		fail(p_path, " is not a file. Name a file.");
	}
	const uint64_t size_bytes = fs::file_size(p_path, code);
	if (code) {
		fail("Cannot read ", p_path, ": ", code.message(), ". Check its permissions.");
	}
	if (size_bytes > p_limit_bytes) {
		fail("File ", p_path, " has ", size_bytes, " bytes, at most ", p_limit_bytes,
				" are read. Use a smaller file.");
	}
	std::ifstream stream(p_path, std::ios::binary);
	std::vector<uint8_t> bytes(size_bytes);
	stream.read(reinterpret_cast<char *>(bytes.data()), static_cast<std::streamsize>(size_bytes));
	if (!stream) {
		fail("Cannot read ", p_path, ": ", std::strerror(errno), ". Check its permissions.");
	}
	remember_loaded(p_path);
	return bytes;
}

void check_image_name(const std::string &p_option, const fs::path &p_path,
		std::string_view p_ending, std::string_view p_hint) {
	std::string ending = p_path.extension().string();
	std::transform(ending.begin(), ending.end(), ending.begin(),
			[](unsigned char p_letter) { return char(std::tolower(p_letter)); });
	for (const std::string_view other :
			{ ".png", ".jpg", ".jpeg", ".exr", ".hdr", ".bmp", ".tga", ".webp" }) {
		if (ending == other && other != p_ending) {
			fail(p_option, " ", p_path, ": the image is written as ", p_ending, ", not as ", other,
					". Name it ", fs::path(p_path).replace_extension(p_ending), ".", p_hint);
		}
	}
}

void check_outputs(std::span<const OutputFile> p_outputs) {
	const std::lock_guard<std::mutex> lock(loaded_mutex);
	std::error_code code;
	std::map<fs::path, std::string> options; // by the path without links
	for (const OutputFile &output : p_outputs) {
		const bool exists = !output.path.empty() && fs::exists(output.path, code);
		if (output.path.empty() || (exists && !fs::is_regular_file(output.path, code))) {
			continue; // not requested, or a device such as /dev/null
		}
		for (const fs::path &input : loaded_paths) {
			if (exists && fs::equivalent(output.path, input, code)) {
				fail(output.option, " ", output.path, " is the same file as ", input,
						", which this command reads. Name another file.");
			}
		}
		const fs::path path = fs::weakly_canonical(fs::absolute(output.path, code), code);
		const auto [found, is_new] = options.emplace(path, output.option);
		if (!code && !is_new) {
			fail(output.option, " and ", found->second, " both name ", output.path,
					". Name another file.");
		}
	}
}

std::string load_text_file(const fs::path &p_path, uint64_t p_limit_bytes) {
	const std::vector<uint8_t> bytes = load_file(p_path, p_limit_bytes);
	return std::string(bytes.begin(), bytes.end());
}

bool is_inside_folder(const fs::path &p_path, const fs::path &p_folder) {
	std::error_code code;
	const fs::path path = fs::weakly_canonical(fs::absolute(p_path), code);
	const fs::path folder = fs::weakly_canonical(fs::absolute(p_folder), code);
	if (code) {
		return false;
	}
	const fs::path relative = path.lexically_relative(folder);
	return !relative.empty() && *relative.begin() != "..";
}

fs::path get_cache_folder() {
	return find_user_folder("GNOMON_CACHE_DIR", UserFolderKind::CACHE, "gnomon-cache");
}

fs::path get_config_folder() {
	return find_user_folder("GNOMON_CONFIG_DIR", UserFolderKind::CONFIG, "gnomon-config");
}

uint64_t compute_hash(std::span<const uint8_t> p_bytes, uint64_t p_seed) {
	return XXH3_64bits_withSeed(p_bytes.data(), p_bytes.size(), p_seed);
}

uint64_t compute_text_hash(std::string_view p_text, uint64_t p_seed) {
	return compute_hash(
			{ reinterpret_cast<const uint8_t *>(p_text.data()), p_text.size() }, p_seed);
}

std::string format_hash(uint64_t p_hash) {
	char digits[32];
	std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(p_hash));
	return digits;
}

std::vector<uint8_t> build_cache_entry(std::span<const uint8_t> p_bytes) {
	std::vector<uint8_t> entry(CACHE_HEADER_BYTES + p_bytes.size());
	const uint64_t numbers[2] = { p_bytes.size(), compute_hash(p_bytes) };
	std::memcpy(entry.data(), CACHE_MAGIC, sizeof(CACHE_MAGIC));
	std::memcpy(entry.data() + sizeof(CACHE_MAGIC), numbers, sizeof(numbers));
	if (!p_bytes.empty()) {
		std::memcpy(entry.data() + CACHE_HEADER_BYTES, p_bytes.data(), p_bytes.size());
	}
	return entry;
}

std::optional<std::span<const uint8_t>> parse_cache_entry(std::span<const uint8_t> p_entry) {
	if (p_entry.size() < CACHE_HEADER_BYTES ||
			std::memcmp(p_entry.data(), CACHE_MAGIC, sizeof(CACHE_MAGIC)) != 0) {
		return std::nullopt;
	}
	uint64_t numbers[2] = {};
	std::memcpy(numbers, p_entry.data() + sizeof(CACHE_MAGIC), sizeof(numbers));
	const std::span<const uint8_t> payload = p_entry.subspan(CACHE_HEADER_BYTES);
	if (numbers[0] != payload.size() || numbers[1] != compute_hash(payload)) {
		return std::nullopt;
	}
	return payload;
}

void save_cache_entry(const std::string &p_name, std::span<const uint8_t> p_bytes) {
	try {
		save_file_atomically(get_cache_folder() / make_path(p_name), build_cache_entry(p_bytes));
	} catch (const Error &error) {
		log_warning("Cache entry not stored: ", error.what());
	}
}

std::vector<uint8_t> load_cache_entry(const std::string &p_name) {
	const fs::path path = get_cache_folder() / make_path(p_name);
	std::error_code code;
	if (!fs::exists(path, code)) {
		return {};
	}
	std::vector<uint8_t> entry;
	try {
		entry = load_file(path);
	} catch (const Error &error) {
		log_warning("Cache entry not used: ", error.what());
		return {};
	}
	if (parse_cache_entry(entry)) {
		entry.erase(entry.begin(), entry.begin() + CACHE_HEADER_BYTES);
		return entry;
	}
	log_warning("Cache entry ", path, " is damaged; it is removed and will be recreated.");
	fs::remove(path, code);
	return {};
}

} // namespace gnomon
