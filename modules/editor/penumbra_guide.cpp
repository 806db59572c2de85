#include "modules/editor/penumbra_guide.h"

#include "modules/mesh_tools/silhouette.h"

#include <cmath>
#include <optional>

namespace gnomon {

namespace {

// Fractions of a ray's length, so that its start and end points do not count as hits.
const double AT_EDGE = 1e-3;
const double AT_RECEIVER = 5e-3;
/// A line longer than this many times its edge's image spans two receivers.
const double LONGEST_LINE = 3.0;

/// A silhouette edge in the world.
struct CasterEdge {
	const SceneRays::Instance *caster = nullptr;
	glm::dvec3 ends[2] = {};
	glm::dvec3 inside = glm::dvec3(0.0); // a point of the face that the light sees
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

/// Traces the rays of one light past the ends of edges.
class PenumbraTracer {
public:
	PenumbraTracer(SceneRays &r_rays, const SceneSnapshot &p_scene, const LightSnapshot &p_light) :
			rays(r_rays), scene(p_scene), light(p_light),
			is_directional(p_light.type == LightType::DIRECTIONAL) {}

	/// Returns where the ray from the rim past an end of the edge hits a receiver: outwards of the
	/// ray from the centre for p_width_m = r, inwards for -t. Returns nothing if it hits none, if
	/// the end is hidden from the light, or if the hit is out of the light's reach or hidden from
	/// the camera.
	std::optional<glm::dvec3> find_end(
			const CasterEdge &p_edge, const glm::dvec3 &p_end, double p_width_m) {
		const glm::dvec3 way = get_way(p_end);
		glm::dvec3 outwards = glm::cross(p_edge.ends[1] - p_edge.ends[0], way);
		const double length = glm::length(outwards);
		if (!(length > 0.0) || is_hidden_from_light(p_end, way)) {
			return std::nullopt;
		}
		outwards /= glm::dot(outwards, p_edge.inside - p_end) > 0.0 ? -length : length;
		// The ray passes through the edge from the opposite side of the rim.
		const glm::dvec3 turned = is_directional
				? way * scene.scene_size_m + p_width_m * outwards // R's tangent, times S
				: way + p_width_m * outwards;
		const std::optional<SceneRays::Hit> hit =
				rays.find_nearest(p_end, turned, AT_EDGE, p_edge.caster);
		if (!hit) {
			return std::nullopt;
		}
		const glm::dvec3 position = p_end + hit->t * turned;
		return is_lit(position) && !is_hidden_from_camera(position) ? std::optional(position)
																	: std::nullopt;
	}

	/// Whether the line is at most LONGEST_LINE times as long as the edge's image at that distance
	/// from the light.
	bool is_one_line(const CasterEdge &p_edge, const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
		const double grown = is_directional ? 1.0
											: glm::length(get_way(p_from)) /
						std::max(glm::length(get_way(p_edge.ends[0])), 1e-30);
		return glm::length(p_to - p_from) <=
				LONGEST_LINE * grown * glm::length(p_edge.ends[1] - p_edge.ends[0]);
	}

private:
	/// Returns the way from the light's centre; for a directional light, a unit vector.
	glm::dvec3 get_way(const glm::dvec3 &p_position) const {
		return is_directional ? light.get_direction_world() : p_position - light.position_world;
	}
	bool is_hidden_from_light(const glm::dvec3 &p_position, const glm::dvec3 &p_way) {
		if (is_directional) {
			return rays.find_nearest(p_position, -p_way, AT_EDGE * scene.scene_size_m).has_value();
		}
		const std::optional<SceneRays::Hit> hit = rays.find_nearest(light.position_world, p_way);
		return hit && hit->t < 1.0 - AT_EDGE;
	}
	bool is_hidden_from_camera(const glm::dvec3 &p_position) {
		const glm::dvec3 &eye = scene.camera.position_world;
		const std::optional<SceneRays::Hit> hit = rays.find_nearest(eye, p_position - eye);
		return hit && hit->t < 1.0 - AT_RECEIVER;
	}
	bool is_lit(const glm::dvec3 &p_position) const {
		const glm::dvec3 way = get_way(p_position);
		const double distance_m = glm::length(way);
		if (is_directional || distance_m == 0.0) {
			return true;
		}
		const bool is_in_range = light.range_m <= 0.0f || distance_m <= double(light.range_m);
		return is_in_range &&
				(light.type != LightType::SPOT ||
						glm::dot(way, light.get_direction_world()) >=
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
			const std::optional<glm::dvec3> from = tracer.find_end(edge, edge.ends[0], width_m);
			const std::optional<glm::dvec3> to =
					from ? tracer.find_end(edge, edge.ends[1], width_m) : std::nullopt;
			if (to && tracer.is_one_line(edge, *from, *to)) {
				lines.push_back({ *from, *to, is_outer });
			}
		}
	}
	return lines;
}

} // namespace gnomon
