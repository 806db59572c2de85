#pragma once

#include "modules/editor/editor_context.h"
#include "modules/editor/scene_rays.h"

namespace gnomon {

/// The ray-cast features of the viewport: picking the node under the mouse, and the penumbra edges
/// of the selected light.
class ViewportGuides {
public:
	/// Call it once a frame. p_drawn_count: ViewportRenderer's count; if it has changed, the scene
	/// may have changed too.
	void update(EditorContext &r_context, uint32_t p_drawn_count);

private:
	SceneRays rays;
	uint32_t followed_count = 0;
	const Node3D *guided_node = nullptr; // the node selected then; compared, never dereferenced
};

} // namespace gnomon
