#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_json.h"

#include <vector>

namespace gnomon {

namespace {

/// Throws an Error if the parsed text would have too many levels, keys or values, before parsing
/// uses memory for them. Only brackets and commas outside of quotes are counted, so the text need
/// not be valid JSON.
void check_json_limits(std::string_view p_text, const GltfMessages &p_messages) {
	std::vector<uint64_t> comma_counts; // of the arrays and objects not closed yet
	std::vector<char> brackets;
	uint64_t value_count = 0;
	for (size_t index = 0; index < p_text.size(); ++index) {
		const char character = p_text[index];
		if (character == '"') {
			++index;
			while (index < p_text.size() && p_text[index] != '"') {
				index += p_text[index] == '\\' ? 2 : 1;
			}
		} else if (character == '{' || character == '[') {
			brackets.push_back(character);
			comma_counts.push_back(0);
			++value_count;
			if (brackets.size() > GLTF_MAX_JSON_DEPTH) {
				throw Error(p_messages.describe("JSON",
						text("is nested deeper than ", GLTF_MAX_JSON_DEPTH, " levels. ",
								CORRECT_OR_EXPORT)));
			}
		} else if ((character == '}' || character == ']') && !brackets.empty()) {
			brackets.pop_back();
			comma_counts.pop_back();
		} else if (character == ',' && !brackets.empty()) {
			++value_count;
			if (++comma_counts.back() >= GLTF_MAX_JSON_KEY_COUNT && brackets.back() == '{') {
				throw Error(p_messages.describe("JSON",
						text("has an object of more than ", GLTF_MAX_JSON_KEY_COUNT, " keys. ",
								CORRECT_OR_EXPORT)));
			}
		}
		if (value_count > GLTF_MAX_JSON_VALUE_COUNT) {
			throw Error(p_messages.describe("JSON",
					text("has more than ", GLTF_MAX_JSON_VALUE_COUNT,
							" values. Split the scene into several files.")));
		}
	}
}

} // namespace

Json parse_gltf_json(std::string_view p_text, const GltfMessages &p_messages) {
	check_json_limits(p_text, p_messages);
	Json json;
	try {
		json = Json::parse(p_text.begin(), p_text.end());
	} catch (const Json::exception &error) {
		// Omits the prefix: "[json.exception.parse_error.101] parse error at line 3, column 7: ..."
		const std::string_view what = error.what();
		const size_t prefix = what.find("] ");
		throw Error(p_messages.describe("JSON",
				text("cannot be parsed: ",
						to_one_line(prefix == what.npos ? what : what.substr(prefix + 2)), ". ",
						CORRECT_OR_EXPORT)));
	}
	if (!json.is_object()) {
		throw Error(p_messages.describe("JSON",
				text("is ", describe_json(json), ", must be an object. ", CORRECT_OR_EXPORT)));
	}
	return json;
}

} // namespace gnomon
