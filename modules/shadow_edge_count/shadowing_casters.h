#pragma once

#include "modules/shadows/shadow_technique.h"

#include <vector>

namespace gnomon {

/// What a directional light's casters may shadow.
struct ShadowedView {
	const LightView &light;
	double disc_radius = 0; // R, a tangent
	std::span<const VisibleReceiver> receivers;
	LightView camera; // sees all receivers
};

/// Returns those of the casters whose shadow may reach a receiver in the camera's view, in their
/// order. p_indices: of instances. p_margin_m: by how much receivers and camera may move without
/// making other casters necessary.
std::vector<uint32_t> find_shadowing_casters(const SceneSnapshot &p_scene,
		const ShadowedView &p_view, const std::vector<uint32_t> &p_indices, double p_margin_m);

/// How many faces and edges of a light's casters the device has room for.
struct CasterLimits {
	uint64_t face_count = 0;
	uint64_t edge_count = 0;
};

/// The casters of a light whose faces and edges are recorded: all of them, unless they exceed the
/// limits. Then, for a directional light, those whose shadows may reach a
/// receiver that the camera sees, and some more, so that they do not change with every step of the
/// camera.
class ChosenCasters {
public:
	/// p_hash: equal for equal casters of the light, see compute_casters_hash.
	void update(const ShadowTechnique::Inputs &p_inputs, double p_disc_radius, uint64_t p_hash,
			const CasterLimits &p_limits);
	/// Indices of instances, ascending.
	const std::vector<uint32_t> &get() const { return indices; }
	size_t get_skipped_count() const { return skipped_count; }
	/// Equal if and only if update() has changed nothing.
	uint64_t get_revision() const { return revision; }

private:
	std::vector<uint32_t> indices;
	size_t skipped_count = 0;
	uint64_t hash = 0;
	uint64_t revision = 0;
};

} // namespace gnomon
