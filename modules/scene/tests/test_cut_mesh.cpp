// build: optimised
#include "modules/core/tests/sanitized.h"
#include "modules/scene/alpha_outline.h"
#include "modules/scene/cut_mesh.h"

#include "tests/test_random.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <map>
#include <random>
#include <utility>

using namespace gnomon;

namespace {

std::shared_ptr<const Image> make_wave_image(glm::uvec2 p_size_px, double p_frequency) {
	std::vector<uint8_t> texels;
	for (uint32_t y = 0; y < p_size_px.y; ++y) {
		for (uint32_t x = 0; x < p_size_px.x; ++x) {
			const double alpha = 0.5 +
					0.5 * std::sin(p_frequency * x + 0.3) * std::cos(p_frequency * 0.8 * y + 1.1);
			texels.insert(texels.end(), { 0, 0, 0, uint8_t(std::lround(alpha * 255)) });
		}
	}
	return make_image("waves", p_size_px, std::move(texels));
}

Material make_material(std::shared_ptr<const Image> p_image) {
	Material material;
	material.alpha_mode = AlphaMode::MASK;
	material.base_color_texture.image = std::move(p_image);
	return material;
}

/// A grid of p_count x p_count quads in the plane z = x / 2; texture coordinates grow by p_repeats
/// over it.
std::shared_ptr<const Mesh> make_grid(uint32_t p_count, double p_repeats, double p_offset = 0) {
	std::vector<glm::vec3> positions;
	MeshAttributes attributes;
	std::vector<uint32_t> indices;
	for (uint32_t y = 0; y <= p_count; ++y) {
		for (uint32_t x = 0; x <= p_count; ++x) {
			const glm::dvec2 position(double(x) / p_count, double(y) / p_count);
			positions.emplace_back(position.x, position.y, position.x / 2);
			attributes.uvs[0].emplace_back(position * p_repeats + p_offset);
		}
	}
	for (uint32_t y = 0; y < p_count; ++y) {
		for (uint32_t x = 0; x < p_count; ++x) {
			const uint32_t a = y * (p_count + 1) + x;
			const uint32_t b = a + p_count + 1;
			indices.insert(indices.end(), { a, a + 1, b + 1, a, b + 1, b });
		}
	}
	return make_mesh("grid", positions, {}, indices, attributes);
}

/// Returns the area of a mesh in the plane of make_grid; of others, that of its projection onto it.
double compute_mesh_area(const Mesh &p_mesh) {
	double area = 0;
	for (size_t i = 0; i < p_mesh.indices.size(); i += 3) {
		const glm::dvec3 a = p_mesh.positions_node[p_mesh.indices[i]];
		const glm::dvec3 b = p_mesh.positions_node[p_mesh.indices[i + 1]];
		const glm::dvec3 c = p_mesh.positions_node[p_mesh.indices[i + 2]];
		// The sign is that of the triangle's winding.
		area += glm::dot(glm::cross(b - a, c - a), glm::normalize(glm::dvec3(-0.5, 0, 1))) / 2;
	}
	return area;
}

/// Returns the fraction of a surface's area where the alpha test passes, estimated by sampling.
double sample_coverage(const Material &p_material, double p_repeats, double p_offset) {
	const AlphaTest test = make_alpha_test(p_material);
	int inside = 0;
	const int COUNT = 700;
	for (int y = 0; y < COUNT; ++y) {
		for (int x = 0; x < COUNT; ++x) {
			const glm::dvec2 uv = p_material.base_color_texture.transform_uv(
					glm::vec2(glm::dvec2(x + 0.5, y + 0.5) / double(COUNT) * p_repeats + p_offset));
			inside += sample_alpha(test, uv) >= test.cutoff ? 1 : 0;
		}
	}
	return double(inside) / (COUNT * COUNT);
}

/// Counts the edges without a face on the other side, by the positions of their ends: an edge's two
/// directions cancel.
uint32_t count_open_edges(const Mesh &p_mesh) {
	const auto less = [](const std::array<float, 6> &p_a, const std::array<float, 6> &p_b) {
		return p_a < p_b;
	};
	std::map<std::array<float, 6>, int, decltype(less)> sums(less);
	for (size_t i = 0; i < p_mesh.indices.size(); i += 3) {
		for (size_t k = 0; k < 3; ++k) {
			const glm::vec3 a = p_mesh.positions_node[p_mesh.indices[i + k]];
			const glm::vec3 b = p_mesh.positions_node[p_mesh.indices[i + (k + 1) % 3]];
			++sums[{ a.x, a.y, a.z, b.x, b.y, b.z }];
			--sums[{ b.x, b.y, b.z, a.x, a.y, a.z }];
		}
	}
	uint32_t count = 0;
	for (const auto &[ends, sum] : sums) {
		count += sum > 0 ? static_cast<uint32_t>(sum) : 0;
	}
	return count;
}

} // namespace

TEST_CASE("[CutMesh] a cut mesh has the area where the alpha test passes, for each wrap mode") {
	Material material = make_material(make_wave_image({ 24, 32 }, 0.7));
	const double whole_area = compute_mesh_area(*make_grid(1, 1));
	for (const TextureWrap wrap :
			{ TextureWrap::REPEAT, TextureWrap::MIRROR, TextureWrap::CLAMP }) {
		for (const bool is_nearest : { false, true }) {
			for (const double repeats : { 1.0, 2.6, -1.7 }) {
				for (const uint32_t count : { 1u, 7u }) {
					CAPTURE(int(wrap));
					CAPTURE(is_nearest);
					CAPTURE(repeats);
					CAPTURE(count);
					Texture &texture = material.base_color_texture;
					texture.wrap_u = texture.wrap_v = wrap;
					texture.is_magnified_nearest = is_nearest;
					texture.transform = glm::mat3x2(0.8f, 0.3f, -0.2f, 1.1f, 0.1f, 0.4f);
					const double offset = -0.35;
					const auto grid = make_grid(count, repeats, offset);
					const CutMesh cut = cut_mesh(grid, material);
					REQUIRE(cut.mesh);
					CHECK(cut.block_size_px == 0);
					CHECK(compute_mesh_area(*cut.mesh) / whole_area ==
							doctest::Approx(sample_coverage(material, repeats, offset))
									.epsilon(0.01));
					CHECK(cut.mesh->source.mesh.lock() == grid);
				}
			}
		}
	}
}

TEST_CASE("[CutMesh] adjacent triangles make the same points: only holes have open edges") {
	// A finer grid has the same holes, and its inner edges must not be open.
	const Material material = make_material(make_wave_image({ 24, 24 }, 0.6));
	const uint32_t coarse = count_open_edges(*cut_mesh(make_grid(1, 1), material).mesh);
	for (const uint32_t count : { 2u, 5u, 16u }) {
		CAPTURE(count);
		const CutMesh cut = cut_mesh(make_grid(count, 1), material);
		const uint32_t fine = count_open_edges(*cut.mesh);
		// The grid's lines, about 3 * count, may split the edges of holes, each line at most twice
		// per texel that it crosses, of 24.
		CHECK(fine >= coarse);
		CHECK(fine <= coarse + 6 * count * 24);
		CHECK(compute_mesh_area(*cut.mesh) ==
				doctest::Approx(compute_mesh_area(*cut_mesh(make_grid(1, 1), material).mesh))
						.epsilon(1e-5));
	}
}

TEST_CASE("[CutMesh] the diagonal of a flat quad does not divide the outline") {
	// A card with one hole, in several positions; p_lift moves one corner off the plane.
	std::vector<uint8_t> texels;
	for (int y = 0; y < 32; ++y) {
		for (int x = 0; x < 32; ++x) {
			const double distance = glm::distance(glm::dvec2(x, y), glm::dvec2(15.5));
			const double alpha = std::clamp(0.5 + 0.2 * (distance - 9), 0.0, 1.0);
			texels.insert(texels.end(), { 0, 0, 0, uint8_t(std::lround(255 * alpha)) });
		}
	}
	const Material material = make_material(make_image("hole", { 32, 32 }, std::move(texels)));
	const auto count_edges = [&](const glm::dmat4 &p_transform, double p_lift, float p_last_u) {
		MeshAttributes attributes;
		attributes.uvs[0] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { p_last_u, 1 } };
		std::vector<glm::vec3> positions;
		for (const glm::dvec3 &corner : { glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0),
					 glm::dvec3(1, 1, 0), glm::dvec3(0, 1, p_lift) }) {
			positions.emplace_back(p_transform * glm::dvec4(corner, 1.0));
		}
		const auto quad =
				make_mesh("quad", positions, {}, { 0, 1, 2, 0, 2, 3 }, std::move(attributes));
		const CutMesh cut = cut_mesh(quad, material);
		REQUIRE(cut.mesh);
		CHECK(cut.mesh->bounds_node.get_diagonal() ==
				doctest::Approx(quad->bounds_node.get_diagonal()));
		return count_open_edges(*cut.mesh);
	};
	const uint32_t flat = count_edges(glm::dmat4(1.0), 0, 0);
	CHECK(flat > 12); // four sides of the quad, and the hole
	// The hole crosses the diagonal twice.
	CHECK(count_edges(glm::dmat4(1.0), 0.01, 0) == flat + 2);
	CHECK(count_edges(glm::dmat4(1.0), 0, 0.02f) > flat); // other texture coordinates beyond it
	TestRandom random;
	for (int index = 0; index < 20; ++index) {
		const glm::dmat4 transform = glm::translate(glm::dmat4(1.0), 5.0 * random.next_unit()) *
				glm::rotate(glm::dmat4(1.0), random.next(0, 6), random.next_unit());
		CHECK(count_edges(transform, 0, 0) == flat); // its corners are rounded to float
	}
}

TEST_CASE("[CutMesh] an uncut mesh is the source itself, and one without any area is null") {
	const auto grid = make_grid(3, 1);
	Material material;
	CHECK(get_cut_mesh(grid, std::make_shared<const Material>(material)).mesh == grid);
	CHECK(get_cut_mesh(grid, nullptr).mesh == grid);
	material.alpha_mode = AlphaMode::BLEND;
	CHECK(cut_mesh(grid, material).mesh == grid);
	material.alpha = 0.4f; // below 0.5, the cutoff of blended surfaces
	CHECK(cut_mesh(grid, material).mesh == nullptr);
	material.alpha_mode = AlphaMode::MASK;
	material.alpha_cutoff = 0.4f;
	CHECK(cut_mesh(grid, material).mesh == grid);
	material.base_color_texture.image = make_wave_image({ 8, 8 }, 0.7);
	material.alpha = 1;
	material.alpha_cutoff = 0;
	CHECK(cut_mesh(grid, material).mesh == grid);
	material.alpha_cutoff = 1.1f;
	CHECK(cut_mesh(grid, material).mesh == nullptr);
	material.transmission = 0.5f; // a mesh that transmits light is not cut
	CHECK(get_cut_mesh(grid, std::make_shared<const Material>(material)).mesh == grid);
}

TEST_CASE("[CutMesh] a mesh without coordinates shows one texel; extreme ones are safe") {
	Material material = make_material(make_wave_image({ 8, 8 }, 0.7));
	const auto plain =
			make_mesh("plain", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, {}, { 0, 1, 2 });
	const AlphaTest test = make_alpha_test(material);
	const OutlineBudget small = { .edges_per_tile = 1 << 10, .edges_per_mesh = 1 << 14 };
	// With sanitizers, millions of edges take more than a minute.
	const OutlineBudget budget = IS_SANITIZED ? small : OutlineBudget();
	CHECK((cut_mesh(plain, material).mesh == plain) ==
			(sample_alpha(test, glm::dvec2(0)) >= test.cutoff));
	for (const float extreme : { NAN, INFINITY, 1e30f, -1e30f, 1e-38f }) {
		CAPTURE(extreme);
		const float alpha = sample_alpha(test, glm::dvec2(extreme, 0.5));
		CHECK(alpha >= 0.0f);
		CHECK(alpha <= 1.0f);
		MeshAttributes attributes;
		attributes.uvs[0] = { { 0, 0 }, { extreme, 0 }, { 0, extreme } };
		cut_mesh(make_mesh("odd", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, {}, { 0, 1, 2 },
						 attributes),
				material, budget);
	}
	// Coordinates that are long and thin, or far away; v is repeated or clamped.
	for (const glm::vec2 &far_uv :
			{ glm::vec2(1e20f, 1e-20f), glm::vec2(1e7f, 1e7f), glm::vec2(3e38f, 1) }) {
		for (const TextureWrap wrap : { TextureWrap::REPEAT, TextureWrap::CLAMP }) {
			CAPTURE(far_uv.x);
			material.base_color_texture.wrap_v = wrap;
			MeshAttributes attributes;
			attributes.uvs[0] = { { 0, 0 }, { far_uv.x, 0.1f }, { 0.1f, far_uv.y } };
			cut_mesh(make_mesh("odd", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, {}, { 0, 1, 2 },
							 attributes),
					material, budget);
		}
	}
	material.base_color_texture.wrap_v = TextureWrap::REPEAT;
	// More tiles than the mesh may have edges: each square represents many tiles.
	const CutMesh many = cut_mesh(make_grid(1, 400), material, small);
	REQUIRE(many.mesh);
	CHECK(many.block_size_px > 8); // the image has 8 x 8 texels
	CHECK(many.mesh->get_triangle_count() < 12u * small.edges_per_mesh);
}

TEST_CASE("[CutMesh] an outlier among the texture coordinates does not make many tiles") {
	const Material material = make_material(make_wave_image({ 24, 24 }, 0.9));
	for (const float far_u : { -1.02236e8f, 3e5f, -7e11f }) {
		CAPTURE(far_u);
		MeshAttributes attributes;
		attributes.uvs[0] = { { -1, 1 }, { 1.5f, 0 }, { far_u, 0 } };
		const auto mesh =
				make_mesh("card", { { -0.5f, -0.5f, 0 }, { 0.5f, -0.5f, 0 }, { 0.5f, 0.125f, 0 } },
						{}, { 0, 1, 2 }, attributes);
		const CutMesh cut = cut_mesh(mesh, material);
		CHECK(cut.block_size_px > 0);
		// Squares of many tiles: a few triangles each, in at most 2 to the power of 13 columns.
		CHECK((cut.mesh ? cut.mesh->get_triangle_count() : 0) < 4u << 13);
		CHECK((cut.mesh ? compute_mesh_area(*cut.mesh) : 0) <= 1.001 * compute_mesh_area(*mesh));
	}
}

TEST_CASE("[CutMesh] triangles that are thin in texture space stay within the mesh's budget") {
	const Material material = make_material(make_wave_image({ 24, 24 }, 0.9));
	const OutlineBudget small = { .edges_per_tile = 1 << 10, .edges_per_mesh = 1 << 14 };
	const auto cut_thin = [&](const std::vector<glm::vec2> &p_uvs) {
		MeshAttributes attributes;
		attributes.uvs[0] = p_uvs;
		const auto thin = make_mesh(
				"thin", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0.5f } }, {}, { 0, 1, 2 }, attributes);
		const auto cut = cut_mesh(thin, material, small).mesh;
		return std::pair(cut ? cut->get_triangle_count() : 0, cut ? compute_mesh_area(*cut) : 0.0);
	};
	const double whole_area = compute_mesh_area(*make_grid(1, 1)) / 2;
	for (const std::vector<glm::vec2> &uvs : {
				 std::vector<glm::vec2>{ { 0, 0 }, { 100, 100 }, { 100, 100.001f } },
				 std::vector<glm::vec2>{ { 0, 0 }, { 4000, 4000 }, { 4000, 4000.001f } },
				 std::vector<glm::vec2>{ { 0, 0 }, { 2e5f, 0 }, { 2e5f, 0.001f } },
				 std::vector<glm::vec2>{ { 0, 0 }, { 1e35f, 0 }, { 0, 1e27f } },
				 // So thin that rounding decides the winding.
				 std::vector<glm::vec2>{ { 0, 1e-44f }, { 40, -6e15f }, { 0, 7e-36f } },
				 std::vector<glm::vec2>{ { 1e-44f, 0 }, { 1e-38f, 1e-43f }, { 0, 1e20f } },
		 }) {
		CAPTURE(uvs[1].x);
		CAPTURE(uvs[1].y);
		const auto [triangle_count, area] = cut_thin(uvs);
		CHECK(triangle_count <= 12 * small.edges_per_mesh);
		CHECK(area <= whole_area * 1.0001);
	}
}

TEST_CASE("[CutMesh] nearly equal vertex alphas give the same cut") {
	const Material material = make_material(make_wave_image({ 24, 24 }, 0.6));
	const auto cut_with = [&](float p_alpha) {
		const auto grid = make_grid(1, 1);
		MeshAttributes attributes = grid->attributes;
		attributes.colors.assign(4, glm::vec4(1, 1, 1, p_alpha));
		return cut_mesh(
				make_mesh("grid", grid->positions_node, {}, grid->indices, attributes), material)
				.mesh;
	};
	CHECK(cut_with(0.9f)->positions_node == cut_with(0.901f)->positions_node);
	CHECK(cut_with(1.0f)->positions_node ==
			cut_mesh(make_grid(1, 1), material).mesh->positions_node);
	CHECK(compute_mesh_area(*cut_with(0.6f)) < compute_mesh_area(*cut_with(0.9f)));
	// Alpha below the cutoff leaves nothing, however close to it.
	CHECK(cut_with(0.499f) == nullptr);
	CHECK(cut_with(NAN) == nullptr);
	CHECK(cut_with(-1.0f) == nullptr);
}

TEST_CASE("[CutMesh] materials with the same alpha test use one cut mesh, others not") {
	const auto grid = make_grid(2, 1);
	Material material = make_material(make_wave_image({ 16, 16 }, 0.5));
	const auto one = std::make_shared<const Material>(material);
	material.roughness = 0.3f;
	const auto other = std::make_shared<const Material>(material);
	material.alpha_cutoff = 0.6f;
	const auto changed = std::make_shared<const Material>(material);
	const CutMesh first = get_cut_mesh(grid, one);
	CHECK(get_cut_mesh(grid, other).mesh == first.mesh);
	CHECK(get_cut_mesh(grid, changed).mesh != first.mesh);
	CHECK(get_cut_mesh(grid, changed).content_hash != first.content_hash);
	CHECK(first.content_hash != 0);
}

TEST_CASE("[CutMesh] unused cut meshes are freed") {
	drop_unused_cut_meshes();
	const size_t before = get_cut_mesh_count();
	auto grid = make_grid(2, 1);
	auto material =
			std::make_shared<const Material>(make_material(make_wave_image({ 16, 16 }, 0.5)));
	std::weak_ptr<const Mesh> cut = get_cut_mesh(grid, material).mesh;
	drop_unused_cut_meshes();
	CHECK(get_cut_mesh_count() == before + 1);
	CHECK(!cut.expired());
	SUBCASE("the mesh is gone") {
		grid.reset();
	}
	SUBCASE("the material is gone") {
		material.reset();
	}
	SUBCASE("the material is gone, and its mesh in use") {
		const auto in_use = cut.lock();
		material.reset();
		drop_unused_cut_meshes();
		CHECK(get_cut_mesh_count() == before + 1);
	}
	drop_unused_cut_meshes();
	CHECK(get_cut_mesh_count() == before);
	CHECK(cut.expired());
}

TEST_CASE("[CutMesh] random masks at random texture coordinates keep their area") {
	std::minstd_rand random(11);
	std::uniform_real_distribution<double> uniform(0, 1);
	for (int i = 0; i < limit_rounds(60); ++i) {
		CAPTURE(i);
		std::vector<uint8_t> texels;
		const glm::uvec2 size_px(1 + random() % 12, 1 + random() % 12);
		for (uint32_t texel = 0; texel < size_px.x * size_px.y; ++texel) {
			texels.insert(texels.end(), { 0, 0, 0, uint8_t(random() % 4 * 85) });
		}
		Material material = make_material(make_image("noise", size_px, texels));
		material.base_color_texture.is_magnified_nearest = i % 3 == 0;
		material.base_color_texture.wrap_u = i % 2 ? TextureWrap::REPEAT : TextureWrap::MIRROR;
		// Coordinates on the borders and corners of texels are the hardest.
		const double repeats = i % 5 == 0 ? 1.0 : i % 5 == 1 ? 2.0 : 3 * uniform(random);
		const double offset = i % 4 == 0 ? 0.0 : i % 4 == 1 ? 0.5 : uniform(random);
		const CutMesh cut = cut_mesh(make_grid(1 + i % 4, repeats, offset), material);
		const double coverage =
				cut.mesh ? compute_mesh_area(*cut.mesh) / compute_mesh_area(*make_grid(1, 1)) : 0.0;
		// Of the whole area. Lines approximate hyperbolas, which matters if alpha changes from
		// texel to texel.
		const double tolerance = material.base_color_texture.is_magnified_nearest ? 0.02 : 0.08;
		CHECK(std::abs(coverage - sample_coverage(material, repeats, offset)) < tolerance);
	}
}
