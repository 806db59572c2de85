#pragma once

#include "modules/shadows/surface_spread.h"

#include <vector>

namespace gnomon {

/// Radial distribution of the light that leaves a semi-infinite translucent body at a point: the
/// dipole model of Jensen et al. 2001 (A practical model for subsurface light transport, section
/// 2.1, eq. 4), with a reduced albedo of 0.98 and a refractive index of 1.3. Distances are in
/// radii: within one radius, 95 % of that light entered the body.
class DipoleSpread : public SurfaceSpread {
public:
	DipoleSpread();

	/// Returns s times the material's scatter distance, in metres. A distance that is not above 0,
	/// or NaN, is replaced by 16 pixels (Wang, Xiao 2015), converted with p_pixel_size_m. s is
	/// clamped to 0..1, and NaN to 0. Returns 0 if the product is not finite.
	float compute_radius_m(const SurfaceMaterial &p_material, float p_pixel_size_m) const override;
	/// Interpolates linearly in a table. p_fraction is clamped to 0..1; 1 gets the distance of
	/// 1 - 1e-4, because its own is infinite.
	float compute_distance(float p_fraction) const override;
	/// Returns the fraction of the light, 0..1, that entered within a distance, given in radii.
	/// Closed form in double precision: the integral of eq. 4 over a disc is elementary in d_r and
	/// d_v, the distances to the dipole's real and virtual source.
	static double compute_fraction(double p_distance);

private:
	std::vector<float> distances; // radii; of fractions 0..1 in even steps
};

/// Returns the scatter coefficient s clamped to 0..1; NaN gives 0.
float clamp_scatter(float p_scatter);

} // namespace gnomon
