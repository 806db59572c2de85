#pragma once

#include "modules/godot_addon/shader_alpha.h"
#include "modules/godot_addon/watched_resource.h"
#include "modules/scene/material.h"

#include <map>
#include <memory>

namespace gnomon {

/// The part of a texture that is the alpha of the image that is read.
struct AlphaSource {
	int channel = 3; // 0 to 3: red, green, blue, alpha
	bool is_inverted = false;
	auto operator<=>(const AlphaSource &) const = default;
};

/// Reads the alpha mask of a material that may have no resource, from the parameters that Godot's
/// generated shaders of base materials with alpha scissor have. Null: it has none, and casts whole.
std::shared_ptr<const Material> read_server_cut_out(godot::RID p_material);

/// Reads the alpha masks of Godot's base materials with alpha scissor, alpha hash or depth prepass:
/// the alpha and the texture of the albedo, the threshold, and how the texture is mapped to the
/// mesh. Alpha hash and depth prepass have no threshold and use 0.5. Also reads the common forms of
/// shaders, see read_shader_alpha. Main thread only.
class CutOutMaterials {
public:
	/// Returns the same object until the material changes. Null: the mask cannot be read, because
	/// the coordinates are triplanar, the texture is an MSDF, its image is not available on the
	/// CPU or has more than 2^26 texels, or vertex colours multiply alpha.
	std::shared_ptr<const Material> read(const godot::BaseMaterial3D &p_material);
	/// The same for a material whose shader is p_text. Null: the shader is none of those forms, or
	/// its texture cannot be read.
	std::shared_ptr<const Material> read(
			const godot::ShaderMaterial &p_material, const ShaderText &p_text);
	/// Removes cached data of freed resources. Call once per frame.
	void forget_unused();

private:
	struct CachedImage {
		std::unique_ptr<WatchedResource> watched;
		std::map<AlphaSource, std::shared_ptr<const Image>> images; // null: it cannot be read
	};
	std::shared_ptr<const Image> read_image(
			const godot::Texture2D &p_texture, const AlphaSource &p_source);
	/// Returns the cached object of a material, which is replaced if it is not p_current.
	std::shared_ptr<const Material> share(
			const godot::Material &p_material, const Material &p_current);

	std::map<uint64_t, CachedImage> images;						   // by the resource's id
	std::map<uint64_t, std::shared_ptr<const Material>> materials; // by the resource's id
};

} // namespace gnomon
