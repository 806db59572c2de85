#include "modules/shadow_edge_count/count_in_double.h"

#include "modules/shadow_edge_count/count_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace gnomon {

namespace {

double cross(const glm::dvec2 &p_a, const glm::dvec2 &p_b) {
	return p_a.x * p_b.y - p_a.y * p_b.x;
}

bool is_in_front(const glm::dvec4 &p_plane, const glm::dvec3 &p_point) {
	return glm::dot(glm::dvec3(p_plane), p_point) + p_plane.w > 0.0;
}

int find_light_side(const CountSpace &p_space, const glm::dvec4 &p_plane) {
	const double reach =
			p_space.disc_radius * (p_space.is_directional ? glm::length(glm::dvec2(p_plane)) : 1.0);
	const double tolerance = p_space.is_directional ? SIDE_TOLERANCE_COSINE
													: SIDE_TOLERANCE_SIZES * p_space.scene_size_m;
	const double side = p_space.get_light_side(p_plane);
	return side > reach + tolerance ? 1 : side < -reach - tolerance ? -1 : 0;
}

/// Maps points to (X, d) as seen from a receiver: X / d is in the plane of the disc that faces it.
class Receiver {
public:
	Receiver(const CountSpace &p_space, const glm::dvec3 &p_position) :
			position(p_position), x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), to_light(0.0, 0.0, -1.0) {
		if (!p_space.is_directional) {
			const glm::dvec3 n = glm::normalize(p_position);
			// The same basis as in make_count_receiver, so that the points of the light are the
			// same.
			const double sign_z = n.z >= 0 ? 1.0 : -1.0;
			const double a = -1.0 / (sign_z + n.z);
			const double b = n.x * n.y * a;
			x = { 1.0 + sign_z * n.x * n.x * a, sign_z * b, -sign_z * n.x };
			y = { b, sign_z + n.y * n.y * a, -n.y };
			to_light = -p_position / glm::dot(p_position, p_position);
		}
	}
	glm::dvec3 find_offset(const glm::dvec3 &p_point) const {
		const glm::dvec3 o = p_point - position;
		return { glm::dot(x, o), glm::dot(y, o), glm::dot(to_light, o) };
	}

private:
	glm::dvec3 position;
	glm::dvec3 x;
	glm::dvec3 y;
	glm::dvec3 to_light;
};

/// Counts, for one receiver, the solids in front of each point of the light, and the area of the
/// disc behind edges.
class Counter {
public:
	Counter(const CountSpace &p_space, const glm::dvec3 &p_receiver,
			std::span<const DiscLookup> p_masks) :
			space(p_space),
			position(p_receiver), receiver(p_space, p_receiver), masks(p_masks),
			counts(p_masks.size()) {
		for (auto &samples : counts) {
			samples.fill(0);
		}
	}

	/// Returns what the edge adds to the mean number of solids, and its weight.
	std::pair<double, int> add_edge(const CountEdge &p_edge) {
		const int weight = p_edge.compute_weight(position);
		const glm::dvec3 a = receiver.find_offset(p_edge.a);
		const glm::dvec3 b = receiver.find_offset(p_edge.b);
		const double side = cross(glm::dvec2(a), glm::dvec2(b));
		const auto ends = cut(a, b);
		if (weight == 0 || side == 0 || !ends) {
			return { 0.0, weight };
		}
		const double before = area;
		const bool is_added = add_sector(weight < 0 ? ends->second : ends->first,
				weight < 0 ? ends->first : ends->second, weight < 0 ? -side : side,
				std::abs(weight));
		return { is_added ? area - before : 0.0, weight };
	}

	/// Adds the line along which a face crosses the disc's plane. p_uses_front_faces: of closed
	/// mesh parts, only faces with the receiver in front have such a line; otherwise, only those
	/// with the receiver behind. Returns whether there is such a line in the disc.
	bool add_cut(const CountFace &p_face, bool p_uses_front_faces) {
		const bool is_receiver_in_front = is_in_front(p_face.plane, position);
		if (!p_face.is_double_sided && is_receiver_in_front != p_uses_front_faces) {
			return false;
		}
		std::optional<glm::dvec2> leave;
		std::optional<glm::dvec2> enter;
		for (size_t corner = 0; corner < 3; ++corner) {
			const glm::dvec3 a = receiver.find_offset(p_face.corners[corner]);
			const glm::dvec3 b = receiver.find_offset(p_face.corners[(corner + 1) % 3]);
			if ((a.z < 1.0) != (b.z < 1.0)) {
				const glm::dvec3 cut = glm::mix(a, b, (1.0 - a.z) / (b.z - a.z));
				(a.z < 1.0 ? leave : enter) = glm::dvec2(cut) / space.disc_radius;
			}
		}
		if (!leave) {
			return false;
		}
		const bool is_between = is_receiver_in_front != (space.get_light_side(p_face.plane) > 0.0);
		return add_sector(is_receiver_in_front ? *leave : *enter,
				is_receiver_in_front ? *enter : *leave, is_between ? 1.0 : -1.0, 1);
	}

	double resolve(int p_solid_count) const {
		const double points = double(DiscMasks::SAMPLE_COUNT * masks.size());
		double hidden = 0;
		double sum = 0;
		double products = 0; // of the changes of the hidden state (0 or 1) and of the count
		double squares = 0;	 // of the change of the count
		bool overlaps = false;
		for (const auto &samples : counts) {
			for (uint32_t index = 0; index < DiscMasks::SAMPLE_COUNT; ++index) {
				const int count = p_solid_count + samples[index];
				const int other = p_solid_count + samples[(index + 2) % DiscMasks::SAMPLE_COUNT];
				hidden += count >= 1 ? 1 : 0;
				sum += count;
				const double change = std::min(std::abs(count - other), 15); // as sum_changes
				products += (count >= 1) != (other >= 1) ? change : 0;
				squares += change * change;
				overlaps = overlaps || count > 1;
			}
		}
		const double mean = p_solid_count + area;
		const double regression_slope = !overlaps ? 1.0 : squares > 0 ? products / squares : 0.0;
		hidden = overlaps ? hidden : sum; // without overlaps the result is 1 - mean
		return std::clamp(
				1.0 - hidden / points - regression_slope * (mean - sum / points), 0.0, 1.0);
	}

private:
	/// Clips an edge to what is nearer to the light than the receiver and in front of the light.
	/// Returns its ends projected to the disc's plane, in units of R, or nothing if none is left.
	std::optional<std::pair<glm::dvec2, glm::dvec2>> cut(
			const glm::dvec3 &p_a, const glm::dvec3 &p_b) const {
		const double minimum = space.nearer_tolerance;
		const double maximum = space.is_directional ? std::numeric_limits<double>::infinity() : 1.0;
		if (std::max(p_a.z, p_b.z) <= minimum || std::min(p_a.z, p_b.z) >= maximum) {
			return std::nullopt;
		}
		const auto move = [&](const glm::dvec3 &p_end, const glm::dvec3 &p_other) {
			const double d = std::clamp(p_end.z, minimum, maximum);
			return d == p_end.z ? p_end
								: glm::mix(p_end, p_other, (d - p_end.z) / (p_other.z - p_end.z));
		};
		const glm::dvec3 a = move(p_a, p_b);
		const glm::dvec3 b = move(p_b, p_a);
		return std::pair(glm::dvec2(a) / (a.z * space.disc_radius),
				glm::dvec2(b) / (b.z * space.disc_radius));
	}

	/// Adds the region of the disc beyond an edge, seen from the centre: a circular sector without
	/// its triangle. It is subtracted if p_side > 0. Limits for rounding: as in make_count_sectors.
	/// Returns whether there is such a region.
	bool add_sector(const glm::dvec2 &p_a, const glm::dvec2 &p_b, double p_side, int p_weight) {
		const glm::dvec2 edge_direction = p_b - p_a;
		if (glm::dot(edge_direction, edge_direction) < 1e-16) {
			return false;
		}
		const glm::dvec2 u = glm::normalize(edge_direction);
		const double distance = std::max(std::abs(cross(p_a, u)), 1e-20);
		if (distance >= 1) {
			return false;
		}
		const double half_chord = std::sqrt(1.0 - distance * distance);
		const double from = std::max(glm::dot(p_a, u), -half_chord);
		const double to = std::min(glm::dot(p_b, u), half_chord);
		if (to <= from) {
			return false;
		}
		const int sign = p_side > 0 ? -1 : 1;
		area += p_weight * sign * 0.5 *
				(std::atan2(to, distance) - std::atan2(from, distance) - distance * (to - from)) /
				std::numbers::pi;
		const glm::dvec2 beyond = p_side > 0 ? glm::dvec2(u.y, -u.x) : glm::dvec2(-u.y, u.x);
		const double middle = (p_side > 0 ? 0.5 : -0.5) * (from + to);
		for (size_t index = 0; index < masks.size(); ++index) {
			const DiscLookup &table = masks[index];
			const uint64_t mask = table.get_mask(beyond, distance, middle) &
					(p_side > 0 ? table.get_wedge(p_a, p_b) : table.get_wedge(p_b, p_a));
			for (uint32_t sample = 0; sample < DiscMasks::SAMPLE_COUNT; ++sample) {
				counts[index][sample] += (mask >> sample & 1) != 0 ? sign * p_weight : 0;
			}
		}
		return true;
	}

	const CountSpace &space;
	const glm::dvec3 position;
	const Receiver receiver;
	const std::span<const DiscLookup> masks;
	double area = 0; // as a fraction of the disc's area
	std::vector<std::array<int, DiscMasks::SAMPLE_COUNT>> counts;
};

} // namespace

int CountEdge::compute_weight(const glm::dvec3 &p_point) const {
	const int first = is_in_front(plane0, p_point) ? 1 : -1;
	const int sum = first - (is_in_front(plane1, p_point) ? 1 : -1);
	return !has_face1 ? first : is_double_sided ? sum : sum / 2;
}

void CountedCasters::add_mesh(const MeshTopology &p_topology, const glm::dmat4 &p_light_from_node,
		const CountSpace &p_space) {
	const bool is_mirrored = glm::determinant(glm::dmat3(p_light_from_node)) < 0;
	const auto to_light = [&](uint32_t p_vertex) {
		return glm::dvec3(
				p_light_from_node * glm::dvec4(p_topology.welded_positions_node[p_vertex], 1.0));
	};
	const size_t first = faces.size();
	for (uint32_t index = 0; index < p_topology.get_face_count(); ++index) {
		CountFace face;
		for (size_t corner = 0; corner < 3; ++corner) {
			face.corners[corner] = to_light(p_topology.triangles[3 * size_t(index) + corner]);
		}
		if (is_mirrored) {
			std::swap(face.corners[1], face.corners[2]);
		}
		const glm::dvec3 normal =
				glm::cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
		const double length = glm::length(normal);
		if (length > 0) {
			const glm::dvec3 unit = normal / length;
			face.plane = glm::dvec4(unit, -glm::dot(unit, face.corners[0]));
		}
		face.is_double_sided = p_topology.is_double_sided(index);
		faces.push_back(face);
	}
	std::vector<glm::dvec4> planes;
	for (const uint32_t plane_face : p_topology.plane_faces) {
		planes.push_back(faces[first + plane_face].plane);
	}
	for (size_t index = 0; index < planes.size(); ++index) {
		faces[first + index].plane = planes[index];
	}
	for (const MeshEdge &mesh_edge : p_topology.edges) {
		CountEdge edge;
		edge.is_double_sided = p_topology.is_double_sided(mesh_edge.face0);
		edge.face0 = static_cast<uint32_t>(first + mesh_edge.face0);
		edge.has_face1 = mesh_edge.face1 != NO_FACE;
		edge.plane0 = faces[first + mesh_edge.face0].plane;
		if (edge.has_face1) {
			edge.plane1 =
					faces[first + mesh_edge.face1].plane * (mesh_edge.is_inconsistent ? -1.0 : 1.0);
			const int side = find_light_side(p_space, edge.plane0);
			// An edge between coplanar faces is never a silhouette.
			if (mesh_edge.is_coplanar ||
					(side != 0 && side == find_light_side(p_space, edge.plane1))) {
				continue;
			}
		}
		edge.a = to_light(is_mirrored ? mesh_edge.b : mesh_edge.a);
		edge.b = to_light(is_mirrored ? mesh_edge.a : mesh_edge.b);
		edges.push_back(edge);
	}
}

namespace {

/// Numbers of faces that the segment from a receiver to the light's centre crosses.
struct Crossings {
	int back_facing = 0;
	int light_facing = 0;
	int double_sided = 0;

	/// See sum_crossings in count_faces_inc.glsl.
	int get_solid_count() const { return double_sided + std::max(back_facing, light_facing); }
};

/// r_details: gets the faces; may be null.
Crossings count_crossings(const CountSpace &p_space, const glm::dvec3 &p_receiver,
		std::span<const CountFace> p_faces, CountDetails *r_details = nullptr) {
	const Receiver receiver(p_space, p_receiver);
	Crossings found;
	for (size_t index = 0; index < p_faces.size(); ++index) {
		const CountFace &face = p_faces[index];
		const bool is_receiver_in_front = is_in_front(face.plane, p_receiver);
		if (is_receiver_in_front == (p_space.get_light_side(face.plane) > 0.0)) {
			continue;
		}
		bool is_left[3];
		for (int corner = 0; corner < 3; ++corner) {
			is_left[corner] =
					cross(glm::dvec2(receiver.find_offset(face.corners[corner])),
							glm::dvec2(receiver.find_offset(face.corners[(corner + 1) % 3]))) > 0;
		}
		if (is_left[0] != is_left[1] || is_left[0] != is_left[2]) {
			continue;
		}
		++(face.is_double_sided				   ? found.double_sided
						: is_receiver_in_front ? found.back_facing
											   : found.light_facing);
		if (r_details != nullptr) {
			r_details->crossed_faces.push_back(index);
		}
	}
	return found;
}

} // namespace

int count_solids_in_double(const CountSpace &p_space, const glm::dvec3 &p_receiver,
		std::span<const CountFace> p_faces) {
	return count_crossings(p_space, p_receiver, p_faces).get_solid_count();
}

double compute_count_visibility(const CountSpace &p_space, const glm::dvec3 &p_receiver,
		std::span<const CountEdge> p_edges, std::span<const CountFace> p_faces,
		std::span<const DiscLookup> p_masks, CountDetails *r_details) {
	CountDetails details;
	Counter counter(p_space, p_receiver, p_masks);
	const Crossings crossings = count_crossings(p_space, p_receiver, p_faces, &details);
	details.solid_count = crossings.get_solid_count();
	if (p_space.disc_radius > 0) {
		for (size_t index = 0; index < p_edges.size(); ++index) {
			const auto [area, weight] = counter.add_edge(p_edges[index]);
			if (area != 0) {
				details.edges.push_back({ index, weight, area });
			}
		}
		for (size_t index = 0; index < p_faces.size() && !p_space.is_directional; ++index) {
			if (counter.add_cut(p_faces[index], crossings.back_facing >= crossings.light_facing)) {
				details.cut_faces.push_back(index);
			}
		}
	}
	if (r_details != nullptr) {
		*r_details = std::move(details);
	}
	return counter.resolve(crossings.get_solid_count());
}

double trace_count_visibility(const CountSpace &p_space, const glm::dvec3 &p_receiver,
		std::span<const CountFace> p_faces, uint32_t p_ray_count) {
	// In (X, d), see Receiver, the ray to a point s of the disc is d (R s, 1), 0 < d < 1.
	const Receiver receiver(p_space, p_receiver);
	const double radius = p_space.disc_radius;
	const double end = p_space.is_directional ? std::numeric_limits<double>::infinity() : 1.0;
	struct Triangle {
		glm::dvec3 a;
		glm::dvec3 ab;
		glm::dvec3 ac;
	};
	std::vector<Triangle> triangles; // that some ray may meet
	for (const CountFace &face : p_faces) {
		glm::dvec3 corners[3];
		std::array<bool, 6> is_outside;
		is_outside.fill(true);
		for (size_t corner = 0; corner < 3; ++corner) {
			const glm::dvec3 offset = corners[corner] = receiver.find_offset(face.corners[corner]);
			const double reach = radius * offset.z;
			const bool outside[] = { offset.z <= 0, offset.z >= end, offset.x > reach,
				offset.x<-reach, offset.y> reach, offset.y < -reach };
			for (size_t plane = 0; plane < is_outside.size(); ++plane) {
				is_outside[plane] = is_outside[plane] && outside[plane];
			}
		}
		if (std::ranges::none_of(is_outside, [](bool p_is_outside) { return p_is_outside; })) {
			triangles.push_back({ corners[0], corners[1] - corners[0], corners[2] - corners[0] });
		}
	}
	uint32_t seen_count = 0;
	for (uint32_t ray = 0; ray < p_ray_count; ++ray) {
		const double distance = radius * std::sqrt((ray + 0.5) / p_ray_count);
		const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
		const glm::dvec3 direction(distance * std::cos(golden_angle * ray),
				distance * std::sin(golden_angle * ray), 1.0);
		// Möller and Trumbore 1997.
		const bool is_hidden = std::ranges::any_of(triangles, [&](const Triangle &p_triangle) {
			const glm::dvec3 h = glm::cross(direction, p_triangle.ac);
			const double determinant = glm::dot(p_triangle.ab, h);
			if (determinant == 0) {
				return false;
			}
			const glm::dvec3 s = -p_triangle.a / determinant;
			const double b = glm::dot(s, h);
			const glm::dvec3 q = glm::cross(s, p_triangle.ab);
			const double c = glm::dot(direction, q);
			const double d = glm::dot(p_triangle.ac, q);
			return b >= 0 && c >= 0 && b + c <= 1 && d > 0 && d < end;
		});
		seen_count += is_hidden ? 0 : 1;
	}
	return p_ray_count == 0 ? 1.0 : double(seen_count) / p_ray_count;
}

} // namespace gnomon
