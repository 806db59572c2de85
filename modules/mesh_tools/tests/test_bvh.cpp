#include "modules/mesh_tools/tests/bvh_queries.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace gnomon;

namespace {

Bounds make_box(const glm::dvec3 &p_minimum, const glm::dvec3 &p_maximum) {
	Bounds box;
	box.minimum = p_minimum;
	box.maximum = p_maximum;
	return box;
}

std::vector<Bounds> make_boxes(uint32_t p_seed, size_t p_count) {
	std::mt19937 random(p_seed);
	std::uniform_real_distribution<double> coordinate(-10, 10);
	std::uniform_real_distribution<double> size(0, 2);
	std::vector<Bounds> boxes;
	for (size_t i = 0; i < p_count; ++i) {
		const glm::dvec3 minimum(coordinate(random), coordinate(random), coordinate(random));
		boxes.push_back(
				make_box(minimum, minimum + glm::dvec3(size(random), size(random), size(random))));
	}
	return boxes;
}

std::vector<uint32_t> find_by_brute_force(const std::vector<Bounds> &p_boxes, const Bounds &p_box) {
	std::vector<uint32_t> found;
	for (uint32_t i = 0; i < p_boxes.size(); ++i) {
		bool overlaps = true;
		for (int axis = 0; axis < 3; ++axis) {
			overlaps = overlaps && p_boxes[i].minimum[axis] <= p_box.maximum[axis] &&
					p_box.minimum[axis] <= p_boxes[i].maximum[axis];
		}
		if (overlaps) {
			found.push_back(i);
		}
	}
	return found;
}

/// Finds the boxes that do not have all eight corners behind the same plane.
std::vector<uint32_t> find_by_brute_force(
		const std::vector<Bounds> &p_boxes, const std::vector<glm::dvec4> &p_planes) {
	std::vector<uint32_t> found;
	for (uint32_t i = 0; i < p_boxes.size(); ++i) {
		bool is_outside = false;
		for (const glm::dvec4 &plane : p_planes) {
			int behind = 0;
			for (int corner = 0; corner < 8; ++corner) {
				const glm::dvec3 point(corner & 1 ? p_boxes[i].maximum.x : p_boxes[i].minimum.x,
						corner & 2 ? p_boxes[i].maximum.y : p_boxes[i].minimum.y,
						corner & 4 ? p_boxes[i].maximum.z : p_boxes[i].minimum.z);
				behind += glm::dot(glm::dvec3(plane), point) + plane.w < 0 ? 1 : 0;
			}
			is_outside = is_outside || behind == 8;
		}
		if (!is_outside) {
			found.push_back(i);
		}
	}
	return found;
}

} // namespace

TEST_CASE("[Bvh] a box query finds the same boxes as brute force") {
	for (const size_t count : { 1, 2, 5, 64, 1000 }) {
		const std::vector<Bounds> boxes = make_boxes(static_cast<uint32_t>(count), count);
		const BvhQueries bvh(boxes);
		for (const Bounds &query : make_boxes(99, 50)) {
			CHECK(bvh.find_in_box(query) == find_by_brute_force(boxes, query));
		}
	}
}

TEST_CASE("[Bvh] a query by planes finds the same boxes as brute force") {
	const std::vector<Bounds> boxes = make_boxes(3, 500);
	const BvhQueries bvh(boxes);
	std::mt19937 random(11);
	std::normal_distribution<double> normal;
	for (int i = 0; i < 50; ++i) {
		std::vector<glm::dvec4> planes;
		for (int plane = 0; plane < i % 8; ++plane) {
			planes.emplace_back(
					glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))),
					2 * normal(random));
		}
		CHECK(bvh.find_in_planes(planes) == find_by_brute_force(boxes, planes));
	}
}

TEST_CASE("[Bvh] identical boxes, exponentially growing boxes and boxes of zero size are found") {
	std::vector<Bounds> boxes(300, make_box(glm::dvec3(0), glm::dvec3(1)));
	// Of boxes that grow like this, the surface area heuristic splits off few at each level.
	for (int i = 0; i < 300; ++i) {
		boxes.push_back(make_box(glm::dvec3(0), glm::dvec3(std::pow(1.9, i) * 1e-40)));
		boxes.push_back(make_box(
				glm::dvec3(std::pow(1.9, i) * 1e-40), glm::dvec3(std::pow(1.9, i) * 1e-40)));
	}
	const BvhQueries bvh(boxes);
	CHECK(bvh.find_in_box(make_box(glm::dvec3(-1), glm::dvec3(1e200))).size() == boxes.size());
	const Bounds query = make_box(glm::dvec3(0.5), glm::dvec3(0.5));
	CHECK(bvh.find_in_box(query) == find_by_brute_force(boxes, query));
}

TEST_CASE("[Bvh] empty and NaN boxes are never found, infinite ones are") {
	const double inf = std::numeric_limits<double>::infinity();
	const double nan = std::numeric_limits<double>::quiet_NaN();
	std::vector<Bounds> boxes = { Bounds(), make_box(glm::dvec3(nan), glm::dvec3(nan)),
		make_box(glm::dvec3(-inf), glm::dvec3(inf)), make_box(glm::dvec3(0), glm::dvec3(1)) };
	for (const Bounds &box : make_boxes(5, 20)) {
		boxes.push_back(box);
	}
	const BvhQueries bvh(boxes);
	const Bounds query = make_box(glm::dvec3(0.2), glm::dvec3(0.4));
	std::vector<uint32_t> found = bvh.find_in_box(query);
	CHECK(found == find_by_brute_force(boxes, query));
	CHECK(found[0] == 2);
	const std::vector<glm::dvec4> planes = { { 1, 0, 0, 0 }, { 0, -1, 0, 0.5 } };
	found = bvh.find_in_planes(planes);
	CHECK(found[0] == 2);
	CHECK(found[1] == 3);

	CHECK(BvhQueries({}).find_in_box(query).empty());
	CHECK(BvhQueries({ Bounds() }).find_in_planes(planes).empty());
	CHECK(bvh.find_in_box(Bounds()).empty());
}
