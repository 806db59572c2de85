#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gnomon {

/// Makes a path of UTF-8 text. The constructor of std::filesystem::path does not on Windows, where
/// libstdc++ 12 reads text as Latin-1; path::string() returns UTF-8 everywhere.
std::filesystem::path make_path(std::string_view p_text);

/// Loads the whole file. A path that is missing, unreadable, a folder, or larger than the limit
/// (default 2 GiB) is an Error that names it.
std::vector<uint8_t> load_file(
		const std::filesystem::path &p_path, uint64_t p_limit_bytes = uint64_t(1) << 31);
/// Loads a file like load_file, as text.
std::string load_text_file(
		const std::filesystem::path &p_path, uint64_t p_limit_bytes = uint64_t(1) << 31);

/// A file that an option of the command line names, to be written.
struct OutputFile {
	std::string option;			// "--out"
	std::filesystem::path path; // empty: not requested
};

/// Throws an Error if the name of an image to be written ends as that of another format, in upper
/// or lower case. Empty: no image is requested. p_option: "--capture". p_ending: ".png". p_hint:
/// added to the message.
void check_image_name(const std::string &p_option, const std::filesystem::path &p_path,
		std::string_view p_ending, std::string_view p_hint = {});

/// Throws an Error if an output is a file that load_file has loaded, or two outputs are one file,
/// whatever links lead to it. Call it when the inputs are loaded, before anything is computed.
void check_outputs(std::span<const OutputFile> p_outputs);

/// Writes a temporary file next to the target, syncs it to disk and renames it, so that the target
/// is always the complete old or the complete new file, even if the process is killed. A process's
/// first save into a folder removes the temporary files that killed processes left there. An
/// unwritable folder or a full disk is an Error naming the path, and on Windows a target that
/// another program has open for longer than a second.
void save_file_atomically(const std::filesystem::path &p_path, std::span<const uint8_t> p_bytes);
void save_file_atomically(const std::filesystem::path &p_path, std::string_view p_text);

/// File name ending of the temporary files of save_file_atomically. They are next to the target and
/// are locked while the process that writes them runs.
inline constexpr std::string_view UNFINISHED_FILE_ENDING = ".gnomon_part";

/// Removes the temporary files of save_file_atomically in the folder that no running process is
/// writing.
void remove_left_over_files(const std::filesystem::path &p_folder);

/// Test hook: the function is called after each step of each save (file created, each MiB written,
/// synced, renamed), so that a test can end the process there. An empty function removes the hook.
/// Returns the previous hook.
std::function<void()> set_save_step_hook(std::function<void()> p_hook);

/// Returns true if the path, with `..` and links resolved, is the folder or below it.
bool is_inside_folder(const std::filesystem::path &p_path, const std::filesystem::path &p_folder);

/// Returns the folder for data that can be recomputed: $GNOMON_CACHE_DIR, else that of
/// find_system_user_folder, else a folder below the system's temporary one. Created when absent.
std::filesystem::path get_cache_folder();

/// Returns the folder for a user's settings: $GNOMON_CONFIG_DIR, else that of
/// find_system_user_folder, else a folder below the system's temporary one. Created when absent.
std::filesystem::path get_config_folder();

/// Computes a 64-bit xxHash3, for naming cache entries and detecting damaged ones. It is not
/// cryptographic.
uint64_t compute_hash(std::span<const uint8_t> p_bytes, uint64_t p_seed = 0);
uint64_t compute_text_hash(std::string_view p_text, uint64_t p_seed = 0);
/// Hashes one value of a type without padding.
template <typename T> uint64_t compute_value_hash(const T &p_value, uint64_t p_seed) {
	static_assert(std::is_trivially_copyable_v<T>);
	return compute_hash({ reinterpret_cast<const uint8_t *>(&p_value), sizeof(T) }, p_seed);
}
/// Formats the hash as 16 hexadecimal digits.
std::string format_hash(uint64_t p_hash);
/// Views an array of values as bytes. Their type should have no padding. The result is valid as
/// long as the array.
template <typename T> std::span<const uint8_t> bytes_of(std::span<const T> p_values) {
	return { reinterpret_cast<const uint8_t *>(p_values.data()), p_values.size_bytes() };
}

/// Builds the contents of a cache file: a magic number, the size of p_bytes, their hash, and the
/// bytes themselves.
std::vector<uint8_t> build_cache_entry(std::span<const uint8_t> p_bytes);
/// Returns the bytes stored in a cache file, or nothing when the file is damaged.
std::optional<std::span<const uint8_t>> parse_cache_entry(std::span<const uint8_t> p_entry);
/// Stores bytes with a checksum under a name in the cache folder. A failure to write only logs a
/// warning.
void save_cache_entry(const std::string &p_name, std::span<const uint8_t> p_bytes);
/// Returns the stored bytes, or an empty vector when the entry is absent or damaged (a damaged
/// entry is logged and removed).
std::vector<uint8_t> load_cache_entry(const std::string &p_name);

} // namespace gnomon
