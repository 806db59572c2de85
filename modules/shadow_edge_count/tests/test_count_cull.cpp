// Which edges a box of receivers leaves out: none that changes what one of them sees.

#include "modules/shadow_edge_count/tests/count_records.h"
#include "modules/shadow_edge_count/tests/count_scene.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace gnomon;

namespace {

// As count_cull_inc.glsl.
const uint32_t USE_AREA = 1;
const uint32_t USE_CENTER = 2;
const uint32_t USE_ONE_WEIGHT = 4;
const uint32_t WEIGHT_SHIFT = 3;
const int WEIGHT_BIAS = 2;

/// Receivers in (x', y', w), as the shader gets them.
struct WarpedBox {
	glm::vec3 least = glm::vec3(std::numeric_limits<float>::max());
	glm::vec3 greatest = glm::vec3(std::numeric_limits<float>::lowest());

	void add(const glm::dvec3 &p_warped) {
		least = glm::min(least, glm::vec3(p_warped));
		greatest = glm::max(greatest, glm::vec3(p_warped));
	}
};

glm::dvec3 unwarp(const CountSpace &p_space, const glm::dvec3 &p_warped) {
	return p_space.is_directional
			? glm::dvec3(p_warped.x, p_warped.y, p_space.depth_far_m - p_warped.z)
			: glm::dvec3(p_warped.x, p_warped.y, 1.0) / p_warped.z;
}

/// Around a few points of the world that lie close together, or far apart.
WarpedBox make_box(const CountScene &p_scene, TestRandom &r_random, double p_width_m) {
	const CountSpace &space = p_scene.get_space();
	for (;;) {
		const glm::dvec3 middle(r_random.next(-1.8, 1.6), r_random.next(0.0, 2.2) * r_random.next(),
				r_random.next(-1.7, 1.5));
		WarpedBox box;
		bool is_before = true;
		for (int index = 0; index < 6; ++index) {
			const glm::dvec3 place = middle + p_width_m * r_random.next() * r_random.next_unit();
			const CountReceiver receiver = p_scene.make_receiver(place, { 0.0, 1.0, 0.0 });
			is_before = is_before && (space.is_directional || receiver.r.z > 0.05);
			box.add(space.warp(receiver.r));
		}
		if (is_before) {
			return box;
		}
	}
}

/// A corner of the box, or a place within it, with any normal.
CountReceiver make_receiver(
		const CountSpace &p_space, const WarpedBox &p_box, TestRandom &r_random, int p_index) {
	glm::dvec3 share;
	for (int axis = 0; axis < 3; ++axis) {
		share[axis] = p_index < 8 ? (p_index >> axis & 1) : r_random.next();
	}
	const glm::dvec3 least(p_box.least);
	return { unwarp(p_space, least + share * (glm::dvec3(p_box.greatest) - least)),
		r_random.next_unit() };
}

/// What a use of an edge leaves of it.
CountEdge keep_use(const CountEdge &p_edge, uint32_t p_use) {
	CountEdge edge = p_edge;
	if ((p_use & USE_AREA) == 0) {
		// Both faces the same one: no silhouette from anywhere.
		edge.has_face1 = true;
		edge.plane1 = edge.plane0;
	}
	if ((p_use & USE_CENTER) == 0) {
		edge.center_weight = 0;
	}
	return edge;
}

struct CullResult {
	std::vector<uint32_t> uses;	   // one per edge, of each box
	size_t bounded_count = 0;	   // boxes
	size_t wrong_bundle_count = 0; // that leave out an edge which is used alone
};

CullResult find_uses(KernelFixture &r_fixture, const CountScene &p_scene,
		const std::vector<WarpedBox> &p_boxes) {
	std::vector<shader::CountEdgeRecord> records;
	for (const CountEdge &edge : p_scene.get_edges()) {
		records.push_back(make_record(edge));
	}
	std::vector<glm::vec4> input;
	for (const WarpedBox &box : p_boxes) {
		input.emplace_back(box.least, 0.0f);
		input.emplace_back(box.greatest, 0.0f);
	}
	const OwnedBuffer view = r_fixture.make_buffer("view",
			std::vector<shader::CountViewConstants>{ make_constants(p_scene) },
			BufferUsage::UNIFORM);
	const OwnedBuffer edges = r_fixture.make_buffer("edges", records);
	const auto results = r_fixture.run("count_cull.comp", input, p_boxes.size() * records.size(), 1,
			{ { 2, view.get() }, { 3, edges.get() } });
	CullResult result;
	for (size_t index = 0; index < results.size(); ++index) {
		result.uses.push_back(uint32_t(results[index].x));
		result.bounded_count += index % records.size() == 0 && results[index].y > 0.5f ? 1 : 0;
		result.wrong_bundle_count += results[index].x > 0.0f && results[index].z == 0.0f ? 1 : 0;
	}
	return result;
}

enum class LightPlace { SPOT_ON_AXIS, SPOT_FAR_OFF, DIRECTIONAL };

/// Two solids and a sheet over the ground, anyhow.
CountScene make_scene(LightPlace p_place, double p_radius_sizes, TestRandom &r_random) {
	CountScene scene;
	scene.is_directional = p_place == LightPlace::DIRECTIONAL;
	scene.radius = scene.is_directional ? p_radius_sizes : p_radius_sizes * scene.scene_size;
	scene.half_extent = scene.is_directional ? 6.0 : 0.95;
	scene.map_size = 64;
	if (p_place == LightPlace::SPOT_FAR_OFF) {
		// About 50 degrees off the axis, as in the corner of an omni light's view.
		scene.light = { 2.2, 3.4, 1.4 };
		scene.target = { 2.3, 1.4, 1.5 };
		scene.half_extent = 2.6;
	}
	const auto place = [&](double p_least_height, double p_greatest_height) {
		const glm::dvec3 position(r_random.next(-0.8, 0.8),
				r_random.next(p_least_height, p_greatest_height), r_random.next(-0.8, 0.8));
		return glm::rotate(glm::translate(glm::dmat4(1.0), position), r_random.next(0.0, 6.28),
				r_random.next_unit());
	};
	scene.add(make_box_mesh("ground", glm::vec3(4.2, 0.2, 4.2)),
			glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.2, 0.0)));
	scene.add(make_box_mesh("box",
					  glm::vec3(r_random.next(0.1, 0.6), r_random.next(0.05, 0.5),
							  r_random.next(0.1, 0.6))),
			place(0.3, 1.0));
	scene.add(make_count_sphere(r_random.next(0.2, 0.7), 6), place(1.0, 2.0));
	scene.add(make_mesh("sheet",
					  { { -0.5f, 0, -0.4f }, { 0.5f, 0, -0.4f }, { 0.5f, 0.1f, 0.4f },
							  { -0.5f, 0, 0.4f } },
					  {}, { 0, 1, 2, 0, 2, 3 }),
			place(0.2, 1.5));
	scene.build();
	return scene;
}

struct CullCheck {
	double greatest_change = 0;
	size_t wrong_weight_count = 0;
	size_t one_weight_count = 0;
	size_t dropped_area_count = 0;	 // an edge of a box, each
	size_t dropped_center_count = 0; // of those that are silhouettes from the light's centre
	size_t kept_count = 0;
	size_t bounded_count = 0;
	size_t penumbra_count = 0; // receivers
};

/// Small boxes and large ones, all receivers of each counted with all edges and with the kept ones.
void check_boxes(KernelFixture &r_fixture, const CountScene &p_scene, TestRandom &r_random,
		CullCheck &r_check) {
	const size_t box_count = 40;
	const int receiver_count = 12;
	std::vector<WarpedBox> boxes;
	for (size_t index = 0; index < box_count; ++index) {
		boxes.push_back(make_box(p_scene, r_random, index % 2 == 0 ? 0.05 : 0.7));
	}
	const CullResult result = find_uses(r_fixture, p_scene, boxes);
	r_check.bounded_count += result.bounded_count;
	CHECK(result.wrong_bundle_count == 0);
	const std::vector<CountEdge> &edges = p_scene.get_edges();
	for (size_t box = 0; box < box_count; ++box) {
		std::vector<CountReceiver> receivers;
		for (int index = 0; index < receiver_count; ++index) {
			receivers.push_back(make_receiver(p_scene.get_space(), boxes[box], r_random, index));
		}
		std::vector<CountEdge> kept;
		for (size_t index = 0; index < edges.size(); ++index) {
			const uint32_t use = result.uses[box * edges.size() + index];
			kept.push_back(keep_use(edges[index], use));
			r_check.kept_count += use != 0 ? 1 : 0;
			r_check.dropped_area_count += (use & USE_AREA) == 0 ? 1 : 0;
			r_check.dropped_center_count +=
					(use & USE_CENTER) == 0 && edges[index].is_center_silhouette() ? 1 : 0;
			if ((use & USE_ONE_WEIGHT) == 0) {
				continue;
			}
			++r_check.one_weight_count;
			for (const CountReceiver &receiver : receivers) {
				r_check.wrong_weight_count += int(use >> WEIGHT_SHIFT) - WEIGHT_BIAS !=
								edges[index].compute_weight(receiver.r)
						? 1
						: 0;
			}
		}
		for (const CountReceiver &receiver : receivers) {
			const double all = p_scene.count(receiver);
			const double few = compute_count_visibility(
					p_scene.get_space(), receiver, kept, p_scene.get_layers(), p_scene.get_masks());
			r_check.penumbra_count += all > 0.002 && all < 0.998 ? 1 : 0;
			r_check.greatest_change = std::max(r_check.greatest_change, std::abs(all - few));
		}
	}
}

} // namespace

TEST_CASE("[GPU][EdgeCount] what a box of receivers leaves out changes nothing any of them sees") {
	KernelFixture fixture;
	TestRandom random;
	for (const LightPlace place :
			{ LightPlace::SPOT_ON_AXIS, LightPlace::SPOT_FAR_OFF, LightPlace::DIRECTIONAL }) {
		for (const double radius : { 0.0, 0.02, 0.1, 0.3, 0.75 }) { // of S, or a tangent
			CAPTURE(int(place));
			CAPTURE(radius);
			CullCheck check;
			for (int scene = 0; scene < 3; ++scene) {
				check_boxes(fixture, make_scene(place, radius, random), random, check);
			}
			CHECK(check.greatest_change < 1e-12);
			CHECK(check.wrong_weight_count == 0);
			// Otherwise nothing was asked.
			CHECK(check.one_weight_count > 50);
			CHECK(check.dropped_area_count > 1000);
			CHECK(check.dropped_center_count > 1000);
			CHECK(check.kept_count > 200);
			CHECK(check.bounded_count > 10);
			CHECK((check.penumbra_count > 5) == (radius > 0));
		}
	}
}

TEST_CASE("[GPU][EdgeCount] a small box of receivers leaves out most edges of a fine sphere") {
	KernelFixture fixture;
	for (const bool is_directional : { false, true }) {
		CAPTURE(is_directional);
		CountScene scene;
		scene.is_directional = is_directional;
		scene.radius = is_directional ? 0.1 : 0.4;
		scene.half_extent = is_directional ? 6.0 : 0.95;
		scene.map_size = 256;
		scene.add(make_count_sphere(0.8, 64),
				glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 1.3, 0.0)));
		scene.build();
		TestRandom random;
		std::vector<WarpedBox> boxes;
		const size_t box_count = 40;
		for (size_t index = 0; index < box_count; ++index) {
			WarpedBox box;
			// As far apart as eight pixels of a picture of 512 x 512 are.
			const glm::dvec3 middle(random.next(-1.6, 0.9), 0.0, random.next(-1.5, 1.0));
			for (const double side : { -0.03, 0.03 }) {
				const glm::dvec3 place = middle + glm::dvec3(side, 0.0, side);
				box.add(scene.get_space().warp(scene.make_receiver(place, { 0, 1, 0 }).r));
			}
			boxes.push_back(box);
		}
		const CullResult result = find_uses(fixture, scene, boxes);
		const size_t edge_count = scene.get_edges().size();
		size_t kept_count = 0;
		size_t most_count = 0;
		for (size_t box = 0; box < box_count; ++box) {
			const auto first = result.uses.begin() + ptrdiff_t(box * edge_count);
			const size_t count = size_t(std::count_if(first, first + ptrdiff_t(edge_count),
					[](uint32_t p_use) { return p_use != 0; }));
			kept_count += count;
			most_count = std::max(most_count, count);
		}
		CHECK(edge_count > 1000);
		CHECK(result.bounded_count == box_count);
		CHECK(kept_count > 0);
		CHECK(most_count * 2 < edge_count);
		CHECK(kept_count * 5 < edge_count * box_count);
	}
}
