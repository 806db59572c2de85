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

// Converts a scene to the ray tracer's input. Positions are relative to the camera and computed
// like the rasteriser's.

namespace gnomon {

/// Triangles of all casters. Opaque casters are merged; each cut-out or translucent one has an
/// entry. Techniques draw cut-out casters as meshes with real holes. Here they are the original
/// meshes, and rays test the alpha where they hit one. Fully transparent casters are skipped.
struct CasterTriangles {
	Triangles opaque;
	std::vector<CutOutTriangles> cut_out;
	std::vector<TranslucentTriangles> translucent;
};

/// Makes the receiver of each pixel. p_is_receiver: returns whether the pixel with this index is a
/// receiver, which the light would reach without casters. p_spread may be null: light then leaves
/// where it enters.
std::vector<ReceiverPoint> make_receiver_points(std::span<const SurfacePoint> p_surfaces,
		const SurfaceSpread *p_spread, const std::function<bool(size_t)> &p_is_receiver);
/// Returns the triangles of each instance whose material spreads light below its surface. p_spread
/// may be null: there are then none.
std::vector<Triangles> collect_spread_bodies(
		const SceneSnapshot &p_scene, const SurfaceSpread *p_spread);
CasterTriangles collect_triangles(const SceneSnapshot &p_scene);
AreaLight make_area_light(const SceneSnapshot &p_scene, const LightSnapshot &p_light);

} // namespace gnomon
