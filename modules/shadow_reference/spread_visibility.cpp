#include "modules/shadow_reference/spread_visibility.h"

#include "modules/shadow_reference/disc_samples.h"
#include "modules/shadow_reference/embree_scene.h"

#include <cmath>

namespace gnomon {

namespace {

constexpr float TWO_PI = 6.283185307f;
// Maximum distance of a receiver from its body, as a multiple of its offset.
constexpr float BODY_REACH = 20.0f;

/// A low-discrepancy sequence in the four-dimensional unit cube, even for every count: Roberts' R
/// sequence (generalised golden ratio). It is additive, with a random start and the inverse powers
/// of the root of x^5 = x + 1 as steps. 32-bit fractions (2^32 is 1) lose no precision over
/// thousands of steps.
class RobertsSequence {
public:
	explicit RobertsSequence(uint64_t p_hash) {
		for (uint32_t axis = 0; axis < 4; ++axis) {
			coordinates[axis] = static_cast<uint32_t>(mix_bits(p_hash + axis) >> 32);
		}
	}
	void step() {
		static constexpr uint32_t STEPS[4] = { 3679390609u, 3152041523u, 2700274806u, 2313257605u };
		for (uint32_t axis = 0; axis < 4; ++axis) {
			coordinates[axis] += STEPS[axis];
		}
	}
	/// Returns a coordinate in 0..1, exclusive of 1.
	float get(uint32_t p_axis) const {
		return static_cast<float>(coordinates[p_axis] >> 8) * 0x1p-24f;
	}

private:
	uint32_t coordinates[4];
};

} // namespace

SpreadVisibility::SpreadVisibility(
		std::span<const Triangles> p_bodies, const SurfaceSpread &p_spread) :
		spread(p_spread) {
	for (const Triangles &body : p_bodies) {
		bodies.emplace_back(body.positions, body.indices);
	}
}

/// Returns the body on which the receiver is, or null when none is within p_reach_m of it.
const EmbreeScene *SpreadVisibility::find_body(
		const ReceiverPoint &p_receiver, float p_reach_m) const {
	const EmbreeScene *nearest = nullptr;
	float nearest_m = 2.0f * p_reach_m;
	const glm::vec3 start = p_receiver.position + p_reach_m * p_receiver.geometric_normal;
	for (const EmbreeScene &body : bodies) {
		const SurfaceHit hit = body.find_nearest(start, -p_receiver.geometric_normal, nearest_m);
		if (hit.is_hit) {
			nearest_m = hit.distance;
			nearest = &body;
		}
	}
	return nearest;
}

std::optional<SpreadVisibility::Point> SpreadVisibility::find_point(
		const EmbreeScene &p_body, const ReceiverPoint &p_receiver, const glm::vec3 &p_on_plane) {
	// Both rays start slightly on the other side of the plane, so that a flat body is not missed.
	const glm::vec3 up = p_receiver.geometric_normal;
	const float offset_m = p_receiver.offset_m;
	const float reach_m = p_receiver.spread_radius_m + offset_m;
	const SurfaceHit below = p_body.find_nearest(p_on_plane + offset_m * up, -up, reach_m);
	const SurfaceHit above = p_body.find_nearest(
			p_on_plane - offset_m * up, up, below.is_hit ? below.distance : reach_m);
	const SurfaceHit &hit = above.is_hit ? above : below;
	const float facing = glm::dot(hit.normal, up);
	if (!hit.is_hit || facing == 0.0f) {
		return std::nullopt;
	}
	const float height_m = (hit.distance - offset_m) * (above.is_hit ? 1.0f : -1.0f);
	return Point{ p_on_plane + height_m * up, facing > 0.0f ? hit.normal : -hit.normal };
}

SpreadMean SpreadVisibility::compute(const CasterScene &p_casters, const AreaLight &p_light,
		const ReceiverPoint &p_receiver, uint32_t p_sample_count, uint64_t p_hash) const {
	SpreadMean mean;
	const EmbreeScene *body = find_body(p_receiver, BODY_REACH * p_receiver.offset_m);
	glm::vec3 axis_x;
	glm::vec3 axis_y;
	find_basis(p_receiver.geometric_normal, axis_x, axis_y);
	for (uint32_t half = 0; half < 2; ++half) {
		RobertsSequence points(mix_bits(p_hash ^ (half + 1)));
		for (uint32_t i = half; i < p_sample_count; i += 2) {
			points.step();
			const float distance_m =
					p_receiver.spread_radius_m * spread.compute_distance(points.get(0));
			const float angle_rad = TWO_PI * points.get(1);
			const glm::vec3 on_plane = p_receiver.position +
					distance_m * (std::cos(angle_rad) * axis_x + std::sin(angle_rad) * axis_y);
			// Without a body the point stays on the plane.
			std::optional<Point> point = Point{ on_plane, p_receiver.geometric_normal };
			if (body != nullptr) {
				point = find_point(*body, p_receiver, on_plane);
			}
			if (!point || !p_light.reaches(point->position, point->normal)) {
				continue;
			}
			mean.counts[half] += 1;
			DiscView view;
			float constant_visibility = 0.0f;
			glm::vec3 visibility(0.0f);
			if (find_disc_view(p_light, point->position, point->normal, p_receiver.offset_m, view,
						constant_visibility)) {
				const float radius = std::sqrt(points.get(2));
				const float disc_angle_rad = TWO_PI * points.get(3);
				const glm::vec3 ray = view.compute_ray(
						radius * std::cos(disc_angle_rad), radius * std::sin(disc_angle_rad));
				visibility = p_casters.trace(view.origin, ray, view.end);
			} else {
				visibility = glm::vec3(constant_visibility);
			}
			mean.transmittance_sums[half] += glm::dvec3(visibility);
		}
	}
	return mean;
}

} // namespace gnomon
