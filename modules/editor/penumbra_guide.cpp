#include "modules/editor/penumbra_guide.h"

#include "modules/mesh_tools/silhouette.h"

#include <cmath>
#include <optional>

namespace gnomon {

namespace {

// Hits this close to the end of a ray on a surface are ignored: at a silhouette edge as a fraction
// of the distance to the light's centre (directional: of the scene size S), at a receiver as a
// fraction of the distance to the camera.
const double EDGE_EPSILON = 1e-3;
const double RECEIVER_EPSILON = 5e-3;
/// A line that is more than this many times as long as the projection of its edge is assumed to
/// span two receivers, and is omitted.
const double MAX_LINE_RATIO = 3.0;

/// A silhouette edge of a caster, in world space.
struct CasterEdge {
	const SceneRays::Instance *caster = nullptr;
	glm::dvec3 ends[2] = {};
	/// Third vertex of the edge's light-facing triangle, or of its only triangle.
	glm::dvec3 inside = glm::dvec3(0.0);
};

std::vector<CasterEdge> collect_edges(const SceneRays &p_rays, const LightSnapshot &p_light) {
	std::vector<CasterEdge> edges;
	const glm::dvec4 light_world = p_light.type == LightType::DIRECTIONAL
			? glm::dvec4(-p_light.get_direction_world(), 0.0)
			: glm::dvec4(p_light.position_world, 1.0);
	for (const SceneRays::Instance &instance : p_rays.get_instances()) {
		if (!instance.casts_shadow) {
			continue;
		}
		const auto topology = get_topology(instance.mesh);
		const Silhouette silhouette =
				build_silhouette(*topology, instance.node_from_world * light_world);
		const auto get_world = [&](uint32_t p_vertex) {
			return glm::dvec3(instance.world_from_node *
					glm::dvec4(topology->welded_positions_node[p_vertex], 1.0));
		};
		for (const SilhouetteEdge &edge : silhouette.edges) {
			const MeshEdge &faces = topology->edges[edge.edge_index];
			const bool is_second = faces.face1 != NO_FACE && !silhouette.is_facing[faces.face0];
			const uint32_t face = is_second ? faces.face1 : faces.face0;
			uint32_t third = edge.from;
			for (uint32_t corner = 0; corner < 3; ++corner) {
				const uint32_t vertex = topology->triangles[3 * size_t(face) + corner];
				third = vertex != edge.from && vertex != edge.to ? vertex : third;
			}
			edges.push_back(
					{ &instance, { get_world(edge.from), get_world(edge.to) }, get_world(third) });
		}
	}
	return edges;
}

/// Casts the rays that touch the ends of silhouette edges, for one light.
class PenumbraTracer {
public:
	PenumbraTracer(SceneRays &r_rays, const SceneSnapshot &p_scene, const LightSnapshot &p_light) :
			rays(r_rays), scene(p_scene), light(p_light),
			is_directional(p_light.type == LightType::DIRECTIONAL) {}

	/// Returns the point of the penumbra's edge that an end of a silhouette edge casts on a
	/// receiver. p_width_m: r for the outer edge, -t for the inner one, see find_penumbra_lines.
	/// Returns nothing if the ray hits no receiver, if the end is hidden from the light, or if the
	/// hit is outside the light's cone or range, or hidden from the camera.
	std::optional<glm::dvec3> find_penumbra_point(
			const CasterEdge &p_edge, const glm::dvec3 &p_end, double p_width_m) {
		const glm::dvec3 from_light = get_light_vector(p_end);
		glm::dvec3 outwards = glm::cross(p_edge.ends[1] - p_edge.ends[0], from_light);
		const double length = glm::length(outwards);
		if (!(length > 0.0) || is_hidden_from_light(p_end, from_light)) {
			return std::nullopt;
		}
		// Makes it a unit vector that points away from the triangle.
		outwards /= glm::dot(outwards, p_edge.inside - p_end) > 0.0 ? -length : length;
		// To pass the edge in the direction of `outwards`, the ray starts on the opposite side of
		// the light's centre.
		const glm::dvec3 ray_direction = is_directional ? from_light * scene.scene_size_m +
						p_width_m * outwards // tangent of the angle: width / S
														: from_light + p_width_m * outwards;
		const std::optional<SceneRays::Hit> hit =
				rays.find_nearest(p_end, ray_direction, EDGE_EPSILON, p_edge.caster);
		if (!hit) {
			return std::nullopt;
		}
		const glm::dvec3 position = p_end + hit->t * ray_direction;
		return is_in_light_range(position) && !is_hidden_from_camera(position)
				? std::optional(position)
				: std::nullopt;
	}

	/// Whether the line is at most MAX_LINE_RATIO times as long as the edge projected from the
	/// light to the line's distance.
	bool spans_one_receiver(
			const CasterEdge &p_edge, const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
		const double scale = is_directional ? 1.0
											: glm::length(get_light_vector(p_from)) /
						std::max(glm::length(get_light_vector(p_edge.ends[0])), 1e-30);
		return glm::length(p_to - p_from) <=
				MAX_LINE_RATIO * scale * glm::length(p_edge.ends[1] - p_edge.ends[0]);
	}

private:
	/// Returns the vector from the light's centre to a point; for a directional light, its unit
	/// direction.
	glm::dvec3 get_light_vector(const glm::dvec3 &p_position) const {
		return is_directional ? light.get_direction_world() : p_position - light.position_world;
	}
	bool is_hidden_from_light(const glm::dvec3 &p_position, const glm::dvec3 &p_from_light) {
		if (is_directional) {
			return rays.find_nearest(p_position, -p_from_light, EDGE_EPSILON * scene.scene_size_m)
					.has_value();
		}
		const std::optional<SceneRays::Hit> hit =
				rays.find_nearest(light.position_world, p_from_light);
		return hit && hit->t < 1.0 - EDGE_EPSILON;
	}
	bool is_hidden_from_camera(const glm::dvec3 &p_position) {
		const glm::dvec3 &eye = scene.camera.position_world;
		const std::optional<SceneRays::Hit> hit = rays.find_nearest(eye, p_position - eye);
		return hit && hit->t < 1.0 - RECEIVER_EPSILON;
	}
	/// Whether the point is inside the light's cone and range.
	bool is_in_light_range(const glm::dvec3 &p_position) const {
		const glm::dvec3 from_light = get_light_vector(p_position);
		const double distance_m = glm::length(from_light);
		if (is_directional || distance_m == 0.0) {
			return true;
		}
		const bool is_in_range = light.range_m <= 0.0f || distance_m <= double(light.range_m);
		return is_in_range &&
				(light.type != LightType::SPOT ||
						glm::dot(from_light, light.get_direction_world()) >=
								distance_m * std::cos(double(light.outer_cone_rad)));
	}

	SceneRays &rays;
	const SceneSnapshot &scene;
	const LightSnapshot &light;
	bool is_directional;
};

} // namespace

std::vector<PenumbraLine> find_penumbra_lines(SceneRays &r_rays, const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, size_t p_edge_count) {
	std::vector<PenumbraLine> lines;
	const double outer_m = double(p_light.penumbra_outer_width_m);
	const double inner_m = double(p_light.penumbra_inner_width_m);
	if (!p_light.casts_shadow || (outer_m <= 0.0 && inner_m <= 0.0)) {
		return lines;
	}
	const std::vector<CasterEdge> edges = collect_edges(r_rays, p_light);
	PenumbraTracer tracer(r_rays, p_scene, p_light);
	const size_t step = std::max<size_t>(1, (edges.size() + p_edge_count - 1) / p_edge_count);
	for (size_t index = 0; index < edges.size(); index += step) {
		const CasterEdge &edge = edges[index];
		for (const bool is_outer : { true, false }) {
			const double width_m = is_outer ? outer_m : -inner_m;
			const std::optional<glm::dvec3> from =
					tracer.find_penumbra_point(edge, edge.ends[0], width_m);
			const std::optional<glm::dvec3> to =
					from ? tracer.find_penumbra_point(edge, edge.ends[1], width_m) : std::nullopt;
			if (to && tracer.spans_one_receiver(edge, *from, *to)) {
				lines.push_back({ *from, *to, is_outer });
			}
		}
	}
	return lines;
}

} // namespace gnomon
