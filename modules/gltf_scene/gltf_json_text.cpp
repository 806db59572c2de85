#include "modules/gltf_scene/gltf_json_text.h"

#include <vector>

namespace gnomon {

namespace {

const char JSON_SPACES[] = " \t\r\n";

/// Walks through the text together with both values, see update_json_text. The text is valid JSON.
class JsonTextUpdater {
public:
	explicit JsonTextUpdater(const std::string &p_text) : text(p_text) {
		const size_t line_end = text.find('\n');
		if (line_end != text.npos) {
			line_break = line_end > 0 && text[line_end - 1] == '\r' ? "\r\n" : "\n";
			const size_t first = line_end + 1;
			indent = text.substr(first, text.find_first_not_of(" \t", first) - first);
		}
	}
	std::string update(const Json &p_before, const Json &p_after) {
		position = text.find('{'); // there may be a byte order mark and spaces before it
		result = text.substr(0, position);
		write(p_before, p_after);
		return result + text.substr(position);
	}

private:
	/// Positions in the text of an element of an array, or of a member of an object.
	struct Item {
		size_t first = 0;	// of the spaces before it
		size_t key = 0;		// of an array's element: that of the value
		size_t key_end = 0; // of an array's element: also that
		size_t value = 0;
		size_t value_end = 0;
		size_t end = 0; // of the spaces after it: the comma or closing bracket
	};

	void skip_spaces() { position = text.find_first_not_of(JSON_SPACES, position); }
	void skip_string();
	void skip_value();
	std::vector<Item> read_items();
	void append(size_t p_first, size_t p_end) { result.append(text, p_first, p_end - p_first); }
	void append_new(const Json &p_value, bool p_has_lines);
	void write(const Json &p_before, const Json &p_after);
	void write_items(const Json &p_before, const Json &p_after);

	const std::string &text;
	std::string line_break = "\n";
	std::string indent; // of one level; empty: the text has no lines
	size_t position = 0;
	std::string result;
};

void JsonTextUpdater::skip_string() {
	for (++position; text[position] != '"'; ++position) {
		position += text[position] == '\\' ? 1 : 0;
	}
	++position;
}

void JsonTextUpdater::skip_value() {
	size_t depth = 0;
	do {
		const char character = text[position];
		if (character == '"') {
			skip_string();
		} else if (character == '{' || character == '[') {
			++depth;
			++position;
		} else if (character == '}' || character == ']') {
			--depth;
			++position;
		} else if (depth > 0 && (character == ',' || character == ':')) {
			++position;
		} else { // a number, true, false or null
			position = text.find_first_of(",:]} \t\r\n", position);
		}
		if (depth > 0) {
			skip_spaces();
		}
	} while (depth > 0);
}

/// Reads the items of the array or object at the position, and moves it to the closing bracket.
std::vector<JsonTextUpdater::Item> JsonTextUpdater::read_items() {
	const bool is_object = text[position] == '{';
	std::vector<Item> items;
	do {
		Item item;
		item.first = ++position; // after the opening bracket or a comma
		skip_spaces();
		item.key = item.key_end = position;
		if (is_object) {
			skip_string();
			item.key_end = position;
			skip_spaces();
			++position; // the colon
			skip_spaces();
		}
		item.value = position;
		skip_value();
		item.value_end = position;
		skip_spaces();
		item.end = position;
		items.push_back(item);
	} while (text[position] == ',');
	return items;
}

/// Appends a value that the text does not have. p_has_lines: whether it may be written in several.
void JsonTextUpdater::append_new(const Json &p_value, bool p_has_lines) {
	if (!p_has_lines || indent.empty()) {
		result += p_value.dump();
		return;
	}
	const size_t line = result.find_last_of('\n') + 1;
	const std::string outer = result.substr(line, result.find_first_not_of(" \t", line) - line);
	for (const char character : p_value.dump(static_cast<int>(indent.size()), indent[0])) {
		result += character == '\n' ? line_break + outer : std::string(1, character);
	}
}

/// Writes the value at the position and moves it to the value's end.
void JsonTextUpdater::write(const Json &p_before, const Json &p_after) {
	const size_t first = position;
	const bool is_same_kind = (p_before.is_object() && p_after.is_object()) ||
			(p_before.is_array() && p_after.is_array());
	if (p_before == p_after) {
		skip_value();
		append(first, position);
	} else if (is_same_kind && !p_before.empty() && !p_after.empty()) {
		write_items(p_before, p_after);
	} else {
		skip_value();
		append_new(p_after, /*p_has_lines=*/true);
	}
}

void JsonTextUpdater::write_items(const Json &p_before, const Json &p_after) {
	const char bracket = text[position];
	const std::vector<Item> items = read_items();
	const size_t end = position;
	if (items.size() != p_before.size()) { // a key occurs twice
		append_new(p_after, /*p_has_lines=*/true);
		position = end + 1;
		return;
	}
	size_t count = 0; // of the items written so far
	const auto separate = [&] { result += count++ > 0 ? "," : ""; };
	result += bracket;
	auto before = p_before.begin();
	for (size_t index = 0; index < items.size(); ++index, ++before) {
		const Item &item = items[index];
		const auto after = p_after.is_object() ? p_after.find(before.key())
				: index < p_after.size()	   ? p_after.begin() + std::ptrdiff_t(index)
											   : p_after.end();
		if (after == p_after.end()) {
			continue;
		}
		separate();
		append(item.first, item.value);
		position = item.value;
		write(*before, *after);
		if (index + 1 < items.size()) {
			append(item.value_end, item.end);
		}
	}
	const Item &last = items.back();
	const bool has_lines = text.find('\n', last.first) < last.key;
	size_t index = 0;
	for (auto after = p_after.begin(); after != p_after.end(); ++after, ++index) {
		const bool is_new =
				p_after.is_object() ? !p_before.contains(after.key()) : index >= p_before.size();
		if (!is_new) {
			continue;
		}
		separate();
		append(last.first, last.key);
		if (p_after.is_object()) {
			result += Json(after.key()).dump();
			append(last.key_end, last.value);
		}
		append_new(*after, has_lines);
	}
	append(last.value_end, end + 1);
	position = end + 1;
}

} // namespace

std::string update_json_text(const std::string &p_text, const Json &p_before, const Json &p_after) {
	return JsonTextUpdater(p_text).update(p_before, p_after);
}

} // namespace gnomon
