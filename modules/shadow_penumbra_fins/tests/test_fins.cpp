#include "modules/mesh_tools/tests/silhouette_edges.h"
#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/shadow_penumbra_fins/tests/fins_fixture.h"

#include <doctest/doctest.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <numbers>
#include <set>

using namespace gnomon;

namespace {

std::shared_ptr<const Mesh> share_mesh(const char *p_name, const Mesh &p_mesh) {
	return make_mesh(p_name, p_mesh.positions_node, {}, p_mesh.indices);
}

std::vector<std::pair<const char *, Mesh>> make_meshes() {
	using namespace test_meshes;
	return { { "cube with split corners", unweld(make_cube()) }, { "sphere", make_sphere(3) },
		{ "torus", make_torus(60, 40) }, { "quad", make_quad() },
		{ "moebius band", make_moebius(30) },
		{ "two cubes with a common edge", join(make_cube(), make_cube(glm::vec3(2, 2, 0))) },
		{ "soup", make_soup(3, 14, 40) } };
}

/// Makes a solid of revolution about y, closed by a disc at both ends. p_profile: radius and height
/// of each ring in metres.
Mesh make_lathed(const std::vector<glm::vec2> &p_profile) {
	constexpr uint32_t SIDE_COUNT = 48;
	const uint32_t ring_count = static_cast<uint32_t>(p_profile.size());
	Mesh mesh;
	for (const glm::vec2 &point : p_profile) {
		for (uint32_t side = 0; side < SIDE_COUNT; ++side) {
			const double angle_rad = 2 * std::numbers::pi * side / SIDE_COUNT;
			mesh.positions_node.emplace_back(
					point.x * std::cos(angle_rad), point.y, point.x * -std::sin(angle_rad));
		}
	}
	const uint32_t top = static_cast<uint32_t>(mesh.positions_node.size());
	mesh.positions_node.emplace_back(0, p_profile.front().y, 0);
	mesh.positions_node.emplace_back(0, p_profile.back().y, 0);
	for (uint32_t side = 0; side < SIDE_COUNT; ++side) {
		const uint32_t next = (side + 1) % SIDE_COUNT;
		mesh.indices.insert(mesh.indices.end(), { top, side, next });
		for (uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
			const uint32_t a = ring * SIDE_COUNT;
			const uint32_t b = a + SIDE_COUNT;
			mesh.indices.insert(mesh.indices.end(),
					{ a + side, b + side, b + next, a + side, b + next, a + next });
		}
		const uint32_t last = (ring_count - 1) * SIDE_COUNT;
		mesh.indices.insert(mesh.indices.end(), { top + 1, last + next, last + side });
	}
	return mesh;
}

/// Makes a scene of p_mesh alone, with a spot light above it.
SmallScene make_fin_scene(const std::shared_ptr<const Mesh> &p_mesh) {
	SmallScene scene;
	scene.ground->surfaces.clear();
	scene.box->surfaces.clear();
	add_mesh(scene.scene, "Mesh", p_mesh, { 0.1, 0.2, -0.1 });
	scene.light->parent_from_node = look_at({ 1, 7, 2 }, { 0, 0, 0 });
	return scene;
}

FinsSettings make_settings(float p_outer_m, float p_inner_m, FinMethod p_method) {
	FinsSettings settings;
	settings.outer_width_m = p_outer_m;
	settings.inner_width_m = p_inner_m;
	settings.beta_m = 1.0f;
	settings.layer_count = 3;
	settings.method = p_method;
	return settings;
}

} // namespace

TEST_CASE("[GPU][PenumbraFins] compute finds the CPU's silhouette edges, in order, on meshes of "
		  "every class") {
	FinsFixture fixture;
	// Each mesh by itself, and all of them in one frame with common buffers.
	for (size_t only = 0; only <= make_meshes().size(); ++only) {
		SmallScene scene = make_fin_scene(share_mesh("first", test_meshes::make_sphere(4)));
		size_t index = 0;
		for (const auto &[name, mesh] : make_meshes()) {
			if (index++ == only || only == make_meshes().size()) {
				add_mesh(
						scene.scene, name, share_mesh(name, mesh), { 0.3 * double(index), 0, 0.2 });
			}
		}
		const FinsFixture::Frame frame = fixture.make_frame(scene, 32);
		SilhouetteCasters casters;
		std::vector<uint8_t> list_bytes;
		std::vector<uint8_t> draw_bytes;
		fixture.run(frame, [&](RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs) {
			casters = build_silhouette_casters(p_inputs, collect_casters(p_inputs, { 0 }),
					/*p_vertices_per_edge=*/12);
			const SilhouetteLists lists = add_silhouette_passes(r_graph, *fixture.device, casters);
			FinsFixture::read_back(
					r_graph, lists.list, casters.edge_count * sizeof(uint32_t), list_bytes);
			FinsFixture::read_back(r_graph, lists.draws,
					casters.casters.size() * sizeof(shader::SilhouetteDraw), draw_bytes);
		});
		const auto list = FinsFixture::cast<uint32_t>(list_bytes);
		const auto draws = FinsFixture::cast<shader::SilhouetteDraw>(draw_bytes);
		REQUIRE(draws.size() == frame.scene->instances.size());
		for (size_t caster = 0; caster < draws.size(); ++caster) {
			const SilhouetteCaster &item = casters.casters[caster];
			const MeshTopology &topology = *item.gpu->topology;
			const auto silhouette = find_silhouette_edges(topology, item.light_position_node);
			std::vector<uint32_t> expected; // indices in the GPU's order
			const std::vector<uint32_t> order = order_edges_by_face(topology);
			for (uint32_t order_index = 0; order_index < order.size(); ++order_index) {
				if (std::binary_search(silhouette.begin(), silhouette.end(), order[order_index])) {
					expected.push_back(order_index);
				}
			}
			CHECK(expected.size() == silhouette.size());
			CAPTURE(frame.scene->instances[item.instance_index].mesh->name);
			CHECK(draws[caster].vertex_count == 12 * expected.size());
			CHECK(draws[caster].instance_count == 1);
			REQUIRE(item.first_in_list + expected.size() <= list.size());
			CHECK(std::equal(expected.begin(), expected.end(), list.begin() + item.first_in_list));
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] geometry shader and compute draw the same penumbra maps, bit for "
		  "bit") {
	FinsFixture fixture;
	for (const auto &[name, mesh] : make_meshes()) {
		CAPTURE(name);
		const SmallScene scene = make_fin_scene(share_mesh(name, mesh));
		const FinsFixture::Frame frame = fixture.make_frame(scene, 128, /*p_margin_m=*/0.2f);
		for (const glm::vec2 widths : { glm::vec2(0.2f, 0.1f), glm::vec2(0.2f, 0.0f),
					 glm::vec2(0.0f, 0.2f), glm::vec2(5.0f, 5.0f) }) {
			CAPTURE(widths.x);
			CAPTURE(widths.y);
			const auto by_geometry = fixture.draw_fins(
					frame, make_settings(widths.x, widths.y, FinMethod::GEOMETRY_SHADER));
			const auto by_compute =
					fixture.draw_fins(frame, make_settings(widths.x, widths.y, FinMethod::COMPUTE));
			CHECK(by_geometry.color == by_compute.color);
			CHECK(by_geometry.depth == by_compute.depth);
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] a cube with split corners has one ring of fins without a gap") {
	// Fins along split normals would leave the corners open (the reason for welded normals).
	FinsFixture fixture;
	SmallScene scene =
			make_fin_scene(share_mesh("cube", test_meshes::unweld(test_meshes::make_cube())));
	scene.light->parent_from_node = look_at({ 0.3, 9, 0.2 }, { 0.1, 0, -0.1 });
	scene.light->outer_cone_rad = 0.35f;
	const FinsFixture::Frame frame = fixture.make_frame(scene, 256, /*p_margin_m=*/0.3f);
	const auto maps = fixture.draw_fins(frame, make_settings(0.3f, 0.0f, FinMethod::COMPUTE));
	// A flood fill over texels without a fin, from the cube's centre, must not reach the map's
	// border.
	const int width = static_cast<int>(frame.views[0].size_px.x);
	const auto is_fin = [&](const glm::ivec2 &p_texel) {
		return maps.depth[size_t(p_texel.y) * size_t(width) + size_t(p_texel.x)] > 0;
	};
	const glm::dvec3 centre_view =
			glm::dvec3(frame.views[0].view_from_world * glm::dvec4(0.1, 0.2, -0.1, 1));
	const glm::dvec2 centre_map =
			glm::dvec2(centre_view) / centre_view.z / glm::dvec2(frame.views[0].half_extent);
	std::vector<glm::ivec2> pending = { glm::ivec2((centre_map * 0.5 + 0.5) * double(width)) };
	std::set<std::pair<int, int>> reached;
	bool has_left = false;
	REQUIRE_FALSE(is_fin(pending[0]));
	while (!pending.empty() && !has_left) {
		const glm::ivec2 texel = pending.back();
		pending.pop_back();
		if (!reached.insert({ texel.x, texel.y }).second) {
			continue;
		}
		for (const glm::ivec2 step :
				{ glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1) }) {
			const glm::ivec2 next = texel + step;
			has_left =
					has_left || glm::min(next.x, next.y) < 0 || glm::max(next.x, next.y) >= width;
			if (!has_left && !is_fin(next)) {
				pending.push_back(next);
			}
		}
	}
	CHECK_FALSE(has_left);
	CHECK(reached.size() > 1000); // not only texels around the start
}

TEST_CASE("[GPU][PenumbraFins] fins of edges that are hidden from the light are dropped") {
	FinsFixture fixture;
	// A small cube right below a large one is hidden from the light.
	SmallScene alone = make_fin_scene(share_mesh("large", test_meshes::make_cube()));
	SmallScene both = make_fin_scene(share_mesh("large", test_meshes::make_cube()));
	add_mesh(both.scene, "Hidden", make_box_mesh("hidden", glm::vec3(0.3f)), { -0.2, -2.0, -0.5 });
	const FinsFixture::Frame frame = fixture.make_frame(alone, 128, /*p_margin_m=*/0.1f);
	const FinsFixture::Frame frame_of_both = fixture.make_frame(both, 128, /*p_margin_m=*/0.1f);
	const FinsSettings settings = make_settings(0.1f, 0.1f, FinMethod::COMPUTE);
	CHECK(fixture.draw_fins(frame_of_both, settings).color ==
			fixture.draw_fins(frame, settings).color);
}

TEST_CASE("[GPU][PenumbraFins] beta drops the inner fins deep in a solid that hides their edge") {
	// Figure 4 (b) of Sun et al. 2010. The silhouette where a mushroom's stem meets its cap is
	// hidden by the cap. Its inner fin is inside the solid and in front of the second layer, so
	// only beta removes it.
	FinsFixture fixture;
	const auto draw = [&](const std::vector<glm::vec2> &p_profile, float p_beta_m) {
		SmallScene scene = make_fin_scene(share_mesh("lathed", make_lathed(p_profile)));
		scene.light->parent_from_node = look_at({ 0.1, 8, -0.1 }, { 0.1, 0, -0.101 });
		FinsSettings settings = make_settings(0.1f, 0.1f, FinMethod::COMPUTE);
		settings.beta_m = p_beta_m;
		return fixture.draw_fins(fixture.make_frame(scene, 256, 0.1f), settings);
	};
	const std::vector<glm::vec2> mushroom = { { 1.0f, 1.0f }, { 1.0f, 0.8f }, { 0.2f, 0.8f },
		{ 0.5f, -1.0f } };
	const std::vector<glm::vec2> cap = { { 1.0f, 1.0f }, { 1.0f, 0.8f } };
	// 0.12 m keeps the inner fins at the cap's rim (t = 0.1 m), but not the stem's 0.2 m below it.
	CHECK(draw(mushroom, 0.12f).color == draw(cap, 0.12f).color);
	CHECK(draw(mushroom, 100.0f).color != draw(cap, 100.0f).color);
}

TEST_CASE("[GPU][PenumbraFins] mirrored and inside-out casters have the outer fins of the plain "
		  "one") {
	FinsFixture fixture;
	const Mesh torus = test_meshes::make_torus(40, 30);
	Mesh flipped = torus;
	for (size_t i = 0; i < flipped.indices.size(); i += 3) {
		std::swap(flipped.indices[i], flipped.indices[i + 1]);
	}
	const auto draw = [&](const Mesh &p_mesh, bool p_mirrors) {
		SmallScene scene = make_fin_scene(share_mesh("torus", p_mesh));
		if (p_mirrors) { // the torus is its own mirror image
			scene.scene.root->children.back()->parent_from_node = glm::dmat4(glm::dvec4(1, 0, 0, 0),
					glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0.1, 0.2, -0.1, 1));
		}
		return fixture.draw_fins(fixture.make_frame(scene, 128, /*p_margin_m=*/0.2f),
				make_settings(0.2f, 0.2f, FinMethod::COMPUTE));
	};
	const auto compute_equal_fraction = [](const FinsFixture::PenumbraMaps &p_left,
												const FinsFixture::PenumbraMaps &p_right) {
		size_t equal_count = 0;
		for (size_t texel = 0; texel < p_left.depth.size(); ++texel) {
			// Penumbra depths. Those of inner fins are smaller than this tolerance.
			equal_count += std::abs(p_left.depth[texel] - p_right.depth[texel]) < 0.01f;
		}
		return double(equal_count) / double(p_left.depth.size());
	};
	const auto plain = draw(torus, /*p_mirrors=*/false);
	// Different triangle diagonals and rounding change single texels at the rims.
	CHECK(compute_equal_fraction(plain, draw(flipped, /*p_mirrors=*/false)) > 0.99);
	CHECK(compute_equal_fraction(plain, draw(torus, /*p_mirrors=*/true)) > 0.99);
	CHECK(compute_equal_fraction(plain, draw(flipped, /*p_mirrors=*/true)) > 0.99);
}

TEST_CASE("[GPU][PenumbraFins] vertices whose normals cancel are counted and nothing is NaN") {
	FinsFixture fixture;
	// A quad and its back side: every vertex normal is zero.
	Mesh double_sided = test_meshes::make_quad();
	double_sided.indices.insert(double_sided.indices.end(), { 2, 1, 0, 3, 2, 0 });
	const SmallScene scene = make_fin_scene(share_mesh("double-sided", double_sided));
	const FinsFixture::Frame frame = fixture.make_frame(scene, 64, /*p_margin_m=*/0.2f);
	fixture.run(frame, [&](RenderGraph &, const ShadowTechnique::Inputs &p_inputs) {
		CHECK(count_zero_normals(build_silhouette_casters(p_inputs,
					  collect_casters(p_inputs, { 0 }), /*p_vertices_per_edge=*/12)) == 4);
	});
	const auto maps = fixture.draw_fins(frame, make_settings(0.2f, 0.2f, FinMethod::COMPUTE));
	for (uint16_t half : FinsFixture::cast<uint16_t>(maps.color)) {
		CHECK(std::isfinite(glm::unpackHalf1x16(half)));
	}
	for (float depth : maps.depth) {
		CHECK((depth >= 0.0f && depth <= 1.0f));
	}
}

TEST_CASE("[GPU][PenumbraFins] devices without geometry shader, fragment stores, conditional "
		  "rendering or depth clamp draw the same maps") {
	FinsFixture full_fixture;
	const Mesh torus = test_meshes::make_torus(60, 40);
	const SmallScene scene = make_fin_scene(share_mesh("torus", torus));
	const FinsFixture::Frame frame = full_fixture.make_frame(scene, 128, /*p_margin_m=*/0.2f);
	const auto expected =
			full_fixture.draw_fins(frame, make_settings(0.2f, 0.1f, FinMethod::COMPUTE));
	const auto expected_layers = full_fixture.find_layers(frame, 3, Peeling::PASSES);
	const SmallScene quad_scene = make_fin_scene(share_mesh("quad", test_meshes::make_quad()));
	const auto expected_quad =
			full_fixture.find_layers(full_fixture.make_frame(quad_scene, 64), 3, Peeling::PASSES);
	const FeatureList features = { &DeviceFeatures::geometry_shader,
		&DeviceFeatures::fragment_stores, &DeviceFeatures::conditional_rendering,
		&DeviceFeatures::depth_clamp };
	for (size_t missing_feature = 0; missing_feature < features.size(); ++missing_feature) {
		CAPTURE(missing_feature);
		FinsFixture limited_fixture("", { features[missing_feature] });
		const auto maps =
				limited_fixture.draw_fins(frame, make_settings(0.2f, 0.1f, FinMethod::COMPUTE));
		CHECK(maps.color == expected.color);
		CHECK(maps.depth == expected.depth);
		CHECK(limited_fixture.find_layers(frame, 3, Peeling::PASSES) == expected_layers);
		CHECK(limited_fixture.find_layers(limited_fixture.make_frame(quad_scene, 64), 3,
					  Peeling::PASSES) == expected_quad);
		// A request for ONE_PASS is honoured only where the device supports it.
		FinsSettings one_pass_settings = make_settings(0.2f, 0.1f, FinMethod::COMPUTE);
		one_pass_settings.map_size_px = 128;
		one_pass_settings.peeling = Peeling::ONE_PASS;
		limited_fixture.run(frame, [&](RenderGraph &, const ShadowTechnique::Inputs &p_inputs) {
			CHECK((choose_peeling(one_pass_settings, p_inputs, 0) == Peeling::PASSES) ==
					(features[missing_feature] == &DeviceFeatures::fragment_stores));
		});
	}
}
