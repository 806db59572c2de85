#include "modules/shadow_edge_count/count_casters.h"

#include "modules/core/error.h"
#include "modules/scene/cut_levels.h"
#include "modules/scene/node_transform.h"
#include "modules/shadows/mesh_store.h"
#include "modules/shadows/scene_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace gnomon {

namespace {

// With more triangles, casters have no second LOD, so that this level does not make
// buffers exceed the device's maximum size.
constexpr uint64_t MAX_COUNT_WITH_LODS = 1'000'000;

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

/// A mesh that casts an instance's shadow, one of two if the instance has LODs.
struct CasterMesh {
	std::shared_ptr<const Mesh> mesh;
	double first_half_width_m = 0; // see shader::CountCasterPush
	double end_half_width_m = std::numeric_limits<double>::infinity();
};

/// The instance's caster mesh and, for receivers that see a wide penumbra, a coarser LOD.
/// Only at rest: a pose moves vertices out of the bounds of their source part.
std::vector<CasterMesh> list_caster_meshes(const InstanceSnapshot &p_instance,
		const LightSnapshot &p_light, const Bounds &p_scene_bounds, double p_disc_radius) {
	std::vector<CasterMesh> meshes;
	meshes.push_back({ p_instance.caster_mesh });
	if (!p_instance.caster_levels || p_instance.pose || p_disc_radius <= 0) {
		return meshes;
	}
	const CutLevels &levels = *p_instance.caster_levels;
	const double half_width = p_instance.compute_max_penumbra_half_width(p_light, p_scene_bounds);
	const uint32_t lod = levels.choose_level(half_width);
	const uint32_t coarse_lod = levels.choose_coarse_level(lod, half_width);
	std::shared_ptr<const Mesh> mesh = coarse_lod > lod ? levels.get_mesh(coarse_lod) : nullptr;
	const double limit_m =
			levels.get_min_half_width(coarse_lod) * compute_max_stretch(p_instance.world_from_node);
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

/// What the casters of all instances have in common.
struct CasterMaker {
	const ShadowTechnique::Inputs &inputs;
	double disc_radius;
	bool may_have_lods;

	/// Makes the casters of an instance, except for their places among all faces and edges, and
	/// adds their meshes to the pools of meshes where needed. None if its meshes have no faces.
	std::vector<RecordedCaster> make(uint32_t p_instance) const;

private:
	bool set_mesh(const CasterMesh &p_level, RecordedCaster &r_recorded) const;
};

/// False if the mesh has no faces.
bool CasterMaker::set_mesh(const CasterMesh &p_level, RecordedCaster &r_recorded) const {
	CountCaster &caster = r_recorded.caster;
	CountMeshPools &pools = inputs.meshes.get_shared<CountMeshPools>();
	const CountGpuMesh &gpu = pools.get(inputs.meshes, p_level.mesh);
	caster.face_count = gpu.faces.get_count() / EDGE_COUNT_MESH_FACE_ITEMS;
	caster.mesh = p_level.mesh;
	shader::CountCasterRecord &record = r_recorded.record;
	record.edge_count = gpu.edges.get_count();
	record.first_mesh_face = gpu.faces.get_first();
	record.first_mesh_edge = gpu.edges.get_first();
	record.first_vertex = gpu.points.get_first();
	record.first_source_part = gpu.get_first_source_part();
	if (caster.face_count > 0 && p_level.mesh->rest) {
		caster.posed = pools.get_posed(inputs.meshes, p_level.mesh);
		caster.posed_positions =
				inputs.meshes.get_topology(p_level.mesh, TopologyBuffer::POSITIONS).positions.get();
		record.first_vertex = caster.posed->points.get_first();
	}
	caster.word_count = count_words(record.edge_count);
	record.first_half_width = static_cast<float>(p_level.first_half_width_m);
	record.end_half_width = static_cast<float>(p_level.end_half_width_m);
	caster.is_coarse = p_level.first_half_width_m > 0;
	return caster.face_count > 0;
}

std::vector<RecordedCaster> CasterMaker::make(uint32_t p_instance) const {
	const double WIDENING = 1.01; // for rounding
	const InstanceSnapshot &instance = inputs.scene.instances[p_instance];
	const LightView &first_view = inputs.views.front();
	const std::vector<CasterMesh> meshes = may_have_lods
			? list_caster_meshes(instance, inputs.light, inputs.summary.get_bounds(), disc_radius)
			: std::vector<CasterMesh>(1, { instance.caster_mesh });
	RecordedCaster recorded;
	CountCaster &caster = recorded.caster;
	caster.instance = p_instance;
	caster.pose_hash = instance.get_pose_hash();
	caster.views = find_seeing_views(inputs, p_instance);
	recorded.record.light_from_node = first_view.view_from_world * instance.world_from_node;
	recorded.record.flags = (instance.is_mirrored() ? EDGE_COUNT_CASTER_MIRRORED : 0u) |
			(meshes.size() > 1 ? EDGE_COUNT_CASTER_LOD : 0u);
	recorded.record.scale = static_cast<float>(compute_max_stretch(instance.world_from_node));
	caster.may_cut_disc = !first_view.is_orthographic && disc_radius > 0 &&
			compute_min_distance_m(instance, glm::inverse(first_view.view_from_world)[3]) <=
					WIDENING * disc_radius;
	std::vector<RecordedCaster> casters;
	for (const CasterMesh &level : meshes) {
		if (set_mesh(level, recorded)) {
			casters.push_back(recorded);
		}
	}
	return casters;
}

/// Whether a caster, p_index of p_before, was elsewhere there, or in another pose.
bool has_moved(const CountCasters &p_before, uint32_t p_index, const CountCaster &p_caster,
		const shader::CountCasterRecord &p_record) {
	return p_record.light_from_node != p_before.records[p_index].light_from_node ||
			p_caster.pose_hash != p_before.casters[p_index].pose_hash;
}

/// Whether both make the same casters for a light.
bool is_same_caster(const InstanceSnapshot &p_before, const InstanceSnapshot &p_instance) {
	return p_before.world_from_node == p_instance.world_from_node &&
			p_before.caster_mesh == p_instance.caster_mesh &&
			p_before.caster_levels == p_instance.caster_levels &&
			p_before.get_pose_hash() == p_instance.get_pose_hash() &&
			p_before.bounds_world.minimum == p_instance.bounds_world.minimum &&
			p_before.bounds_world.maximum == p_instance.bounds_world.maximum;
}

bool is_collapsed(const InstanceSnapshot &p_instance) {
	const double volume = glm::determinant(glm::dmat3(p_instance.world_from_node));
	return volume == 0 || !std::isfinite(volume);
}

/// Sets what some casters have and the others lack.
void sum_up(CountCasters &r_casters) {
	uint32_t views_with_faces = 0;
	r_casters.may_cut_disc = false;
	r_casters.has_lods = false;
	for (const CountCaster &caster : r_casters.casters) {
		views_with_faces |= caster.views;
		r_casters.may_cut_disc |= caster.may_cut_disc;
		r_casters.has_lods |= r_casters.instances[caster.instance].caster_levels != nullptr;
	}
	r_casters.empty_views = ~views_with_faces & ~0u >> (32 - r_casters.view_count);
}

} // namespace

bool CountCasters::has_layout_of(const CountCasters &p_other) const {
	return std::equal(casters.begin(), casters.end(), p_other.casters.begin(),
				   p_other.casters.end(),
				   [](const CountCaster &p_a, const CountCaster &p_b) {
					   return p_a.mesh == p_b.mesh;
				   }) &&
			std::equal(records.begin(), records.end(), p_other.records.begin(),
					[](const shader::CountCasterRecord &p_a, const shader::CountCasterRecord &p_b) {
						return p_a.flags == p_b.flags;
					});
}

void CountCasters::add(const std::string &p_light, RecordedCaster p_caster) {
	CountCaster &caster = p_caster.caster;
	shader::CountCasterRecord &record = p_caster.record;
	const auto index = static_cast<uint32_t>(casters.size());
	record.first_face = face_count;
	record.first_word = word_count;
	add_work_items(index, { face_count, caster.face_count }, face_groups);
	add_work_items(index, { word_count, caster.word_count }, word_groups);
	face_count = add_checked(face_count, caster.face_count, "triangles", p_light);
	edge_count = add_checked(edge_count, record.edge_count, "edges", p_light);
	word_count += caster.word_count;
	coarse_count += caster.is_coarse ? 1 : 0;
	if (caster.posed) {
		posed.push_back(index);
	}
	moved.push_back(index);
	records.push_back(record);
	casters.push_back(std::move(caster));
}

CountCasters build_count_casters(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_indices, double p_disc_radius, CasterOrder &r_order) {
	CountCasters result;
	result.casters.reserve(p_indices.size());
	result.disc_radius = p_disc_radius;
	result.side_tolerance = static_cast<float>(p_inputs.views.front().is_orthographic
					? SIDE_TOLERANCE_COSINE
					: SIDE_TOLERANCE_SIZES * p_inputs.scene.scene_size_m);
	result.instances = p_inputs.scene.instances;
	result.indices = p_indices;
	result.first_casters.assign(result.instances.size(), CountCasters::NO_CASTER);
	result.scene_bounds_world = p_inputs.summary.get_bounds();
	result.view_count = static_cast<uint32_t>(p_inputs.views.size());
	uint64_t triangle_count = 0;
	std::vector<OrderedCaster> ordered;
	ordered.reserve(p_indices.size());
	for (const uint32_t index : p_indices) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		const auto count = static_cast<uint32_t>(instance.caster_mesh->get_triangle_count());
		triangle_count += count;
		ordered.push_back({ instance.bounds_world, count }); // about one edge per triangle
	}
	result.may_have_lods = triangle_count <= MAX_COUNT_WITH_LODS;
	const CasterMaker maker = { p_inputs, p_disc_radius, result.may_have_lods };
	for (const uint32_t ordered_index : r_order.update(std::move(ordered), p_inputs.may_reuse)) {
		const uint32_t index = p_indices[ordered_index];
		if (is_collapsed(p_inputs.scene.instances[index])) {
			++result.collapsed_instance_count;
			continue;
		}
		for (RecordedCaster &caster : maker.make(index)) {
			uint32_t &first = result.first_casters[index];
			first = std::min(first, static_cast<uint32_t>(result.casters.size()));
			result.add(p_inputs.light.name, std::move(caster));
		}
	}
	sum_up(result);
	return result;
}

std::optional<MovedCasters> find_moved_casters(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_indices, const CountCasters &p_casters,
		CasterOrder &r_order) {
	const size_t PAGE_SIZE = SharedVector<InstanceSnapshot>::PAGE_SIZE;
	const Bounds &before_world = p_casters.scene_bounds_world;
	const Bounds &bounds_world = p_inputs.summary.get_bounds();
	const bool has_same_bounds = before_world.minimum == bounds_world.minimum &&
			before_world.maximum == bounds_world.maximum;
	// Which levels of detail cast depends on the bounds.
	if (p_casters.indices != p_indices || (p_casters.has_lods && !has_same_bounds)) {
		return {};
	}
	const SharedVector<InstanceSnapshot> &instances = p_inputs.scene.instances;
	const std::vector<uint32_t> pages = instances.find_changed_pages(p_casters.instances);
	if (2 * pages.size() > instances.get_page_count()) {
		return {};
	}
	std::vector<uint32_t> changed; // indices of instances
	std::vector<std::pair<uint32_t, Bounds>> bounds;
	for (const uint32_t page : pages) {
		const uint32_t begin = static_cast<uint32_t>(page * PAGE_SIZE);
		const uint32_t end = begin + static_cast<uint32_t>(instances.get_page(page).size());
		for (auto index = std::lower_bound(p_indices.begin(), p_indices.end(), begin);
				index != p_indices.end() && *index < end; ++index) {
			if (is_same_caster(p_casters.instances[*index], instances[*index])) {
				continue;
			}
			if (p_casters.instances[*index].caster_levels != instances[*index].caster_levels) {
				return {};
			}
			changed.push_back(*index);
			bounds.emplace_back(
					uint32_t(index - p_indices.begin()), instances[*index].bounds_world);
		}
	}
	if (!r_order.move(bounds)) {
		return {};
	}
	const CasterMaker maker = { p_inputs, p_casters.disc_radius, p_casters.may_have_lods };
	MovedCasters moved;
	moved.instances = instances;
	for (const uint32_t index : changed) {
		uint32_t caster_index = p_casters.first_casters[index];
		std::vector<RecordedCaster> made;
		if (!is_collapsed(instances[index])) {
			made = maker.make(index);
		}
		if (made.empty() != (caster_index == CountCasters::NO_CASTER)) {
			return {};
		}
		for (RecordedCaster &recorded : made) {
			const CountCaster &caster = recorded.caster;
			const CountCaster &before = p_casters.casters[caster_index];
			const shader::CountCasterRecord &before_record = p_casters.records[caster_index];
			if (before.mesh != caster.mesh ||
					before_record.flags != recorded.record.flags || // they tell if there are two
					(caster.may_cut_disc && !p_casters.may_cut_disc)) {
				return {};
			}
			recorded.record.first_face = before_record.first_face;
			recorded.record.first_word = before_record.first_word;
			if (has_moved(p_casters, caster_index, caster, recorded.record) ||
					before.views != caster.views) {
				moved.casters.emplace_back(caster_index, std::move(recorded));
			}
			++caster_index;
		}
	}
	return moved;
}

void MovedCasters::apply_to(CountCasters &r_casters) {
	r_casters.moved.clear();
	bool has_same_sums = true;
	for (auto &[caster_index, recorded] : casters) {
		CountCaster &caster = recorded.caster;
		CountCaster &replaced = r_casters.casters[caster_index];
		has_same_sums = has_same_sums && replaced.views == caster.views &&
				replaced.may_cut_disc == caster.may_cut_disc;
		if (has_moved(r_casters, caster_index, caster, recorded.record)) {
			r_casters.moved.push_back(caster_index);
		}
		r_casters.records[caster_index] = recorded.record;
		replaced = std::move(caster);
	}
	std::sort(r_casters.moved.begin(), r_casters.moved.end());
	r_casters.instances = instances;
	if (!has_same_sums) {
		sum_up(r_casters);
	}
}

void compare_casters(const CountCasters &p_before, CountCasters &r_casters) {
	std::erase_if(r_casters.moved, [&](uint32_t p_index) {
		return !has_moved(
				p_before, p_index, r_casters.casters[p_index], r_casters.records[p_index]);
	});
}

} // namespace gnomon
