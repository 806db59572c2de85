#include "modules/masks/exr_header.h"

#include "modules/core/error.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace gnomon {

namespace {

constexpr uint8_t MAGIC[] = { 0x76, 0x2f, 0x31, 0x01 };
constexpr size_t FIRST_ATTRIBUTE_OFFSET = 8;	   // after magic, version and flags
constexpr uint8_t DEEP_OR_MULTI_PART_FLAGS = 0x18; // 0x08 deep, 0x10 multi-part
constexpr size_t CHANNEL_BYTES = 16;			   // type, flags and sampling, after the name
constexpr int64_t MAX_LINES_IN_BLOCK = 256;		   // DWAB, the maximum of all compressions
constexpr int64_t BYTES_PER_VALUE = 4;			   // maximum of half, float and uint
constexpr int64_t MAX_BLOCK_BYTES = 1 << 28;	   // decompressed together: lines or a tile
constexpr int64_t OFFSET_BYTES = sizeof(int64_t);  // per tile, in a table after the header

/// An attribute that OpenEXR reads by its type, whatever length the file states.
struct KnownAttribute {
	std::string_view name;
	std::string_view type;
	size_t size_bytes; // 0: any
};
constexpr KnownAttribute KNOWN_ATTRIBUTES[] = {
	{ "channels", "chlist", 0 },
	{ "compression", "compression", 1 },
	{ "dataWindow", "box2i", 16 },
	{ "displayWindow", "box2i", 16 },
	{ "lineOrder", "lineOrder", 1 },
	{ "pixelAspectRatio", "float", 4 },
	{ "screenWindowCenter", "v2f", 8 },
	{ "screenWindowWidth", "float", 4 },
	{ "tiles", "tiledesc", 9 },
};

/// Walks through the attributes of a header and checks each of them.
class HeaderChecker {
public:
	HeaderChecker(std::span<const uint8_t> p_bytes, const std::string &p_name) :
			bytes(p_bytes), name(p_name) {}

	std::vector<uint8_t> check() {
		if (!std::equal(std::begin(MAGIC), std::end(MAGIC), bytes.begin(),
					bytes.begin() + std::ptrdiff_t(std::min(bytes.size(), std::size(MAGIC))))) {
			fail("Mask ", name, ": not an OpenEXR file. Name one that `gnomon visibility` wrote.");
		}
		// Byte 5 is the second byte of the version, which has the flags.
		if (bytes.size() > FIRST_ATTRIBUTE_OFFSET && (bytes[5] & DEEP_OR_MULTI_PART_FLAGS) != 0) {
			fail("Mask ", name, ": has several parts or deep pixels; a mask has one flat part. ",
					"Write it with `gnomon visibility`.");
		}
		position = FIRST_ATTRIBUTE_OFFSET;
		while (read_byte() != 0) {
			--position;
			read_attribute();
		}
		check_memory();
		std::vector<uint8_t> header(bytes.begin(), bytes.begin() + std::ptrdiff_t(position));
		for (const size_t type : unneeded_types) {
			header[type] = '?'; // a type that OpenEXR does not know
		}
		return header;
	}

private:
	uint8_t read_byte() {
		if (position >= bytes.size()) {
			fail_truncated();
		}
		return bytes[position++];
	}
	[[noreturn]] void fail_truncated() const {
		fail("Mask ", name,
				": not an OpenEXR file, or damaged, or cut short: its header goes beyond its ",
				bytes.size(), " bytes. Write it again.");
	}
	std::string_view read_string() {
		const size_t first = position;
		while (read_byte() != 0) {
		}
		return { reinterpret_cast<const char *>(bytes.data()) + first, position - 1 - first };
	}
	uint32_t read_u32() {
		uint32_t value = 0;
		for (int shift = 0; shift < 32; shift += 8) {
			value |= static_cast<uint32_t>(read_byte()) << shift;
		}
		return value;
	}
	int64_t read_i32() { return static_cast<int32_t>(read_u32()); }

	void read_attribute() {
		const std::string_view attribute = read_string();
		const size_t type_position = position;
		const std::string_view type = read_string();
		const uint64_t length = read_u32();
		if (length >= bytes.size() - position) { // the header's final 0 byte must follow
			fail_truncated();
		}
		const size_t end = position + length;
		const auto known = std::find_if(std::begin(KNOWN_ATTRIBUTES), std::end(KNOWN_ATTRIBUTES),
				[&](const KnownAttribute &p_known) { return p_known.name == attribute; });
		if (known == std::end(KNOWN_ATTRIBUTES)) {
			if (!type.empty()) {
				unneeded_types.push_back(type_position);
			}
		} else if (type != known->type || (known->size_bytes != 0 && length != known->size_bytes)) {
			fail("Mask ", name, ": attribute ", attribute, " (", length,
					" bytes) must be of the type ", known->type,
					" and of that type's size. The file is damaged: write it again.");
		} else {
			read_known(attribute, end);
		}
		position = end;
	}
	void read_known(std::string_view p_attribute, size_t p_end) {
		if (p_attribute == "channels") {
			channel_count = 0;
			while (read_byte() != 0) {
				--position;
				read_string();
				position += CHANNEL_BYTES;
				++channel_count;
			}
			if (position != p_end) {
				fail("Mask ", name, ": its list of channels is not as long as it states. ",
						"Write it again.");
			}
		} else if (p_attribute == "dataWindow") {
			const int64_t left = read_i32();
			const int64_t top = read_i32();
			width = read_i32() - left + 1;
			height = read_i32() - top + 1;
		} else if (p_attribute == "tiles") {
			tile_width = read_u32();
			tile_height = read_u32();
		}
	}
	/// Fails if blocks of lines, tiles or the table of tiles would need too much memory. Images
	/// above the size limit of a mask are refused by the caller, and by OpenEXR before it allocates
	/// memory. Sizes are up to 2^32 here and products of them could overflow, so limits are divided
	/// instead.
	void check_memory() const {
		const bool has_tiles = tile_width > 0 && tile_height > 0;
		const int64_t columns = std::max(width, tile_width);
		const int64_t lines = has_tiles ? tile_height : MAX_LINES_IN_BLOCK;
		const int64_t values = MAX_BLOCK_BYTES / BYTES_PER_VALUE;
		if (columns > 0 && channel_count > 0 && lines > values / columns / channel_count) {
			fail("Mask ", name, ": blocks of ", lines, " lines of ", columns, " pixels with ",
					channel_count, " channels are too large, must be at most ", MAX_BLOCK_BYTES,
					" bytes. Omit channels, or use smaller tiles.");
		}
		if (has_tiles && width > 0 && height > 0) {
			const int64_t tile_columns = (width + tile_width - 1) / tile_width;
			const int64_t tile_rows = (height + tile_height - 1) / tile_height;
			const int64_t table_entries = static_cast<int64_t>(bytes.size()) / OFFSET_BYTES;
			if (tile_rows > table_entries / tile_columns) {
				fail("Mask ", name, ": ", bytes.size(), " bytes cannot hold ", tile_columns, " x ",
						tile_rows, " tiles. The file is damaged: write it again.");
			}
		}
	}

	std::span<const uint8_t> bytes;
	const std::string &name;
	size_t position = 0;
	std::vector<size_t> unneeded_types; // positions of the types of attributes that no mask needs
	int64_t channel_count = 0;
	int64_t width = 0;
	int64_t height = 0;
	int64_t tile_width = 0;
	int64_t tile_height = 0;
};

} // namespace

std::vector<uint8_t> make_safe_exr_header(
		std::span<const uint8_t> p_bytes, const std::string &p_name) {
	return HeaderChecker(p_bytes, p_name).check();
}

} // namespace gnomon
