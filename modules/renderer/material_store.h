#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/scene/material.h"
#include "modules/shadows/mesh_store.h"

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace gnomon {

/// Returns all mip levels of an image, RGBA8. Each texel is the mean of the texels that it covers
/// in the level before. sRGB colours are averaged in linear space and weighted by alpha.
std::vector<uint8_t> make_mip_levels(const Image &p_image, bool p_is_srgb, uint32_t &r_level_count);

/// A material's textures in GPU memory, and its shader constants.
struct GpuMaterial {
	OwnedBuffer constants;				// shader::MaterialConstants
	std::array<TextureRID, 5> textures; // in the order of Material::list_textures
	std::array<SamplerRID, 5> samplers;
	std::weak_ptr<const Material> material;
};

/// Vertex attributes other than position and normal, in GPU memory.
struct GpuAttributes {
	std::array<OwnedBuffer, 2> uvs;
	OwnedBuffer tangents;
	OwnedBuffer colors;
};

/// A vertex buffer of a mesh, or one with a single element that is used for all vertices
/// (is_constant).
struct VertexStream {
	BufferRID buffer;
	bool is_constant = false;
};

/// Textures and constants of the materials in use, in GPU memory. Those of materials and images
/// that no longer exist are freed.
class MaterialStore {
public:
	explicit MaterialStore(RenderingDevice &p_device);

	/// Returns the GPU data of a material. Uploads the material and its images at the first call.
	const GpuMaterial &get(const std::shared_ptr<const Material> &p_material);
	/// Returns the first and second texture coordinates, tangents and colours of a mesh, in the
	/// order of the inputs of gbuffer.vert. Computes tangents if the material needs them and the
	/// mesh has none.
	std::array<VertexStream, 4> get_streams(MeshStore &r_meshes,
			const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material);
	/// Frees the resources of materials and images that no longer exist. Call it once per frame.
	void collect_garbage();
	size_t get_texture_count() const { return images.size(); }

private:
	struct GpuImage {
		OwnedTexture texture;
		std::weak_ptr<const Image> image;
	};
	TextureRID get_texture(const Texture &p_texture, bool p_is_srgb);
	SamplerRID get_sampler(const Texture &p_texture);
	BufferRID get_constant_stream(size_t p_stream);

	RenderingDevice &device;
	std::map<const Material *, GpuMaterial> materials;
	std::map<std::pair<uint64_t, bool>, GpuImage> images; // key: image id, is sRGB
	std::map<std::array<int, 5>, OwnedSampler> samplers;  // key: the enums of SamplerDesc
	OwnedTexture white;
	std::array<OwnedBuffer, 4> constant_streams;
};

/// Returns whether the G-buffer pass needs more data about the surface than GBufferInstance
/// contains: textures, vertex colours or an alpha cutoff.
bool needs_gpu_material(const Mesh &p_mesh, const Material &p_material);

} // namespace gnomon
