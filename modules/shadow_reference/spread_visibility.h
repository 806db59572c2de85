#pragma once

#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/light_disc.h"
#include "modules/shadows/surface_spread.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// Sums over the rays of one receiver, in two halves that were sampled independently.
struct SpreadMean {
	/// Per half, the sum of the rays' RGB transmittances.
	glm::dvec3 transmittance_sums[2] = { glm::dvec3(0.0), glm::dvec3(0.0) };
	/// Per half, the number of rays that started where the light can reach the body.
	double counts[2] = { 0, 0 };

	/// Not defined when both counts are 0.
	glm::dvec3 compute_mean() const {
		return (transmittance_sums[0] + transmittance_sums[1]) / (counts[0] + counts[1]);
	}
};

/// Computes the exact mask of translucent receivers: the light's visibility, averaged over the
/// points where light enters that leaves at the receiver. These points are sampled on the
/// receiver's tangent plane and moved along its normal, up or down by at most the spread radius, to
/// the nearest surface of the same body. A flat body is therefore exactly the semi-infinite slab
/// for which the dipole model is made. Points that the light cannot reach, or without such a
/// surface, do not count. A receiver without a body nearby uses the points on its tangent plane.
class SpreadVisibility {
public:
	/// p_spread must outlive it.
	SpreadVisibility(std::span<const Triangles> p_bodies, const SurfaceSpread &p_spread);

	/// p_receiver: with a unit normal and a spread radius above 0. All rays start as far off the
	/// surface as its own. p_sample_count: samples of both halves together, including those that do
	/// not count. p_hash: seed of the samples. May be called from several threads.
	SpreadMean compute(const CasterScene &p_casters, const AreaLight &p_light,
			const ReceiverPoint &p_receiver, uint32_t p_sample_count, uint64_t p_hash) const;

private:
	struct Point {
		glm::vec3 position;
		glm::vec3 normal;
	};
	const EmbreeScene *find_body(const ReceiverPoint &p_receiver, float p_reach_m) const;
	/// Moves a point of the receiver's tangent plane along its normal to the body's surface.
	/// Returns nothing when that is farther than the spread radius.
	static std::optional<Point> find_point(const EmbreeScene &p_body,
			const ReceiverPoint &p_receiver, const glm::vec3 &p_on_plane);

	std::vector<EmbreeScene> bodies;
	const SurfaceSpread &spread;
};

} // namespace gnomon
