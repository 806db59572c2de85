#include "modules/receiver_scatter/dipole_spread.h"

#include "receiver_scatter/receiver_scatter_shared.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

constexpr double REDUCED_ALBEDO = 0.98;	 // of skin and marble; Jensen et al. 2001, figure 5
constexpr double REFRACTIVE_INDEX = 1.3; // of both; same figure
constexpr double SHARE_IN_RADIUS = 0.95;
constexpr uint32_t TABLE_SIZE = 4096; // share 1e-4 is half a step: linear steps are below 1e-3
constexpr double LARGEST_SHARE = 1.0 - 1e-4;

/// The dipole with lengths in 1 / (reduced extinction coefficient).
struct Dipole {
	double transport = std::sqrt(3.0 * (1.0 - REDUCED_ALBEDO)); // effective transport coefficient
	double real_depth = 1.0;
	double virtual_depth = 1.0;
	double weight = 1.0; // of the integral over the whole plane, without its constant factor

	Dipole() {
		const double index = REFRACTIVE_INDEX;
		const double diffuse_fresnel =
				-1.440 / (index * index) + 0.710 / index + 0.668 + 0.0636 * index;
		const double boundary = (1.0 + diffuse_fresnel) / (1.0 - diffuse_fresnel); // A
		virtual_depth = real_depth * (1.0 + 4.0 / 3.0 * boundary);
		weight = std::exp(-transport * real_depth) + std::exp(-transport * virtual_depth);
	}

	/// Eq. 4 sums z (1 + k d) exp(-k d) / d^3 over both sources, d^2 = r^2 + z^2. As r dr = d dd,
	/// its integral over a disc is that of z (1 + k d) exp(-k d) / d^2, which is -z exp(-k d) / d.
	double compute_share(double p_r) const {
		const auto outside = [&](double p_z) {
			const double d = std::sqrt(p_r * p_r + p_z * p_z);
			return p_z * std::exp(-transport * d) / d;
		};
		return 1.0 - (outside(real_depth) + outside(virtual_depth)) / weight;
	}

	double find_distance(double p_share) const {
		double low = 0.0;
		double high = 1.0;
		while (compute_share(high) < p_share) {
			high *= 2.0;
		}
		for (int step = 0; step < 60; ++step) {
			const double middle = 0.5 * (low + high);
			(compute_share(middle) < p_share ? low : high) = middle;
		}
		return 0.5 * (low + high);
	}
};

const Dipole dipole;
const double radius = dipole.find_distance(SHARE_IN_RADIUS);

} // namespace

float clamp_scatter(float p_scatter) {
	return p_scatter > 0.0f ? std::min(p_scatter, 1.0f) : 0.0f;
}

DipoleSpread::DipoleSpread() : distances(TABLE_SIZE + 1) {
	for (uint32_t index = 0; index <= TABLE_SIZE; ++index) {
		const double share = std::min(double(index) / TABLE_SIZE, LARGEST_SHARE);
		distances[index] = static_cast<float>(dipole.find_distance(share) / radius);
	}
}

float DipoleSpread::compute_radius_m(
		const SurfaceMaterial &p_material, float p_pixel_size_m) const {
	const float distance_m = p_material.scatter_distance_m > 0.0f
			? p_material.scatter_distance_m
			: SCATTER_RADIUS_PX * p_pixel_size_m;
	const float radius_m = clamp_scatter(p_material.scatter) * distance_m;
	return std::isfinite(radius_m) ? radius_m : 0.0f;
}

float DipoleSpread::compute_distance(float p_share) const {
	const float position = std::clamp(p_share, 0.0f, 1.0f) * TABLE_SIZE;
	const uint32_t index = std::min(static_cast<uint32_t>(position), TABLE_SIZE - 1);
	const float fraction = position - static_cast<float>(index);
	return distances[index] + fraction * (distances[index + 1] - distances[index]);
}

double DipoleSpread::compute_share(double p_distance) {
	return dipole.compute_share(p_distance * radius);
}

} // namespace gnomon
