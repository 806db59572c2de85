#pragma once

#include "modules/shadow_reference/area_light_visibility.h"
#include "modules/shadow_reference/reference_entry.h"
#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// The reference as a technique: reads back the camera's depth, normals, materials and receivers,
/// traces on the CPU, and uploads the mask to the GPU in float32. Results are cached on disk under
/// a hash of all inputs.
class ShadowReference : public ShadowTechnique {
public:
	ShadowLimits get_limits(const PropertyValues & /*p_properties*/) const override {
		return { .min_caster_distance_radii = 0 }; // no limits: exact for every light
	}
	void get_light_properties(PropertyList &r_list) const override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	bool sees_translucent_casters() const override { return true; }
	float get_standard_error() const override { return last_reference.standard_error; }
	std::vector<std::string> get_shader_files() const override { return {}; }

private:
	/// All data of one frame that the host pass needs. The pass runs when Inputs no longer exists.
	struct Job;
	/// The host pass: loads or computes the reference and writes it to the mask's buffer.
	void run(const Job &p_job, HostContext &p_context);
	/// Traces the reference.
	void compute(const Job &p_job, const std::vector<ReceiverPoint> &p_points,
			ReferenceVisibility &r_reference);

	uint64_t last_key = 0; // of last_reference
	ReferenceVisibility last_reference;
};

} // namespace gnomon
