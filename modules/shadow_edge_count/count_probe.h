#pragma once

#include "modules/shadow_edge_count/leaf_passes.h"
#include "modules/shadows/probe.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

/// Explains the visibility of single receivers of a frame: reads back what the passes wrote, and
/// repeats each step in double precision. Where two steps differ is the cause of an error.
class CountProbe {
public:
	CountProbe(const ShadowTechnique::Inputs &p_inputs, const CountSettings &p_settings,
			const CountCapacities &p_capacities);

	/// Adds a pass that reads back what explain() needs. p_debug_image: see add_count_debug_pass.
	/// p_mask: see add_count_passes.
	void add_read_back(RenderGraph &r_graph, const CountFrameBuffers &p_light,
			const CountLeaves &p_leaves, RGTexture p_debug_image, RGTexture p_mask);
	/// Adds, after the frame has finished: the receiver's leaf; the faces that the way to the
	/// light's centre crosses; the edges that change what it sees, with their casters; its
	/// visibility in the mask, as counted on the GPU, from the leaf's list in double, from all
	/// faces and edges that the GPU found in double, from the meshes in double, and by rays in
	/// double; and which of these differ. p_casters: of the frame.
	void explain(const ProbedReceiver &p_receiver, const CountCasters &p_casters,
			ProbeEntry &r_explanation) const;

private:
	/// Copies of GPU memory, shared with the callbacks that fill them.
	struct Copies {
		std::vector<uint8_t> planes, faces, edges, totals;
		std::vector<uint8_t> leaves, results, lists, counts;
		std::array<std::vector<uint8_t>, EDGE_COUNT_DEBUG_LAYERS> debug_layers;
		std::vector<uint8_t> mask; // of opaque casters, before mask filters
	};
	struct Work;

	std::shared_ptr<Copies> copies = std::make_shared<Copies>();
	LightView view; // the first; its axes are those of light space
	CountSettings settings;
	shader::CountLightConstants constants;
	glm::uvec2 size_px;
	double scene_size_m;
};

} // namespace gnomon
