#pragma once

// Hides the differences between Embree 3 and 4: the include folder and the arguments of queries.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace gnomon {

/// Sets tfar of each ray with valid = -1 to -infinity when it hits a triangle between tnear and
/// tfar. The rays of one call should be coherent: start at one point, with similar directions.
inline void find_occluded_8(RTCScene p_scene, const int *p_valid, RTCRay8 &r_rays) {
#if RTC_VERSION_MAJOR >= 4
	RTCOccludedArguments arguments = {};
	rtcInitOccludedArguments(&arguments);
	arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
	rtcOccluded8(p_valid, p_scene, &r_rays, &arguments);
#else
	RTCIntersectContext context = {};
	rtcInitIntersectContext(&context);
	context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
	rtcOccluded8(p_valid, p_scene, &context, &r_rays);
#endif
}

/// As find_occluded_8, for one ray.
inline void find_occluded_1(RTCScene p_scene, RTCRay &r_ray) {
#if RTC_VERSION_MAJOR >= 4
	RTCOccludedArguments arguments = {};
	rtcInitOccludedArguments(&arguments);
	rtcOccluded1(p_scene, &r_ray, &arguments);
#else
	RTCIntersectContext context = {};
	rtcInitIntersectContext(&context);
	rtcOccluded1(p_scene, &context, &r_ray);
#endif
}

/// Sets tfar and the hit to the nearest hit. Without one, r_query.hit.geomID is not changed.
inline void find_nearest_1(RTCScene p_scene, RTCRayHit &r_query) {
#if RTC_VERSION_MAJOR >= 4
	RTCIntersectArguments arguments = {};
	rtcInitIntersectArguments(&arguments);
	rtcIntersect1(p_scene, &r_query, &arguments);
#else
	RTCIntersectContext context = {};
	rtcInitIntersectContext(&context);
	rtcIntersect1(p_scene, &context, &r_query);
#endif
}

/// For each ray of eight, indexed by its id: the geometries that it meets, each listed once.
using Crossings = std::array<std::vector<uint32_t>, 8>;

/// Query context that passes the crossings to record_crossing.
struct CrossingContext {
#if RTC_VERSION_MAJOR >= 4
	RTCRayQueryContext base; // must be first: the filter function gets its address
#else
	RTCIntersectContext base;
#endif
	Crossings *crossings;
};

/// Filter function of geometries for find_crossings_8: records the geometry of each hit and rejects
/// the hit, so that the ray continues.
inline void record_crossing(const RTCFilterFunctionNArguments *p_arguments) {
	Crossings &crossings = *reinterpret_cast<CrossingContext *>(p_arguments->context)->crossings;
	for (unsigned int i = 0; i < p_arguments->N; ++i) {
		if (p_arguments->valid[i] != 0) {
			std::vector<uint32_t> &geometries =
					crossings[RTCRayN_id(p_arguments->ray, p_arguments->N, i)];
			const uint32_t geometry = RTCHitN_geomID(p_arguments->hit, p_arguments->N, i);
			if (std::find(geometries.begin(), geometries.end(), geometry) == geometries.end()) {
				geometries.push_back(geometry);
			}
			p_arguments->valid[i] = 0;
		}
	}
}

/// Adds to r_crossings all geometries that the rays meet between tnear and tfar. Only geometries
/// whose filter function is record_crossing are added. The id of each ray is its index in
/// r_crossings. Rays may start anywhere.
inline void find_crossings_8(
		RTCScene p_scene, const int *p_valid, RTCRay8 &r_rays, Crossings &r_crossings) {
	CrossingContext context = {};
	context.crossings = &r_crossings;
#if RTC_VERSION_MAJOR >= 4
	rtcInitRayQueryContext(&context.base);
	RTCOccludedArguments arguments = {};
	rtcInitOccludedArguments(&arguments);
	arguments.context = &context.base;
	rtcOccluded8(p_valid, p_scene, &r_rays, &arguments);
#else
	rtcInitIntersectContext(&context.base);
	rtcOccluded8(p_valid, p_scene, &context.base, &r_rays);
#endif
}

} // namespace gnomon
