#include "modules/shadow_edge_count/count_casters.h"

#include "modules/core/error.h"
#include "modules/scene/cut_levels.h"
#include "modules/scene/node_transform.h"
#include "modules/shadows/mesh_store.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace gnomon {

namespace {

// With more triangles, casters have no second level of detail, so that this level does not make
// buffers exceed the device's maximum size.
constexpr uint64_t MAX_COUNT_WITH_LEVELS = 1'000'000;

const double SIDE_TOLERANCE_SIZES = 2.5e-7; // maximum shift of a plane by rounding, in S
const double SIDE_TOLERANCE_COSINE = 1e-6;	// the same for a directional light, as a cosine

/// Lower bound of the distance of a point from the instance's casters: from their box along the
/// world's axes, and from the planes of their box along the node's axes.
double compute_min_distance_m(const InstanceSnapshot &p_instance, const glm::dvec3 &p_point_world) {
	const glm::dmat4 node_from_world = glm::inverse(p_instance.world_from_node);
	const glm::dmat3 rows = glm::transpose(glm::dmat3(node_from_world));
	const glm::dvec3 point_node(node_from_world * glm::dvec4(p_point_world, 1.0));
	const Bounds &box = p_instance.caster_bounds_node;
	const glm::dvec3 gap_node =
			glm::max(glm::dvec3(box.minimum) - point_node, point_node - glm::dvec3(box.maximum));
	double distance_m = p_instance.bounds_world.compute_distance(p_point_world);
	for (int axis = 0; axis < 3; ++axis) {
		distance_m = std::max(distance_m, gap_node[axis] / glm::length(rows[axis]));
	}
	return distance_m;
}

/// A mesh that casts an instance's shadow, one of two if the instance has levels of detail.
struct CasterMesh {
	std::shared_ptr<const Mesh> mesh;
	double first_half_width_m = 0; // see shader::CountCasterPush
	double end_half_width_m = std::numeric_limits<double>::infinity();
};

/// The instance's caster mesh and, for receivers that see a wide penumbra, a coarser level of
/// detail. Only at rest: a pose moves vertices out of the bounds of their source part.
std::vector<CasterMesh> list_caster_meshes(const InstanceSnapshot &p_instance,
		const LightSnapshot &p_light, const Bounds &p_scene_bounds, double p_disc_radius) {
	std::vector<CasterMesh> meshes(1, { p_instance.caster_mesh });
	if (!p_instance.caster_levels || p_instance.pose || p_disc_radius <= 0) {
		return meshes;
	}
	const CutLevels &levels = *p_instance.caster_levels;
	const double half_width = p_instance.compute_max_penumbra_half_width(p_light, p_scene_bounds);
	const uint32_t level = levels.choose_level(half_width);
	const uint32_t coarse_level = levels.choose_coarse_level(level, half_width);
	std::shared_ptr<const Mesh> mesh =
			coarse_level > level ? levels.get_mesh(coarse_level) : nullptr;
	const double limit_m = levels.get_min_half_width(coarse_level) *
			compute_max_stretch(p_instance.world_from_node);
	// No penumbra of a point light is wider than the light, measured at the caster.
	if (mesh && (p_light.type == LightType::DIRECTIONAL || limit_m < p_disc_radius)) {
		meshes[0].end_half_width_m = limit_m;
		meshes.push_back({ std::move(mesh), limit_m });
	}
	return meshes;
}

/// The sum of both. Throws an Error if it exceeds MAX_CASTER_FACES.
uint32_t add_checked(
		uint32_t p_sum, uint32_t p_count, const char *p_what, const std::string &p_light) {
	if (p_count > MAX_CASTER_FACES - p_sum) {
		fail_capacity("Light \"", p_light, "\": its casters have more than ", MAX_CASTER_FACES, " ",
				p_what, ", which is the most for edge_count. Let fewer meshes cast shadows.");
	}
	return p_sum + p_count;
}

/// Bit i is set if view i may see the instance.
uint32_t find_seeing_views(const ShadowTechnique::Inputs &p_inputs, uint32_t p_instance) {
	uint32_t views = 0;
	for (size_t view = 0; view < p_inputs.views.size(); ++view) {
		const std::vector<uint32_t> &seen = p_inputs.casters[view].instances; // in order
		views |= std::binary_search(seen.begin(), seen.end(), p_instance) ? 1u << view : 0u;
	}
	return views;
}

uint32_t count_words(uint32_t p_edge_count) {
	return (p_edge_count + EDGE_COUNT_EDGES_PER_WORD - 1) / EDGE_COUNT_EDGES_PER_WORD;
}

/// Adds one mesh of an instance, also to the pools of meshes where needed. p_caster has what all
/// its meshes have in common. False if the mesh has no faces.
bool add_caster(const ShadowTechnique::Inputs &p_inputs, const CasterMesh &p_level,
		CountCaster p_caster, CountCasters &r_casters) {
	CountMeshPools &pools = p_inputs.meshes.get_shared<CountMeshPools>();
	const CountGpuMesh &gpu = pools.get(p_inputs.meshes, p_level.mesh);
	p_caster.face_count = gpu.faces.get_count() / EDGE_COUNT_MESH_FACE_ITEMS;
	if (p_caster.face_count == 0) {
		return false;
	}
	p_caster.mesh_id = p_level.mesh->id;
	shader::CountCasterRecord &record = p_caster.record;
	record.edge_count = gpu.edges.get_count();
	record.first_mesh_face = gpu.faces.get_first();
	record.first_mesh_edge = gpu.edges.get_first();
	record.first_vertex = gpu.points.get_first();
	record.first_source_part = gpu.get_first_source_part();
	if (p_level.mesh->rest) {
		p_caster.posed = pools.get_posed(p_inputs.meshes, p_level.mesh);
		p_caster.posed_positions =
				p_inputs.meshes.get_topology(p_level.mesh, TopologyBuffer::POSITIONS)
						.positions.get();
		record.first_vertex = p_caster.posed->points.get_first();
	}
	p_caster.word_count = count_words(record.edge_count);
	record.first_face = r_casters.face_count;
	record.first_word = r_casters.word_count;
	record.first_half_width = static_cast<float>(p_level.first_half_width_m);
	record.end_half_width = static_cast<float>(p_level.end_half_width_m);
	r_casters.face_count = add_checked(
			r_casters.face_count, p_caster.face_count, "triangles", p_inputs.light.name);
	r_casters.edge_count =
			add_checked(r_casters.edge_count, record.edge_count, "edges", p_inputs.light.name);
	r_casters.word_count += p_caster.word_count;
	r_casters.casters.push_back(std::move(p_caster));
	return true;
}

} // namespace

bool CountCasters::has_layout_of(const CountCasters &p_other) const {
	return std::equal(casters.begin(), casters.end(), p_other.casters.begin(),
			p_other.casters.end(), [](const CountCaster &p_a, const CountCaster &p_b) {
				return p_a.mesh_id == p_b.mesh_id && p_a.record.flags == p_b.record.flags;
			});
}

CountCasters build_count_casters(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_indices, double p_disc_radius, CasterOrder &r_order) {
	const LightView &first = p_inputs.views.front();
	const bool is_directional = first.is_orthographic;
	const double WIDENING = 1.01; // for rounding
	const glm::dvec3 light_world(glm::inverse(first.view_from_world)[3]);
	CountCasters result;
	result.casters.reserve(p_indices.size());
	result.disc_radius = p_disc_radius;
	result.side_tolerance =
			static_cast<float>(is_directional ? SIDE_TOLERANCE_COSINE
											  : SIDE_TOLERANCE_SIZES * p_inputs.scene.scene_size_m);
	const Bounds &scene_bounds = p_inputs.scene_bounds_world;
	uint32_t views_with_faces = 0;
	uint64_t triangle_count = 0;
	std::vector<OrderedCaster> ordered;
	ordered.reserve(p_indices.size());
	for (const uint32_t index : p_indices) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		const auto count = static_cast<uint32_t>(instance.caster_mesh->get_triangle_count());
		triangle_count += count;
		ordered.push_back({ instance.bounds_world, count }); // about one edge per triangle
	}
	const bool may_have_levels = triangle_count <= MAX_COUNT_WITH_LEVELS;
	for (const uint32_t ordered_index : r_order.update(ordered, p_inputs.may_reuse)) {
		const uint32_t index = p_indices[ordered_index];
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		const double volume = glm::determinant(glm::dmat3(instance.world_from_node));
		if (volume == 0 || !std::isfinite(volume)) {
			++result.collapsed_instance_count;
			continue;
		}
		const std::vector<CasterMesh> meshes = may_have_levels
				? list_caster_meshes(instance, p_inputs.light, scene_bounds, p_disc_radius)
				: std::vector<CasterMesh>(1, { instance.caster_mesh });
		CountCaster caster;
		caster.pose_hash = instance.get_pose_hash();
		caster.views = find_seeing_views(p_inputs, index);
		caster.record.light_from_node = first.view_from_world * instance.world_from_node;
		caster.record.flags = (volume < 0 ? EDGE_COUNT_CASTER_MIRRORED : 0u) |
				(meshes.size() > 1 ? EDGE_COUNT_CASTER_LEVEL : 0u);
		caster.record.scale = static_cast<float>(compute_max_stretch(instance.world_from_node));
		bool has_faces = false;
		for (const CasterMesh &level : meshes) {
			if (add_caster(p_inputs, level, caster, result)) {
				has_faces = true;
			}
		}
		if (has_faces) {
			views_with_faces |= caster.views;
			result.may_cut_disc = result.may_cut_disc ||
					(!is_directional && p_disc_radius > 0 &&
							compute_min_distance_m(instance, light_world) <=
									WIDENING * p_disc_radius);
		}
	}
	result.empty_views = ~views_with_faces & ~0u >> (32 - p_inputs.views.size());
	return result;
}

void compare_casters(const CountCasters &p_before, CountCasters &r_casters) {
	for (size_t index = 0; index < r_casters.casters.size(); ++index) {
		CountCaster &caster = r_casters.casters[index];
		const CountCaster &before = p_before.casters[index];
		caster.is_moved = caster.record.light_from_node != before.record.light_from_node ||
				caster.pose_hash != before.pose_hash;
	}
}

} // namespace gnomon
