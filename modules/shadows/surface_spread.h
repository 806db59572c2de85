#pragma once

namespace gnomon {

/// What a receiver's material defines of the light below its surface.
struct SurfaceMaterial {
	float scatter = 0.0f;			 // s in 0..1
	float scatter_distance_m = 0.0f; // 0: not given
	bool operator==(const SurfaceMaterial &) const = default;
};

/// Where the light entered a surface that leaves it at a receiver: the exact form of a mask filter,
/// for a reference to integrate. Radially symmetric on the receiver's tangent plane.
class SurfaceSpread {
public:
	virtual ~SurfaceSpread() = default;
	/// In metres, the unit of compute_distance(). p_pixel_size_m: how wide a pixel is at the
	/// receiver, across the view. 0: light leaves where it enters.
	virtual float compute_radius_m(
			const SurfaceMaterial &p_material, float p_pixel_size_m) const = 0;
	/// Distance, in radii, within which that share (0..1) of the light entered. Finite.
	virtual float compute_distance(float p_share) const = 0;
};

} // namespace gnomon
