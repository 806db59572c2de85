#pragma once

#include "modules/godot_addon/watched_resource.h"
#include "modules/scene/material.h"

#include <map>
#include <memory>

namespace gnomon {

/// Reads the alpha masks of Godot's base materials with alpha scissor, alpha hash or depth prepass:
/// the alpha and the texture of the albedo, the threshold, and how the texture is mapped to the
/// mesh. Alpha hash and depth prepass have no threshold and use 0.5. Main thread only.
class CutOutMaterials {
public:
	/// Returns the same object until the material changes. Null: the mask cannot be read, because
	/// the coordinates are triplanar, the texture is an MSDF, its image is not available on the
	/// CPU or has more than 2^26 texels, or vertex colours multiply alpha.
	std::shared_ptr<const Material> read(const godot::BaseMaterial3D &p_material);
	/// Removes cached data of freed resources. Call once per frame.
	void forget_unused();

private:
	struct CachedImage {
		std::unique_ptr<WatchedResource> watched;
		std::shared_ptr<const Image> image; // null: it cannot be read
	};
	const std::shared_ptr<const Image> &read_image(const godot::Texture2D &p_texture);

	std::map<uint64_t, CachedImage> images;						   // by the resource's id
	std::map<uint64_t, std::shared_ptr<const Material>> materials; // by the resource's id
};

} // namespace gnomon
