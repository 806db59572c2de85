#include "modules/shadow_reference/shadow_reference_source.h"

#include "modules/core/error.h"
#include "modules/shadow_reference/reference_input.h"

namespace gnomon {

ReferenceAnswer ShadowReferenceSource::trace(uint32_t p_sample_count,
		const std::atomic<bool> &p_is_cancelled, const std::function<void(float)> &p_progress) {
	if (!tracer) {
		const size_t pixel_count = size_t(question.size_px.x) * question.size_px.y;
		GNOMON_ASSERT(
				question.surfaces.size() == pixel_count && question.receiver.size() == pixel_count,
				question.surfaces.size(), " surfaces and ", question.receiver.size(),
				" receivers for ", pixel_count, " pixels");
		points = make_receiver_points(question.surfaces, question.spread.get(),
				[&](size_t p_pixel) { return question.receiver[p_pixel] >= 0.5f; });
		const CasterTriangles triangles = collect_triangles(*question.scene);
		tracer.emplace(triangles.opaque.positions, triangles.opaque.indices, triangles.translucent,
				triangles.cut_out);
		if (question.spread) {
			spread_visibility.emplace(collect_spread_bodies(*question.scene, question.spread.get()),
					*question.spread);
		}
	}
	VisibilityOptions options;
	options.scene_size_m = static_cast<float>(question.scene->scene_size_m);
	options.sample_count = p_sample_count;
	options.is_cancelled = &p_is_cancelled;
	options.progress = p_progress;
	options.spread = spread_visibility ? &*spread_visibility : nullptr;
	VisibilityResult result = tracer->compute(
			points, question.size_px, make_area_light(*question.scene, question.light), options);
	return { std::move(result.visibility), result.standard_error, result.penumbra_pixel_count,
		result.is_complete };
}

} // namespace gnomon
