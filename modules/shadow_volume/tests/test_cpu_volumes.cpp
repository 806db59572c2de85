#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/shadow_volume/cpu_volumes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>

using namespace gnomon;

namespace {

/// Returns named meshes of every class.
std::map<std::string, Mesh> make_meshes() {
	Mesh flipped = test_meshes::make_cube(); // one face winds the other way
	std::swap(flipped.indices[0], flipped.indices[1]);
	Mesh fan = test_meshes::make( // three faces at one edge
			{ { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0.2f }, { -1, 0, 0.4f }, { 0.1f, 0, -1 } },
			{ 0, 1, 2, 0, 1, 3, 1, 0, 4 });
	return { { "cube", test_meshes::make_cube() }, { "sphere", test_meshes::make_sphere(3) },
		{ "torus", test_meshes::make_torus(12, 8) }, { "quad", test_meshes::make_quad() },
		{ "moebius", test_meshes::make_moebius(9) }, { "soup", test_meshes::make_soup(3, 30, 60) },
		{ "flipped face", flipped }, { "fan", fan },
		{ "cube and quad", test_meshes::join(test_meshes::make_cube(), test_meshes::make_quad()) },
		{ "cube and Moebius strip",
				test_meshes::join(test_meshes::make_moebius(9), test_meshes::make_cube()) } };
}

using Corner = std::array<float, 4>;

/// For a directional light, all corners at infinity are the same point.
Corner make_key(const glm::vec4 &p_corner, bool p_is_directional) {
	return p_is_directional && p_corner.w == 0
			? Corner{ 0, 0, 0, 0 }
			: Corner{ p_corner.x, p_corner.y, p_corner.z, p_corner.w };
}

/// Counts edges that triangles do not traverse equally often in both directions. A closed surface
/// has none.
size_t count_open_edges(const std::vector<glm::vec4> &p_corners, bool p_is_directional) {
	std::map<std::pair<Corner, Corner>, int> counts;
	for (size_t first = 0; first < p_corners.size(); first += 3) {
		for (size_t i = 0; i < 3; ++i) {
			const Corner a = make_key(p_corners[first + i], p_is_directional);
			const Corner b = make_key(p_corners[first + (i + 1) % 3], p_is_directional);
			if (a < b) {
				++counts[{ a, b }];
			} else if (b < a) {
				--counts[{ b, a }];
			}
		}
	}
	return size_t(std::count_if(
			counts.begin(), counts.end(), [](const auto &p_entry) { return p_entry.second != 0; }));
}

} // namespace

TEST_CASE("[ShadowVolume] the volume of every mesh class is closed, for lights on every side") {
	for (const auto &[name, mesh] : make_meshes()) {
		CAPTURE(name);
		const MeshTopology topology = build_topology(mesh);
		for (const glm::dvec4 &light : { glm::dvec4(3, 5, 2, 1), glm::dvec4(-4, 0.3, 1, 1),
					 glm::dvec4(0.1, -0.2, 0.15, 1), glm::dvec4(0, 1, 0, 0),
					 glm::dvec4(0.3, -0.5, 0.8, 0), glm::dvec4(2, 1, 0.5, 1) }) {
			CAPTURE(light.x);
			const VolumeFaces all = VolumeFaces::ALL;
			const VolumeFaces not_solid = VolumeFaces::NOT_SOLID;
			const auto corners =
					build_cpu_volume(topology, light, { not_solid, /*has_far_cap=*/true });
			CHECK(corners.size() % 3 == 0);
			CHECK(count_open_edges(corners, light.w == 0) == 0);
			// With all faces robust, the volume is closed too.
			const auto robust = build_cpu_volume(topology, light, { all, /*has_far_cap=*/true });
			CHECK(robust.size() > 0);
			CHECK(count_open_edges(robust, light.w == 0) == 0);
			// The far caps are as many triangles as the near ones, the rest are sides.
			const auto near =
					build_cpu_volume(topology, light, { not_solid, /*has_far_cap=*/false });
			const size_t cap_size = corners.size() - near.size();
			CHECK((cap_size > 0 || corners.empty())); // empty: no face is light-facing from inside
			CHECK(cap_size % 3 == 0);
			CHECK((near.size() - cap_size) % 6 == 0);
		}
	}
}

TEST_CASE("[ShadowVolume] a cube seen from a corner has six sides and three faces") {
	const MeshTopology topology = build_topology(test_meshes::make_cube());
	const glm::dvec4 light(4, 5, 6, 1);
	const auto count = [&](VolumeFaces p_robust, bool p_has_far_cap) {
		return build_cpu_volume(topology, light, { p_robust, p_has_far_cap }).size();
	};
	// Six sides of 6 vertices. Three faces, so near and far cap have 6 triangles of 3 vertices.
	for (const VolumeFaces robust : { VolumeFaces::NONE, VolumeFaces::NOT_SOLID }) {
		CHECK(count(robust, false) == 6 * 6 + 6 * 3);
		CHECK(count(robust, true) == 6 * 6 + 2 * 6 * 3);
	}
	// Robust: two sides at each silhouette edge, and caps of all 12 triangles.
	CHECK(count(VolumeFaces::ALL, true) == 2 * 6 * 6 + 2 * 12 * 3);
}

TEST_CASE("[ShadowVolume] only open and inside-out parts of a mesh have a volume for "
		  "each face") {
	Mesh quad = test_meshes::make_quad();
	for (glm::vec3 &position : quad.positions_node) {
		position += glm::vec3(5, 0, 0);
	}
	const Mesh cube = test_meshes::make_cube();
	Mesh inside_out = test_meshes::make_cube({ 0, 9, 0 });
	for (size_t first = 0; first < inside_out.indices.size(); first += 3) {
		std::swap(inside_out.indices[first], inside_out.indices[first + 1]);
	}
	const glm::dvec4 light(4, 5, -6, 1); // behind the quad
	for (const bool has_far_cap : { false, true }) {
		const VolumeShape shape = { VolumeFaces::NOT_SOLID, has_far_cap };
		const auto count = [&](const Mesh &p_mesh) {
			return build_cpu_volume(build_topology(p_mesh), light, shape).size();
		};
		CHECK(count(quad) > 0);
		CHECK(count(test_meshes::join(cube, quad)) == count(cube) + count(quad));
		CHECK(count(test_meshes::join(cube, inside_out)) == count(cube) + count(inside_out));
		const VolumeShape all = { VolumeFaces::ALL, has_far_cap };
		CHECK(count(inside_out) == build_cpu_volume(build_topology(inside_out), light, all).size());
	}
}

TEST_CASE("[ShadowVolume] a light whose position is not finite gives no volume") {
	const MeshTopology topology = build_topology(test_meshes::make_cube());
	for (const double value : { double(NAN), double(INFINITY) }) {
		const VolumeShape shape = { VolumeFaces::ALL, true };
		CHECK(build_cpu_volume(topology, glm::dvec4(value, 0, 0, 1), shape).empty());
	}
}
