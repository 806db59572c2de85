#pragma once

#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/spread_visibility.h"
#include "modules/shadows/reference_source.h"

#include <optional>

namespace gnomon {

/// Computes the reference in parallel with the frames. The first trace builds the bounding volume
/// hierarchy of the casters, later ones reuse it.
class ShadowReferenceSource : public ReferenceSource {
public:
	explicit ShadowReferenceSource(ReferenceRequest p_request) : request(std::move(p_request)) {}

	ReferenceResult trace(uint32_t p_sample_count, const std::atomic<bool> &p_is_cancelled,
			const std::function<void(float)> &p_progress) override;

private:
	ReferenceRequest request;
	std::vector<ReceiverPoint> points;
	std::optional<CasterScene> tracer;
	std::optional<SpreadVisibility> spread_visibility;
};

} // namespace gnomon
