#include "modules/shadow_reference/reference_entry.h"

#include "modules/core/files.h"

#include <cstring>

namespace gnomon {

namespace {

struct EntryHeader {
	uint64_t key = 0; // hash of everything that the reference depends on
	uint64_t penumbra_pixel_count = 0;
	uint64_t pixel_count = 0;
	float standard_error = 0;
	uint32_t padding = 0; // explicit, so that no byte is undefined
};

/// Like std::memcpy, which must not get the null pointer of an empty vector.
void copy_bytes(void *r_target, const void *p_source, size_t p_count) {
	if (p_count > 0) {
		std::memcpy(r_target, p_source, p_count);
	}
}

std::string get_entry_name(uint64_t p_key) {
	return "reference_" + format_hash(p_key);
}

} // namespace

std::vector<uint8_t> build_reference_entry(uint64_t p_key, const ReferenceVisibility &p_reference) {
	EntryHeader header;
	header.key = p_key;
	header.penumbra_pixel_count = p_reference.penumbra_pixel_count;
	header.pixel_count = p_reference.visibility.size();
	header.standard_error = p_reference.standard_error;
	const size_t value_bytes = p_reference.visibility.size() * sizeof(float);
	const size_t color_bytes = p_reference.colors.size() * sizeof(glm::vec3);
	std::vector<uint8_t> bytes(sizeof(header) + value_bytes + color_bytes);
	copy_bytes(bytes.data(), &header, sizeof(header));
	copy_bytes(bytes.data() + sizeof(header), p_reference.visibility.data(), value_bytes);
	copy_bytes(bytes.data() + sizeof(header) + value_bytes, p_reference.colors.data(), color_bytes);
	return bytes;
}

std::optional<ReferenceVisibility> parse_reference_entry(
		std::span<const uint8_t> p_bytes, uint64_t p_key, size_t p_pixel_count, bool p_is_colored) {
	EntryHeader header;
	if (p_pixel_count > p_bytes.size()) {
		return std::nullopt; // too short; without this, the sizes below could wrap around
	}
	const size_t value_bytes = p_pixel_count * sizeof(float);
	const size_t color_bytes = p_is_colored ? p_pixel_count * sizeof(glm::vec3) : 0;
	if (p_bytes.size() != sizeof(header) + value_bytes + color_bytes) {
		return std::nullopt;
	}
	std::memcpy(&header, p_bytes.data(), sizeof(header));
	if (header.key != p_key || header.pixel_count != p_pixel_count) {
		return std::nullopt;
	}
	ReferenceVisibility reference;
	reference.standard_error = header.standard_error;
	reference.penumbra_pixel_count = header.penumbra_pixel_count;
	reference.visibility.resize(p_pixel_count);
	copy_bytes(reference.visibility.data(), p_bytes.data() + sizeof(header), value_bytes);
	if (p_is_colored) {
		reference.colors.resize(p_pixel_count);
		copy_bytes(reference.colors.data(), p_bytes.data() + sizeof(header) + value_bytes,
				color_bytes);
	}
	return reference;
}

void save_reference(uint64_t p_key, const ReferenceVisibility &p_reference) {
	save_cache_entry(get_entry_name(p_key), build_reference_entry(p_key, p_reference));
}

std::optional<ReferenceVisibility> load_reference(
		uint64_t p_key, size_t p_pixel_count, bool p_is_colored) {
	return parse_reference_entry(
			load_cache_entry(get_entry_name(p_key)), p_key, p_pixel_count, p_is_colored);
}

} // namespace gnomon
