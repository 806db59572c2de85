#pragma once

#include "modules/shadow_volume/volume_area.h"
#include "modules/shadow_volume/volume_settings.h"
#include "modules/shadow_volume/volume_shape.h"
#include "modules/shadows/silhouette_lists.h"

#include <vector>

namespace gnomon {

/// One caster whose shadow volume is drawn.
struct VolumeCaster {
	uint32_t instance_index = 0;
	const GpuTopology *gpu = nullptr;
	glm::vec4 light_position_node = glm::vec4(0.0f);	  // as VolumePush::light_position_node
	StencilMethod stencil_method = StencilMethod::Z_PASS; // how the stencil counts it
	VolumeShape shape;
	bool is_mirrored = false;
	VolumeExtruder extruder = VolumeExtruder::COMPUTE;
	uint32_t group = 0; // casters of one group are counted together in the stencil
	VolumeArea area;
};

struct VolumeCasters {
	std::vector<VolumeCaster> casters; // ordered by instance_index
	uint32_t group_count = 0;
	// For the frame plan.
	uint32_t z_fail_count = 0;
	uint32_t robust_count = 0; // with robust faces
	uint32_t geometry_shader_count = 0;
	uint32_t collapsed_count = 0;	 // collapsed to a line or point, so without a volume
	uint32_t skipped_caps_count = 0; // without far caps, because z-pass is safe
	uint32_t offscreen_count = 0;	 // with a shadow outside the image
};

/// Returns how far the camera for which volumes are drawn is moved, see VOLUMES_OFFSET_AXIS: the
/// offset of a receiver as near to the camera as the lit receivers' bounds.
float compute_volume_camera_move_m(const ShadowTechnique::Inputs &p_inputs);

/// Returns the camera for which volumes are drawn: the scene's camera, moved.
LightView make_volume_camera(const ShadowTechnique::Inputs &p_inputs);

/// Decides for every caster of p_instances (ascending) how its volume is drawn. Faces of mesh parts
/// that are not solid are robust (VolumeShape::robust), and all faces are when the light is inside
/// the caster's box, slightly grown. The stencil counts to 255: if more volumes may overlap, the
/// casters are split into groups.
VolumeCasters build_volume_casters(const ShadowTechnique::Inputs &p_inputs,
		const VolumeSettings &p_settings, const std::vector<uint32_t> &p_instances);

/// Estimates how many solids of the mesh are behind one another at most (layers), 1 to 32: as many
/// as it has parts when all are convex (see count_convex_parts), else one for every 8 triangles of
/// the mesh.
uint32_t estimate_layers(const MeshTopology &p_topology);

} // namespace gnomon
