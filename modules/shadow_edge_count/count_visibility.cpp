#include "modules/shadow_edge_count/count_visibility.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

namespace gnomon {

namespace {

// Shares of w (directional: of a length, see get_depth_scale). Measured:
// doc/techniques/edge_count.md.
const double AWAY_TOLERANCE = 5e-5;			// of faces turned away from the light, and of crossings
const double TOWARD_TOLERANCE = 3e-4;		// of faces turned towards it; crossings of sheets
const double DOUBLE_SIDED_TOLERANCE = 3e-3; // likewise, of sheets
const double STEEP_SLOPE = 3e-3;			// rise of the receiver to a texel that is too steep
const double LOW_CLEARANCE = 0.02;			// below a solid, where the way to a texel has room
const double LOW_TEXEL = 2.0;				// square texels: the cost of having none
const double FLAT_NORMAL = 1e-7;			// of dot(n, r): the receiver is seen edge on
const double NEARER_TOLERANCE = 2e-5;		// an edge that is no nearer to the light than this
const double SMALLEST_RADIUS_SIZES = 1e-6;	// of S: R is at least this where it divides
const int SATURATION = 15;					// of a counter

/// How many faces lie between a texel's centre at depth w and the light.
struct LayerCounts {
	int away_count = 0;
	int toward_count = 0;
	double clearance = LOW_CLEARANCE; // below the nearest solid; a share, as the tolerances
};

LayerCounts count_layers(
		const CountSpace &p_space, const std::vector<LayerFragment> &p_fragments, double p_w) {
	const double scale = p_space.get_depth_scale(p_w);
	LayerCounts counts;
	for (const LayerFragment &fragment : p_fragments) {
		const double height = fragment.w - p_w;
		if (fragment.is_away || fragment.is_double_sided) {
			if (height > AWAY_TOLERANCE * scale) {
				++counts.away_count;
				counts.clearance = std::min(counts.clearance, height / scale);
			}
		}
		if (!fragment.is_away || fragment.is_double_sided) {
			const double tolerance =
					fragment.is_double_sided ? DOUBLE_SIDED_TOLERANCE : TOWARD_TOLERANCE;
			counts.toward_count += height > tolerance * scale ? 1 : 0;
		}
	}
	return counts;
}

class Counter {
public:
	Counter(const CountSpace &p_space, const CountReceiver &p_receiver, const LayerMap &p_layers,
			std::span<const DiscMasks> p_masks) :
			space(p_space),
			receiver(p_receiver), layers(p_layers), masks(p_masks),
			projection(p_space, p_receiver.r), warped(p_space.warp(p_receiver.r)), p(warped),
			wp(warped.z), scale(p_space.get_depth_scale(warped.z)), counts(p_masks.size()) {
		const glm::dvec3 normal = receiver.normal;
		const double depth_slope = space.is_directional ? normal.z : glm::dot(normal, receiver.r);
		if (std::abs(depth_slope) >=
				FLAT_NORMAL * (space.is_directional ? 1.0 : glm::length(receiver.r))) {
			slope = glm::dvec2(normal) / depth_slope;
		}
		for (auto &samples : counts) {
			samples.fill(0);
		}
	}

	double compute(std::span<const CountEdge> p_edges) {
		choose_reference();
		for (const CountEdge &edge : p_edges) {
			add_edge(edge);
		}
		return resolve();
	}

private:
	/// w of the receiver's plane at a point, never below the receiver: the plane's own fall is no
	/// shadow.
	double compute_plane_w(const glm::dvec2 &p_point) const {
		return wp + std::max(compute_rise(p_point), 0.0);
	}
	double compute_rise(const glm::dvec2 &p_point) const { return glm::dot(slope, p_point - p); }

	LayerCounts count_at(const glm::ivec2 &p_texel) const {
		return count_layers(
				space, layers.get_fragments(p_texel), compute_plane_w(layers.get_center(p_texel)));
	}

	/// The texel whose solids are counted: the nearest one, unless it says little. Beside the map,
	/// which holds all casters, nothing lies between the receiver and the light's centre.
	void choose_reference() {
		const glm::dvec2 place = layers.to_texels(p);
		const glm::dvec2 size_px(layers.get_size_px());
		if (glm::any(glm::lessThan(place, glm::dvec2(0.0))) ||
				glm::any(glm::greaterThan(place, size_px))) {
			reference_w = wp;
			return;
		}
		const glm::ivec2 last = glm::ivec2(layers.get_size_px()) - 1;
		const glm::ivec2 nearest = glm::clamp(glm::ivec2(glm::floor(place)), glm::ivec2(0), last);
		glm::ivec2 chosen = nearest;
		LayerCounts found = count_at(nearest);
		const double steep = STEEP_SLOPE * scale;
		if (layers.is_buried(nearest) || found.away_count != found.toward_count ||
				compute_rise(layers.get_center(nearest)) > steep) {
			double least = std::numeric_limits<double>::infinity();
			for (int y = -1; y <= 1; ++y) {
				for (int x = -1; x <= 1; ++x) {
					const glm::ivec2 texel = nearest + glm::ivec2(x, y);
					if (!layers.is_inside(texel)) {
						continue;
					}
					const LayerCounts here = count_at(texel);
					const glm::dvec2 away = glm::dvec2(texel) + 0.5 - place;
					const double rise =
							std::max(compute_rise(layers.get_center(texel)), 0.0) / steep;
					const bool is_bad =
							layers.is_buried(texel) || here.away_count != here.toward_count;
					const double low = 1.0 - here.clearance / LOW_CLEARANCE;
					const double cost = glm::dot(away, away) + rise * rise + LOW_TEXEL * low +
							(is_bad ? 1e6 : 0.0);
					if (cost < least) {
						least = cost;
						chosen = texel;
						found = here;
					}
				}
			}
		}
		const glm::dvec2 center = layers.get_center(chosen);
		to_reference = center - p;
		reference_w = compute_plane_w(center);
		solid_count = found.away_count;
	}

	/// Solids whose outline lies between the reference and the receiver.
	void correct_reference(
			const CountEdge &p_edge, const glm::dvec2 &p_a, const glm::dvec2 &p_b, double p_side) {
		const double reference_side = cross(p_a - to_reference, p_b - to_reference);
		if ((reference_side > 0) == (p_side > 0)) {
			return;
		}
		const double at_a = cross(to_reference, p_a);
		const double at_b = cross(to_reference, p_b);
		if ((at_a > 0) == (at_b > 0)) {
			return;
		}
		const double edge_w = glm::mix(p_edge.a.z, p_edge.b.z, at_a / (at_a - at_b));
		const double plane_w =
				glm::mix(reference_w, wp, reference_side / (reference_side - p_side));
		// A sheet bends up and down: its own rim may lie a little above its receiver's plane.
		const double tolerance = p_edge.is_double_sided ? TOWARD_TOLERANCE : AWAY_TOLERANCE;
		if (edge_w - plane_w > tolerance * space.get_depth_scale(plane_w)) {
			const bool is_reversed = p_edge.center_weight < 0;
			solid_count += std::abs(p_edge.center_weight) * ((p_side > 0) == is_reversed ? 1 : -1);
		}
	}

	/// The edge on the disc's plane, cut where it is no nearer to the light than the receiver.
	std::optional<std::pair<glm::dvec2, glm::dvec2>> project(const CountEdge &p_edge) const {
		const double least = NEARER_TOLERANCE * scale;
		glm::dvec3 a = projection.project(p_edge.a - warped);
		glm::dvec3 b = projection.project(p_edge.b - warped);
		if (a.z <= least && b.z <= least) {
			return std::nullopt;
		}
		if (a.z <= least) {
			a = glm::mix(a, b, (least - a.z) / (b.z - a.z));
			a.z = least;
		} else if (b.z <= least) {
			b = glm::mix(b, a, (least - b.z) / (a.z - b.z));
			b.z = least;
		}
		return std::pair(glm::dvec2(a) / a.z, glm::dvec2(b) / b.z);
	}

	void add_edge(const CountEdge &p_edge) {
		const glm::dvec2 a = glm::dvec2(p_edge.a) - p;
		const glm::dvec2 b = glm::dvec2(p_edge.b) - p;
		double side = cross(a, b); // the one value both tests use, so that they never disagree
		if (p_edge.is_center_silhouette()) {
			correct_reference(p_edge, a, b, side);
		}
		const int weight = p_edge.compute_weight(receiver.r);
		if (weight == 0 || side == 0) {
			return;
		}
		auto ends = project(p_edge);
		if (!ends) {
			return;
		}
		if (weight < 0) {
			std::swap(ends->first, ends->second);
			side = -side;
		}
		add_sector(ends->first, ends->second, side, std::abs(weight));
	}

	/// Adds the part of the disc beyond the edge, as the centre sees it: a sector without its
	/// triangle, with the sign of the turn.
	void add_sector(const glm::dvec2 &p_a, const glm::dvec2 &p_b, double p_side, int p_weight) {
		const double radius = space.disc_radius;
		const glm::dvec2 way = p_b - p_a;
		if (glm::dot(way, way) < 1e-16 * radius * radius) {
			return;
		}
		const glm::dvec2 u = glm::normalize(way);
		const double distance = std::max(std::abs(cross(p_a, u)), 1e-20);
		if (distance >= radius) {
			return;
		}
		const double half_chord = std::sqrt(radius * radius - distance * distance);
		const double from = std::max(glm::dot(p_a, u), -half_chord);
		const double to = std::min(glm::dot(p_b, u), half_chord);
		if (to <= from) {
			return;
		}
		const int sign = p_side > 0 ? -1 : 1;
		sum += p_weight * sign * 0.5 *
				(radius * radius * (std::atan2(to, distance) - std::atan2(from, distance)) -
						distance * (to - from));
		const glm::dvec2 beyond = p_side > 0 ? glm::dvec2(u.y, -u.x) : glm::dvec2(-u.y, u.x);
		for (size_t index = 0; index < masks.size(); ++index) {
			const DiscMasks &table = masks[index];
			const uint64_t mask = table.get_mask(beyond, distance / radius) &
					(p_side > 0 ? table.get_wedge(p_a, p_b) : table.get_wedge(p_b, p_a));
			for (uint32_t sample = 0; sample < DiscMasks::SAMPLE_COUNT; ++sample) {
				counts[index][sample] += (mask >> sample & 1) != 0 ? sign * p_weight : 0;
			}
		}
	}

	double resolve() {
		const int solids = std::clamp(solid_count, 0, SATURATION);
		const double least_radius =
				SMALLEST_RADIUS_SIZES * (space.is_directional ? 1.0 : space.scene_size_m);
		const double radius = std::max(space.disc_radius, least_radius);
		const double mean = solids + sum / (std::numbers::pi * radius * radius);
		int over_sum = 0;
		int under_sum = 0;
		int blocked_count = 0;
		for (const auto &samples : counts) {
			for (const int delta : samples) {
				const int count = solids + delta;
				blocked_count += count >= 1 ? 1 : 0;
				over_sum += std::max(count - 1, 0);
				under_sum += std::max(-count, 0);
			}
		}
		const int sample_count = static_cast<int>(DiscMasks::SAMPLE_COUNT * masks.size());
		const double over = double(over_sum) / sample_count;
		const double under = double(under_sum) / sample_count;
		const double blocked = double(blocked_count) / sample_count;
		if (over + under == 0) {
			return 1.0 - std::clamp(mean, 0.0, 1.0); // one layer at most: exact
		}
		if (blocked_count == sample_count) {
			return 0.0; // what the area of overlaps, known by points alone, would leave is noise
		}
		const double exact = 1.0 - std::clamp(mean - over + under, 0.0, 1.0);
		return glm::mix(1.0 - blocked, exact, std::clamp(1.0 - over - under, 0.0, 1.0));
	}

	const CountSpace &space;
	const CountReceiver &receiver;
	const LayerMap &layers;
	const std::span<const DiscMasks> masks;
	const DiscProjection projection;
	const glm::dvec3 warped;
	const glm::dvec2 p;
	const double wp;
	const double scale;
	glm::dvec2 slope = glm::dvec2(0.0);
	glm::dvec2 to_reference = glm::dvec2(0.0);
	double reference_w = 0;
	int solid_count = 0;
	double sum = 0;
	std::vector<std::array<int, DiscMasks::SAMPLE_COUNT>> counts;
};

} // namespace

double compute_count_visibility(const CountSpace &p_space, const CountReceiver &p_receiver,
		std::span<const CountEdge> p_edges, const LayerMap &p_layers,
		std::span<const DiscMasks> p_masks) {
	return Counter(p_space, p_receiver, p_layers, p_masks).compute(p_edges);
}

} // namespace gnomon
