#include "modules/gltf_scene/gltf_textures.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_values.h"
#include "modules/gltf_scene/image_decoder.h"

#include <cmath>

namespace gnomon {

namespace {

/// Limit on the texels of all images of a file: 2 GiB, a third more with mip levels.
const uint64_t MAX_TOTAL_TEXELS = uint64_t(1) << 29;

TextureWrap to_wrap(int p_mode) {
	return p_mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE	  ? TextureWrap::CLAMP
			: p_mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::MIRROR
															  : TextureWrap::REPEAT;
}

/// Reads KHR_texture_transform: scale, then rotation, then offset. The rotation is
/// counter-clockwise as seen on screen, with y down.
glm::mat3x2 read_transform(const tinygltf::Value &p_transform) {
	const auto get_pair = [&](const char *p_key, double p_default) {
		if (!p_transform.Has(p_key)) {
			return glm::dvec2(p_default);
		}
		const tinygltf::Value &pair = p_transform.Get(p_key);
		return glm::dvec2(pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble());
	};
	const glm::dvec2 offset = get_pair("offset", 0);
	const glm::dvec2 scale = get_pair("scale", 1);
	const double rotation_rad = get_number(p_transform, "rotation", 0);
	const double c = std::cos(rotation_rad);
	const double s = std::sin(rotation_rad);
	return glm::mat3x2(glm::dvec2(c, -s) * scale.x, glm::dvec2(s, c) * scale.y, offset);
}

} // namespace

GltfTextures::GltfTextures(
		const GltfObject &p_root, const tinygltf::Model &p_model, GltfBuffers &p_buffers) :
		root(p_root),
		model(p_model), buffers(p_buffers) {}

Texture GltfTextures::read(
		size_t p_index, int p_uv_set, const tinygltf::ExtensionMap &p_extensions) {
	Texture texture;
	const tinygltf::Texture &definition = model.textures[p_index];
	GltfMessages &messages = root.get_messages();
	if (definition.source < 0) {
		const GltfObject texture_json = root.get_element("textures", p_index);
		if (!texture_json.find("source")) { // otherwise check_gltf has reported it
			messages.report(messages.describe(texture_json.get_member_path("source"),
					"is missing, must name a PNG or JPEG image; no image is used. Export the file "
					"again with images of these kinds."));
		}
		return texture;
	}
	texture.image = load_image(static_cast<size_t>(definition.source));
	if (!texture.image) {
		return texture;
	}
	if (definition.sampler >= 0) {
		read_sampler(static_cast<size_t>(definition.sampler), texture);
	}
	texture.uv_set = static_cast<uint32_t>(p_uv_set);
	if (const tinygltf::Value *transform = find_extension(p_extensions, GLTF_TEXTURE_TRANSFORM)) {
		texture.transform = read_transform(*transform);
		texture.uv_set = static_cast<uint32_t>(get_number(*transform, "texCoord", p_uv_set));
	}
	return texture;
}

void GltfTextures::read_sampler(size_t p_index, Texture &r_texture) const {
	const tinygltf::Sampler &sampler = model.samplers[p_index];
	r_texture.wrap_u = to_wrap(sampler.wrapS);
	r_texture.wrap_v = to_wrap(sampler.wrapT);
	r_texture.is_magnified_nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
	switch (sampler.minFilter) {
		case TINYGLTF_TEXTURE_FILTER_NEAREST:
		case TINYGLTF_TEXTURE_FILTER_LINEAR:
			r_texture.mip_filter = MipFilter::NONE;
			break;
		case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
		case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
			r_texture.mip_filter = MipFilter::NEAREST;
			break;
		default:
			r_texture.mip_filter = MipFilter::LINEAR;
	}
	r_texture.is_minified_nearest = sampler.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ||
			sampler.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
			sampler.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
}

const std::shared_ptr<const Image> &GltfTextures::load_image(size_t p_index) {
	const auto [found, is_new] = images.try_emplace(p_index);
	if (is_new) {
		const GltfObject image = root.get_element("images", p_index);
		try {
			found->second = decode(p_index, image);
		} catch (const Error &error) {
			root.get_messages().report(
					text(error.what(), " Materials that use it are drawn without it."));
		}
	}
	return found->second;
}

std::shared_ptr<const Image> GltfTextures::decode(size_t p_index, const GltfObject &p_image) {
	GltfMessages &messages = root.get_messages();
	std::vector<uint8_t> file;
	std::span<const uint8_t> bytes;
	const Json *uri = p_image.find("uri");
	if (uri) {
		if (!uri->is_string()) {
			p_image.fail_value("uri", "text");
		}
		file = buffers.load_uri(p_image, uri->get_ref<const std::string &>());
		bytes = file;
	} else if (p_image.find("bufferView")) {
		const size_t view = p_image.require_index("bufferView", model.bufferViews.size());
		bytes = buffers.load_view(model, view);
	} else {
		messages.fail(p_image.get_path(),
				"has neither uri nor bufferView, must have one of them. Export the file again.");
	}
	std::string warning;
	std::shared_ptr<const Image> image;
	try {
		image = decode_image(
				bytes, make_name(p_image.get_text("name"), text("Image ", p_index)), warning);
	} catch (const Error &error) {
		messages.fail(p_image.get_path(), error.what());
	}
	if (!warning.empty()) {
		messages.report(messages.describe(p_image.get_path(), warning));
	}
	texel_count += uint64_t(image->size_px.x) * image->size_px.y;
	if (texel_count > MAX_TOTAL_TEXELS) {
		p_image.fail_at(uri ? "uri" : "bufferView",
				text("makes more than ", MAX_TOTAL_TEXELS,
						" texels in all images. Make images smaller."));
	}
	return image;
}

} // namespace gnomon
