#pragma once

#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/spread_visibility.h"
#include "modules/shadows/reference_source.h"

#include <optional>

namespace gnomon {

/// The reference in parallel with the frames. The tree over the casters is built by the first trace
/// and cached.
class ShadowReferenceSource : public ReferenceSource {
public:
	explicit ShadowReferenceSource(ReferenceQuestion p_question) :
			question(std::move(p_question)) {}

	ReferenceAnswer trace(uint32_t p_sample_count, const std::atomic<bool> &p_is_cancelled,
			const std::function<void(float)> &p_progress) override;

private:
	ReferenceQuestion question;
	std::vector<ReceiverPoint> points;
	std::optional<CasterScene> tracer;
	std::optional<SpreadVisibility> spread_visibility;
};

} // namespace gnomon
