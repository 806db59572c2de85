#pragma once

#include "modules/editor/editor_context.h"
#include "modules/editor/scene_rays.h"

namespace gnomon {

/// What the viewport needs rays for: which node is under the mouse, and where the penumbra of the
/// selected light ends.
class ViewportGuides {
public:
	/// Once a frame. p_drawn_count: ViewportRenderer's; when it has changed, so may have the scene.
	void update(EditorContext &r_context, uint32_t p_drawn_count);

private:
	SceneRays rays;
	uint32_t followed_count = 0;
	const Node3D *guided_node = nullptr; // the selected one then; compared only
};

} // namespace gnomon
