#pragma once

namespace gnomon {

/// The material parameters of subsurface scattering at a receiver.
struct SurfaceMaterial {
	float scatter = 0.0f;			 // s, 0..1: how much light spreads below the surface
	float scatter_distance_m = 0.0f; // 0: not given
	bool operator==(const SurfaceMaterial &) const = default;
};

/// The distribution of the points at which light that leaves a surface at a receiver entered it:
/// the exact form of a mask filter, which a reference integrates. Radially symmetric on the
/// receiver's tangent plane.
class SurfaceSpread {
public:
	virtual ~SurfaceSpread() = default;
	/// The radius in metres, which is the unit of compute_distance(). p_pixel_size_m: width of a
	/// pixel at the receiver, across the view. Returns 0 when light leaves where it enters.
	virtual float compute_radius_m(
			const SurfaceMaterial &p_material, float p_pixel_size_m) const = 0;
	/// Distance, as a multiple of the radius, within which the fraction p_fraction (0..1) of the
	/// light entered. Finite.
	virtual float compute_distance(float p_fraction) const = 0;
};

} // namespace gnomon
