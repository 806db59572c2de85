#pragma once

#include "modules/gltf_scene/gltf_buffers.h"
#include "modules/scene/texture.h"

#include <tiny_gltf.h>

#include <map>
#include <memory>
#include <string>

namespace gnomon {

/// Reads textures and decodes their images; each image is decoded only once. An image that cannot
/// be read is reported, and textures that use it are empty.
class GltfTextures {
public:
	/// p_root: the JSON document as read, for the URIs and buffer views of images. The document,
	/// the model and the buffers must outlive this object.
	GltfTextures(const GltfObject &p_root, const tinygltf::Model &p_model, GltfBuffers &p_buffers);

	/// Reads the texture of a tinygltf TextureInfo, NormalTextureInfo or OcclusionTextureInfo.
	template <typename Info> Texture read(const Info &p_info) {
		return p_info.index < 0
				? Texture()
				: read(static_cast<size_t>(p_info.index), p_info.texCoord, p_info.extensions);
	}

private:
	Texture read(size_t p_index, int p_uv_set, const tinygltf::ExtensionMap &p_extensions);
	const std::shared_ptr<const Image> &load_image(size_t p_index);
	std::shared_ptr<const Image> decode(size_t p_index, const GltfObject &p_image);
	void read_sampler(size_t p_index, Texture &r_texture) const;

	GltfObject root;
	const tinygltf::Model &model;
	GltfBuffers &buffers;
	std::map<size_t, std::shared_ptr<const Image>> images; // null: cannot be read
	uint64_t texel_count = 0;							   // of all images so far
};

} // namespace gnomon
