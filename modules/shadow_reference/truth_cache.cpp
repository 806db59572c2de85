#include "modules/shadow_reference/truth_cache.h"

#include "modules/core/files.h"

#include <cstring>

namespace gnomon {

namespace {

struct EntryHeader {
	uint64_t key = 0;
	uint64_t penumbra_pixel_count = 0;
	uint64_t pixel_count = 0;
	float standard_error = 0;
	uint32_t padding = 0;
};

std::string get_entry_name(uint64_t p_key) {
	return "truth_" + format_hash(p_key);
}

} // namespace

void save_truth(uint64_t p_key, const Truth &p_truth) {
	EntryHeader header;
	header.key = p_key;
	header.penumbra_pixel_count = p_truth.penumbra_pixel_count;
	header.pixel_count = p_truth.visibility.size();
	header.standard_error = p_truth.standard_error;
	const size_t value_bytes = p_truth.visibility.size() * sizeof(float);
	const size_t color_bytes = p_truth.colors.size() * sizeof(glm::vec3);
	std::vector<uint8_t> bytes(sizeof(header) + value_bytes + color_bytes);
	std::memcpy(bytes.data(), &header, sizeof(header));
	std::memcpy(bytes.data() + sizeof(header), p_truth.visibility.data(), value_bytes);
	if (color_bytes > 0) {
		std::memcpy(
				bytes.data() + sizeof(header) + value_bytes, p_truth.colors.data(), color_bytes);
	}
	save_cache_entry(get_entry_name(p_key), bytes);
}

std::optional<Truth> load_truth(uint64_t p_key, size_t p_pixel_count, bool p_is_colored) {
	const std::vector<uint8_t> bytes = load_cache_entry(get_entry_name(p_key));
	EntryHeader header;
	const size_t value_bytes = p_pixel_count * sizeof(float);
	const size_t color_bytes = p_is_colored ? p_pixel_count * sizeof(glm::vec3) : 0;
	if (bytes.size() != sizeof(header) + value_bytes + color_bytes) {
		return std::nullopt;
	}
	std::memcpy(&header, bytes.data(), sizeof(header));
	if (header.key != p_key || header.pixel_count != p_pixel_count) {
		return std::nullopt;
	}
	Truth truth;
	truth.standard_error = header.standard_error;
	truth.penumbra_pixel_count = header.penumbra_pixel_count;
	truth.visibility.resize(p_pixel_count);
	std::memcpy(truth.visibility.data(), bytes.data() + sizeof(header), value_bytes);
	if (p_is_colored) {
		truth.colors.resize(p_pixel_count);
		std::memcpy(truth.colors.data(), bytes.data() + sizeof(header) + value_bytes, color_bytes);
	}
	return truth;
}

} // namespace gnomon
