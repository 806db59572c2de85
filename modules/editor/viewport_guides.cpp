#include "modules/editor/viewport_guides.h"

#include <utility>

namespace gnomon {

namespace {

// Numbers of silhouette edges that are traced: fewer while something moves, to keep the frame time
// low.
const size_t MAX_MOVING_EDGE_COUNT = 150;
const size_t MAX_EDGE_COUNT = 1500;

} // namespace

void ViewportGuides::update(EditorContext &r_context, uint32_t p_drawn_count) {
	ViewportState &viewport = r_context.viewport;
	EditorDocument &document = r_context.document;
	const bool is_changed = p_drawn_count != updated_count || viewport.is_guide_changed;
	// The rays' scene is updated only if there is something to pick or trace, because that computes
	// the posed vertices.
	bool is_scene_updated = false;
	const auto update_scene = [&] {
		if (!std::exchange(is_scene_updated, true)) {
			rays.update_scene(document.get_scene());
		}
	};
	if (viewport.pick) {
		const ViewportPick pick = *viewport.pick;
		viewport.pick.reset();
		update_scene();
		const std::optional<SceneRays::Hit> hit =
				rays.find_nearest(pick.origin_world, pick.direction_world);
		document.select(hit ? hit->instance->node : nullptr);
	}
	const Node3D *selected = document.get_selected();
	if (!is_changed && selected == last_selected) {
		return;
	}
	updated_count = p_drawn_count;
	viewport.is_guide_changed = false;
	last_selected = selected;
	viewport.penumbra_lines.clear();
	if (!viewport.shows_penumbra || dynamic_cast<const Light3D *>(selected) == nullptr) {
		return;
	}
	try {
		const auto scene = r_context.build_viewport_snapshot();
		if (const LightSnapshot *light = scene->find_light(selected->name)) {
			const bool is_moving =
					r_context.is_image_coarse || document.get_timeline().is_playing();
			update_scene();
			viewport.penumbra_lines = find_penumbra_lines(
					rays, *scene, *light, is_moving ? MAX_MOVING_EDGE_COUNT : MAX_EDGE_COUNT);
		}
	} catch (const std::exception &) {
		// Drawing the scene fails too, and reports why.
	}
}

} // namespace gnomon
