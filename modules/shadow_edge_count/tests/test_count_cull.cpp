// A box of receivers must not reject an edge that changes the visibility of one of them.

#include "modules/shadow_edge_count/tests/count_records.h"
#include "modules/shadow_edge_count/tests/count_scene.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace gnomon;

namespace {

const int UNKNOWN_WEIGHT = 9; // see count_cull.comp

/// Receivers in light space, and their box: bounds of (x', y'), and of w relative to a plane.
struct ReceiverBox {
	std::vector<glm::dvec3> receivers;
	std::array<glm::vec4, 3> box; // see count_cull.comp
};

/// (x', y', w) of a point, see CountLeaf.
glm::dvec3 warp(const CountScene &p_scene, const glm::dvec3 &p_r) {
	return p_scene.get_space().is_directional
			// The same depth_far_m as in CountArrays.
			? glm::dvec3(p_r.x, p_r.y, 3.0 * p_scene.get_space().scene_size_m - p_r.z)
			: glm::dvec3(p_r.x, p_r.y, 1.0) / p_r.z;
}

/// Random receivers near a random point, on a plane if p_is_flat, and their box. p_width_m: scale
/// of their distances from the point.
ReceiverBox make_box(
		const CountScene &p_scene, TestRandom &r_random, double p_width_m, bool p_is_flat) {
	for (;;) {
		const glm::dvec3 middle(r_random.next(-1.8, 1.6), r_random.next(0.0, 2.2) * r_random.next(),
				r_random.next(-1.7, 1.5));
		const glm::dvec3 u = r_random.next_unit();
		const glm::dvec3 v = r_random.next_unit();
		ReceiverBox result;
		bool is_in_front = true;
		for (int index = 0; index < 12; ++index) {
			const glm::dvec3 offset = p_is_flat
					? u * r_random.next(-1, 1) + v * r_random.next(-1, 1)
					: r_random.next() * r_random.next_unit();
			const glm::dvec3 receiver(glm::vec3(
					p_scene.make_receiver(middle + p_width_m * offset, { 0.0, 1.0, 0.0 })));
			is_in_front = is_in_front && (p_scene.is_directional || receiver.z > 0.05);
			result.receivers.push_back(receiver);
		}
		const glm::dvec3 normal_world = glm::normalize(glm::cross(u, v));
		const glm::dvec3 normal = // in light space
				p_scene.make_receiver(normal_world, {}) - p_scene.make_receiver({}, {});
		const double height =
				p_scene.is_directional ? normal.z : glm::dot(normal, result.receivers[0]);
		if (!is_in_front || std::abs(height) < 1e-3) {
			continue; // a receiver is behind the light or too close, or the plane is edge-on
		}
		const glm::vec2 slope(glm::dvec2(normal) / height); // w per x' and y' of the plane
		glm::vec2 minimum(1e30f);
		glm::vec2 maximum(-1e30f);
		glm::vec2 range(1e30f, -1e30f);
		glm::vec2 w_range(1e30f, -1e30f);
		for (const glm::dvec3 &receiver : result.receivers) {
			const glm::dvec3 warped = warp(p_scene, receiver);
			const float above = float(warped.z - glm::dot(glm::dvec2(slope), glm::dvec2(warped)));
			minimum = glm::min(minimum, glm::vec2(warped));
			maximum = glm::max(maximum, glm::vec2(warped));
			range = { std::min(range.x, above), std::max(range.y, above) };
			w_range = { std::min(w_range.x, float(warped.z)),
				std::max(w_range.y, float(warped.z)) };
		}
		result.box = { glm::vec4(minimum, maximum), glm::vec4(slope, range),
			glm::vec4(w_range, 0, 0) };
		return result;
	}
}

struct CullResult {
	std::vector<bool> is_used;		// the box may need the edge; by box, then by edge
	std::vector<int> known_weights; // by box, then by edge; may be UNKNOWN_WEIGHT
	size_t wrong_node_count = 0;	// nodes that are rejected although an edge of theirs is used
};

CullResult find_uses(KernelFixture &r_fixture, const CountScene &p_scene,
		const std::vector<ReceiverBox> &p_boxes) {
	const CountArrays arrays(p_scene);
	std::vector<glm::vec4> input;
	for (const ReceiverBox &box : p_boxes) {
		input.insert(input.end(), box.box.begin(), box.box.end());
	}
	const OwnedBuffer light = r_fixture.make_buffer("light",
			std::vector<shader::CountLightConstants>{ arrays.light }, BufferUsage::STORAGE);
	const OwnedBuffer edges = r_fixture.make_buffer("edges", arrays.edges);
	const OwnedBuffer planes = r_fixture.make_buffer("planes", arrays.planes);
	const auto results =
			r_fixture.run("count_cull.comp", input, p_boxes.size() * arrays.edges.size(), 1,
					{ { 2, light.get() }, { 3, edges.get() }, { 4, planes.get() } },
					arrays.pipeline_constants);
	CullResult result;
	for (const glm::vec4 &found : results) {
		result.is_used.push_back(found.x > 0.5f);
		result.known_weights.push_back(int(found.y));
		result.wrong_node_count += found.x > 0.5f && (found.z < 0.5f || found.w < 0.5f) ? 1 : 0;
	}
	return result;
}

enum class LightSetup { SPOT_ON_AXIS, SPOT_FAR_OFF, DIRECTIONAL };

/// Two solids and an open mesh at random positions above the ground. p_radius_sizes: R as a
/// fraction of S; directional: a tangent.
CountScene make_culled_scene(LightSetup p_setup, double p_radius_sizes, TestRandom &r_random) {
	CountScene scene;
	scene.is_directional = p_setup == LightSetup::DIRECTIONAL;
	scene.radius = scene.is_directional ? p_radius_sizes : p_radius_sizes * scene.scene_size;
	scene.half_extent = scene.is_directional ? 6.0 : 0.95;
	if (p_setup == LightSetup::SPOT_FAR_OFF) {
		// The casters are about 50 degrees off the axis, as in the corner of a wide view.
		scene.light = { 2.2, 3.4, 1.4 };
		scene.target = { 2.3, 1.4, 1.5 };
		scene.half_extent = 2.6;
	}
	const auto make_transform = [&](double p_min_height, double p_max_height) {
		const glm::dvec3 position(r_random.next(-0.8, 0.8),
				r_random.next(p_min_height, p_max_height), r_random.next(-0.8, 0.8));
		return glm::rotate(glm::translate(glm::dmat4(1.0), position), r_random.next(0.0, 6.28),
				r_random.next_unit());
	};
	scene.add(make_box_mesh("ground", glm::vec3(4.2, 0.2, 4.2)),
			glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.2, 0.0)));
	scene.add(make_box_mesh("box",
					  glm::vec3(r_random.next(0.1, 0.6), r_random.next(0.05, 0.5),
							  r_random.next(0.1, 0.6))),
			make_transform(0.3, 1.0));
	scene.add(make_count_sphere(r_random.next(0.2, 0.7), 6), make_transform(1.0, 2.0));
	scene.add(make_mesh("quad",
					  { { -0.5f, 0, -0.4f }, { 0.5f, 0, -0.4f }, { 0.5f, 0.1f, 0.4f },
							  { -0.5f, 0, 0.4f } },
					  {}, { 0, 1, 2, 0, 2, 3 }),
			make_transform(0.2, 1.5));
	scene.build();
	return scene;
}

struct CullCheck {
	double max_change = 0;		   // of a receiver's visibility
	size_t wrong_weight_count = 0; // receivers whose weight differs from the known one
	size_t known_weight_count = 0; // pairs of a box and an edge
	size_t rejected_count = 0;	   // pairs of a box and an edge
	size_t used_count = 0;		   // pairs of a box and an edge
	size_t penumbra_count = 0;	   // receivers
};

/// Counts the receivers of small and large boxes with all edges, and with the used ones only.
void check_boxes(KernelFixture &r_fixture, const CountScene &p_scene, TestRandom &r_random,
		CullCheck &r_check) {
	const size_t box_count = 60;
	std::vector<ReceiverBox> boxes;
	for (size_t index = 0; index < box_count; ++index) {
		boxes.push_back(make_box(p_scene, r_random, index % 2 == 0 ? 0.05 : 0.7, index % 3 != 0));
	}
	const CullResult result = find_uses(r_fixture, p_scene, boxes);
	CHECK(result.wrong_node_count == 0);
	const std::vector<CountEdge> &edges = p_scene.get_edges();
	for (size_t box = 0; box < box_count; ++box) {
		std::vector<CountEdge> used;
		for (size_t index = 0; index < edges.size(); ++index) {
			const size_t item = box * edges.size() + index;
			if (result.is_used[item]) {
				used.push_back(edges[index]);
			}
			++(result.is_used[item] ? r_check.used_count : r_check.rejected_count);
			if (result.known_weights[item] == UNKNOWN_WEIGHT) {
				continue;
			}
			++r_check.known_weight_count;
			for (const glm::dvec3 &receiver : boxes[box].receivers) {
				r_check.wrong_weight_count +=
						result.known_weights[item] != edges[index].compute_weight(receiver) ? 1 : 0;
			}
		}
		for (const glm::dvec3 &receiver : boxes[box].receivers) {
			const double all = p_scene.count(receiver);
			const double few = compute_count_visibility(
					p_scene.get_space(), receiver, used, p_scene.get_faces(), p_scene.get_masks());
			r_check.penumbra_count += all > 0.002 && all < 0.998 ? 1 : 0;
			r_check.max_change = std::max(r_check.max_change, std::abs(all - few));
		}
	}
}

} // namespace

TEST_CASE("[GPU][EdgeCount] edges that a box of receivers rejects change nothing for any of them") {
	KernelFixture fixture;
	TestRandom random;
	for (const LightSetup setup :
			{ LightSetup::SPOT_ON_AXIS, LightSetup::SPOT_FAR_OFF, LightSetup::DIRECTIONAL }) {
		for (const double radius : { 0.02, 0.1, 0.3, 0.75 }) { // of S, or a tangent
			CAPTURE(int(setup));
			CAPTURE(radius);
			CullCheck check;
			for (int scene = 0; scene < 3; ++scene) {
				check_boxes(fixture, make_culled_scene(setup, radius, random), random, check);
			}
			CHECK(check.max_change < 1e-12); // 0 but for rounding
			CHECK(check.wrong_weight_count == 0);
			// The scenes have enough cases of each kind.
			CHECK(check.known_weight_count > 50);
			CHECK(check.rejected_count > 1000);
			CHECK(check.used_count > 200);
			CHECK(check.penumbra_count > 5);
		}
	}
}

TEST_CASE("[GPU][EdgeCount] a small box of receivers rejects most edges of a fine sphere") {
	KernelFixture fixture;
	for (const bool is_directional : { false, true }) {
		CAPTURE(is_directional);
		CountScene scene;
		scene.is_directional = is_directional;
		scene.radius = is_directional ? 0.1 : 0.4;
		scene.half_extent = is_directional ? 6.0 : 0.95;
		scene.add(make_count_sphere(0.8, 64),
				glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 1.3, 0.0)));
		scene.build();
		TestRandom random;
		std::vector<ReceiverBox> boxes;
		for (size_t index = 0; index < 40; ++index) {
			boxes.push_back(make_box(scene, random, 0.03, true));
		}
		const CullResult result = find_uses(fixture, scene, boxes);
		const size_t used_count =
				size_t(std::count(result.is_used.begin(), result.is_used.end(), true));
		CHECK(scene.get_edges().size() > 1000);
		CHECK(used_count > 0);
		CHECK(used_count * 5 < result.is_used.size()); // of all pairs of a box and an edge
	}
}
