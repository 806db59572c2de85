#pragma once

#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/light_disc.h"
#include "modules/shadows/surface_spread.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// Means over rays of one receiver, in two halves that were drawn independently.
struct SpreadMean {
	glm::dvec3 visible_counts[2] = { glm::dvec3(0.0), glm::dvec3(0.0) }; // one for each colour
	double counts[2] = { 0, 0 }; // of rays that started where the light reaches the body

	glm::dvec3 compute_mean() const {
		return (visible_counts[0] + visible_counts[1]) / (counts[0] + counts[1]);
	}
};

/// The exact mask of translucent receivers: the light's visibility, averaged over the points where
/// light enters that leaves at the receiver. A point at a distance on the receiver's tangent plane
/// represents the nearest one of the same body along the receiver's normal, up or down by that
/// radius at most; a flat body is therefore exactly the semi-infinite slab that the dipole is made
/// for. Points that the light cannot reach, or where there is no such surface, do not count.
class SpreadVisibility {
public:
	/// p_spread must outlive it.
	SpreadVisibility(std::span<const Triangles> p_bodies, const SurfaceSpread &p_spread);

	/// p_receiver: with a unit normal and a spread radius above 0, from which light leaves that
	/// entered about it. p_sample_count rays in all; p_offset_m: how far they start off the
	/// surface. May be called from several threads.
	SpreadMean compute(const CasterScene &p_casters, const AreaLight &p_light,
			const ReceiverPoint &p_receiver, float p_offset_m, uint32_t p_sample_count,
			uint64_t p_hash) const;

private:
	struct Point {
		glm::vec3 position;
		glm::vec3 normal;
	};
	const EmbreeScene *find_body(const ReceiverPoint &p_receiver, float p_reach_m) const;
	static std::optional<Point> find_point(const EmbreeScene &p_body,
			const ReceiverPoint &p_receiver, const glm::vec3 &p_on_plane, float p_offset_m);

	std::vector<EmbreeScene> bodies;
	const SurfaceSpread &spread;
};

} // namespace gnomon
