#include "modules/godot_addon/cut_out_materials.h"

#include "modules/godot_addon/variant_numbers.h"

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

/// Copies the channel that the alpha is made of into the alpha of all texels.
void select_alpha(const AlphaSource &p_source, std::vector<uint8_t> &r_texels) {
	for (size_t texel = 0; p_source != AlphaSource() && texel < r_texels.size(); texel += 4) {
		const uint8_t value = r_texels[texel + size_t(p_source.channel)];
		r_texels[texel + 3] = p_source.is_inverted ? uint8_t(255 - value) : value;
	}
}

/// Returns the image as RGBA8, or null if its texels cannot be read.
std::shared_ptr<const Image> decode(
		const godot::Ref<godot::Image> &p_image, const AlphaSource &p_source) {
	if (!p_image || p_image.is_empty()) {
		return nullptr;
	}
	// Convert a copy, because some textures return their own image.
	const godot::Ref<godot::Resource> copy = p_image.duplicate(/*deep=*/false);
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
	std::vector<uint8_t> texels(bytes.begin(), bytes.begin() + size);
	select_alpha(p_source, texels);
	return make_image("albedo", glm::uvec2(width, height), std::move(texels));
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

/// Whether the sampler of that name in a shader has the hint.
bool has_sampler_hint(const ShaderText &p_text, const std::string &p_sampler, const char *p_hint) {
	const std::string &code = p_text.get_code();
	const size_t name = code.find(p_sampler, code.find("sampler2D"));
	const size_t end = code.find(';', name);
	return name != std::string::npos && end != std::string::npos &&
			code.substr(name, end - name).find(p_hint) != std::string::npos;
}

/// Returns the texture of a sampler that no texture is set for.
std::shared_ptr<const Image> make_default_image(
		const ShaderText &p_text, const std::string &p_sampler, const AlphaSource &p_source) {
	const bool is_transparent = has_sampler_hint(p_text, p_sampler, "hint_default_transparent");
	const bool is_black = has_sampler_hint(p_text, p_sampler, "hint_default_black");
	const uint8_t color = is_transparent || is_black ? 0 : 255;
	std::vector<uint8_t> texels = { color, color, color, uint8_t(is_transparent ? 0 : 255) };
	select_alpha(p_source, texels);
	return make_image("default", glm::uvec2(1), std::move(texels));
}

} // namespace

std::shared_ptr<const Material> CutOutMaterials::share(
		const godot::Material &p_material, const Material &p_current) {
	std::shared_ptr<const Material> &cached =
			materials[godot::get_instance_id(p_material.get_object())];
	if (!cached || *cached != p_current) {
		cached = std::make_shared<const Material>(p_current);
	}
	return cached;
}

/// Godot's materials do not signal changes, so they are read at every call.
std::shared_ptr<const Material> CutOutMaterials::read(const godot::BaseMaterial3D &p_material) {
	using godot::BaseMaterial3D;
	const godot::Ref<godot::Texture2D> texture =
			p_material.get_texture(BaseMaterial3D::TEXTURE_ALBEDO);
	const std::shared_ptr<const Image> image = texture ? read_image(texture, {}) : nullptr;
	if ((texture && !image) || p_material.get_flag(BaseMaterial3D::FLAG_UV1_USE_TRIPLANAR) ||
			p_material.get_flag(BaseMaterial3D::FLAG_ALBEDO_TEXTURE_MSDF) ||
			p_material.get_flag(BaseMaterial3D::FLAG_ALBEDO_FROM_VERTEX_COLOR)) {
		return nullptr;
	}
	return share(p_material, make_material(p_material, image));
}

std::shared_ptr<const Material> CutOutMaterials::read(
		const godot::ShaderMaterial &p_material, const ShaderText &p_text) {
	const godot::Ref<godot::Shader> shader = p_material.get_shader();
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	const auto find_uniform = [&](const std::string &p_name) {
		const std::vector<double> numbers =
				to_numbers(p_material.get_shader_parameter(p_name.c_str()));
		return numbers.empty()
				? to_numbers(server.shader_get_parameter_default(shader.get_rid(), p_name.c_str()))
				: numbers;
	};
	const std::optional<ShaderAlpha> alpha =
			read_shader_alpha(p_text, find_uniform, DEFAULT_ALPHA_THRESHOLD);
	if (!alpha) {
		return nullptr;
	}
	Material current;
	current.alpha_mode = AlphaMode::MASK;
	current.alpha_cutoff = alpha->threshold;
	if (alpha->sampler.empty()) {
		return share(p_material, current);
	}
	godot::Ref<godot::Texture2D> texture =
			godot::Ref<godot::Texture2D>::share(godot::cast<godot::Texture2D>(godot::ObjectHandle(
					p_material.get_shader_parameter(alpha->sampler.c_str()).to_object())));
	if (!texture) {
		const godot::Ref<godot::Texture> by_default =
				shader.get_default_texture_parameter(alpha->sampler.c_str(), /*index=*/0);
		texture = godot::Ref<godot::Texture2D>::share(godot::cast<godot::Texture2D>(by_default));
	}
	const AlphaSource source = { alpha->channel, alpha->is_inverted };
	const std::shared_ptr<const Image> image = texture
			? read_image(texture, source)
			: make_default_image(p_text, alpha->sampler, source);
	if (!image) {
		return nullptr;
	}
	Texture &base = current.base_color_texture;
	base.image = image;
	base.wrap_u = base.wrap_v = has_sampler_hint(p_text, alpha->sampler, "repeat_disable")
			? TextureWrap::CLAMP
			: TextureWrap::REPEAT;
	base.is_magnified_nearest = has_sampler_hint(p_text, alpha->sampler, "filter_nearest");
	base.transform = alpha->uv_from_mesh_uv;
	return share(p_material, current);
}

std::shared_ptr<const Image> CutOutMaterials::read_image(
		const godot::Texture2D &p_texture, const AlphaSource &p_source) {
	CachedImage &cached = images[godot::get_instance_id(p_texture.get_object())];
	if (!cached.watched) {
		cached.watched = std::make_unique<WatchedResource>(p_texture);
	}
	if (cached.watched->take_change()) {
		cached.images.clear();
	}
	const auto [found, is_new] = cached.images.try_emplace(p_source);
	if (is_new) {
		found->second = decode(p_texture.get_image(), p_source);
	}
	return found->second;
}

std::shared_ptr<const Material> read_server_cut_out(godot::RID p_material) {
	if (!p_material.id) {
		return nullptr;
	}
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	const std::vector<double> threshold =
			to_numbers(server.material_get_param(p_material, "alpha_scissor_threshold"));
	const std::vector<double> scale =
			to_numbers(server.material_get_param(p_material, "uv1_scale"));
	const std::vector<double> offset =
			to_numbers(server.material_get_param(p_material, "uv1_offset"));
	const std::vector<double> albedo = to_numbers(server.material_get_param(p_material, "albedo"));
	const godot::RID texture = server.material_get_param(p_material, "texture_albedo").to_rid();
	if (threshold.empty() || scale.size() < 2 || offset.size() < 2 || albedo.size() < 4 ||
			!texture.id) {
		return nullptr;
	}
	const std::shared_ptr<const Image> image =
			decode(server.texture_2d_get(texture), AlphaSource());
	if (!image) {
		return nullptr;
	}
	auto cut_out = std::make_shared<Material>();
	cut_out->alpha_mode = AlphaMode::MASK;
	cut_out->alpha = static_cast<float>(albedo[3]);
	cut_out->alpha_cutoff = static_cast<float>(threshold[0]);
	cut_out->base_color_texture.image = image;
	cut_out->base_color_texture.transform =
			glm::mat3x2(scale[0], 0, 0, scale[1], offset[0], offset[1]);
	return cut_out;
}

void CutOutMaterials::forget_unused() {
	std::erase_if(images, [](const auto &p_entry) { return !p_entry.second.watched->is_alive(); });
	std::erase_if(materials,
			[](const auto &p_entry) { return godot::get_instance(p_entry.first) == nullptr; });
}

} // namespace gnomon
