#include "modules/godot_addon/cut_out_materials.h"

namespace gnomon {

namespace {

const float DEFAULT_ALPHA_THRESHOLD = 0.5f;
const int64_t MAX_TEXELS = int64_t(1) << 26; // as MAX_IMAGE_TEXELS of glTF images

bool is_nearest(const godot::BaseMaterial3D &p_material) {
	using godot::BaseMaterial3D;
	switch (p_material.get_texture_filter()) {
		case BaseMaterial3D::TEXTURE_FILTER_NEAREST:
		case BaseMaterial3D::TEXTURE_FILTER_NEAREST_WITH_MIPMAPS:
		case BaseMaterial3D::TEXTURE_FILTER_NEAREST_WITH_MIPMAPS_ANISOTROPIC:
			return true;
		default:
			return false;
	}
}

/// Returns the texture as RGBA8, or null if its texels cannot be read.
std::shared_ptr<const Image> decode(const godot::Texture2D &p_texture) {
	const godot::Ref<godot::Image> shown = p_texture.get_image();
	if (!shown || shown.is_empty()) {
		return nullptr;
	}
	// Convert a copy, because some textures return their own image.
	const godot::Ref<godot::Resource> copy = shown.duplicate(/*deep=*/false);
	const auto image = godot::cast<godot::Image>(copy);
	const int64_t width = image.get_width();
	const int64_t height = image.get_height();
	if (width * height > MAX_TEXELS || (image.is_compressed() && image.decompress() != 0)) {
		return nullptr;
	}
	image.convert(godot::Image::FORMAT_RGBA8);
	const godot::PackedByteArray data = image.get_data();
	const std::span<const uint8_t> bytes = data.get_values();
	const size_t size = size_t(width) * size_t(height) * 4; // of mip level 0, in bytes
	if (width <= 0 || height <= 0 || bytes.size() < size) {
		return nullptr;
	}
	return make_image("albedo", glm::uvec2(width, height), { bytes.begin(), bytes.begin() + size });
}

Material make_material(
		const godot::BaseMaterial3D &p_material, const std::shared_ptr<const Image> &p_image) {
	using godot::BaseMaterial3D;
	Material material;
	material.alpha_mode = AlphaMode::MASK;
	material.alpha = p_material.get_albedo().w;
	material.alpha_cutoff =
			p_material.get_transparency() == BaseMaterial3D::TRANSPARENCY_ALPHA_SCISSOR
			? static_cast<float>(p_material.get_alpha_scissor_threshold())
			: DEFAULT_ALPHA_THRESHOLD;
	Texture &texture = material.base_color_texture;
	texture.image = p_image;
	texture.wrap_u = texture.wrap_v = p_material.get_flag(BaseMaterial3D::FLAG_USE_TEXTURE_REPEAT)
			? TextureWrap::REPEAT
			: TextureWrap::CLAMP;
	texture.is_magnified_nearest = is_nearest(p_material);
	const glm::vec3 scale = p_material.get_uv1_scale();
	const glm::vec3 offset = p_material.get_uv1_offset();
	texture.transform = glm::mat3x2(scale.x, 0, 0, scale.y, offset.x, offset.y);
	return material;
}

} // namespace

/// Godot's materials do not signal changes, so they are read at every call.
std::shared_ptr<const Material> CutOutMaterials::read(const godot::BaseMaterial3D &p_material) {
	using godot::BaseMaterial3D;
	const godot::Ref<godot::Texture2D> texture =
			p_material.get_texture(BaseMaterial3D::TEXTURE_ALBEDO);
	const std::shared_ptr<const Image> image = texture ? read_image(texture) : nullptr;
	if ((texture && !image) || p_material.get_flag(BaseMaterial3D::FLAG_UV1_USE_TRIPLANAR) ||
			p_material.get_flag(BaseMaterial3D::FLAG_ALBEDO_TEXTURE_MSDF) ||
			p_material.get_flag(BaseMaterial3D::FLAG_ALBEDO_FROM_VERTEX_COLOR)) {
		return nullptr;
	}
	const Material current = make_material(p_material, image);
	std::shared_ptr<const Material> &cached =
			materials[godot::get_instance_id(p_material.get_object())];
	if (!cached || *cached != current) {
		cached = std::make_shared<const Material>(current);
	}
	return cached;
}

const std::shared_ptr<const Image> &CutOutMaterials::read_image(const godot::Texture2D &p_texture) {
	CachedImage &cached = images[godot::get_instance_id(p_texture.get_object())];
	const bool is_new = !cached.watched;
	if (is_new) {
		cached.watched = std::make_unique<WatchedResource>(p_texture);
	}
	if (cached.watched->take_change() || is_new) {
		cached.image = decode(p_texture);
	}
	return cached.image;
}

void CutOutMaterials::forget_unused() {
	std::erase_if(images, [](const auto &p_entry) { return !p_entry.second.watched->is_alive(); });
	std::erase_if(materials,
			[](const auto &p_entry) { return godot::get_instance(p_entry.first) == nullptr; });
}

} // namespace gnomon
