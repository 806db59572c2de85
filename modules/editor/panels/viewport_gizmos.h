#pragma once

#include "modules/editor/editor_context.h"
#include "modules/editor/viewport_projection.h"

// Overlays over the viewport's image, drawn with Dear ImGui in the viewport's window.

namespace gnomon {

/// Draws a mark at each light and camera; a click selects it.
void draw_node_marks(EditorContext &r_context, const ViewportProjection &p_projection);
/// Draws the gizmos of the selected node (Node3D::add_gizmos) and their handles, which can be
/// dragged.
void draw_gizmos(EditorContext &r_context, const ViewportProjection &p_projection);
/// Draws ViewportState::penumbra_lines.
void draw_penumbra_lines(const EditorContext &p_context, const ViewportProjection &p_projection);

} // namespace gnomon
