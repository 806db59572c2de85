#pragma once

#include "modules/scene/scene_snapshot.h"
#include "modules/shadow_reference/area_light_visibility.h"
#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/spread_visibility.h"
#include "modules/shadows/reference_source.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

// A scene as the tracer takes it: relative to the camera, as the rasteriser places it.

namespace gnomon {

/// Triangles of all casters: the opaque ones together, each other by itself. Those with holes are
/// not the meshes that techniques draw: a ray looks up the alpha where it meets one.
struct CasterTriangles {
	Triangles opaque;
	std::vector<CutOutTriangles> cut_out;
	std::vector<TranslucentTriangles> translucent;
};

/// p_is_receiver: of a pixel, does the light reach there? p_spread may be null.
std::vector<ReceiverPoint> make_receiver_points(std::span<const SurfacePoint> p_surfaces,
		const SurfaceSpread *p_spread, const std::function<bool(size_t)> &p_is_receiver);
/// Those on which light spreads, of all instances with that property. p_spread may be null.
std::vector<Triangles> collect_spread_bodies(
		const SceneSnapshot &p_scene, const SurfaceSpread *p_spread);
CasterTriangles collect_triangles(const SceneSnapshot &p_scene);
AreaLight make_area_light(const SceneSnapshot &p_scene, const LightSnapshot &p_light);

} // namespace gnomon
