#pragma once

#include "modules/shadow_reference/area_light_visibility.h"
#include "modules/shadow_reference/reference_entry.h"
#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// The reference as a technique: reads back the camera's depth and normals, traces on the CPU, and
/// hands the mask to the GPU in float32. Cached on disk by the content of everything it depends on.
class ShadowReference : public ShadowTechnique {
public:
	ShadowLimits get_limits(const PropertyValues & /*p_properties*/) const override {
		return { .least_caster_distance_radii = 0 }; // exact everywhere
	}
	void get_light_properties(PropertyList &r_list) const override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	bool sees_translucent_casters() const override { return true; }
	float get_standard_error() const override { return last_reference.standard_error; }
	std::vector<std::string> get_shader_files() const override { return {}; }

private:
	/// Everything of one frame that the host pass needs; the inputs end before it runs.
	struct Job;
	void run(const Job &p_job, HostContext &p_context);
	void compute(const Job &p_job, const std::vector<ReceiverPoint> &p_points,
			ReferenceVisibility &r_reference);

	uint64_t last_key = 0; // of last_reference
	ReferenceVisibility last_reference;
};

} // namespace gnomon
