#pragma once

#include "modules/editor/editor_context.h"
#include "modules/editor/scene_rays.h"

namespace gnomon {

/// The ray-cast features of the viewport: picking the node under the mouse, and the penumbra edges
/// of the selected light.
class ViewportGuides {
public:
	/// Call it once a frame. p_drawn_count: ViewportRenderer::get_drawn_count. If it has changed,
	/// the scene or the camera may have changed too.
	void update(EditorContext &r_context, uint32_t p_drawn_count);

private:
	SceneRays rays;
	uint32_t updated_count = 0;			   // p_drawn_count at the last update of the lines
	const Node3D *last_selected = nullptr; // node selected at that time; never dereferenced
};

} // namespace gnomon
