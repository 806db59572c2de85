#include "modules/shadow_reference/area_light_visibility.h"

#include "modules/core/error.h"
#include "modules/shadow_reference/disc_samples.h"
#include "modules/shadow_reference/embree_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

namespace gnomon {

namespace {

constexpr float START_OFFSET = 5e-5f; // of S; the techniques move P by the same
/// Rays to a disc at a finite distance end here, so that a lamp's own surface at the disc does not
/// hide it. Many float roundings, far below a sample's share.
constexpr float RAY_END = 1.0f - 1e-5f;
constexpr float MAX_RADIUS = 1e18f; // Embree drops coordinates beyond 1.8e18
constexpr uint32_t MAX_SAMPLE_COUNT = 65536;
constexpr uint32_t TILE_SIZE_PX = 8; // neighbours share the tree's nodes in the cache
constexpr float PENUMBRA_MINIMUM = 0.002f;
constexpr float PENUMBRA_MAXIMUM = 0.998f;

bool is_finite(const glm::vec3 &p_value) {
	return std::isfinite(p_value.x) && std::isfinite(p_value.y) && std::isfinite(p_value.z);
}

/// Two unit vectors perpendicular to a unit vector and to each other (Duff et al. 2017).
void find_basis(const glm::vec3 &p_normal, glm::vec3 &r_x, glm::vec3 &r_y) {
	const float sign = std::copysign(1.0f, p_normal.z);
	const float a = -1.0f / (sign + p_normal.z);
	const float b = p_normal.x * p_normal.y * a;
	r_x = glm::vec3(1.0f + sign * p_normal.x * p_normal.x * a, sign * b, -sign * p_normal.x);
	r_y = glm::vec3(b, sign + p_normal.y * p_normal.y * a, -p_normal.y);
}

/// Unit vector; scaled first, because squares of long or short vectors leave float's range.
glm::vec3 normalize_safely(const glm::vec3 &p_vector) {
	const float largest =
			std::max({ std::abs(p_vector.x), std::abs(p_vector.y), std::abs(p_vector.z) });
	return glm::normalize(p_vector / largest);
}

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
	if (!(p_options.scene_size_m >= 0.0f && std::isfinite(p_options.scene_size_m))) {
		fail("Reference: scene size is ", p_options.scene_size_m,
				" m, must be finite and not negative. Set the scene's extras.scene_size.");
	}
}

/// Towards the disc from one start: centre + radius (x basis_x + y basis_y), rays to be cut at
/// `end`.
struct DiscView {
	glm::vec3 origin = glm::vec3(0.0f);
	glm::vec3 centre = glm::vec3(0.0f);	 // relative to the origin
	glm::vec3 basis_x = glm::vec3(0.0f); // length: the disc's radius
	glm::vec3 basis_y = glm::vec3(0.0f);
	float end = RAY_END;
};

/// How many rays of one half of a pixel's samples meet nothing.
uint32_t count_visible(const EmbreeScene &p_scene, const DiscView &p_view,
		const DiscSamples &p_samples, uint64_t p_hash) {
	const uint32_t scramble_u = static_cast<uint32_t>(p_hash);
	const uint32_t scramble_v = static_cast<uint32_t>(p_hash >> 32);
	uint32_t visible_count = 0;
	DiscSamples::Packet packet = {};
	alignas(32) RTCRay8 rays = {};
	for (uint32_t index = 0; index < p_samples.get_packet_count(); ++index) {
		p_samples.compute_packet(index, scramble_u, scramble_v, packet);
		const uint32_t lane_count = std::min(
				DiscSamples::PACKET_SIZE, p_samples.get_count() - index * DiscSamples::PACKET_SIZE);
		alignas(32) int valid[DiscSamples::PACKET_SIZE];
		for (uint32_t i = 0; i < DiscSamples::PACKET_SIZE; ++i) {
			valid[i] = i < lane_count ? -1 : 0;
			rays.org_x[i] = p_view.origin.x;
			rays.org_y[i] = p_view.origin.y;
			rays.org_z[i] = p_view.origin.z;
			rays.dir_x[i] = p_view.centre.x + packet.x[i] * p_view.basis_x.x +
					packet.y[i] * p_view.basis_y.x;
			rays.dir_y[i] = p_view.centre.y + packet.x[i] * p_view.basis_x.y +
					packet.y[i] * p_view.basis_y.y;
			rays.dir_z[i] = p_view.centre.z + packet.x[i] * p_view.basis_x.z +
					packet.y[i] * p_view.basis_y.z;
			rays.tnear[i] = 0.0f;
			rays.tfar[i] = p_view.end;
			rays.time[i] = 0.0f;
			rays.mask[i] = 0xffffffffu;
			rays.id[i] = 0;
			rays.flags[i] = 0;
		}
		find_occluded_8(p_scene.get(), valid, rays);
		for (uint32_t i = 0; i < lane_count; ++i) {
			visible_count += rays.tfar[i] >= 0.0f ? 1 : 0;
		}
	}
	return visible_count;
}

/// What all threads share while one image is made.
struct Job {
	const EmbreeScene &scene;
	std::span<const ReceiverPoint> points;
	glm::uvec2 size_px;
	const AreaLight &light;
	const VisibilityOptions &options;
	DiscSamples first_half;
	DiscSamples second_half;
	bool has_second_half;
	std::vector<float> &visibility;
	std::vector<float> half_difference; // A - B, for the standard error
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

/// False where v is known without rays; r_visibility is then set.
bool find_disc_view(
		const Job &p_job, const ReceiverPoint &p_point, DiscView &r_view, float &r_visibility) {
	r_visibility = 0.0f;
	if (!p_point.is_receiver || !is_finite(p_point.position) ||
			!is_finite(p_point.geometric_normal)) {
		return false;
	}
	r_view.origin = p_point.position +
			p_point.geometric_normal * (START_OFFSET * p_job.options.scene_size_m);
	glm::vec3 axis;
	if (p_job.light.is_directional) {
		axis = -normalize_safely(p_job.light.direction);
		r_view.centre = axis;
		r_view.end = std::numeric_limits<float>::infinity();
	} else {
		r_view.centre = p_job.light.position - r_view.origin;
		if (!is_finite(r_view.centre)) {
			return false;
		}
		if (r_view.centre == glm::vec3(0.0f)) {
			r_visibility = 1.0f;
			return false;
		}
		axis = normalize_safely(r_view.centre);
	}
	find_basis(axis, r_view.basis_x, r_view.basis_y);
	r_view.basis_x *= p_job.light.disc_radius;
	r_view.basis_y *= p_job.light.disc_radius;
	return true;
}

/// Returns the number of rays.
uint64_t trace_pixel(Job &r_job, uint32_t p_pixel) {
	DiscView view;
	if (!find_disc_view(r_job, r_job.points[p_pixel], view, r_job.visibility[p_pixel])) {
		return 0;
	}
	const uint64_t hash = mix_bits(mix_bits(r_job.options.seed) ^ p_pixel);
	const uint32_t first = count_visible(r_job.scene, view, r_job.first_half, mix_bits(hash ^ 1));
	const uint32_t second = r_job.has_second_half
			? count_visible(r_job.scene, view, r_job.second_half, mix_bits(hash ^ 2))
			: 0;
	const float sample_count = static_cast<float>(r_job.options.sample_count);
	r_job.visibility[p_pixel] = static_cast<float>(first + second) / sample_count;
	r_job.half_difference[p_pixel] =
			static_cast<float>(first) / static_cast<float>(r_job.first_half.get_count()) -
			static_cast<float>(second) / static_cast<float>(r_job.second_half.get_count());
	return r_job.options.sample_count;
}

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
					return; // the tile does not count as done
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

/// Serial, so that the sum does not depend on the threads.
void compute_standard_error(const Job &p_job, VisibilityResult &r_result) {
	const double first_count = p_job.first_half.get_count();
	const double second_count = p_job.has_second_half ? p_job.second_half.get_count() : 0;
	double square_sum = 0;
	for (size_t i = 0; i < r_result.visibility.size(); ++i) {
		if (r_result.visibility[i] > PENUMBRA_MINIMUM &&
				r_result.visibility[i] < PENUMBRA_MAXIMUM) {
			++r_result.penumbra_pixel_count;
			square_sum += static_cast<double>(p_job.half_difference[i]) * p_job.half_difference[i];
		}
	}
	if (p_job.light.disc_radius == 0.0f) {
		r_result.standard_error = 0.0f;
	} else if (!p_job.has_second_half) {
		r_result.standard_error = -1.0f;
	} else if (r_result.penumbra_pixel_count > 0) {
		r_result.standard_error = static_cast<float>(
				std::sqrt(square_sum / static_cast<double>(r_result.penumbra_pixel_count) *
						first_count * second_count) /
				(first_count + second_count));
	}
}

} // namespace

AreaLightVisibility::AreaLightVisibility(
		std::span<const glm::vec3> p_positions, std::span<const uint32_t> p_triangle_indices) :
		scene(std::make_unique<EmbreeScene>(p_positions, p_triangle_indices)) {}

AreaLightVisibility::~AreaLightVisibility() = default;
AreaLightVisibility::AreaLightVisibility(AreaLightVisibility &&) noexcept = default;
AreaLightVisibility &AreaLightVisibility::operator=(AreaLightVisibility &&) noexcept = default;

VisibilityResult AreaLightVisibility::compute(std::span<const ReceiverPoint> p_points,
		const glm::uvec2 &p_size_px, const AreaLight &p_light,
		const VisibilityOptions &p_options) const {
	GNOMON_ASSERT(p_points.size() == static_cast<size_t>(p_size_px.x) * p_size_px.y &&
					p_points.size() < std::numeric_limits<uint32_t>::max(),
			p_points.size(), " points for ", p_size_px.x, " x ", p_size_px.y);
	check_light(p_light);
	check_options(p_options);
	VisibilityResult result;
	result.visibility.assign(p_points.size(), 0.0f);
	// All samples of a point light are one.
	const uint32_t sample_count = p_light.disc_radius == 0.0f ? 1 : p_options.sample_count;
	VisibilityOptions options = p_options;
	options.sample_count = sample_count;
	Job job{ *scene, p_points, p_size_px, p_light, options,
		DiscSamples(sample_count - sample_count / 2, options.seed),
		DiscSamples(std::max(sample_count / 2, 1u), options.seed), sample_count > 1,
		result.visibility, std::vector<float>(p_points.size(), 0.0f) };

	uint32_t thread_count = options.thread_count;
	if (thread_count == 0) {
		thread_count = std::max(1u, std::thread::hardware_concurrency());
	}
	thread_count = std::min(thread_count, std::max(1u, job.get_tile_count()));
	{
		std::vector<std::jthread> threads;
		struct StopOnExit {
			Job &job;
			bool is_armed = true;
			~StopOnExit() { job.is_stopped = job.is_stopped || is_armed; }
		} stop{ job };
		for (uint32_t i = 1; i < thread_count; ++i) {
			threads.emplace_back([&job] { trace_tiles(job, nullptr); });
		}
		trace_tiles(job, options.progress); // when progress throws, `stop` ends the others first
		stop.is_armed = false;
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
