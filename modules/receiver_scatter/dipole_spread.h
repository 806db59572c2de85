#pragma once

#include "modules/shadows/surface_spread.h"

#include <vector>

namespace gnomon {

/// How far light travels below the surface of a semi-infinite translucent body: the dipole of
/// Jensen et al. 2001 (A practical model for subsurface light transport, section 2.1, eq. 4), for a
/// reduced albedo of 0.98 and a refractive index of 1.3. Distances are in radii: within one radius
/// 95 % of the light entered.
class DipoleSpread : public SurfaceSpread {
public:
	DipoleSpread();

	/// s times scatter_distance; where that is 0, the radius that the source gives in pixels, 16 s,
	/// at the size that a pixel has at the receiver. s beyond 0..1 is cut, NaN counts as 0.
	float compute_radius_m(const SurfaceMaterial &p_material, float p_pixel_size_m) const override;
	/// Interpolated in a table. Shares beyond 1 - 1e-4 count as that.
	float compute_distance(float p_share) const override;
	/// The share of the light that entered within that distance, 0..1, in closed form: the integral
	/// of eq. 4 over a disc is elementary in d_r and d_v. Double precision.
	static double compute_share(double p_distance);

private:
	std::vector<float> distances; // by share, evenly spaced
};

/// s as the program uses it: cut to 0..1; 0 where it is no number.
float clamp_scatter(float p_scatter);

} // namespace gnomon
