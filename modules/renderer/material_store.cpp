#include "modules/renderer/material_store.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include "renderer/renderer_shared.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

float srgb_to_linear(float p_value) {
	return p_value <= 0.04045f ? p_value / 12.92f : std::pow((p_value + 0.055f) / 1.055f, 2.4f);
}

float linear_to_srgb(float p_value) {
	return p_value <= 0.0031308f ? p_value * 12.92f
								 : 1.055f * std::pow(p_value, 1.0f / 2.4f) - 0.055f;
}

/// The texels of the previous level that one texel covers along an axis, with their weights.
struct Taps {
	uint32_t first = 0;
	uint32_t count = 0;
	float weights[3] = {};
};

std::vector<Taps> find_taps(uint32_t p_from, uint32_t p_to) {
	std::vector<Taps> taps(p_to);
	const double scale = double(p_from) / p_to; // 1, 2, or for odd sizes up to 3
	for (uint32_t index = 0; index < p_to; ++index) {
		const double low = index * scale;
		const double high = std::min((index + 1) * scale, double(p_from));
		Taps &tap = taps[index];
		tap.first = static_cast<uint32_t>(low);
		for (uint32_t texel = tap.first; texel < high && tap.count < 3; ++texel) {
			const double covered = std::min(high, texel + 1.0) - std::max(low, double(texel));
			tap.weights[tap.count++] = static_cast<float>(covered / scale);
		}
	}
	return taps;
}

/// Appends the mip level of the size p_to_px, computed from the one before, to r_texels.
void append_level(const uint8_t *p_from, glm::uvec2 p_from_px, glm::uvec2 p_to_px, bool p_is_srgb,
		std::vector<uint8_t> &r_texels) {
	static const std::array<float, 256> LINEAR = [] {
		std::array<float, 256> values;
		for (size_t index = 0; index < values.size(); ++index) {
			values[index] = srgb_to_linear(static_cast<float>(index) / 255.0f);
		}
		return values;
	}();
	const std::vector<Taps> columns = find_taps(p_from_px.x, p_to_px.x);
	const std::vector<Taps> rows = find_taps(p_from_px.y, p_to_px.y);
	for (const Taps &row : rows) {
		for (const Taps &column : columns) {
			glm::vec3 sum(0.0f), weighted_sum(0.0f);
			float alpha = 0.0f;
			for (uint32_t y = 0; y < row.count; ++y) {
				for (uint32_t x = 0; x < column.count; ++x) {
					const uint8_t *texel =
							p_from + 4 * (size_t(row.first + y) * p_from_px.x + column.first + x);
					const float weight = row.weights[y] * column.weights[x];
					glm::vec3 color;
					for (int channel = 0; channel < 3; ++channel) {
						color[channel] = p_is_srgb ? LINEAR[texel[channel]]
												   : static_cast<float>(texel[channel]) / 255.0f;
					}
					const float texel_alpha = static_cast<float>(texel[3]) / 255.0f;
					sum += color * weight;
					weighted_sum += color * (weight * texel_alpha);
					alpha += weight * texel_alpha;
				}
			}
			if (p_is_srgb && alpha > 0.0f) {
				sum = weighted_sum / alpha;
			}
			for (int channel = 0; channel < 3; ++channel) {
				const float value = p_is_srgb ? linear_to_srgb(sum[channel]) : sum[channel];
				r_texels.push_back(
						static_cast<uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f));
			}
			r_texels.push_back(static_cast<uint8_t>(std::clamp(alpha, 0.0f, 1.0f) * 255.0f + 0.5f));
		}
	}
}

shader::TextureTransform make_texture_transform(const Texture &p_texture) {
	const glm::mat3x2 &transform = p_texture.transform;
	return { glm::vec4(transform[0].x, transform[1].x, transform[2].x,
					 p_texture.uv_set == 1 ? 1.0f : 0.0f),
		glm::vec4(transform[0].y, transform[1].y, transform[2].y, 0.0f) };
}

shader::MaterialConstants make_constants(const Material &p_material) {
	shader::MaterialConstants constants = {};
	constants.base_color = make_texture_transform(p_material.base_color_texture);
	constants.metallic_roughness = make_texture_transform(p_material.metallic_roughness_texture);
	constants.normal = make_texture_transform(p_material.normal_texture);
	constants.occlusion = make_texture_transform(p_material.occlusion_texture);
	constants.emissive = make_texture_transform(p_material.emissive_texture);
	constants.alpha = p_material.alpha;
	constants.alpha_cutoff = p_material.is_cut_out() ? p_material.alpha_cutoff : -1.0f;
	constants.normal_scale = p_material.normal_scale;
	constants.occlusion_strength = p_material.occlusion_strength;
	return constants;
}

/// Generated tangents of a mesh that has none, for its first (SET = 0) or second (SET = 1) texture
/// coordinates. MeshStore::get_derived has one entry per mesh and type, hence two types.
template <int SET> struct GeneratedTangents { OwnedBuffer buffer; };

} // namespace

std::vector<uint8_t> make_mip_levels(
		const Image &p_image, bool p_is_srgb, uint32_t &r_level_count) {
	std::vector<uint8_t> texels = p_image.texels;
	texels.reserve(texels.size() + texels.size() / 2 + 64);
	glm::uvec2 size_px = p_image.size_px;
	size_t begin = 0;
	for (r_level_count = 1; std::max(size_px.x, size_px.y) > 1; ++r_level_count) {
		const glm::uvec2 next_px = compute_mip_size(size_px, 1);
		const std::vector<uint8_t> level(texels.begin() + std::ptrdiff_t(begin), texels.end());
		begin = texels.size();
		append_level(level.data(), size_px, next_px, p_is_srgb, texels);
		size_px = next_px;
	}
	return texels;
}

bool needs_gpu_material(const Mesh &p_mesh, const Material &p_material) {
	const auto textures = p_material.list_textures();
	return !p_mesh.attributes.colors.empty() || p_material.is_cut_out() ||
			std::any_of(textures.begin(), textures.end(),
					[](const Texture *p_texture) { return bool(p_texture->image); });
}

MaterialStore::MaterialStore(RenderingDevice &p_device) : device(p_device) {}

TextureRID MaterialStore::get_texture(const Texture &p_texture, bool p_is_srgb) {
	if (!p_texture.image) {
		if (!white) {
			const std::array<uint8_t, 4> texel = { 255, 255, 255, 255 };
			white = OwnedTexture(device,
					device.create_texture_with_data({ "white", Format::RGBA8_UNORM }, texel));
		}
		return white.get();
	}
	GpuImage &image = images[{ p_texture.image->id, p_is_srgb }];
	if (!image.texture) {
		TextureDesc desc;
		desc.name = p_texture.image->name;
		desc.format = p_is_srgb ? Format::RGBA8_SRGB : Format::RGBA8_UNORM;
		desc.size_px = p_texture.image->size_px;
		const std::vector<uint8_t> texels =
				make_mip_levels(*p_texture.image, p_is_srgb, desc.mip_count);
		image.texture = OwnedTexture(device, device.create_texture_with_data(desc, texels));
		image.image = p_texture.image;
	}
	return image.texture.get();
}

SamplerRID MaterialStore::get_sampler(const Texture &p_texture) {
	const auto get_filter = [](bool p_is_nearest) {
		return p_is_nearest ? Filter::NEAREST : Filter::LINEAR;
	};
	const auto get_address = [](TextureWrap p_wrap) {
		return p_wrap == TextureWrap::CLAMP		? AddressMode::CLAMP
				: p_wrap == TextureWrap::MIRROR ? AddressMode::MIRROR
												: AddressMode::REPEAT;
	};
	const SamplerDesc desc = { "texture", get_filter(p_texture.is_magnified_nearest),
		get_filter(p_texture.is_minified_nearest),
		p_texture.mip_filter == MipFilter::NONE				 ? MipMode::NONE
				: p_texture.mip_filter == MipFilter::NEAREST ? MipMode::NEAREST
															 : MipMode::LINEAR,
		get_address(p_texture.wrap_u), get_address(p_texture.wrap_v) };
	OwnedSampler &sampler = samplers[{ int(desc.mag_filter), int(desc.min_filter),
			int(desc.mip_mode), int(desc.address_u), int(desc.address_v) }];
	if (!sampler) {
		sampler = OwnedSampler(device, device.create_sampler(desc));
	}
	return sampler.get();
}

const GpuMaterial &MaterialStore::get(const std::shared_ptr<const Material> &p_material) {
	GpuMaterial &made = materials[p_material.get()];
	if (made.constants && !made.material.expired()) { // expired: a new material at an old address
		return made;
	}
	const shader::MaterialConstants constants = make_constants(*p_material);
	made.constants = OwnedBuffer(device,
			device.create_buffer_with_data(
					{ text(p_material->name, " material"), sizeof(constants),
							BufferUsage::UNIFORM | BufferUsage::COPY_TARGET },
					bytes_of(std::span(&constants, 1))));
	const auto textures = p_material->list_textures();
	for (size_t index = 0; index < textures.size(); ++index) {
		const bool is_srgb = textures[index] == &p_material->base_color_texture ||
				textures[index] == &p_material->emissive_texture;
		made.textures[index] = get_texture(*textures[index], is_srgb);
		made.samplers[index] = get_sampler(*textures[index]);
	}
	made.material = p_material;
	return made;
}

BufferRID MaterialStore::get_constant_stream(size_t p_stream) {
	// First and second uv, tangent, colour.
	const glm::vec4 values[] = { glm::vec4(0.0f), glm::vec4(0.0f), glm::vec4(1, 0, 0, 1),
		glm::vec4(1.0f) };
	OwnedBuffer &buffer = constant_streams[p_stream];
	if (!buffer) {
		buffer = OwnedBuffer(device,
				device.create_buffer_with_data(
						{ "one for all vertices", sizeof(glm::vec4),
								BufferUsage::VERTEX | BufferUsage::COPY_TARGET },
						bytes_of(std::span(&values[p_stream], 1))));
	}
	return buffer.get();
}

std::array<VertexStream, 4> MaterialStore::get_streams(MeshStore &r_meshes,
		const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material) {
	// deform_tangents.comp reads the tangents of deformable meshes as a storage buffer.
	const BufferUsage usage = BufferUsage::VERTEX | BufferUsage::COPY_TARGET |
			(p_mesh->is_deformable() ? BufferUsage::STORAGE : BufferUsage::VERTEX);
	const auto upload = [&](const char *p_what, const auto &p_values) {
		if (p_values.empty()) {
			return OwnedBuffer();
		}
		const std::span<const uint8_t> bytes = bytes_of(std::span(p_values));
		return OwnedBuffer(device,
				device.create_buffer_with_data(
						{ text(p_mesh->name, " ", p_what), bytes.size(), usage }, bytes));
	};
	const MeshAttributes &attributes = p_mesh->attributes;
	const GpuAttributes &uploaded = r_meshes.get_derived<GpuAttributes>(p_mesh, [&] {
		return GpuAttributes{ { upload("first coordinates", attributes.uvs[0]),
									  upload("second coordinates", attributes.uvs[1]) },
			upload("tangents", attributes.tangents), upload("colours", attributes.colors) };
	});
	BufferRID tangents = uploaded.tangents.get();
	const uint32_t set = p_material.normal_texture.uv_set;
	if (!tangents && p_material.normal_texture.image && !attributes.uvs[set].empty()) {
		const auto make = [&] {
			return upload("tangents",
					compute_tangents(p_mesh->positions_node, p_mesh->normals_node, p_mesh->indices,
							attributes.uvs[set]));
		};
		tangents = set == 0 ? r_meshes.get_derived<GeneratedTangents<0>>(p_mesh,
											  [&] { return GeneratedTangents<0>{ make() }; })
									  .buffer.get()
							: r_meshes.get_derived<GeneratedTangents<1>>(p_mesh,
											  [&] { return GeneratedTangents<1>{ make() }; })
									  .buffer.get();
	}
	if (tangents && p_mesh->rest) {
		tangents = r_meshes.get_deformed_tangents(p_mesh, tangents);
	}
	std::array<VertexStream, 4> streams;
	const BufferRID buffers[] = { uploaded.uvs[0].get(), uploaded.uvs[1].get(), tangents,
		uploaded.colors.get() };
	for (size_t index = 0; index < streams.size(); ++index) {
		streams[index] = buffers[index] ? VertexStream{ buffers[index], false }
										: VertexStream{ get_constant_stream(index), true };
	}
	return streams;
}

void MaterialStore::collect_garbage() {
	std::erase_if(materials, [](const auto &p_entry) { return p_entry.second.material.expired(); });
	std::erase_if(images, [](const auto &p_entry) { return p_entry.second.image.expired(); });
}

} // namespace gnomon
