#include "modules/gltf_scene/gltf_textures.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/image_decoder.h"

#include <cfloat>
#include <cmath>

namespace gnomon {

namespace {

/// Limit on the texels of all images of a file: 2 GiB, a third more with mip levels.
const uint64_t MAX_TOTAL_TEXELS = uint64_t(1) << 29;
// Offsets, scales and rotations of texture coordinates; a float has no useful precision above.
const double MAX_UV_TRANSFORM = 1e6;

TextureWrap read_wrap(const GltfObject &p_sampler, const char *p_key) {
	const uint64_t mode =
			p_sampler
					.read_choice(p_key,
							{ TINYGLTF_TEXTURE_WRAP_REPEAT, TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE,
									TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT },
							"repetition")
					.value_or(TINYGLTF_TEXTURE_WRAP_REPEAT);
	return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE		? TextureWrap::CLAMP
			: mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::MIRROR
															: TextureWrap::REPEAT;
}

/// Reads a sampler, as a texture without image. An invalid value is reported, and its default used.
Texture read_sampler(const GltfObject &p_sampler) {
	Texture texture;
	texture.wrap_u = read_wrap(p_sampler, "wrapS");
	texture.wrap_v = read_wrap(p_sampler, "wrapT");
	texture.is_magnified_nearest =
			p_sampler.read_choice("magFilter",
					{ TINYGLTF_TEXTURE_FILTER_NEAREST, TINYGLTF_TEXTURE_FILTER_LINEAR },
					"interpolation") == TINYGLTF_TEXTURE_FILTER_NEAREST;
	const auto filter = p_sampler.read_choice("minFilter",
			{ TINYGLTF_TEXTURE_FILTER_NEAREST, TINYGLTF_TEXTURE_FILTER_LINEAR,
					TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST,
					TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST,
					TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR,
					TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR },
			"interpolation with mip maps");
	const auto is_any = [&](uint64_t p_first, uint64_t p_second) {
		return filter == p_first || filter == p_second;
	};
	texture.mip_filter = is_any(TINYGLTF_TEXTURE_FILTER_NEAREST, TINYGLTF_TEXTURE_FILTER_LINEAR)
			? MipFilter::NONE
			: is_any(TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST,
					  TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST)
			? MipFilter::NEAREST
			: MipFilter::LINEAR;
	texture.is_minified_nearest = filter == TINYGLTF_TEXTURE_FILTER_NEAREST ||
			is_any(TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST,
					TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR);
	return texture;
}

/// Reads a pair of numbers of KHR_texture_transform; both are p_default if it is absent. Any other
/// value is reported.
glm::dvec2 read_pair(const GltfObject &p_object, std::string_view p_key, double p_default) {
	const Json *value = p_object.find(p_key);
	const auto is_good = [](const Json &p_number) {
		return p_number.is_number() && std::abs(p_number.get<double>()) <= MAX_UV_TRANSFORM;
	};
	if (value && value->is_array() && value->size() == 2 && is_good((*value)[0]) &&
			is_good((*value)[1])) {
		return { (*value)[0].get<double>(), (*value)[1].get<double>() };
	}
	if (value) {
		p_object.report_value(p_key,
				text("two numbers in -", MAX_UV_TRANSFORM, "..", MAX_UV_TRANSFORM),
				text(p_default, ", ", p_default));
	}
	return glm::dvec2(p_default);
}

/// Reads KHR_texture_transform: scale, then rotation, then offset. The rotation is
/// counter-clockwise as seen on screen, with y down.
void read_transform(const GltfObject &p_transform, GltfTextureInfo &r_info) {
	r_info.uv_set = static_cast<uint32_t>(
			p_transform.read_choice("texCoord", { 0, 1 }, "that of the texture")
					.value_or(r_info.uv_set));
	const glm::dvec2 offset = read_pair(p_transform, "offset", 0);
	const glm::dvec2 scale = read_pair(p_transform, "scale", 1);
	const double rotation_rad =
			p_transform.read_number("rotation", 0, -MAX_UV_TRANSFORM, MAX_UV_TRANSFORM, "rad");
	const double c = std::cos(rotation_rad);
	const double s = std::sin(rotation_rad);
	r_info.transform = glm::mat3x2(glm::dvec2(c, -s) * scale.x, glm::dvec2(s, c) * scale.y, offset);
}

} // namespace

GltfTextureInfo read_texture_info(
		const GltfObject &p_parent, const char *p_key, size_t p_texture_count) {
	GltfTextureInfo info;
	const Json *json = p_parent.find(p_key);
	if (!json) {
		return info;
	}
	if (!json->is_object()) {
		p_parent.report_value(p_key, "an object", "no texture");
		return info;
	}
	const GltfObject object = *p_parent.find_object(p_key);
	info.index = object.read_index("index", p_texture_count, "no texture");
	if (!info.index) {
		return info;
	}
	info.uv_set = static_cast<uint32_t>(object.read_choice("texCoord", { 0, 1 }, "0").value_or(0));
	const auto extensions = object.find_object("extensions");
	const Json *transform = extensions ? extensions->find(GLTF_TEXTURE_TRANSFORM) : nullptr;
	if (transform && transform->is_object()) {
		read_transform(*extensions->find_object(GLTF_TEXTURE_TRANSFORM), info);
	} else if (transform) {
		extensions->report_value(GLTF_TEXTURE_TRANSFORM, "an object", "no transform");
	}
	info.scale = static_cast<float>(object.read_number("scale", 1, -FLT_MAX, FLT_MAX));
	info.strength = static_cast<float>(object.read_number("strength", 1, 0, 1));
	return info;
}

GltfTextures::GltfTextures(
		const GltfObject &p_root, const tinygltf::Model &p_model, GltfBuffers &p_buffers) :
		root(p_root),
		model(p_model), buffers(p_buffers) {
	root.for_each("images", [](const GltfObject &) {}); // they must be objects
	std::vector<Texture> samplers;
	root.for_each("samplers",
			[&](const GltfObject &p_sampler) { samplers.push_back(read_sampler(p_sampler)); });
	const size_t image_count = root.get_count("images");
	root.for_each("textures", [&](const GltfObject &p_texture) {
		const auto sampler =
				p_texture.read_index("sampler", samplers.size(), "repetition with interpolation");
		definitions.push_back({ p_texture.read_index("source", image_count, "no image"),
				sampler ? samplers[*sampler] : Texture() });
	});
}

Texture GltfTextures::load(const GltfTextureInfo &p_info) {
	if (!p_info.index) {
		return {};
	}
	const Definition &definition = definitions[*p_info.index];
	if (!definition.image_index) {
		const GltfObject json = root.get_element("textures", *p_info.index);
		if (!json.find("source")) { // otherwise the constructor has reported it
			GltfMessages &messages = root.get_messages();
			messages.report(messages.describe(json.get_member_path("source"),
					"is missing, must name a PNG or JPEG image; no image is used. Export the file "
					"again with images of these kinds."));
		}
		return {};
	}
	Texture texture = definition.sampler;
	texture.image = load_image(*definition.image_index);
	if (!texture.image) {
		return {};
	}
	texture.uv_set = p_info.uv_set;
	texture.transform = p_info.transform;
	return texture;
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
