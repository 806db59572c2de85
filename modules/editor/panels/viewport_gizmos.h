#pragma once

#include "modules/editor/editor_context.h"
#include "modules/editor/viewport_projection.h"

// Overlays of the viewport's image, drawn with Dear ImGui in the viewport's window.

namespace gnomon {

/// Draws a mark at each light and camera; a click selects it.
void draw_node_marks(EditorContext &r_context, const ViewportProjection &p_projection);
/// Draws the rings, discs and cones of the selected node, and their handles.
void draw_gizmos(EditorContext &r_context, const ViewportProjection &p_projection);
/// Draws the penumbra edges of the selected light.
void draw_penumbra_lines(const EditorContext &p_context, const ViewportProjection &p_projection);

} // namespace gnomon
