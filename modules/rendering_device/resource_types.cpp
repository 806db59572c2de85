#include "modules/rendering_device/resource_types.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

struct FormatRow {
	const char *name;
	uint32_t texel_size_bytes;
};

// In the order of Format.
const FormatRow FORMATS[] = {
	{ "R8_UNORM", 1 },
	{ "R16_SFLOAT", 2 },
	{ "R32_SFLOAT", 4 },
	{ "R32_UINT", 4 },
	{ "RG16_SFLOAT", 4 },
	{ "RG32_UINT", 8 },
	{ "RG32_SFLOAT", 8 },
	{ "RGBA8_UNORM", 4 },
	{ "RGBA8_SRGB", 4 },
	{ "BGRA8_UNORM", 4 },
	{ "RGBA16_SFLOAT", 8 },
	{ "RGBA32_SFLOAT", 16 },
	{ "RGBA32_UINT", 16 },
	{ "D32_SFLOAT", 4 },
	{ "D32_SFLOAT_S8_UINT", 8 },
};
static_assert(std::size(FORMATS) == static_cast<size_t>(Format::D32_SFLOAT_S8_UINT) + 1);

const std::pair<TextureUsage, const char *> TEXTURE_USAGES[] = {
	{ TextureUsage::SAMPLED, "SAMPLED" },
	{ TextureUsage::STORAGE, "STORAGE" },
	{ TextureUsage::COLOR_ATTACHMENT, "COLOR_ATTACHMENT" },
	{ TextureUsage::DEPTH_ATTACHMENT, "DEPTH_ATTACHMENT" },
	{ TextureUsage::COPY_SOURCE, "COPY_SOURCE" },
	{ TextureUsage::COPY_TARGET, "COPY_TARGET" },
};

const FormatRow &get_row(Format p_format) {
	const size_t index = static_cast<size_t>(p_format);
	GNOMON_ASSERT(index < std::size(FORMATS), "format ", index);
	return FORMATS[index];
}

} // namespace

uint32_t get_texel_size_bytes(Format p_format) {
	return get_row(p_format).texel_size_bytes;
}

const char *get_format_name(Format p_format) {
	return get_row(p_format).name;
}

bool is_depth_format(Format p_format) {
	return p_format == Format::D32_SFLOAT || has_stencil(p_format);
}

bool has_stencil(Format p_format) {
	return p_format == Format::D32_SFLOAT_S8_UINT;
}

bool is_uint_format(Format p_format) {
	return p_format == Format::R32_UINT || p_format == Format::RG32_UINT;
}

std::string describe_usage(TextureUsage p_usage) {
	std::string names;
	for (const auto &[usage, name] : TEXTURE_USAGES) {
		if (has_usage(p_usage, usage)) {
			names += (names.empty() ? "" : " | ") + std::string(name);
		}
	}
	return names;
}

glm::uvec2 compute_mip_size(glm::uvec2 p_size_px, uint32_t p_level) {
	return glm::max(p_size_px >> p_level, glm::uvec2(1));
}

uint64_t compute_layer_bytes(const TextureDesc &p_desc) {
	uint64_t texel_count = 0;
	for (uint32_t level = 0; level < p_desc.mip_count; ++level) {
		const glm::uvec2 size_px = compute_mip_size(p_desc.size_px, level);
		texel_count += uint64_t(size_px.x) * size_px.y;
	}
	return texel_count * get_texel_size_bytes(p_desc.format);
}

bool is_write(Access p_access) {
	switch (p_access) {
		case Access::SHADER_WRITE_FRAGMENT:
		case Access::SHADER_WRITE_COMPUTE:
		case Access::COLOR_WRITE:
		case Access::DEPTH_WRITE:
		case Access::COPY_WRITE:
		case Access::HOST_WRITE:
			return true;
		default:
			return false;
	}
}

} // namespace gnomon
