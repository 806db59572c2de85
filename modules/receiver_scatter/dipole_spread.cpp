#include "modules/receiver_scatter/dipole_spread.h"

#include "receiver_scatter/receiver_scatter_shared.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Of skin in red light. The coefficients in figure 5 of Jensen et al. 2001 give 0.96 for skin1 and
// 0.99 for skin2.
constexpr double REDUCED_ALBEDO = 0.98;
constexpr double REFRACTIVE_INDEX = 1.3;	// of skin; same figure
constexpr double FRACTION_IN_RADIUS = 0.95; // fraction of the light that defines the radius
constexpr uint32_t TABLE_SIZE = 4096;		// linear interpolation: fraction errs by below 1e-4
constexpr double MAX_FRACTION = 1.0 - 1e-4; // 1 has an infinite distance

/// The dipole model. Lengths are in mean free paths: 1 / (reduced extinction coefficient).
struct Dipole {
	double transport = std::sqrt(3.0 * (1.0 - REDUCED_ALBEDO)); // effective transport coefficient
	double real_depth = 1.0;	// depth of the real source below the surface
	double virtual_depth = 1.0; // height of the virtual source above the surface
	double weight = 1.0; // integral of eq. 4 over the whole plane, without its constant factor

	Dipole() {
		const double index = REFRACTIVE_INDEX;
		// Diffuse Fresnel reflectance, fitted: Jensen et al. 2001, section 2.1.
		const double diffuse_fresnel =
				-1.440 / (index * index) + 0.710 / index + 0.668 + 0.0636 * index;
		const double boundary = (1.0 + diffuse_fresnel) / (1.0 - diffuse_fresnel); // A in the paper
		virtual_depth = real_depth * (1.0 + 4.0 / 3.0 * boundary);
		weight = std::exp(-transport * real_depth) + std::exp(-transport * virtual_depth);
	}

	/// Returns the fraction of the light that entered within p_r. Eq. 4 sums
	/// z (1 + k d) exp(-k d) / d^3 over both sources, with k = `transport`, the source's depth or
	/// height z, and d^2 = r^2 + z^2. As r dr = d dd, its integral over a disc is that of
	/// z (1 + k d) exp(-k d) / d^2 over d, whose antiderivative is -z exp(-k d) / d.
	double compute_fraction(double p_r) const {
		const auto outside = [&](double p_z) {
			const double d = std::sqrt(p_r * p_r + p_z * p_z);
			return p_z * std::exp(-transport * d) / d;
		};
		return 1.0 - (outside(real_depth) + outside(virtual_depth)) / weight;
	}

	/// Inverts compute_fraction by bisection.
	double find_distance(double p_fraction) const {
		double low = 0.0;
		double high = 1.0;
		while (compute_fraction(high) < p_fraction) {
			high *= 2.0;
		}
		for (int step = 0; step < 60; ++step) { // more than the 53 bits of a double
			const double middle = 0.5 * (low + high);
			(compute_fraction(middle) < p_fraction ? low : high) = middle;
		}
		return 0.5 * (low + high);
	}
};

const Dipole dipole;
const double radius = dipole.find_distance(FRACTION_IN_RADIUS); // in mean free paths

} // namespace

float clamp_scatter(float p_scatter) {
	return p_scatter > 0.0f ? std::min(p_scatter, 1.0f) : 0.0f;
}

DipoleSpread::DipoleSpread() : distances(TABLE_SIZE + 1) {
	for (uint32_t index = 0; index <= TABLE_SIZE; ++index) {
		const double table_fraction = std::min(double(index) / TABLE_SIZE, MAX_FRACTION);
		distances[index] = static_cast<float>(dipole.find_distance(table_fraction) / radius);
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

float DipoleSpread::compute_distance(float p_fraction) const {
	const float position = std::clamp(p_fraction, 0.0f, 1.0f) * TABLE_SIZE;
	const uint32_t index = std::min(static_cast<uint32_t>(position), TABLE_SIZE - 1);
	const float fraction = position - static_cast<float>(index);
	return distances[index] + fraction * (distances[index + 1] - distances[index]);
}

double DipoleSpread::compute_fraction(double p_distance) {
	return dipole.compute_fraction(p_distance * radius);
}

} // namespace gnomon
