#pragma once

#include "modules/gltf_scene/gltf_buffers.h"
#include "modules/scene/texture.h"

#include <tiny_gltf.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// A material's reference to a texture.
struct GltfTextureInfo {
	std::optional<size_t> index; // of the texture in the file; none: no texture
	uint32_t uv_set = 0;
	glm::mat3x2 transform = Texture().transform;
	float scale = 1;	// of a normal texture
	float strength = 1; // of an occlusion texture
};

/// Reads the member p_key of a material or of a part of it. An invalid value is reported, and its
/// default used. p_texture_count: length of the document's list of textures.
GltfTextureInfo read_texture_info(
		const GltfObject &p_parent, const char *p_key, size_t p_texture_count);

/// Reads textures and decodes their images; each image is decoded only once. An image that cannot
/// be read is reported, and textures that use it are empty.
class GltfTextures {
public:
	/// p_root: the document's JSON, for the URIs and buffer views of images. The arguments must
	/// outlive this object.
	GltfTextures(const GltfObject &p_root, const tinygltf::Model &p_model, GltfBuffers &p_buffers);

	/// Loads the texture with its image.
	Texture load(const GltfTextureInfo &p_info);

private:
	struct Definition {
		std::optional<size_t> image_index; // none: missing, or reported as invalid
		Texture sampler;
	};
	const std::shared_ptr<const Image> &load_image(size_t p_index);
	std::shared_ptr<const Image> decode(size_t p_index, const GltfObject &p_image);

	GltfObject root;
	const tinygltf::Model &model;
	GltfBuffers &buffers;
	std::vector<Definition> definitions;				   // by index of the texture
	std::map<size_t, std::shared_ptr<const Image>> images; // null: cannot be read
	uint64_t texel_count = 0;							   // of all images so far
};

} // namespace gnomon
