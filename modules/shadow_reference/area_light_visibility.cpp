#include "modules/core/error.h"
#include "modules/core/finite.h"
#include "modules/core/limits.h"
#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/disc_samples.h"
#include "modules/shadow_reference/spread_visibility.h"
#include "modules/shadows/mask.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

// Implements CasterScene::compute. The rest of the class is in caster_scene.cpp.

namespace gnomon {

namespace {

constexpr float MAX_RADIUS = 1e18f; // Embree drops coordinates beyond 1.8e18
constexpr uint32_t MAX_SAMPLE_COUNT = 65536;
constexpr uint32_t TILE_SIZE_PX = 8; // neighbouring pixels share BVH nodes in the CPU cache

void check_light(const AreaLight &p_light) {
	if (!(p_light.disc_radius >= 0.0f && p_light.disc_radius <= MAX_RADIUS)) {
		fail("Reference: the light's radius is ", p_light.disc_radius, ", must be 0..", MAX_RADIUS,
				". Set light_size or light_angular_distance.");
	}
	if (p_light.is_directional &&
			(!is_finite(p_light.direction) || p_light.direction == glm::vec3(0.0f))) {
		fail("Reference: the light's direction must be finite and not zero. Check its node's "
			 "rotation.");
	}
	if (!p_light.is_directional && !is_finite(p_light.position)) {
		fail("Reference: the light's position must be finite. Check its node's translation.");
	}
}

void check_options(const VisibilityOptions &p_options) {
	if (p_options.sample_count < 1 || p_options.sample_count > MAX_SAMPLE_COUNT) {
		fail("Reference: sample count is ", p_options.sample_count, ", must be 1..",
				MAX_SAMPLE_COUNT, ". Set reference_samples.");
	}
}

/// Returns the sum of the transmittances of the rays of one half of a pixel's samples. p_hash:
/// selects the scramble of the samples.
glm::dvec3 sum_transmittances(const CasterScene &p_scene, const DiscView &p_view,
		const DiscSamples &p_samples, uint64_t p_hash) {
	const uint32_t scramble_u = static_cast<uint32_t>(p_hash);
	const uint32_t scramble_v = static_cast<uint32_t>(p_hash >> 32);
	glm::dvec3 sum(0.0);
	DiscSamples::Packet packet = {};
	alignas(32) RTCRay8 rays = {};
	for (uint32_t index = 0; index < p_samples.get_packet_count(); ++index) {
		p_samples.compute_packet(index, scramble_u, scramble_v, packet);
		const uint32_t lane_count = std::min(
				DiscSamples::PACKET_SIZE, p_samples.get_count() - index * DiscSamples::PACKET_SIZE);
		alignas(32) int valid[DiscSamples::PACKET_SIZE];
		for (uint32_t i = 0; i < DiscSamples::PACKET_SIZE; ++i) {
			valid[i] = i < lane_count ? -1 : 0;
			set_ray(rays, i, p_view.origin, p_view.compute_ray(packet.x[i], packet.y[i]),
					p_view.end);
		}
		glm::vec3 transmittances[DiscSamples::PACKET_SIZE];
		p_scene.trace(valid, rays, transmittances);
		for (uint32_t i = 0; i < lane_count; ++i) {
			sum += glm::dvec3(transmittances[i]);
		}
	}
	return sum;
}

/// State that all threads share while one image is computed.
struct Job {
	const CasterScene &scene;
	std::span<const ReceiverPoint> points;
	glm::uvec2 size_px;
	const AreaLight &light;
	const VisibilityOptions &options;
	DiscSamples first_half;
	DiscSamples second_half;
	bool has_second_half;
	std::vector<float> &visibility;
	std::vector<glm::vec3> &colors; // empty without translucent casters
	/// Samples of receivers with a spread radius, which even a light without size needs.
	uint32_t spread_sample_count;
	std::vector<float> half_error; // per pixel, see compute_half_error
	std::atomic<uint64_t> ray_count = 0;
	std::atomic<uint32_t> next_tile = 0;
	std::atomic<uint32_t> done_tile_count = 0;
	std::atomic<bool> is_stopped = false;

	glm::uvec2 get_tile_counts() const { return (size_px + TILE_SIZE_PX - 1u) / TILE_SIZE_PX; }
	uint32_t get_tile_count() const { return get_tile_counts().x * get_tile_counts().y; }
	bool should_stop() const {
		return is_stopped || (options.is_cancelled != nullptr && *options.is_cancelled);
	}
};

void store_visibility(Job &r_job, uint32_t p_pixel, const glm::dvec3 &p_visibility) {
	if (r_job.colors.empty()) {
		r_job.visibility[p_pixel] = static_cast<float>(p_visibility.x);
		return;
	}
	r_job.colors[p_pixel] = glm::vec3(p_visibility);
	r_job.visibility[p_pixel] = compute_mask_luminance(r_job.colors[p_pixel]);
}

/// Returns the error estimated from the two halves of a pixel's rays: (A - B) sqrt(a b) / (a + b),
/// where A and B are their means and a and b their counts. 0 when a half has no rays.
float compute_half_error(const glm::dvec3 &p_first_sum, double p_first_count,
		const glm::dvec3 &p_second_sum, double p_second_count) {
	if (p_first_count == 0 || p_second_count == 0) {
		return 0.0f;
	}
	const float difference = compute_mask_luminance(
			glm::vec3(p_first_sum / p_first_count - p_second_sum / p_second_count));
	return difference *
			static_cast<float>(
					std::sqrt(p_first_count * p_second_count) / (p_first_count + p_second_count));
}

/// Stores the mean visibility of the surface around the receiver, where light enters that leaves at
/// the receiver. Returns the number of rays that count. 0: none started where the light can reach
/// the body, because the body is far smaller than the spread radius; nothing is stored.
uint64_t trace_spread_pixel(Job &r_job, uint32_t p_pixel, uint64_t p_hash) {
	const ReceiverPoint &point = r_job.points[p_pixel];
	const SpreadMean mean = r_job.options.spread->compute(
			r_job.scene, r_job.light, point, r_job.spread_sample_count, p_hash);
	const double count = mean.counts[0] + mean.counts[1];
	if (count > 0) {
		store_visibility(r_job, p_pixel, mean.compute_mean());
		r_job.half_error[p_pixel] = compute_half_error(mean.transmittance_sums[0], mean.counts[0],
				mean.transmittance_sums[1], mean.counts[1]);
	}
	return static_cast<uint64_t>(count);
}

/// Stores the visibility at the receiver itself. Returns the number of rays.
uint64_t trace_plain_pixel(Job &r_job, uint32_t p_pixel, const DiscView &p_view, uint64_t p_hash) {
	const glm::dvec3 first =
			sum_transmittances(r_job.scene, p_view, r_job.first_half, mix_bits(p_hash ^ 1));
	const glm::dvec3 second = r_job.has_second_half
			? sum_transmittances(r_job.scene, p_view, r_job.second_half, mix_bits(p_hash ^ 2))
			: glm::dvec3(0.0);
	store_visibility(r_job, p_pixel, (first + second) / double(r_job.options.sample_count));
	if (r_job.has_second_half) {
		r_job.half_error[p_pixel] = compute_half_error(
				first, r_job.first_half.get_count(), second, r_job.second_half.get_count());
	}
	return r_job.options.sample_count;
}

/// Stores the visibility of one pixel. Returns the number of rays.
uint64_t trace_pixel(Job &r_job, uint32_t p_pixel) {
	const ReceiverPoint &point = r_job.points[p_pixel];
	if (!point.is_receiver) {
		return 0;
	}
	const uint64_t hash = mix_bits(mix_bits(r_job.options.seed) ^ p_pixel);
	DiscView view;
	float constant_visibility = 0.0f;
	if (!find_disc_view(r_job.light, point.position, point.geometric_normal, point.offset_m, view,
				constant_visibility)) {
		store_visibility(r_job, p_pixel, glm::dvec3(constant_visibility));
		return 0;
	}
	uint64_t ray_count = 0;
	if (point.spread_radius_m > 0.0f && r_job.options.spread != nullptr) {
		ray_count = trace_spread_pixel(r_job, p_pixel, hash);
	}
	return ray_count > 0 ? ray_count : trace_plain_pixel(r_job, p_pixel, view, hash);
}

/// Runs on every thread: traces tiles until all are taken or the job stops.
void trace_tiles(Job &r_job, const std::function<void(float)> &p_progress) {
	const uint32_t tile_count = r_job.get_tile_count();
	while (!r_job.should_stop()) {
		const uint32_t tile = r_job.next_tile++;
		if (tile >= tile_count) {
			break;
		}
		const glm::uvec2 begin =
				glm::uvec2(tile % r_job.get_tile_counts().x, tile / r_job.get_tile_counts().x) *
				TILE_SIZE_PX;
		const glm::uvec2 end = glm::min(begin + TILE_SIZE_PX, r_job.size_px);
		uint64_t ray_count = 0;
		for (uint32_t y = begin.y; y < end.y; ++y) {
			for (uint32_t x = begin.x; x < end.x; ++x) {
				if (r_job.should_stop()) {
					return; // the tile is not counted in done_tile_count
				}
				ray_count += trace_pixel(r_job, y * r_job.size_px.x + x);
			}
		}
		r_job.ray_count += ray_count;
		const uint32_t done = ++r_job.done_tile_count;
		if (p_progress) {
			p_progress(static_cast<float>(done) / static_cast<float>(tile_count));
		}
	}
}

/// Runs serially, so that the rounding of the sum does not depend on the threads.
void compute_standard_error(const Job &p_job, VisibilityResult &r_result) {
	double square_sum = 0;
	for (size_t i = 0; i < r_result.visibility.size(); ++i) {
		if (r_result.visibility[i] > MIN_PENUMBRA_VISIBILITY &&
				r_result.visibility[i] < MAX_PENUMBRA_VISIBILITY) {
			++r_result.penumbra_pixel_count;
			square_sum += static_cast<double>(p_job.half_error[i]) * p_job.half_error[i];
		}
	}
	if (!p_job.has_second_half && p_job.light.disc_radius > 0.0f) {
		r_result.standard_error = -1.0f;
	} else if (r_result.penumbra_pixel_count > 0) {
		r_result.standard_error = static_cast<float>(
				std::sqrt(square_sum / static_cast<double>(r_result.penumbra_pixel_count)));
	}
}

} // namespace

VisibilityResult CasterScene::compute(std::span<const ReceiverPoint> p_points,
		const glm::uvec2 &p_size_px, const AreaLight &p_light,
		const VisibilityOptions &p_options) const {
	GNOMON_ASSERT(p_points.size() == static_cast<size_t>(p_size_px.x) * p_size_px.y &&
					p_points.size() < std::numeric_limits<uint32_t>::max(),
			p_points.size(), " points for ", p_size_px.x, " x ", p_size_px.y);
	check_light(p_light);
	check_options(p_options);
	VisibilityResult result;
	result.visibility.assign(p_points.size(), 0.0f);
	if (is_colored()) {
		result.colors.assign(p_points.size(), glm::vec3(0.0f));
	}
	// All samples of a point light are the same, so one suffices.
	const uint32_t sample_count = p_light.disc_radius == 0.0f ? 1 : p_options.sample_count;
	VisibilityOptions options = p_options;
	options.sample_count = sample_count;
	Job job{ *this, p_points, p_size_px, p_light, options,
		DiscSamples(sample_count - sample_count / 2, options.seed),
		DiscSamples(std::max(sample_count / 2, 1u), options.seed), sample_count > 1,
		result.visibility, result.colors, p_options.sample_count,
		std::vector<float>(p_points.size(), 0.0f) };

	uint32_t thread_count = options.thread_count;
	if (thread_count == 0) {
		thread_count = std::max(1u, std::thread::hardware_concurrency());
	}
	thread_count = std::min(thread_count, std::max(1u, job.get_tile_count()));
	std::exception_ptr failure; // of any thread: memory may run out, and progress may throw
	std::mutex failure_mutex;
	const auto trace = [&](const std::function<void(float)> &p_progress) {
		try {
			trace_tiles(job, p_progress);
		} catch (...) {
			const std::lock_guard lock(failure_mutex);
			failure = std::current_exception();
			job.is_stopped = true; // ends the others
		}
	};
	{ // at its end, the threads join
		std::vector<std::jthread> threads;
		for (uint32_t i = 1; i < thread_count; ++i) {
			threads.emplace_back([&] { trace(nullptr); });
		}
		trace(options.progress);
	}
	if (failure) {
		std::rethrow_exception(failure);
	}
	result.ray_count = job.ray_count;
	result.is_complete = job.done_tile_count == job.get_tile_count();
	if (options.progress && result.is_complete) {
		options.progress(1.0f);
	}
	compute_standard_error(job, result);
	return result;
}

} // namespace gnomon
