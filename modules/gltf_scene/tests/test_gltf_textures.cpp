// Tests how textures are read from glTF files and how their images are decoded.

#include "modules/core/png.h"
#include "modules/gltf_scene/image_decoder.h"
#include "modules/gltf_scene/tests/gltf_test_files.h"
#include "modules/scene/cut_levels.h"
#include "modules/scene/scene_snapshot.h"

#include <doctest/doctest.h>
#include <png.h>
#include <turbojpeg.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace gnomon;

namespace {

/// Four RGBA8 texels, the content of encode_small_png.
const std::vector<uint8_t> TEXELS = { 255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 10, 20, 30,
	40 };

std::vector<uint8_t> to_bytes(std::string_view p_text) {
	return { p_text.begin(), p_text.end() };
}

std::vector<uint8_t> encode_small_png() {
	return encode_png({ 2, 2 }, /*p_channel_count=*/4, TEXELS);
}

std::vector<uint8_t> encode_jpeg(
		const std::vector<uint8_t> &p_rgb, int p_size_px, int p_format = TJPF_RGB) {
	const tjhandle encoder = tjInitCompress();
	unsigned char *bytes = nullptr;
	unsigned long size = 0;
	const int result = tjCompress2(encoder, p_rgb.data(), p_size_px, /*pitch=*/0, p_size_px,
			p_format, &bytes, &size, TJSAMP_444, /*jpegQual=*/95, /*flags=*/0);
	std::vector<uint8_t> file(bytes, bytes + (result == 0 ? size : 0));
	tjFree(bytes);
	tjDestroy(encoder);
	return file;
}

/// Returns a document of a triangle whose material has a base colour texture from an image file.
/// The triangle also has two sets of UVs, tangents and vertex colours.
Json make_textured(const GltfTestFolder &p_folder) {
	Json json = make_triangle(p_folder);
	GltfTestBuffer buffer;
	buffer.add_accessor(buffer.add_view(std::vector<float>{ 0, 0, 0, 1, 0, 0, 0, 1, 0 }),
			GLTF_TEST_FLOAT, "VEC3", 3);
	buffer.add_accessor(
			buffer.add_view(std::vector<uint16_t>{ 0, 1, 2 }), GLTF_TEST_USHORT, "SCALAR", 3);
	buffer.add_accessor(
			buffer.add_view(std::vector<float>{ 0, 0, 1, 0, 0, 1 }), GLTF_TEST_FLOAT, "VEC2", 3);
	buffer.add_accessor(buffer.add_view(std::vector<uint16_t>{ 0, 0, 65535, 0, 0, 32768 }),
			GLTF_TEST_USHORT, "VEC2", 3);
	buffer.accessors[3]["normalized"] = true;
	buffer.add_accessor(buffer.add_view(std::vector<float>{ 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1 }),
			GLTF_TEST_FLOAT, "VEC4", 3);
	buffer.add_accessor(
			buffer.add_view(std::vector<uint8_t>{ 255, 0, 51, 0, 0, 255, 0, 0, 0, 0, 0, 0 }, 4),
			GLTF_TEST_UBYTE, "VEC3", 3);
	buffer.accessors[5]["normalized"] = true;
	buffer.store(json, p_folder);
	json["meshes"][0]["primitives"][0]["material"] = 0;
	json["meshes"][0]["primitives"][0]["attributes"] = { { "POSITION", 0 }, { "TEXCOORD_0", 2 },
		{ "TEXCOORD_1", 3 }, { "TANGENT", 4 }, { "COLOR_0", 5 } };
	json["materials"] =
			Json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
	json["textures"] = Json::parse(R"([{"source": 0}])");
	json["images"] = Json::parse(R"([{"uri": "wood%20a.png"}])");
	p_folder.write("wood a.png", encode_small_png());
	return json;
}

const MeshInstance3D::Surface &get_surface(const Scene &p_scene) {
	return p_scene.find_nodes<MeshInstance3D>().at(0)->surfaces.at(0);
}

Texture load_base_color(const GltfTestFolder &p_folder, const Json &p_json) {
	return get_surface(*p_folder.load(p_json)).material->base_color_texture;
}

void write_big_endian(uint32_t p_number, uint8_t *r_bytes) {
	for (int byte = 0; byte < 4; ++byte) {
		r_bytes[byte] = static_cast<uint8_t>(p_number >> (24 - 8 * byte));
	}
}

/// Writes the checksum of the PNG chunk that begins at offset p_chunk: length, type, data, CRC. Its
/// data must be shorter than 256 bytes.
void write_png_checksum(std::vector<uint8_t> &r_bytes, size_t p_chunk) {
	const size_t length_bytes = r_bytes[p_chunk + 3];
	uint32_t crc = 0xffffffffu; // CRC-32 of type and data (PNG specification, annex D)
	for (size_t index = p_chunk + 4; index < p_chunk + 8 + length_bytes; ++index) {
		crc ^= r_bytes[index];
		for (int bit = 0; bit < 8; ++bit) {
			crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
		}
	}
	write_big_endian(~crc, &r_bytes[p_chunk + 8 + length_bytes]);
}

/// Decodes an image and returns the error or warning; empty if there is none.
std::string get_decode_error(const std::vector<uint8_t> &p_bytes) {
	std::string warning;
	try {
		decode_image(p_bytes, "image", warning);
	} catch (const Error &error) {
		return error.what();
	}
	return warning;
}

/// Returns a PNG file of 2 x 1 pixels. p_depth: bits per channel. p_row: the packed pixels.
std::vector<uint8_t> encode_png_of_type(
		int p_color_type, int p_depth, const std::vector<uint8_t> &p_row) {
	struct File {
		std::vector<uint8_t> bytes;
	} file;
	png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
	png_infop info = png_create_info_struct(png);
	png_set_write_fn(
			png, &file,
			[](png_structp p_png, png_bytep p_bytes, size_t p_count) {
				auto &target = static_cast<File *>(png_get_io_ptr(p_png))->bytes;
				target.insert(target.end(), p_bytes, p_bytes + p_count);
			},
			nullptr);
	png_set_IHDR(png, info, 2, 1, p_depth, p_color_type, PNG_INTERLACE_NONE,
			PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
	png_color palette[] = { { 1, 2, 3 }, { 4, 5, 6 } };
	png_byte alphas[] = { 7 };
	if (p_color_type == PNG_COLOR_TYPE_PALETTE) {
		png_set_PLTE(png, info, palette, 2);
		png_set_tRNS(png, info, alphas, 1, nullptr);
	}
	png_set_gAMA(png, info, 1.0); // ignored, as glTF requires
	png_write_info(png, info);
	png_write_row(png, p_row.data());
	png_write_end(png, info);
	png_destroy_write_struct(&png, &info);
	return file.bytes;
}

} // namespace

TEST_CASE("[GltfTextures] images are read from files, data URIs and buffer views, each once") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_textured(folder);
	Json second = json["materials"][0];
	json["materials"].push_back(second);
	json["meshes"][0]["primitives"].push_back(json["meshes"][0]["primitives"][0]);
	json["meshes"][0]["primitives"][1]["material"] = 1;
	const auto scene = folder.load(json);
	const auto &surfaces = scene->find_nodes<MeshInstance3D>().at(0)->surfaces;
	const Texture &texture = surfaces.at(0).material->base_color_texture;
	REQUIRE(texture.image);
	CHECK(texture.image->size_px == glm::uvec2(2));
	CHECK(texture.image->texels == TEXELS);
	CHECK(texture.image == surfaces.at(1).material->base_color_texture.image);
	CHECK(texture.wrap_u == TextureWrap::REPEAT);
	CHECK(scene->side_files.size() == 2); // the buffer and the image

	const std::vector<uint8_t> png = encode_small_png();
	GltfTestBuffer buffer;
	buffer.bytes = load_file(folder.path / "data.bin");
	buffer.views = json["bufferViews"];
	buffer.accessors = json["accessors"];
	const size_t view = buffer.add_view(png);
	buffer.store(json, folder);
	json["images"][0] = { { "bufferView", view }, { "mimeType", "image/png" },
		{ "name", "inside" } };
	CHECK(load_base_color(folder, json).image->texels == TEXELS);
	CHECK(load_base_color(folder, json).image->name == "inside");
	json["images"][0] = { { "uri",
			"data:image/"
			"x-any;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+"
			"M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==" } };
	REQUIRE(load_base_color(folder, json).image);
	CHECK(load_base_color(folder, json).image->size_px == glm::uvec2(1));
	CHECK(log.errors.empty());
}

TEST_CASE("[GltfTextures] all PNG colour types are expanded to RGBA8 without colour conversion") {
	std::string warning;
	const auto decode = [&](const std::vector<uint8_t> &p_bytes) {
		return decode_image(p_bytes, "image", warning)->texels;
	};
	using Bytes = std::vector<uint8_t>;
	CHECK(decode(encode_png_of_type(PNG_COLOR_TYPE_GRAY, 8, { 9, 200 })) ==
			Bytes{ 9, 9, 9, 255, 200, 200, 200, 255 });
	CHECK(decode(encode_png_of_type(PNG_COLOR_TYPE_GRAY, 1, { 0x40 })) ==
			Bytes{ 0, 0, 0, 255, 255, 255, 255, 255 });
	CHECK(decode(encode_png_of_type(PNG_COLOR_TYPE_GRAY_ALPHA, 8, { 9, 3, 200, 4 })) ==
			Bytes{ 9, 9, 9, 3, 200, 200, 200, 4 });
	CHECK(decode(encode_png_of_type(PNG_COLOR_TYPE_PALETTE, 8, { 0, 1 })) ==
			Bytes{ 1, 2, 3, 7, 4, 5, 6, 255 });
	CHECK(decode(encode_png_of_type(
				  PNG_COLOR_TYPE_RGB, 16, { 1, 99, 2, 99, 3, 99, 4, 0, 5, 0, 6, 0 })) ==
			Bytes{ 1, 2, 3, 255, 4, 5, 6, 255 });
	CHECK(warning.empty());
}

TEST_CASE("[GltfTextures] JPEG images are read, and damaged ones in part") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_textured(folder);
	std::vector<uint8_t> rgb;
	for (int index = 0; index < 64 * 64; ++index) {
		rgb.insert(rgb.end(), { uint8_t(index % 64 * 4), 100, uint8_t(index / 64 * 4) });
	}
	const std::vector<uint8_t> jpeg = encode_jpeg(rgb, 64);
	REQUIRE(jpeg.size() > 500);		  // so that its first half, below, is more than a header
	folder.write("wood a.png", jpeg); // the bytes decide, not the name
	const Texture texture = load_base_color(folder, json);
	REQUIRE(texture.image);
	int max_difference = 0;
	for (size_t index = 0; index < 64 * 64; ++index) {
		for (size_t channel = 0; channel < 3; ++channel) {
			max_difference = std::max(max_difference,
					std::abs(
							texture.image->texels[index * 4 + channel] - rgb[index * 3 + channel]));
		}
		CHECK(texture.image->texels[index * 4 + 3] == 255);
	}
	CHECK(max_difference <= 8);
	CHECK(log.errors.empty());
	folder.write("wood a.png", std::span(jpeg).first(jpeg.size() / 2));
	CHECK(load_base_color(folder, json).image);
	CHECK(GltfTestLog::contains(
			log.errors, "images[0] is a damaged JPEG image, of which a part is shown"));
	CHECK(get_decode_error(encode_jpeg(std::vector<uint8_t>(16 * 16 * 4, 0), 16, TJPF_CMYK))
					.find("CMYK") != std::string::npos);
}

TEST_CASE("[GltfTextures] images that cannot be read are reported; the scene loads without them") {
	GltfTestFolder folder;
	const Json json = make_textured(folder);
	std::vector<uint8_t> huge = encode_small_png();
	huge[16] = 0x7f; // its width, whose checksum is wrong now too
	std::vector<uint8_t> cut = encode_small_png();
	cut.resize(50); // in the image data, which begins at 41
	const std::vector<std::pair<std::vector<uint8_t>, std::string>> bad = {
		{ huge, "cannot be read" }, { cut, "PNG image that cannot be read: it ends too early" },
		{ {}, "is empty, must be PNG or JPEG. Export" },
		{ { 'P', 'N', 'G' }, "is no image, must be PNG or JPEG. Export" },
		{ to_bytes("GIF89a"), "is a GIF image, must be PNG or JPEG. Convert" },
		{ to_bytes("RIFF1234WEBPVP8X"), "is a WebP image, must be PNG or JPEG. Convert" },
		{ to_bytes("RIFF1234WAVE"), "is no image, must be" },
		{ to_bytes("\xabKTX 20\xbb"), "is a KTX image" }, { to_bytes("DDS |"), "is a DDS image" },
		{ to_bytes("1234ftypavif"), "is an AVIF image" },
		{ { 0xff, 0xd8, 0xff, 0xe0, 0 }, "JPEG image that cannot be read" }
	};
	for (const auto &[bytes, expected_text] : bad) {
		CAPTURE(expected_text);
		GltfTestLog log;
		folder.write("wood a.png", bytes);
		CHECK_FALSE(load_base_color(folder, json).image);
		REQUIRE(log.errors.size() == 1);
		CHECK(GltfTestLog::contains(log.errors, "scene.gltf\": images[0] is "));
		CHECK(GltfTestLog::contains(log.errors, expected_text));
	}
	const std::vector<std::pair<Json, std::string>> bad_images = {
		{ { { "uri", "missing.png" } }, "images[0].uri cannot be read" },
		{ { { "uri", "../secret.png" } }, "leads out of the project folder" },
		{ { { "uri", 3 } }, "images[0].uri is 3" },
		{ { { "uri", "data:image/png,abc" } }, "no base64" },
		{ { { "bufferView", 99 } }, "images[0].bufferView is 99" },
		{ Json::object(),
				"images[0] has neither uri nor bufferView, must have one of them. Export" }
	};
	for (const auto &[image, expected_text] : bad_images) {
		CAPTURE(expected_text);
		GltfTestLog log;
		Json changed = json;
		changed["images"][0] = image;
		CHECK_FALSE(load_base_color(folder, changed).image);
		CHECK(GltfTestLog::contains(log.errors, expected_text));
	}
}

TEST_CASE("[GltfTextures] an image that is too large is rejected because of its header") {
	// The header has a valid checksum, but the only row is that of a 1 x 1 image: if rows were
	// decoded, the error would be another.
	std::vector<uint8_t> png = encode_png({ 1, 1 }, /*p_channel_count=*/4, std::vector<uint8_t>(4));
	const size_t header = 8; // the chunk IHDR, behind the file's signature
	const std::vector<std::pair<uint32_t, uint32_t>> sizes = { { 16384, 16384 }, { 20000, 20000 },
		{ 20000, 2 }, { 1, 0x7fffffff } };
	for (const auto &[width_px, height_px] : sizes) {
		write_big_endian(width_px, &png[header + 8]);
		write_big_endian(height_px, &png[header + 12]);
		write_png_checksum(png, header);
		CHECK(get_decode_error(png) ==
				text("has ", width_px, " x ", height_px,
						" pixels, must have 1..16384 on each side and at most 67108864 in all. "
						"Make it smaller."));
	}
}

TEST_CASE("[GltfTextures] only the first frame of an animated PNG image is read, with an error") {
	GltfTestFolder folder;
	GltfTestLog log;
	const Json json = make_textured(folder);
	std::vector<uint8_t> png = encode_small_png();
	std::vector<uint8_t> chunk(20); // length, type, 8 bytes of data, checksum
	write_big_endian(8, chunk.data());
	std::memcpy(&chunk[4], "acTL", 4);
	write_big_endian(2, &chunk[8]); // frames
	write_png_checksum(chunk, 0);
	const size_t header_end = 33; // signature and IHDR
	png.insert(png.begin() + header_end, chunk.begin(), chunk.end());
	folder.write("wood a.png", png);
	const Texture texture = load_base_color(folder, json);
	REQUIRE(texture.image);
	CHECK(texture.image->texels == TEXELS);
	CHECK(log.errors.size() == 1);
	CHECK(GltfTestLog::contains(
			log.errors, "images[0] is an animated PNG image, of which the first frame is shown."));
}

TEST_CASE("[GltfTextures] an invalid index is reported once, with the default that is used") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_textured(folder);
	json["samplers"] = Json::parse("[{}]");
	json["textures"] = Json::parse(R"([{"source": 0, "sampler": 9}, {"source": 5}, {}])");
	json["materials"][0]["emissiveTexture"] = { { "index", 1 } };
	json["materials"][0]["occlusionTexture"] = { { "index", 2 } };
	CHECK(load_base_color(folder, json).image);
	CHECK(log.errors.size() == 3);
	for (const char *expected_text :
			{ "textures[0].sampler is 9, must be 0..0; repetition with interpolation is used.",
					"textures[1].source is 5, must be 0..0; no image is used.",
					"textures[2].source is missing, must name a PNG or JPEG image" }) {
		CAPTURE(expected_text);
		CHECK(GltfTestLog::contains(log.errors, expected_text));
	}
	// A texture without sampler, in a document without samplers, is valid.
	log.errors.clear();
	json.erase("samplers");
	json["textures"] = Json::parse(R"([{"source": 0}])");
	json["materials"][0].erase("emissiveTexture");
	json["materials"][0].erase("occlusionTexture");
	const Texture texture = load_base_color(folder, json);
	CHECK(texture.wrap_u == TextureWrap::REPEAT);
	CHECK(texture.mip_filter == MipFilter::LINEAR);
	CHECK(log.errors.empty());
	json["textures"][0]["sampler"] = 0;
	CHECK(load_base_color(folder, json).image);
	CHECK(GltfTestLog::contains(log.errors,
			"textures[0].sampler is 0, must be absent, as there is nothing to refer to"));
}

TEST_CASE("[GltfTextures] samplers, UV sets and transforms are read; invalid ones are reported") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_textured(folder);
	// CLAMP_TO_EDGE, MIRRORED_REPEAT, NEAREST, NEAREST_MIPMAP_NEAREST
	json["samplers"] = Json::parse(
			R"([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9984}])");
	json["textures"][0]["sampler"] = 0;
	Json &info = json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
	info["texCoord"] = 1;
	info["extensions"]["KHR_texture_transform"] = { { "offset", { 0, 1 } },
		{ "rotation", 1.5707963267948966 }, { "scale", { 0.5, 0.5 } } };
	const auto scene = folder.load(json);
	const Texture &texture = get_surface(*scene).material->base_color_texture;
	CHECK(texture.wrap_u == TextureWrap::CLAMP);
	CHECK(texture.wrap_v == TextureWrap::MIRROR);
	CHECK(texture.is_magnified_nearest);
	CHECK(texture.is_minified_nearest);
	CHECK(texture.mip_filter == MipFilter::NEAREST);
	CHECK(texture.uv_set == 1);
	// The example of the extension's specification: the lower left quarter, rotated clockwise.
	CHECK(glm::distance(texture.transform_uv({ 0, 0 }), glm::vec2(0, 1)) < 1e-6f);
	CHECK(glm::distance(texture.transform_uv({ 1, 0 }), glm::vec2(0, 0.5f)) < 1e-6f);
	CHECK(glm::distance(texture.transform_uv({ 0, 1 }), glm::vec2(0.5f, 1)) < 1e-6f);
	const MeshAttributes &attributes = get_surface(*scene).mesh->attributes;
	CHECK(attributes.uvs[0].empty()); // no texture uses them
	REQUIRE(attributes.uvs[1].size() == 3);
	CHECK(attributes.uvs[1][1].x == 1.0f);
	CHECK(attributes.uvs[1][2].y == doctest::Approx(0.5).epsilon(1e-4));
	CHECK(attributes.colors[0] == glm::vec4(1, 0, 0.2f, 1));
	CHECK(attributes.tangents.empty()); // no normal map
	CHECK(log.errors.empty());

	info["extensions"]["KHR_texture_transform"] =
			Json::parse(R"({"offset": [1e300, 0], "scale": [1], "rotation": "x", "texCoord": -1})");
	const auto refused = folder.load(json);
	const Texture &plain = get_surface(*refused).material->base_color_texture;
	CHECK(plain.transform == glm::mat3x2(1, 0, 0, 1, 0, 0));
	CHECK(plain.uv_set == 1); // the texture's own texCoord
	for (const char *expected_text :
			{ "KHR_texture_transform.offset is an array of 2", "scale is an array of 1",
					"rotation is \"x\"", "KHR_texture_transform.texCoord is -1" }) {
		CAPTURE(expected_text);
		CHECK(GltfTestLog::contains(log.errors, expected_text));
	}
	info["texCoord"] = 2;
	info["index"] = 0.0; // valid: a whole number written as a float
	info.erase("extensions");
	json["samplers"][0]["wrapS"] = 7;
	json["samplers"][0]["magFilter"] = "x";
	json["textures"].push_back({ { "source", 5 }, { "sampler", 9 } });
	json["materials"][0]["normalTexture"] = { { "index", 1 } };
	json["materials"][0]["emissiveTexture"] = { { "index", 44 } };
	json["materials"][0]["occlusionTexture"] = "x";
	json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
	const auto other = folder.load(json);
	CHECK(get_surface(*other).material->base_color_texture.uv_set == 0);
	CHECK(get_surface(*other).mesh->attributes.uvs[0] ==
			std::vector<glm::vec2>(3, glm::vec2(0.0f)));
	for (const char *expected_text :
			{ "baseColorTexture.texCoord is 2, must be one of 0, 1", "samplers[0].wrapS is 7",
					"samplers[0].magFilter is \"x\"", "textures[1].source is 5, must be 0..0",
					"textures[1].sampler is 9", "emissiveTexture.index is 44",
					"occlusionTexture is \"x\"", "has no TEXCOORD_0" }) {
		CAPTURE(expected_text);
		CHECK(GltfTestLog::contains(log.errors, expected_text));
	}
	// Saving preserves the invalid values.
	save_gltf(*other, folder.path / "again.gltf");
	CHECK(folder.read_json("again.gltf") == json);
}

TEST_CASE("[GltfTextures] alpha, cutoff and tangents are read") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_textured(folder);
	Json &material = json["materials"][0];
	material["alphaMode"] = "MASK";
	material["alphaCutoff"] = 0.25;
	material["pbrMetallicRoughness"]["baseColorFactor"] = { 1, 1, 1, 0.5 };
	material["normalTexture"] = { { "index", 0 }, { "scale", 2 } };
	const auto scene = folder.load(json);
	CHECK(get_surface(*scene).material->alpha_mode == AlphaMode::MASK);
	CHECK(get_surface(*scene).material->alpha_cutoff == 0.25f);
	CHECK(get_surface(*scene).material->alpha == 0.5f);
	CHECK(get_surface(*scene).material->normal_scale == 2.0f);
	CHECK(get_surface(*scene).mesh->attributes.tangents.at(2).w == -1.0f);
	CHECK(log.warnings.empty());
	material["alphaMode"] = "BLEND";
	const auto blended = folder.load(json);
	CHECK(get_surface(*blended).material->alpha_cutoff == 0.5f);
	CHECK(GltfTestLog::contains(log.warnings, "materials[0] has alphaMode BLEND"));
	CHECK_FALSE(GltfTestLog::contains(log.warnings, "nothing of it is drawn"));
	material["pbrMetallicRoughness"]["baseColorFactor"] = { 1, 1, 1, 0.25 };
	folder.load(json);
	CHECK(GltfTestLog::contains(log.warnings,
			"materials[0] has an alpha of 0.25, less than 0.5: nothing of it is drawn"));
	material["alphaMode"] = "GLASS";
	material["pbrMetallicRoughness"]["baseColorFactor"] = { 1, 1, 1, 7 };
	const auto refused = folder.load(json);
	CHECK(get_surface(*refused).material->alpha_mode == AlphaMode::OPAQUE);
	CHECK(get_surface(*refused).material->alpha == 1.0f);
	CHECK(GltfTestLog::contains(log.errors, "alphaMode is \"GLASS\", must be \"OPAQUE\""));
	CHECK(GltfTestLog::contains(
			log.errors, "baseColorFactor is an array of 4, must be four numbers"));
}

TEST_CASE("[GltfTextures] backslashes in a URI are path separators and stay inside the project") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_textured(folder);
	std::filesystem::create_directory(folder.path / "skins");
	folder.write("skins/wood.png", encode_small_png());
	for (const char *uri : { ".\\wood a.png", "skins\\wood.png", "skins%5Cwood.png" }) {
		CAPTURE(uri);
		json["images"][0]["uri"] = uri;
		CHECK(load_base_color(folder, json).image);
	}
	CHECK(log.errors.empty());
	if (std::filesystem::path::preferred_separator == '/') { // elsewhere no name has a backslash
		folder.write("with\\backslash.png", encode_small_png());
		json["images"][0]["uri"] = "with\\backslash.png";
		CHECK(load_base_color(folder, json).image);
	}
	for (const char *uri : { "..\\..\\wood.png", "\\wood.png", "skins\\absent.png" }) {
		CAPTURE(uri);
		log.errors.clear();
		json["images"][0]["uri"] = uri;
		CHECK_FALSE(load_base_color(folder, json).image);
		CHECK(log.errors.size() == 1);
	}
}

TEST_CASE("[GltfTextures] damaged images are decoded or rejected, without a crash") {
	std::vector<uint8_t> rgb(32 * 32 * 3, 77);
	for (size_t index = 0; index < rgb.size(); ++index) {
		rgb[index] = static_cast<uint8_t>(index * 7);
	}
	const std::vector<uint8_t> files[] = { encode_png({ 32, 32 }, /*p_channel_count=*/3, rgb),
		encode_jpeg(rgb, 32) };
	std::mt19937 random(20100901); // any fixed seed
	for (const std::vector<uint8_t> &file : files) {
		for (int round = 0; round < 500; ++round) {
			std::vector<uint8_t> bytes = file;
			for (int change = 0; change < 3; ++change) {
				bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
			}
			bytes.resize(round % 3 == 0 ? random() % bytes.size() : bytes.size());
			get_decode_error(bytes);
		}
	}
}

TEST_CASE("[glTF] nodes that share a mesh share its triangles, material, image and cut mesh") {
	const GltfTestFolder folder;
	Json json = make_textured(folder);
	json["materials"][0]["alphaMode"] = "MASK";
	json["nodes"] = Json::parse(R"([{"mesh": 0}, {"mesh": 0, "scale": [-1, 1, 1]},
			{"mesh": 0, "scale": [1, 3, 0.5], "translation": [4, 0, 0]},
			{"mesh": 0, "scale": [20, 20, 20], "rotation": [0, 0.6, 0, 0.8]}])");
	json["scenes"] = Json::parse(R"([{"nodes": [0, 1, 2, 3]}])");
	json["scene"] = 0;
	const auto scene = folder.load(json);
	const auto snapshot = build_snapshot(*scene, Camera3D());
	REQUIRE(snapshot->instances.size() == 4);
	const InstanceSnapshot &first = snapshot->instances[0];
	CHECK(first.caster_mesh != first.mesh);
	REQUIRE(first.caster_levels);
	for (const InstanceSnapshot &instance : snapshot->instances) {
		CHECK(instance.mesh == first.mesh);
		CHECK(instance.material == first.material);
		CHECK(instance.material->base_color_texture.image ==
				first.material->base_color_texture.image);
		CHECK(instance.caster_mesh == first.caster_mesh);
		CHECK(instance.caster_levels == first.caster_levels);
		CHECK(instance.caster_levels->get_mesh(0) == first.caster_levels->get_mesh(0));
	}
}
