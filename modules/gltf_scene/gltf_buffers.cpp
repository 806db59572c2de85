#include "modules/gltf_scene/gltf_buffers.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include <algorithm>
#include <cctype>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

std::optional<int> parse_hex_digit(char p_digit) {
	if (p_digit >= '0' && p_digit <= '9') {
		return p_digit - '0';
	}
	const char lower = static_cast<char>(p_digit | 0x20); // ASCII: to lower case
	if (lower >= 'a' && lower <= 'f') {
		return lower - 'a' + 10;
	}
	return std::nullopt;
}

/// Decodes % escapes such as %20. Returns nothing if an escape is invalid.
std::optional<std::string> decode_percent(std::string_view p_uri) {
	std::string decoded;
	for (size_t index = 0; index < p_uri.size(); ++index) {
		if (p_uri[index] != '%') {
			decoded += p_uri[index];
			continue;
		}
		if (index + 2 >= p_uri.size()) {
			return std::nullopt;
		}
		const std::optional<int> high = parse_hex_digit(p_uri[index + 1]);
		const std::optional<int> low = parse_hex_digit(p_uri[index + 2]);
		if (!high || !low) {
			return std::nullopt;
		}
		decoded += static_cast<char>(*high * 16 + *low);
		index += 2;
	}
	return decoded;
}

/// Returns whether the URI begins with a scheme, such as "http:" or "file:": a letter, then
/// letters, digits, "+", "-" or "." up to the first colon (RFC 3986, 3.1).
bool has_scheme(std::string_view p_uri) {
	const size_t colon = p_uri.find(':');
	if (colon == std::string_view::npos || colon == 0 || !std::isalpha(uint8_t(p_uri[0]))) {
		return false;
	}
	for (const char character : p_uri.substr(0, colon)) {
		if (!std::isalnum(uint8_t(character)) && !std::strchr("+-.", character)) {
			return false;
		}
	}
	return true;
}

} // namespace

bool is_data_uri(std::string_view p_uri) {
	return p_uri.starts_with("data:");
}

fs::path resolve_uri(
		std::string_view p_uri, const GltfLocation &p_location, const GltfObject &p_object) {
	const auto reject = [&](const char *p_problem) {
		p_object.fail_at("uri",
				text("is \"", to_one_line(p_uri), "\", ", p_problem,
						". Put the file next to the scene and refer to it by its name alone."));
	};
	if (has_scheme(p_uri)) {
		reject("must be a file's relative path");
	}
	const std::optional<std::string> decoded = decode_percent(p_uri);
	if (!decoded || decoded->empty() || decoded->find('\0') != std::string::npos) {
		reject("must be a path with valid % escapes");
	}
	fs::path relative = make_path(*decoded);
	std::error_code code;
	if (decoded->find('\\') != std::string::npos &&
			!fs::exists(p_location.folder / relative, code)) {
		// Some converters write Windows paths with backslashes, which glTF does not allow.
		std::string separated = *decoded;
		std::replace(separated.begin(), separated.end(), '\\', '/');
		relative = make_path(separated);
	}
	if (relative.is_absolute()) {
		reject("must not be an absolute path");
	}
	const fs::path path = p_location.folder / relative;
	if (!is_inside_folder(path, p_location.project_folder)) {
		reject("which leads out of the project folder");
	}
	return path;
}

std::string encode_uri(std::string_view p_file_name) {
	const char DIGITS[] = "0123456789ABCDEF";
	std::string uri;
	for (const char character : p_file_name) {
		const uint8_t byte = static_cast<uint8_t>(character);
		if (std::isalnum(byte) || (character != '\0' && std::strchr("-._~", character))) {
			uri += character;
		} else {
			uri += { '%', DIGITS[byte >> 4], DIGITS[byte & 15] };
		}
	}
	return uri;
}

GltfBuffers::GltfBuffers(const GltfObject &p_root, const GltfLocation &p_location,
		const std::vector<uint8_t> *p_bin_chunk) :
		root(p_root),
		location(p_location), bin_chunk(p_bin_chunk) {}

std::span<const uint8_t> GltfBuffers::load_buffer(size_t p_index) {
	const GltfObject buffer = root.get_element("buffers", p_index);
	const uint64_t length_bytes = buffer.require_integer("byteLength", 1, GLTF_MAX_BUFFER_BYTES);
	const Json *uri = buffer.find("uri");
	std::span<const uint8_t> bytes;
	if (uri) {
		if (!uri->is_string()) {
			buffer.fail_value("uri", "text");
		}
		if (!loaded.contains(p_index)) {
			std::vector<uint8_t> made = load_uri(buffer, uri->get_ref<const std::string &>());
			loaded_bytes += made.size();
			if (loaded_bytes > GLTF_MAX_BUFFER_BYTES) {
				buffer.fail_at("uri",
						text("makes more than ", GLTF_MAX_BUFFER_BYTES,
								" bytes of buffers. Split the scene."));
			}
			loaded.emplace(p_index, std::move(made));
		}
		bytes = loaded.at(p_index);
	} else if (p_index == 0 && bin_chunk) {
		bytes = *bin_chunk;
	} else {
		buffer.fail_value("uri", "a file's relative path");
	}
	if (bytes.size() < length_bytes) {
		buffer.fail_at("byteLength",
				text("is ", length_bytes, ", must be at most ", bytes.size(),
						", the size of its data. Export the file again."));
	}
	return bytes.first(length_bytes);
}

std::span<const uint8_t> GltfBuffers::load_view(const tinygltf::Model &p_model, size_t p_index) {
	const tinygltf::BufferView &view = p_model.bufferViews[p_index];
	const auto bytes = load_buffer(static_cast<size_t>(view.buffer));
	const auto check = [&](const char *p_key, uint64_t p_value, uint64_t p_minimum,
							   uint64_t p_maximum) {
		if (p_value < p_minimum || p_value > p_maximum) {
			root.get_messages().fail_value(text("bufferViews[", p_index, "].", p_key),
					text(p_value), text("a whole number in ", p_minimum, "..", p_maximum));
		}
	};
	check("byteOffset", view.byteOffset, 0, bytes.size() - 1);
	check("byteLength", view.byteLength, 1, bytes.size() - view.byteOffset);
	return bytes.subspan(view.byteOffset, view.byteLength);
}

std::vector<uint8_t> GltfBuffers::load_uri(const GltfObject &p_object, const std::string &p_uri) {
	if (!is_data_uri(p_uri)) {
		const fs::path path = resolve_uri(p_uri, location, p_object);
		files.push_back(path);
		try {
			return load_file(path, GLTF_MAX_FILE_BYTES);
		} catch (const Error &error) {
			p_object.fail_at("uri", text("cannot be read: ", error.what()));
		}
	}
	// tinygltf decodes only a fixed set of media types. The type does not matter here, so it
	// is replaced by one of them.
	const size_t comma = p_uri.find(',');
	std::vector<uint8_t> bytes;
	std::string media_type;
	if (comma == std::string::npos ||
			!std::string_view(p_uri).substr(0, comma).ends_with(";base64") ||
			!tinygltf::DecodeDataURI(&bytes, media_type,
					"data:application/octet-stream;base64," + p_uri.substr(comma + 1),
					/*reqBytes=*/0, /*checkSize=*/false)) {
		p_object.fail_at("uri", "is no base64 data. Export the file again.");
	}
	return bytes;
}

} // namespace gnomon
