#include "modules/shadow_reference/shadow_reference_source.h"

#include "modules/core/error.h"
#include "modules/shadow_reference/reference_input.h"

namespace gnomon {

ReferenceResult ShadowReferenceSource::trace(uint32_t p_sample_count,
		const std::atomic<bool> &p_is_cancelled, const std::function<void(float)> &p_progress) {
	if (!tracer) {
		const size_t pixel_count = size_t(request.size_px.x) * request.size_px.y;
		GNOMON_ASSERT(
				request.surfaces.size() == pixel_count && request.receiver.size() == pixel_count,
				request.surfaces.size(), " surfaces and ", request.receiver.size(),
				" receivers for ", pixel_count, " pixels");
		points = make_receiver_points(request.surfaces, request.spread.get(),
				[&](size_t p_pixel) { return request.receiver[p_pixel] >= 0.5f; });
		const CasterTriangles triangles = collect_triangles(*request.scene);
		tracer.emplace(triangles.opaque.positions, triangles.opaque.indices, triangles.translucent,
				triangles.cut_out);
		if (request.spread) {
			spread_visibility.emplace(
					collect_spread_bodies(*request.scene, request.spread.get()), *request.spread);
		}
	}
	VisibilityOptions options;
	options.sample_count = p_sample_count;
	options.is_cancelled = &p_is_cancelled;
	options.progress = p_progress;
	options.spread = spread_visibility ? &*spread_visibility : nullptr;
	VisibilityResult result = tracer->compute(
			points, request.size_px, make_area_light(*request.scene, request.light), options);
	return { std::move(result.visibility), result.standard_error, result.penumbra_pixel_count,
		result.is_complete };
}

} // namespace gnomon
