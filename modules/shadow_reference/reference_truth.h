#pragma once

#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/spread_visibility.h"
#include "modules/shadows/truth_source.h"

#include <optional>

namespace gnomon {

/// The truth beside the frames. The tree over the casters is built by the first trace and kept.
class ReferenceTruth : public TruthSource {
public:
	explicit ReferenceTruth(TruthQuestion p_question) : question(std::move(p_question)) {}

	TruthAnswer trace(uint32_t p_sample_count, const std::atomic<bool> &p_is_cancelled,
			const std::function<void(float)> &p_progress) override;

private:
	TruthQuestion question;
	std::vector<ReceiverPoint> points;
	std::optional<CasterScene> tracer;
	std::optional<SpreadVisibility> spread_visibility;
};

} // namespace gnomon
