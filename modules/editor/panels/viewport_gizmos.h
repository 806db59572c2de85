#pragma once

#include "modules/editor/editor_context.h"
#include "modules/editor/viewport_projection.h"

// What is drawn over the viewport's image, with Dear ImGui, in the viewport's window.

namespace gnomon {

/// A mark where each light and camera is; a click selects it.
void draw_node_marks(EditorContext &r_context, const ViewportProjection &p_projection);
/// The rings, discs and cones of the selected node, and the handles that change them.
void draw_gizmos(EditorContext &r_context, const ViewportProjection &p_projection);
/// Where the penumbra of the selected light ends.
void draw_penumbra_lines(const EditorContext &p_context, const ViewportProjection &p_projection);

} // namespace gnomon
