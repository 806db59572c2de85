#pragma once

#include "modules/godot_addon/watched_resource.h"
#include "modules/scene/material.h"

#include <map>
#include <memory>

namespace gnomon {

/// Where Godot's base materials with alpha scissor, hash or depth prepass are there: their albedo's
/// alpha, texture, threshold, and how the texture is mapped to the mesh. Hash and depth prepass,
/// which have no threshold, count as one of a half. Main thread only.
class CutOutMaterials {
public:
	/// The same material until something of it changes. Null: the holes cannot be read, as the
	/// coordinates are triplanar, the texture has no texels in this program (or more than the
	/// engine reads), or vertex colours multiply alpha.
	std::shared_ptr<const Material> read(const godot::BaseMaterial3D &p_material);
	/// Drops what is known of resources that are gone. Once a frame.
	void forget_unused();

private:
	struct KnownImage {
		std::unique_ptr<WatchedResource> watched;
		std::shared_ptr<const Image> image; // null: it has no texels
	};
	const std::shared_ptr<const Image> &read_image(const godot::Texture2D &p_texture);

	std::map<uint64_t, KnownImage> images;						   // by the resource's id
	std::map<uint64_t, std::shared_ptr<const Material>> materials; // by the resource's id
};

} // namespace gnomon
