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

/// Returns an image with all its mip levels, RGBA8: each texel of a level is the mean of those it
/// covers, weighted by their alpha; sRGB colours are averaged in linear space.
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

/// One vertex stream: from a mesh, or with a single element that all vertices share.
struct VertexStream {
	BufferRID buffer;
	bool is_constant = false;
};

/// The textures of the materials in use; those that are no longer referenced are freed.
class MaterialStore {
public:
	explicit MaterialStore(RenderingDevice &p_device);

	/// Uploads the material and its images the first time.
	const GpuMaterial &get(const std::shared_ptr<const Material> &p_material);
	/// Returns first and second texture coordinates, tangents and colours of a mesh, in the order
	/// of gbuffer.vert. Computes tangents if the material needs them and the mesh has none.
	std::array<VertexStream, 4> get_streams(MeshStore &r_meshes,
			const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material);
	/// Frees resources of materials that were freed. Call it once a frame.
	void collect_garbage();
	size_t get_texture_count() const { return images.size(); }

private:
	struct GpuImage {
		OwnedTexture texture;
		std::weak_ptr<const Image> image;
	};
	TextureRID get_texture(const Texture &p_texture, bool p_is_srgb);
	SamplerRID get_sampler(const Texture &p_texture);
	BufferRID get_constant(size_t p_stream);

	RenderingDevice &device;
	std::map<const Material *, GpuMaterial> materials;
	std::map<std::pair<uint64_t, bool>, GpuImage> images; // by id, and whether sRGB
	std::map<std::array<int, 5>, OwnedSampler> samplers;
	OwnedTexture white;
	std::array<OwnedBuffer, 4> constant_streams;
};

/// Whether the G-buffer pass needs more of the surface than InstancePush contains.
bool has_look(const Mesh &p_mesh, const Material &p_material);

} // namespace gnomon
