#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace gnomon {

/// Keeps the order of keys, so that a saved file differs only where it changed.
using Json = nlohmann::ordered_json;

/// Limits that no real scene reaches, but that keep memory use bounded. A larger file is rejected.
const uint64_t GLTF_MAX_FILE_BYTES = uint64_t(1) << 30;
const uint64_t GLTF_MAX_BUFFER_BYTES = uint64_t(1) << 31; // all buffers of a file together
const uint64_t GLTF_MAX_NODE_COUNT = 1000000;
const uint64_t GLTF_MAX_NODE_DEPTH = 1000;				   // the tree is walked recursively
const uint64_t GLTF_MAX_VERTEX_COUNT = uint64_t(1) << 25;  // of all meshes; 0.8 GB
const uint64_t GLTF_MAX_INDEX_COUNT = uint64_t(1) << 27;   // of all meshes; 0.5 GB
const uint64_t GLTF_MAX_SURFACE_COUNT = uint64_t(1) << 22; // of all nodes; 0.3 GB
/// Limit on the extras of all nodes' lights. A value counts as one, and each 64 bytes of its name
/// and text as one more.
const uint64_t GLTF_MAX_LIGHT_VALUE_COUNT = uint64_t(1) << 20;
const uint64_t GLTF_MAX_JSON_DEPTH = 256;			 // copying and writing a value is recursive
const uint64_t GLTF_MAX_JSON_KEY_COUNT = 4096;		 // of one object; the search is linear
const uint64_t GLTF_MAX_JSON_VALUE_COUNT = 20000000; // about 1 GB once parsed

/// The next step, at the end of messages: for values that people write, and for those that only
/// exporters do.
inline const char CORRECT_OR_EXPORT[] = "Correct it or export the file again.";
inline const char EXPORT_AGAIN[] = "Export the file again.";

/// Formats and logs the messages about one file.
struct GltfMessages {
	std::string file; // as the user named it
	/// Error lines and kinds of warnings already logged, so that each appears only once.
	std::set<std::string> logged;

	/// Logs the line as an error unless it was logged before.
	void report(const std::string &p_line);
	/// Logs a warning unless one of the same kind was logged before: one per file is enough.
	void warn(const char *p_kind, std::string_view p_path, std::string_view p_problem);
	/// Returns for example `"desk.gltf": nodes[3].mesh is 7, must be 0..1. <next step>`, always one
	/// line.
	std::string describe(std::string_view p_path, std::string_view p_problem) const;
	/// Throws an Error with the line that describe returns.
	[[noreturn]] void fail(std::string_view p_path, std::string_view p_problem) const;
	/// Throws an Error: "is <value>, must be <range>. Correct it or export the file again."
	[[noreturn]] void fail_value(
			std::string_view p_path, std::string_view p_value, std::string_view p_range) const;
};

/// Replaces line breaks and other control characters by spaces, and truncates long text.
std::string to_one_line(std::string_view p_text);
/// Returns a name as one line, or the fallback if it is empty.
std::string make_name(std::string_view p_name, const std::string &p_fallback);
/// Describes a value for a message: "an array of 3", "an object", or its JSON text, truncated if
/// long.
std::string describe_json(const Json &p_value);

/// Parses a file's JSON. Throws an Error if the text is not a JSON object or exceeds the limits
/// above.
Json parse_gltf_json(std::string_view p_text, const GltfMessages &p_messages);

/// Converts whole numbers such as 3.0 to integers, except in extras and extensions.
void convert_whole_numbers(Json &r_json);

/// Refers to a JSON object of a document, and knows its JSON path. Every access is checked. "Fails"
/// below means: throws an Error with file, path, value and range; "reported": logged as an error,
/// after which loading continues.
class GltfObject {
public:
	/// Both the JSON and the messages must outlive this object.
	GltfObject(Json &r_json, std::string p_path, GltfMessages &p_messages);

	const Json &get_json() const { return *json; }
	const std::string &get_path() const { return path; }
	GltfMessages &get_messages() const { return *messages; }
	/// Returns the path of a member, such as "nodes[3].mesh".
	std::string get_member_path(std::string_view p_key) const;

	/// Sets or removes a member of the JSON object to which this refers.
	void set(std::string_view p_key, Json p_value) const {
		(*json)[std::string(p_key)] = std::move(p_value);
	}
	void erase(std::string_view p_key) const { json->erase(std::string(p_key)); }

	/// Returns the value; null if it is absent or JSON null.
	Json *find(std::string_view p_key) const;
	/// Fails if the value is not an object. If it is absent, find_ returns nothing and require_
	/// fails.
	std::optional<GltfObject> find_object(std::string_view p_key) const;
	GltfObject require_object(std::string_view p_key) const;
	/// Returns `extensions.<name>`; nothing if absent.
	std::optional<GltfObject> find_extension(std::string_view p_name) const;
	/// Returns the extras if they are an object; nothing otherwise, because they may be of any
	/// type.
	std::optional<GltfObject> find_extras() const;
	/// Returns the length of an array; 0 if absent. Fails if the value is not an array.
	size_t get_count(std::string_view p_key) const;
	/// Returns an array's element; fails unless it is an object. p_index is below get_count.
	GltfObject get_element(std::string_view p_key, size_t p_index) const;

	/// Calls p_read with each element of an array, which may be absent. Fails unless it is an array
	/// of objects.
	template <typename Read> void for_each(std::string_view p_key, const Read &p_read) const {
		const size_t count = get_count(p_key);
		for (size_t index = 0; index < count; ++index) {
			p_read(get_element(p_key, index));
		}
	}

	/// Returns a whole number of at least 0; nothing if absent or any other value.
	std::optional<uint64_t> find_whole_number(std::string_view p_key) const;
	/// Returns a whole number in p_minimum..p_maximum; fails on any other value. If it is absent,
	/// find_ returns nothing and require_ fails.
	std::optional<uint64_t> find_integer(
			std::string_view p_key, uint64_t p_minimum, uint64_t p_maximum) const;
	uint64_t require_integer(std::string_view p_key, uint64_t p_minimum, uint64_t p_maximum) const;
	/// Returns an index into an array of p_count elements; fails on any other value. If it is
	/// absent, find_ returns nothing and require_ fails.
	std::optional<size_t> find_index(std::string_view p_key, size_t p_count) const;
	size_t require_index(std::string_view p_key, size_t p_count) const;
	/// Fails unless the value is an array of such indices, or absent.
	void check_indices(std::string_view p_key, size_t p_count) const;
	/// Fills the span from an array of the same number of finite numbers; fails on any other value.
	/// Returns false if absent.
	bool find_numbers(std::string_view p_key, std::span<double> r_numbers) const;
	/// Returns text; empty if absent or not text. That is no error: a name may be anything, and
	/// callers that need a certain text check the result.
	std::string get_text(std::string_view p_key) const;

	/// Returns a number in p_minimum..p_maximum; any other value is reported and the default
	/// returned.
	double read_number(std::string_view p_key, double p_default, double p_minimum, double p_maximum,
			std::string_view p_unit = "") const;
	/// Returns an index into an array of p_count elements, or one of the whole numbers p_choices;
	/// nothing if absent. Any other value is reported, and nothing returned. p_default: what is
	/// used instead, for the message.
	std::optional<size_t> read_index(
			std::string_view p_key, size_t p_count, std::string_view p_default) const;
	std::optional<uint64_t> read_choice(std::string_view p_key,
			std::initializer_list<uint64_t> p_choices, std::string_view p_default) const;
	/// Reads the first three of 3 or 4 numbers, in 0..p_maximum. Any other value is reported. If it
	/// is absent or reported, leaves r_color unchanged and returns false.
	bool read_color(std::string_view p_key, double p_maximum, std::span<float, 3> r_color) const;
	/// Reads true, false, 1 or 0 (Blender writes flags as numbers); any other value is reported and
	/// the default returned.
	bool read_bool(std::string_view p_key, bool p_default) const;

	/// Fails with a problem of the member p_key.
	[[noreturn]] void fail_at(std::string_view p_key, std::string_view p_problem) const;
	/// Fails with "is <value>, must be <range>".
	[[noreturn]] void fail_value(std::string_view p_key, std::string_view p_range) const;
	/// Logs "is <value>, must be <range>; <default> is used" as an error.
	void report_value(
			std::string_view p_key, std::string_view p_range, std::string_view p_default) const;

private:
	Json *json;
	std::string path;
	GltfMessages *messages;
};

/// Returns the decimal number with the fewest digits that reads back as this float, so that 0.1f is
/// written as 0.1.
double to_shortest_decimal(float p_value);

} // namespace gnomon
