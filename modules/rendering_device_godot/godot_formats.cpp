#include "modules/rendering_device_godot/godot_formats.h"

#include "modules/core/error.h"

#include <godot_api.gen.h>

namespace gnomon {

using RD = godot::RenderingDevice;

int64_t to_godot_format(Format p_format) {
	switch (p_format) {
		case Format::R8_UNORM:
			return RD::DATA_FORMAT_R8_UNORM;
		case Format::R16_SFLOAT:
			return RD::DATA_FORMAT_R16_SFLOAT;
		case Format::R32_SFLOAT:
			return RD::DATA_FORMAT_R32_SFLOAT;
		case Format::R32_UINT:
			return RD::DATA_FORMAT_R32_UINT;
		case Format::RG16_SFLOAT:
			return RD::DATA_FORMAT_R16G16_SFLOAT;
		case Format::RG32_UINT:
			return RD::DATA_FORMAT_R32G32_UINT;
		case Format::RG32_SFLOAT:
			return RD::DATA_FORMAT_R32G32_SFLOAT;
		case Format::RGBA8_UNORM:
			return RD::DATA_FORMAT_R8G8B8A8_UNORM;
		case Format::RGBA8_SRGB:
			return RD::DATA_FORMAT_R8G8B8A8_SRGB;
		case Format::BGRA8_UNORM:
			return RD::DATA_FORMAT_B8G8R8A8_UNORM;
		case Format::RGBA16_SFLOAT:
			return RD::DATA_FORMAT_R16G16B16A16_SFLOAT;
		case Format::RGBA32_SFLOAT:
			return RD::DATA_FORMAT_R32G32B32A32_SFLOAT;
		case Format::RGBA32_UINT:
			return RD::DATA_FORMAT_R32G32B32A32_UINT;
		case Format::D32_SFLOAT:
			return RD::DATA_FORMAT_D32_SFLOAT;
		case Format::D32_SFLOAT_S8_UINT:
			return RD::DATA_FORMAT_D32_SFLOAT_S8_UINT;
	}
	GNOMON_ASSERT(false, "format ", int(p_format));
	return 0;
}

int64_t to_godot_vertex_format(uint32_t p_component_count) {
	constexpr int64_t FORMATS[] = { RD::DATA_FORMAT_R32_SFLOAT, RD::DATA_FORMAT_R32G32_SFLOAT,
		RD::DATA_FORMAT_R32G32B32_SFLOAT, RD::DATA_FORMAT_R32G32B32A32_SFLOAT };
	GNOMON_ASSERT(p_component_count >= 1 && p_component_count <= 4, "a vertex attribute has ",
			p_component_count, " components");
	return FORMATS[p_component_count - 1];
}

int64_t to_godot_usage(const TextureDesc &p_desc) {
	constexpr std::pair<TextureUsage, int64_t> BITS[] = {
		{ TextureUsage::SAMPLED, RD::TEXTURE_USAGE_SAMPLING_BIT },
		{ TextureUsage::STORAGE, RD::TEXTURE_USAGE_STORAGE_BIT },
		{ TextureUsage::COLOR_ATTACHMENT, RD::TEXTURE_USAGE_COLOR_ATTACHMENT_BIT },
		{ TextureUsage::DEPTH_ATTACHMENT, RD::TEXTURE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT },
		{ TextureUsage::COPY_SOURCE, RD::TEXTURE_USAGE_CAN_COPY_FROM_BIT },
		{ TextureUsage::COPY_TARGET,
				RD::TEXTURE_USAGE_CAN_COPY_TO_BIT | RD::TEXTURE_USAGE_CAN_UPDATE_BIT },
	};
	int64_t usage = 0;
	for (const auto &[gnomon_bit, godot_bits] : BITS) {
		usage |= has_usage(p_desc.usage, gnomon_bit) ? godot_bits : 0;
	}
	return usage;
}

glm::vec4 to_godot_clear_value(Format p_format, const glm::vec4 &p_value) {
	return is_uint_format(p_format) ? glm::uintBitsToFloat(glm::uvec4(p_value)) : p_value;
}

} // namespace gnomon
