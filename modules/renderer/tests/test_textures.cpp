// Compares what each texture and material feature writes to the G-buffer with values that are
// computed here on the CPU.
#include "modules/render_graph/read_back.h"
#include "modules/renderer/gbuffer.h"
#include "modules/renderer/tests/render_fixture.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/normal_packing.h"

#include <doctest/doctest.h>
#include <glm/gtc/packing.hpp>

#include <cmath>
#include <fstream>

using namespace gnomon;

namespace {

const uint32_t SIZE_PX = 64;
// For the argument p_is_srgb of sample and make_mip_levels.
const bool SRGB = true;
const bool LINEAR = false;

double srgb_to_linear(double p_value) {
	return p_value <= 0.04045 ? p_value / 12.92 : std::pow((p_value + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double p_value) {
	return p_value <= 0.0031308 ? p_value * 12.92 : 1.055 * std::pow(p_value, 1 / 2.4) - 0.055;
}

/// An image of noise that is the same for the same size and seed. (The constants are those of the
/// PCG random number generators.)
std::shared_ptr<const Image> make_noise(glm::uvec2 p_size_px, uint32_t p_seed = 1) {
	std::vector<uint8_t> texels;
	uint32_t state = p_seed * 747796405u + 2891336453u;
	for (uint32_t index = 0; index < p_size_px.x * p_size_px.y * 4; ++index) {
		state = state * 747796405u + 2891336453u;
		texels.push_back(static_cast<uint8_t>(state >> 24));
	}
	return make_image("noise", p_size_px, std::move(texels));
}

int wrap(int p_texel, int p_count, TextureWrap p_wrap) {
	if (p_wrap == TextureWrap::CLAMP) {
		return std::clamp(p_texel, 0, p_count - 1);
	}
	const int period = p_wrap == TextureWrap::MIRROR ? 2 * p_count : p_count;
	const int index = ((p_texel % period) + period) % period;
	return index < p_count ? index : period - 1 - index;
}

/// Samples the first mip level as a GPU sampler does. Values are 0..1, sRGB colours are linearised.
glm::dvec4 sample(const Texture &p_texture, glm::dvec2 p_uv, bool p_is_srgb) {
	const Image &image = *p_texture.image;
	p_uv = glm::dmat3x2(p_texture.transform) * glm::dvec3(p_uv, 1.0);
	const glm::dvec2 position = p_uv * glm::dvec2(image.size_px);
	const auto fetch = [&](int p_x, int p_y) {
		const uint8_t *texel =
				image.get_texel(uint32_t(wrap(p_x, int(image.size_px.x), p_texture.wrap_u)),
						uint32_t(wrap(p_y, int(image.size_px.y), p_texture.wrap_v)));
		glm::dvec4 value;
		for (int channel = 0; channel < 4; ++channel) {
			value[channel] = texel[channel] / 255.0;
			if (p_is_srgb && channel < 3) {
				value[channel] = srgb_to_linear(value[channel]);
			}
		}
		return value;
	};
	if (p_texture.is_magnified_nearest) {
		return fetch(int(std::floor(position.x)), int(std::floor(position.y)));
	}
	const glm::dvec2 low = glm::floor(position - 0.5);
	const glm::dvec2 fraction = position - 0.5 - low;
	const int x = int(low.x);
	const int y = int(low.y);
	return glm::mix(glm::mix(fetch(x, y), fetch(x + 1, y), fraction.x),
			glm::mix(fetch(x, y + 1), fetch(x + 1, y + 1), fraction.x), fraction.y);
}

/// The G-buffer's textures as bytes, rows from the top.
struct Texels {
	std::vector<uint8_t> base_color, normal, material, emissive, depth;

	glm::dvec4 get_base_color(uint32_t p_pixel) const { // sRGB-encoded; alpha is linear
		glm::dvec4 color;
		for (int channel = 0; channel < 4; ++channel) {
			color[channel] = base_color[p_pixel * 4 + uint32_t(channel)] / 255.0;
		}
		return color;
	}
	glm::vec4 get_half(const std::vector<uint8_t> &p_texels, uint32_t p_pixel) const {
		uint64_t packed;
		std::memcpy(&packed, p_texels.data() + p_pixel * 8, sizeof(packed));
		return glm::unpackHalf4x16(packed);
	}
	glm::vec3 get_normal(uint32_t p_pixel) const {
		uint32_t packed;
		std::memcpy(&packed, normal.data() + p_pixel * 4, sizeof(packed));
		return unpack_normal(packed);
	}
	float get_depth(uint32_t p_pixel) const {
		float value;
		std::memcpy(&value, depth.data() + p_pixel * 4, sizeof(value));
		return value;
	}
};

/// A square that fills the image of a camera, with texture coordinates from `low` at the top left
/// to `high` at the bottom right.
struct Square {
	Material material;
	MeshAttributes attributes;
	glm::dvec2 low = glm::dvec2(0.0);
	glm::dvec2 high = glm::dvec2(1.0);
	glm::dmat4 world_from_node = glm::dmat4(1.0);

	Square() {
		material.base_color = glm::vec3(1.0f);
		material.roughness = 1.0f;
	}

	glm::dvec2 get_uv(uint32_t p_pixel) const {
		const glm::dvec2 fraction =
				(glm::dvec2(p_pixel % SIZE_PX, p_pixel / SIZE_PX) + 0.5) / double(SIZE_PX);
		return glm::mix(low, high, fraction);
	}

	Texels draw(RenderFixture &r_fixture) const {
		Scene scene;
		auto camera = std::make_unique<Camera3D>();
		camera->vertical_fov_rad = float(2 * std::atan(0.5)); // the square is 2 m high, 2 m away
		camera->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 2));
		MeshAttributes all = attributes;
		if (all.uvs[0].empty()) {
			all.uvs[0] = { { low.x, low.y }, { low.x, high.y }, { high.x, high.y },
				{ high.x, low.y } };
		}
		auto square = std::make_unique<MeshInstance3D>();
		square->name = "Square";
		square->parent_from_node = world_from_node;
		square->surfaces.push_back(
				{ make_mesh("square", { { -1, 1, 0 }, { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 } },
						  std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)), { 0, 1, 2, 0, 2, 3 }, all),
						std::make_shared<Material>(material) });
		scene.root->add_child(std::move(square));
		const Camera3D &added = static_cast<Camera3D &>(*scene.root->add_child(std::move(camera)));
		const auto snapshot = build_snapshot(scene, added);

		RenderingDevice &device = *r_fixture.device;
		MeshStore meshes(device);
		MaterialStore materials(device);
		TransientPool pool(device);
		RenderGraph graph(device, pool);
		const glm::uvec2 size_px(SIZE_PX);
		const RGBuffer frame =
				graph.upload_constants("frame", compute_frame_constants(*snapshot, size_px),
						BufferUsage::STORAGE | BufferUsage::UNIFORM);
		const VisibleReceiver visible[] = { { 0, snapshot->instances[0].bounds_world } };
		GBufferInstances instances;
		instances.update(*snapshot, visible, size_px);
		CHECK(instances.instances.size() == 1);
		const GBuffer gbuffer =
				add_gbuffer_pass(graph, device, meshes, materials, instances, frame);
		Texels texels;
		add_readback(graph, gbuffer.base_color, texels.base_color);
		add_readback(graph, gbuffer.shading_normal, texels.normal);
		add_readback(graph, gbuffer.material, texels.material);
		add_readback(graph, gbuffer.emissive, texels.emissive);
		add_readback(graph, gbuffer.depth, texels.depth);
		graph.execute(RenderGraph::Mode::WAIT);
		return texels;
	}
};

/// Returns the largest error of all pixels, in units of 1/255 of the sRGB-encoded value.
template <typename Expect>
double find_base_color_error(const Texels &p_texels, const Expect &p_expect) {
	double max_error = 0;
	for (uint32_t pixel = 0; pixel < SIZE_PX * SIZE_PX; ++pixel) {
		const glm::dvec4 expected = p_expect(pixel);
		const glm::dvec4 drawn = p_texels.get_base_color(pixel);
		for (int channel = 0; channel < 3; ++channel) {
			max_error = std::max(
					max_error, std::abs(drawn[channel] - linear_to_srgb(expected[channel])) * 255);
		}
	}
	return max_error;
}

/// Tolerances in units of 1/255. 0.5 is the rounding to bytes. Many devices interpolate texels with
/// 8-bit weights, so that linear filtering needs a larger one.
const double LINEAR_TOLERANCE = 1.51;
const double NEAREST_TOLERANCE = 0.51;

} // namespace

TEST_CASE("[GPU][Textures] a base colour is repeated, mirrored or clamped, interpolated or not") {
	RenderFixture fixture;
	Square square;
	square.low = { -0.7, -1.4 };
	square.high = { 1.9, 1.3 };
	Texture &texture = square.material.base_color_texture;
	texture.image = make_noise({ 4, 3 });
	for (const TextureWrap wrap_u :
			{ TextureWrap::REPEAT, TextureWrap::MIRROR, TextureWrap::CLAMP }) {
		for (const TextureWrap wrap_v : { TextureWrap::REPEAT, TextureWrap::CLAMP }) {
			for (const bool is_nearest : { false, true }) {
				CAPTURE(int(wrap_u));
				CAPTURE(int(wrap_v));
				CAPTURE(is_nearest);
				texture.wrap_u = wrap_u;
				texture.wrap_v = wrap_v;
				texture.is_magnified_nearest = is_nearest;
				CHECK(find_base_color_error(square.draw(fixture), [&](uint32_t p_pixel) {
					return sample(texture, square.get_uv(p_pixel), SRGB);
				}) <= (is_nearest ? NEAREST_TOLERANCE : LINEAR_TOLERANCE));
			}
		}
	}
}

TEST_CASE("[GPU][Textures] the base colour's texture is multiplied by factor and vertex colours") {
	RenderFixture fixture;
	Square square;
	square.material.base_color = glm::vec3(0.5f, 0.25f, 1.0f);
	square.material.base_color_texture.image = make_noise({ 4, 4 });
	square.attributes.colors = { { 1, 1, 1, 1 }, { 0, 1, 0.5f, 1 }, { 0, 1, 0.5f, 1 },
		{ 1, 1, 1, 1 } };
	const auto expect = [&](uint32_t p_pixel) {
		const double down = (p_pixel / SIZE_PX + 0.5) / SIZE_PX;
		glm::dvec3 color = glm::mix(glm::dvec3(1.0), glm::dvec3(0, 1, 0.5), down) *
				glm::dvec3(square.material.base_color);
		if (square.material.base_color_texture.image) {
			color *= glm::dvec3(
					sample(square.material.base_color_texture, square.get_uv(p_pixel), SRGB));
		}
		return glm::dvec4(color, 1.0);
	};
	CHECK(find_base_color_error(square.draw(fixture), expect) <= LINEAR_TOLERANCE);
	square.material.base_color_texture.image.reset(); // vertex colours alone
	CHECK(find_base_color_error(square.draw(fixture), expect) <= 1);
}

TEST_CASE("[GPU][Textures] texture coordinates are scaled, rotated and moved, and the second set "
		  "is used if requested") {
	RenderFixture fixture;
	Square square;
	Texture &texture = square.material.base_color_texture;
	texture.image = make_noise({ 5, 4 });
	texture.is_magnified_nearest = true;
	const double rotation_rad = 0.6;
	texture.transform =
			glm::mat3x2(glm::dvec2(std::cos(rotation_rad), -std::sin(rotation_rad)) * 1.5,
					glm::dvec2(std::sin(rotation_rad), std::cos(rotation_rad)) * 0.7,
					glm::dvec2(0.3, -0.2));
	uint32_t wrong_count = 0; // at texel borders, where rounding decides
	const Texels texels = square.draw(fixture);
	for (uint32_t pixel = 0; pixel < SIZE_PX * SIZE_PX; ++pixel) {
		const glm::dvec4 expected = sample(texture, square.get_uv(pixel), SRGB);
		wrong_count +=
				std::abs(texels.get_base_color(pixel).x - linear_to_srgb(expected.x)) > 1 / 255.0;
	}
	CHECK(wrong_count <= 4);

	texture.transform = glm::mat3x2(1, 0, 0, 1, 0, 0);
	texture.uv_set = 1;
	square.attributes.uvs[0].assign(4, glm::vec2(0.0f));
	square.attributes.uvs[1] = { { 0, 0 }, { 0, 1 }, { 1, 1 }, { 1, 0 } };
	CHECK(find_base_color_error(square.draw(fixture), [&](uint32_t p_pixel) {
		return sample(texture, square.get_uv(p_pixel), SRGB);
	}) <= NEAREST_TOLERANCE);
}

TEST_CASE("[GPU][Textures] roughness is green, metal blue, occlusion red, emission a colour") {
	RenderFixture fixture;
	Square square;
	Material &material = square.material;
	material.metallic = 0.75f;
	material.roughness = 0.5f;
	material.emissive = glm::vec3(4, 2, 1);
	material.occlusion_strength = 0.5f;
	material.metallic_roughness_texture.image = make_noise({ 4, 4 }, 1);
	material.occlusion_texture.image = make_noise({ 4, 4 }, 2);
	material.emissive_texture.image = make_noise({ 4, 4 }, 3);
	for (Texture *texture : { &material.metallic_roughness_texture, &material.occlusion_texture,
				 &material.emissive_texture }) {
		texture->is_magnified_nearest = true;
	}
	for (const ShadingModel model : { ShadingModel::METALLIC_ROUGHNESS, ShadingModel::PHONG }) {
		material.shading_model = model;
		const Texels texels = square.draw(fixture);
		double max_error = 0;
		for (uint32_t pixel = 0; pixel < SIZE_PX * SIZE_PX; ++pixel) {
			const glm::dvec2 uv = square.get_uv(pixel);
			const glm::dvec4 surface = sample(material.metallic_roughness_texture, uv, LINEAR);
			const glm::dvec4 drawn = texels.get_half(texels.material, pixel);
			// Phong's model is stored as -1 - roughness.
			const double roughness = model == ShadingModel::PHONG ? -1 - drawn.z : drawn.z;
			max_error = std::max({ max_error, std::abs(roughness - 0.5 * surface.y),
					std::abs(drawn.w - 0.75 * surface.z) });
			const double occlusion =
					1 + 0.5 * (sample(material.occlusion_texture, uv, LINEAR).x - 1);
			max_error = std::max(max_error, std::abs(texels.get_base_color(pixel).w - occlusion));
			const glm::dvec4 emissive = sample(material.emissive_texture, uv, SRGB);
			const glm::dvec4 emitted = texels.get_half(texels.emissive, pixel);
			for (int channel = 0; channel < 3; ++channel) {
				max_error = std::max(max_error,
						std::abs(
								emitted[channel] / material.emissive[channel] - emissive[channel]));
			}
		}
		CHECK(max_error <= 1 / 255.0);
	}
}

TEST_CASE("[GPU][Textures] a normal map perturbs normals, with the mesh's tangents or generated "
		  "ones") {
	RenderFixture fixture;
	Square square;
	square.material.normal_texture.image = make_noise({ 4, 4 });
	square.material.normal_texture.is_magnified_nearest = true;
	square.material.normal_scale = 0.5f;
	square.material.is_double_sided = true;
	// Returns the largest distance of a drawn normal from the expected one.
	const auto find_error = [&](const glm::dvec3 &p_tangent, double p_bitangent_sign) {
		const Texels texels = square.draw(fixture);
		const glm::dvec3 bitangent = glm::cross(glm::dvec3(0, 0, 1), p_tangent) * p_bitangent_sign;
		double max_error = 0;
		for (uint32_t pixel = 0; pixel < SIZE_PX * SIZE_PX; ++pixel) {
			glm::dvec2 uv = square.get_uv(pixel);
			if (square.world_from_node[0].x < 0) { // mirrored: u grows to the left
				uv.x = 1 - uv.x;
			}
			const glm::dvec3 map =
					glm::dvec3(sample(square.material.normal_texture, uv, LINEAR)) * 2.0 - 1.0;
			const glm::dvec3 expected = glm::normalize(p_tangent * (map.x * 0.5) +
					bitangent * (map.y * 0.5) + glm::dvec3(0, 0, map.z));
			max_error = std::max(
					max_error, glm::distance(expected, glm::dvec3(texels.get_normal(pixel))));
		}
		return max_error;
	};
	const double NORMAL_TOLERANCE = 2e-4; // packing alone: up to 7e-5, see normal_inc.glsl
	// x along u; y against v, which grows downwards
	CHECK(find_error({ 1, 0, 0 }, 1) <= NORMAL_TOLERANCE);
	square.attributes.tangents.assign(4, glm::vec4(0, 1, 0, -1));
	CHECK(find_error({ 0, 1, 0 }, -1) <= NORMAL_TOLERANCE);
	square.attributes.tangents.clear();
	square.world_from_node[0].x = -1; // mirrored: x is still along u, which grows to the left
	CHECK(find_error({ -1, 0, 0 }, -1) <= NORMAL_TOLERANCE);
}

TEST_CASE("[GPU][Textures] pixels below the alpha cutoff are not drawn, opaque materials ignore "
		  "alpha") {
	RenderFixture fixture;
	Square square;
	square.material.base_color_texture.image = make_noise({ 8, 8 });
	square.material.alpha = 0.8f;
	square.material.alpha_cutoff = 0.4f;
	for (const AlphaMode mode : { AlphaMode::OPAQUE, AlphaMode::MASK, AlphaMode::BLEND }) {
		square.material.alpha_mode = mode;
		const Texels texels = square.draw(fixture);
		uint32_t wrong_count = 0;
		uint32_t seen_count = 0;
		for (uint32_t pixel = 0; pixel < SIZE_PX * SIZE_PX; ++pixel) {
			const double alpha =
					0.8 * sample(square.material.base_color_texture, square.get_uv(pixel), SRGB).w;
			const bool is_expected = mode == AlphaMode::OPAQUE || alpha >= 0.4;
			const bool is_seen = texels.get_depth(pixel) > 0;
			seen_count += is_seen;
			wrong_count += is_seen != is_expected && std::abs(alpha - 0.4) > 1 / 255.0;
		}
		CHECK(wrong_count == 0);
		CHECK((seen_count == SIZE_PX * SIZE_PX) == (mode == AlphaMode::OPAQUE));
	}
}

TEST_CASE("[Textures] each mip level has the mean light of the texels that it covers") {
	// Black and white: the mean light is 0.5, which is 188 in sRGB and 128 in linear encoding.
	std::vector<uint8_t> texels;
	for (uint32_t index = 0; index < 64; ++index) {
		const uint8_t value = (index + index / 8) % 2 == 0 ? 0 : 255;
		texels.insert(texels.end(), { value, value, value, 255 });
	}
	const auto board = make_image("board", { 8, 8 }, texels);
	uint32_t level_count = 0;
	std::vector<uint8_t> levels = make_mip_levels(*board, SRGB, level_count);
	CHECK(level_count == 4);
	REQUIRE(levels.size() == (64 + 16 + 4 + 1) * 4);
	CHECK(std::equal(texels.begin(), texels.end(), levels.begin()));
	for (size_t index = 64 * 4; index < levels.size(); ++index) {
		CHECK(std::abs(levels[index] - (index % 4 == 3 ? 255 : 188)) <= 1);
	}
	levels = make_mip_levels(*board, LINEAR, level_count);
	CHECK(levels.back() == 255); // alpha
	CHECK(std::abs(levels[64 * 4] - 128) <= 1);
	// Odd sizes: nothing is skipped, nothing counts twice.
	const auto odd = make_noise({ 7, 5 });
	levels = make_mip_levels(*odd, LINEAR, level_count);
	CHECK(level_count == 3);
	double mean = 0;
	for (uint32_t index = 0; index < 35; ++index) {
		mean += odd->texels[index * 4] / 35.0;
	}
	CHECK(std::abs(levels[levels.size() - 4] - mean) <= 2);
	// Colours of transparent texels do not bleed into opaque ones.
	const auto leaf = make_image("leaf", { 2, 1 }, { 0, 255, 0, 255, 255, 0, 0, 0 });
	levels = make_mip_levels(*leaf, SRGB, level_count);
	CHECK(levels[8] == 0);
	CHECK(levels[9] == 255);
	CHECK(levels[11] == 128);
}

TEST_CASE("[GPU][Textures] a minified texture shows its mean, or, without mip levels, texels of "
		  "its first level") {
	RenderFixture fixture;
	Square square;
	square.high = { 256, 256 }; // 4 repetitions per pixel along each axis
	Texture &texture = square.material.base_color_texture;
	texture.image = make_image("stripes", { 2, 1 }, { 0, 0, 0, 255, 255, 255, 255, 255 });
	CHECK(find_base_color_error(square.draw(fixture), [](uint32_t) { return glm::dvec4(0.5); }) <=
			1);
	texture.mip_filter = MipFilter::NONE;
	texture.is_minified_nearest = true;
	const Texels texels = square.draw(fixture);
	for (uint32_t pixel = 0; pixel < SIZE_PX * SIZE_PX; pixel += 37) {
		const double value = texels.get_base_color(pixel).x;
		CHECK((value == 0 || value == 1));
	}
}

TEST_CASE("[GPU][Textures] a missing texture is white") {
	RenderFixture fixture;
	Square square;
	Material &material = square.material;
	material.base_color = glm::vec3(0.7f, 0.2f, 0.9f);
	material.emissive = glm::vec3(0.3f, 5.0f, 0.01f);
	material.roughness = 0.37f;
	material.metallic = 0.83f;
	material.occlusion_strength = 0.6f;
	Texture *const textures[] = { &material.base_color_texture,
		&material.metallic_roughness_texture, &material.occlusion_texture,
		&material.emissive_texture };
	const auto white = make_image("white", { 2, 2 }, std::vector<uint8_t>(16, 255));
	const auto noise = make_noise({ 4, 4 });
	for (Texture *only : textures) {
		for (Texture *texture : textures) {
			texture->image = texture == only ? noise : nullptr;
		}
		const Texels missing = square.draw(fixture);
		for (Texture *texture : textures) {
			texture->image = texture == only ? noise : white;
		}
		const Texels all = square.draw(fixture);
		CAPTURE(only - &material.base_color_texture);
		CHECK(missing.base_color == all.base_color);
		CHECK(missing.material == all.material);
		CHECK(missing.emissive == all.emissive);
		CHECK(missing.normal == all.normal);
	}
}

TEST_CASE("[GPU][Textures] textures of images that no longer exist are freed") {
	RenderFixture fixture;
	MaterialStore store(*fixture.device);
	auto image = make_noise({ 16, 16 });
	Material source_material;
	source_material.base_color_texture.image = image;
	source_material.emissive_texture.image = image; // one texture for both
	source_material.occlusion_texture.image = image;
	auto first = std::make_shared<const Material>(source_material);
	auto second = std::make_shared<const Material>(source_material);
	store.get(first);
	const uint64_t with_one = fixture.device->get_memory_use().used_bytes;
	store.get(second);
	CHECK(store.get_texture_count() == 2); // one as sRGB, one as linear values
	// The second material adds its constants only.
	CHECK(fixture.device->get_memory_use().used_bytes - with_one < 1024);
	first.reset();
	second.reset();
	source_material = Material();
	store.collect_garbage();
	CHECK(store.get_texture_count() == 2); // the image is still referenced
	image.reset();
	store.collect_garbage();
	CHECK(store.get_texture_count() == 0);
}

namespace {

/// Returns the host memory that this process occupies, driver included; 0 where the system has no
/// /proc.
uint64_t measure_host_bytes() {
	std::ifstream file("/proc/self/status");
	for (std::string line; std::getline(file, line);) {
		if (line.starts_with("VmRSS:")) {
			return std::stoull(line.substr(6)) << 10; // KiB
		}
	}
	return 0;
}

} // namespace

TEST_CASE(
		"[GPU][Textures] drawing copies of textured meshes needs no more host memory each frame") {
	RenderFixture fixture;
	SmallScene scene;
	auto plain = std::make_shared<Material>();
	plain->base_color_texture.image = make_noise({ 16, 16 });
	auto cut_out = std::make_shared<Material>(*plain);
	cut_out->alpha_mode = AlphaMode::MASK;
	auto bumpy = std::make_shared<Material>(*plain);
	bumpy->normal_texture.image = make_noise({ 16, 16 }, 2);
	const std::shared_ptr<const Material> materials[] = { plain, cut_out, bumpy };
	const auto box = make_box_mesh("box", glm::vec3(0.05f));
	MeshAttributes attributes;
	attributes.uvs[0].resize(box->positions_node.size());
	for (size_t vertex = 0; vertex < attributes.uvs[0].size(); ++vertex) {
		attributes.uvs[0][vertex] = glm::vec2(vertex % 2, vertex / 2 % 2);
	}
	const auto textured =
			make_mesh("textured", box->positions_node, box->normals_node, box->indices, attributes);
	const int COPY_COUNT = 48;
	for (int copy = 0; copy < COPY_COUNT; ++copy) {
		MeshInstance3D &node = add_mesh(
				scene.scene, "Copy", textured, { 0.2 * (copy % 8) - 0.7, 0.2 * (copy / 8), 0.3 });
		// Copies of one material would be one draw.
		node.surfaces[0].material = std::make_shared<const Material>(*materials[copy % 3]);
	}
	const auto render_frames = [&](int p_count) {
		for (int frame = 0; frame < p_count; ++frame) {
			REQUIRE(fixture.render_image(scene).commands.draws > COPY_COUNT);
		}
		fixture.device->wait_idle();
		return measure_host_bytes();
	};
	const uint64_t before = render_frames(8);
	if (before == 0) {
		MESSAGE("Not tested: this system has no /proc/self/status.");
		return;
	}
	const uint64_t after = render_frames(16);
	CHECK(after < before + (uint64_t(16) << 20)); // a leak of 20 kB for each draw would be seen
}

TEST_CASE("[GPU][Textures] copies of a mesh with one material are one draw, and look the same") {
	RenderFixture fixture;
	const auto box = make_box_mesh("box", glm::vec3(0.08f));
	MeshAttributes attributes;
	attributes.uvs[0].resize(box->positions_node.size());
	for (size_t vertex = 0; vertex < attributes.uvs[0].size(); ++vertex) {
		attributes.uvs[0][vertex] = glm::vec2(vertex % 2, vertex / 2 % 2);
	}
	const auto mesh =
			make_mesh("mesh", box->positions_node, box->normals_node, box->indices, attributes);
	const int COPY_COUNT = 24;
	for (const bool has_texture : { false, true }) {
		CAPTURE(has_texture);
		auto material = std::make_shared<Material>();
		material->base_color = glm::vec3(0.8f, 0.5f, 0.2f);
		if (has_texture) {
			material->base_color_texture.image = make_noise({ 16, 16 });
		}
		std::vector<uint8_t> pixels[2];
		uint64_t draws[2] = {};
		for (const bool is_shared : { false, true }) {
			SmallScene scene;
			for (int copy = 0; copy < COPY_COUNT; ++copy) {
				MeshInstance3D &node = add_mesh(scene.scene, "Copy", mesh,
						{ 0.3 * (copy % 8) - 1.0, 0.3 * (copy / 8), 0.5 });
				// Mirrored and stretched copies have draws of their own, or the same one.
				const glm::dvec3 size(copy % 3 == 0 ? -1.0 : 1.0, 1.0 + 0.03 * copy, 1.0);
				node.parent_from_node = glm::scale(node.parent_from_node, size);
				// A copy of the mesh has a draw of its own.
				node.surfaces[0] = { is_shared
							? mesh
							: make_mesh("mesh", mesh->positions_node, mesh->normals_node,
									  mesh->indices, attributes),
					material };
			}
			const RenderResult result = fixture.render_image(scene);
			pixels[is_shared] = result.image;
			draws[is_shared] = result.commands.draws;
		}
		CHECK(pixels[0] == pixels[1]);
		CHECK(draws[0] - draws[1] == COPY_COUNT - 2);
	}
}
