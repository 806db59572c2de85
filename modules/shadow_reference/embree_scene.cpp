#include "modules/shadow_reference/embree_scene.h"

#include "modules/core/error.h"
#include "modules/core/finite.h"
#include "modules/shadow_reference/light_disc.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

namespace gnomon {

namespace {

RTCRay make_ray(const glm::vec3 &p_origin, const glm::vec3 &p_direction, float p_end) {
	RTCRay ray = {};
	ray.org_x = p_origin.x;
	ray.org_y = p_origin.y;
	ray.org_z = p_origin.z;
	ray.dir_x = p_direction.x;
	ray.dir_y = p_direction.y;
	ray.dir_z = p_direction.z;
	ray.tfar = p_end;
	ray.mask = 0xffffffffu;
	return ray;
}

/// Returns the indices of the triangles that a ray can hit: those whose corners are finite, as
/// Embree expects, and that have an area. The others would only change the order in which Embree
/// stores triangles, and with it rays that touch an edge. An index out of range is a programming
/// error.
std::vector<uint32_t> keep_hittable(
		std::span<const glm::vec3> p_positions, std::span<const uint32_t> p_triangle_indices) {
	GNOMON_ASSERT(p_triangle_indices.size() % 3 == 0, p_triangle_indices.size(), " indices");
	std::vector<uint32_t> kept_indices;
	kept_indices.reserve(p_triangle_indices.size());
	for (size_t i = 0; i < p_triangle_indices.size(); i += 3) {
		bool are_finite = true;
		for (size_t k = i; k < i + 3; ++k) {
			const uint32_t index = p_triangle_indices[k];
			GNOMON_ASSERT(index < p_positions.size(), "index ", index, " of ", p_positions.size());
			are_finite = are_finite && is_finite(p_positions[index]);
		}
		const auto get_corner = [&](size_t p_corner) {
			return glm::dvec3(p_positions[p_triangle_indices[i + p_corner]]);
		};
		if (are_finite &&
				glm::cross(get_corner(1) - get_corner(0), get_corner(2) - get_corner(0)) !=
						glm::dvec3(0.0)) {
			kept_indices.insert(
					kept_indices.end(), &p_triangle_indices[i], &p_triangle_indices[i] + 3);
		}
	}
	return kept_indices;
}

/// Filter function of cut-out geometries: rejects hits in holes.
void test_alpha(const RTCFilterFunctionNArguments *p_arguments) {
	const auto &body = *static_cast<const CutOutTriangles *>(p_arguments->geometryUserPtr);
	for (unsigned int i = 0; i < p_arguments->N; ++i) {
		if (p_arguments->valid[i] != 0 &&
				!body.is_hit(RTCHitN_primID(p_arguments->hit, p_arguments->N, i),
						RTCHitN_u(p_arguments->hit, p_arguments->N, i),
						RTCHitN_v(p_arguments->hit, p_arguments->N, i))) {
			p_arguments->valid[i] = 0;
		}
	}
}

/// Returns the Embree device that all scenes share, because each device has threads and memory of
/// its own. It exists as long as a scene does. Throws an Error when Embree cannot create it.
std::shared_ptr<RTCDeviceTy> acquire_device() {
	static std::mutex mutex;
	static std::weak_ptr<RTCDeviceTy> shared;
	const std::lock_guard<std::mutex> lock(mutex);
	std::shared_ptr<RTCDeviceTy> device = shared.lock();
	if (!device) {
		RTCDevice created = rtcNewDevice(nullptr);
		if (created == nullptr) {
			fail("Reference: Embree cannot create a device (RTCError ",
					static_cast<int>(rtcGetDeviceError(nullptr)),
					"; 4: out of memory, 5: unsupported CPU). Free memory or use another CPU.");
		}
		device.reset(created, &rtcReleaseDevice);
		shared = device;
	}
	return device;
}

} // namespace

bool CutOutTriangles::is_hit(uint32_t p_triangle, float p_u, float p_v) const {
	const uint32_t *corners = &triangles.indices[3 * size_t(p_triangle)];
	const float weights[] = { 1.0f - p_u - p_v, p_u, p_v };
	glm::dvec2 uv(0.0);
	double alpha = 0;
	for (int corner = 0; corner < 3; ++corner) {
		uv += glm::dvec2(uvs[corners[corner]]) * double(weights[corner]);
		alpha += double(alphas[corners[corner]]) * weights[corner];
	}
	return alpha * (image ? sample_alpha(test, uv) : 1.0f) >= test.cutoff;
}

EmbreeScene::EmbreeScene() : device(acquire_device()), scene(rtcNewScene(device.get())) {
	rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
	rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
}

EmbreeScene::EmbreeScene(std::span<const glm::vec3> p_positions,
		std::span<const uint32_t> p_triangle_indices, std::span<const CutOutTriangles> p_cut_out) :
		EmbreeScene() { // after this, the destructor runs even if the body throws
	add(p_positions, p_triangle_indices, HitMode::OCCLUDE);
	for (const CutOutTriangles &body : p_cut_out) {
		auto owned = std::make_unique<CutOutTriangles>(body);
		owned->triangles.indices = keep_hittable(body.triangles.positions, body.triangles.indices);
		owned->test.image = owned->image.get();
		cut_out.push_back(std::move(owned));
		add(cut_out.back()->triangles.positions, cut_out.back()->triangles.indices,
				HitMode::OCCLUDE, cut_out.back().get());
	}
	finish();
}

EmbreeScene EmbreeScene::make_recording_scene(std::span<const Triangles *const> p_geometries) {
	EmbreeScene created;
	for (const Triangles *triangles : p_geometries) {
		created.add(triangles->positions, triangles->indices, HitMode::RECORD);
	}
	created.finish();
	return created;
}

EmbreeScene::EmbreeScene(EmbreeScene &&p_other) noexcept :
		device(std::move(p_other.device)), scene(std::exchange(p_other.scene, nullptr)),
		cut_out(std::move(p_other.cut_out)) {}

EmbreeScene::~EmbreeScene() {
	if (scene != nullptr) {
		rtcReleaseScene(scene);
	}
}

void EmbreeScene::check() const {
	const RTCError error = rtcGetDeviceError(device.get());
	if (error != RTC_ERROR_NONE) {
		fail("Reference: Embree reports error ", static_cast<int>(error),
				" while building the scene. Free memory or use fewer triangles.");
	}
}

SurfaceHit EmbreeScene::find_nearest(
		const glm::vec3 &p_origin, const glm::vec3 &p_direction, float p_reach_m) const {
	RTCRayHit query = {};
	query.ray = make_ray(p_origin, p_direction, p_reach_m);
	query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
	find_nearest_1(scene, query);
	if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
		return {};
	}
	const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
	// Scaled before it is normalized: the square of a tiny triangle's normal would underflow.
	const float largest = std::max({ std::abs(normal.x), std::abs(normal.y), std::abs(normal.z) });
	return { true, query.ray.tfar,
		largest > 0.0f ? glm::normalize(normal / largest) : glm::vec3(0.0f) };
}

bool EmbreeScene::is_occluded(
		const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const {
	RTCRay ray = make_ray(p_origin, p_ray, p_end);
	find_occluded_1(scene, ray);
	return ray.tfar < 0.0f;
}

/// Adds one geometry, even without finite triangles, so that its id is the number of earlier calls.
void EmbreeScene::add(std::span<const glm::vec3> p_positions,
		std::span<const uint32_t> p_triangle_indices, HitMode p_hit_mode,
		const CutOutTriangles *p_cut_out) {
	const std::vector<uint32_t> hittable_indices = keep_hittable(p_positions, p_triangle_indices);
	RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
	if (!hittable_indices.empty()) {
		// Buffers of Embree's own, because it reads 16 bytes beyond the last vertex of a shared
		// one.
		void *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
				RTC_FORMAT_FLOAT3, sizeof(glm::vec3), p_positions.size());
		void *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
				RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), hittable_indices.size() / 3);
		if (vertices != nullptr && indices != nullptr) {
			std::copy(p_positions.begin(), p_positions.end(), static_cast<glm::vec3 *>(vertices));
			std::copy(hittable_indices.begin(), hittable_indices.end(),
					static_cast<uint32_t *>(indices));
		}
	}
	if (p_hit_mode == HitMode::RECORD) {
		rtcSetGeometryOccludedFilterFunction(geometry, &record_crossing);
	}
	if (p_cut_out != nullptr) {
		rtcSetGeometryUserData(geometry, const_cast<CutOutTriangles *>(p_cut_out)); // only read
		rtcSetGeometryOccludedFilterFunction(geometry, &test_alpha);
		rtcSetGeometryIntersectFilterFunction(geometry, &test_alpha);
	}
	rtcCommitGeometry(geometry);
	rtcAttachGeometry(scene, geometry);
	rtcReleaseGeometry(geometry);
	check();
}

void EmbreeScene::finish() {
	rtcCommitScene(scene);
	check();
}

} // namespace gnomon
