// GLB: tinygltf reads it only together with its buffers, and keeps no chunks of other kinds.
#include "modules/gltf_scene/gltf_container.h"

#include "modules/core/error.h"

#include <bit>
#include <cstring>

namespace gnomon {

namespace {

static_assert(std::endian::native == std::endian::little,
		"glTF is little-endian and is read without conversion");

const uint32_t GLB_MAGIC = 0x46546C67; // "glTF"
const uint32_t GLB_VERSION = 2;
const uint32_t CHUNK_JSON = 0x4E4F534A; // "JSON"
const uint32_t CHUNK_BIN = 0x004E4942;	// "BIN\0"
const size_t HEADER_BYTES = 12;			// magic, version, length
const size_t CHUNK_HEADER_BYTES = 8;	// length, type
const size_t MIN_GLB_BYTES = HEADER_BYTES + CHUNK_HEADER_BYTES;
const char COPY_OR_EXPORT[] = "Copy or export the file again.";

uint32_t read_u32(std::span<const uint8_t> p_bytes, size_t p_offset) {
	uint32_t value = 0;
	std::memcpy(&value, p_bytes.data() + p_offset, sizeof(value));
	return value;
}

void append_u32(std::vector<uint8_t> &r_bytes, size_t p_value) {
	const uint32_t value = static_cast<uint32_t>(p_value);
	const uint8_t *first = reinterpret_cast<const uint8_t *>(&value);
	r_bytes.insert(r_bytes.end(), first, first + sizeof(value));
}

void append_chunk(std::vector<uint8_t> &r_bytes, uint32_t p_type, std::span<const uint8_t> p_data,
		uint8_t p_padding) {
	const size_t padded_bytes = (p_data.size() + 3) / 4 * 4;
	append_u32(r_bytes, padded_bytes);
	append_u32(r_bytes, p_type);
	r_bytes.insert(r_bytes.end(), p_data.begin(), p_data.end());
	r_bytes.resize(r_bytes.size() + padded_bytes - p_data.size(), p_padding);
}

std::string_view to_text(std::span<const uint8_t> p_bytes) {
	return { reinterpret_cast<const char *>(p_bytes.data()), p_bytes.size() };
}

GltfContainer parse_glb(std::span<const uint8_t> p_bytes, const GltfMessages &p_messages) {
	const auto fail_glb = [&](const std::string &p_problem) {
		throw Error(p_messages.describe("GLB", p_problem + " " + COPY_OR_EXPORT));
	};
	if (p_bytes.size() < MIN_GLB_BYTES) {
		fail_glb(text("has ", p_bytes.size(), " bytes, must be at least ", MIN_GLB_BYTES, "."));
	}
	if (read_u32(p_bytes, 4) != GLB_VERSION) {
		fail_glb(text("version is ", read_u32(p_bytes, 4), ", must be 2."));
	}
	const size_t length_bytes = read_u32(p_bytes, 8);
	if (length_bytes > p_bytes.size() || length_bytes < MIN_GLB_BYTES) {
		fail_glb(text("length is ", length_bytes, ", must be ", MIN_GLB_BYTES, "..", p_bytes.size(),
				", at most the size of the file; the file is truncated or damaged."));
	}
	p_bytes = p_bytes.first(length_bytes); // data after the length is ignored

	GltfContainer container;
	container.format = GltfFormat::BINARY;
	size_t offset = HEADER_BYTES;
	for (size_t chunk_index = 0; offset < p_bytes.size(); ++chunk_index) {
		if (p_bytes.size() - offset < CHUNK_HEADER_BYTES) {
			fail_glb(text("chunk ", chunk_index, " is truncated."));
		}
		const size_t chunk_bytes = read_u32(p_bytes, offset);
		const uint32_t type = read_u32(p_bytes, offset + 4);
		if (chunk_bytes > p_bytes.size() - offset - CHUNK_HEADER_BYTES) {
			fail_glb(text("chunk ", chunk_index, " has ", chunk_bytes, " bytes, must be at most ",
					p_bytes.size() - offset - CHUNK_HEADER_BYTES, "."));
		}
		const auto data = p_bytes.subspan(offset + CHUNK_HEADER_BYTES, chunk_bytes);
		if ((chunk_index == 0) != (type == CHUNK_JSON)) {
			fail_glb(text("chunk ", chunk_index, " has type ", type,
					"; the first, and only the first, must be JSON."));
		}
		if (chunk_index == 0) {
			container.json_text = to_text(data);
		} else if (chunk_index == 1 && type == CHUNK_BIN) {
			container.bin_chunk.emplace(data.begin(), data.end());
		} else {
			const auto whole = p_bytes.subspan(offset, CHUNK_HEADER_BYTES + chunk_bytes);
			container.other_chunks.insert(container.other_chunks.end(), whole.begin(), whole.end());
		}
		offset += CHUNK_HEADER_BYTES + chunk_bytes;
	}
	return container;
}

} // namespace

GltfContainer parse_gltf_container(
		std::span<const uint8_t> p_bytes, const GltfMessages &p_messages) {
	if (p_bytes.size() >= sizeof(GLB_MAGIC) && read_u32(p_bytes, 0) == GLB_MAGIC) {
		return parse_glb(p_bytes, p_messages);
	}
	GltfContainer container;
	container.json_text = to_text(p_bytes);
	return container;
}

std::vector<uint8_t> build_glb(const GltfContainer &p_container, const GltfMessages &p_messages) {
	const std::string &json = p_container.json_text;
	std::vector<uint8_t> bytes;
	append_u32(bytes, GLB_MAGIC);
	append_u32(bytes, GLB_VERSION);
	append_u32(bytes, 0); // the length, which is written below
	append_chunk(bytes, CHUNK_JSON,
			std::span(reinterpret_cast<const uint8_t *>(json.data()), json.size()),
			/*p_padding=*/' ');
	if (p_container.bin_chunk) {
		append_chunk(bytes, CHUNK_BIN, *p_container.bin_chunk, /*p_padding=*/0);
	}
	bytes.insert(bytes.end(), p_container.other_chunks.begin(), p_container.other_chunks.end());
	if (bytes.size() > UINT32_MAX) {
		throw Error(p_messages.describe("GLB",
				text("would have ", bytes.size(), " bytes, must be at most ", UINT32_MAX,
						". Save as .gltf instead.")));
	}
	const uint32_t length_bytes = static_cast<uint32_t>(bytes.size());
	std::memcpy(bytes.data() + 8, &length_bytes, sizeof(length_bytes));
	return bytes;
}

} // namespace gnomon
