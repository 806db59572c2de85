#include "modules/shadow_volume/volume_casters.h"

#include "modules/mesh_tools/convexity.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/mesh_store.h"

#include "shadow_volume/shadow_volume_shared.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gnomon {

namespace {

const uint32_t STENCIL_MAXIMUM = 255;
const uint32_t TRIANGLES_PER_LAYER = 8; // a box has 12 and one layer
const uint32_t MAX_LAYERS = 32;
// For fewer triangles, compute shaders cost more per caster than they save (doc/benchmarks.md).
const uint32_t MAX_FACES_FOR_GEOMETRY_SHADER = 4096;
// Boxes are grown by this fraction of their diagonal before testing whether the light is inside.
const double BOX_GROWTH = 1e-3;

/// What is derived from the parts of a mesh, cached per mesh.
struct MeshSolids {
	uint32_t layer_count = 0;				// see estimate_layers
	VolumeFaces robust = VolumeFaces::NONE; // while the light is outside the mesh's box
};

MeshSolids find_solids(const MeshTopology &p_topology) {
	MeshSolids solids;
	solids.layer_count = estimate_layers(p_topology);
	const auto solid_count = std::count_if(p_topology.parts.begin(), p_topology.parts.end(),
			[](const MeshPart &p_part) { return p_part.is_solid(); });
	solids.robust = solid_count == 0						? VolumeFaces::ALL
			: size_t(solid_count) < p_topology.parts.size() ? VolumeFaces::NOT_SOLID
															: VolumeFaces::NONE;
	return solids;
}

bool is_light_inside(const InstanceSnapshot &p_instance, const LightSnapshot &p_light) {
	if (p_light.type == LightType::DIRECTIONAL) {
		return false;
	}
	const double margin_m = BOX_GROWTH * p_instance.bounds_world.get_diagonal();
	const glm::dvec3 &light = p_light.position_world;
	return glm::all(glm::greaterThanEqual(light, p_instance.bounds_world.minimum - margin_m)) &&
			glm::all(glm::lessThanEqual(light, p_instance.bounds_world.maximum + margin_m));
}

/// Counts how many layers may cover each tile of the image, and starts a new group when the
/// stencil could overflow.
class GroupSplitter {
public:
	explicit GroupSplitter(glm::uvec2 p_size_px) : size_px(p_size_px) {}

	/// Adds a volume and returns its group. p_layer_count: how much it adds to the stencil at most.
	uint32_t assign_group(const VolumeArea &p_area, uint32_t p_layer_count) {
		if (find_max_layers(p_area) + p_layer_count > STENCIL_MAXIMUM) {
			layers.fill(0);
			++group;
		}
		for_each_tile(p_area, [&](uint32_t &r_layers) { r_layers += p_layer_count; });
		return group;
	}

private:
	static const uint32_t TILES_PER_SIDE = 16;

	template <typename Function> void for_each_tile(const VolumeArea &p_area, Function p_function) {
		const glm::uvec2 begin = p_area.offset_px * TILES_PER_SIDE / size_px;
		const glm::uvec2 end =
				(p_area.offset_px + p_area.size_px - 1u) * TILES_PER_SIDE / size_px; // inclusive
		for (uint32_t y = begin.y; y <= end.y; ++y) {
			for (uint32_t x = begin.x; x <= end.x; ++x) {
				p_function(layers[y * TILES_PER_SIDE + x]);
			}
		}
	}
	uint32_t find_max_layers(const VolumeArea &p_area) {
		uint32_t max_layers = 0;
		for_each_tile(
				p_area, [&](uint32_t p_layers) { max_layers = std::max(max_layers, p_layers); });
		return max_layers;
	}

	glm::uvec2 size_px;
	std::array<uint32_t, TILES_PER_SIDE *TILES_PER_SIDE> layers = {};
	uint32_t group = 0;
};

} // namespace

uint32_t estimate_layers(const MeshTopology &p_topology) {
	const uint32_t convex_count = count_convex_parts(p_topology);
	const uint32_t layers =
			convex_count > 0 ? convex_count : p_topology.get_face_count() / TRIANGLES_PER_LAYER;
	return std::clamp(layers, 1u, MAX_LAYERS);
}

float compute_volume_camera_move_m(const ShadowTechnique::Inputs &p_inputs) {
	double nearest_m = std::numeric_limits<float>::max();
	for (const VisibleReceiver &receiver : p_inputs.lit_receivers) {
		nearest_m = std::min(nearest_m,
				receiver.bounds_world.compute_distance(p_inputs.scene.camera.position_world));
	}
	return compute_receiver_offset_m(compute_frame_constants(p_inputs.scene, p_inputs.size_px),
			static_cast<float>(nearest_m));
}

LightView make_volume_camera(const ShadowTechnique::Inputs &p_inputs) {
	CameraSnapshot camera = p_inputs.scene.camera;
	camera.position_world[VOLUMES_OFFSET_AXIS] += compute_volume_camera_move_m(p_inputs);
	return make_camera_view(camera, p_inputs.size_px);
}

VolumeCasters build_volume_casters(const ShadowTechnique::Inputs &p_inputs,
		const VolumeSettings &p_settings, const std::vector<uint32_t> &p_instances) {
	const LightView camera = make_volume_camera(p_inputs);
	VolumeArea whole;
	whole.size_px = p_inputs.size_px;
	GroupSplitter groups(p_inputs.size_px);
	VolumeCasters result;
	for (uint32_t index : p_instances) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		VolumeCaster caster;
		caster.instance_index = index;
		caster.light_position_node =
				compute_light_position_node(p_inputs.light, instance.world_from_node);
		if (!is_light_position_finite(caster.light_position_node)) {
			++result.collapsed_count;
			continue;
		}
		caster.gpu = &p_inputs.meshes.get_topology(instance.caster_mesh, TopologyBuffer::NONE);
		if (caster.gpu->edge_count == 0) {
			continue;
		}
		caster.area = compute_volume_area(
				instance.bounds_world, p_inputs.light, camera, p_inputs.size_px);
		if (p_inputs.may_skip && caster.area.is_empty()) {
			++result.offscreen_count;
			continue;
		}
		if (!p_settings.has_scissor) {
			caster.area = whole;
		}
		const MeshTopology &topology = *caster.gpu->topology;
		caster.is_mirrored = instance.is_mirrored();
		const MeshSolids &solids = p_inputs.meshes.get_derived<MeshSolids>(
				instance.caster_mesh, [&] { return find_solids(topology); });
		caster.shape.robust =
				p_settings.is_always_robust || is_light_inside(instance, p_inputs.light)
				? VolumeFaces::ALL
				: solids.robust;
		caster.stencil_method = p_settings.stencil_method.value_or(!p_inputs.may_skip ||
								may_shade_near_plane(instance.bounds_world, p_inputs.light, camera)
						? StencilMethod::Z_FAIL
						: StencilMethod::Z_PASS);
		caster.shape.has_far_cap = caster.stencil_method == StencilMethod::Z_FAIL;
		// A robust volume counts every solid twice.
		const bool is_robust = caster.shape.robust != VolumeFaces::NONE;
		caster.group = groups.assign_group(caster.area, (is_robust ? 2 : 1) * solids.layer_count);
		caster.extruder =
				p_settings.extruder.value_or(p_inputs.device.get_features().geometry_shader &&
										topology.get_face_count() <= MAX_FACES_FOR_GEOMETRY_SHADER
								? VolumeExtruder::GEOMETRY_SHADER
								: VolumeExtruder::COMPUTE);
		result.geometry_shader_count += caster.extruder == VolumeExtruder::GEOMETRY_SHADER ? 1 : 0;
		result.z_fail_count += caster.shape.has_far_cap ? 1 : 0;
		result.skipped_caps_count +=
				!p_settings.stencil_method && !caster.shape.has_far_cap ? 1 : 0;
		result.robust_count += is_robust ? 1 : 0;
		result.group_count = caster.group + 1;
		result.casters.push_back(caster);
	}
	return result;
}

} // namespace gnomon
