#include "modules/editor/viewport_guides.h"

#include <utility>

namespace gnomon {

namespace {

// Maximum numbers of silhouette edges that are traced: fewer while something moves, so that it does
// not have to wait for them.
const size_t MOVING_EDGE_COUNT = 150;
const size_t EDGE_COUNT = 1500;

} // namespace

void ViewportGuides::update(EditorContext &r_context, uint32_t p_drawn_count) {
	ViewportState &viewport = r_context.viewport;
	EditorDocument &document = r_context.document;
	const bool is_changed = p_drawn_count != followed_count || viewport.is_guide_changed;
	// Updated only when there is something to pick or trace, because it computes the posed
	// vertices.
	bool is_followed = false;
	const auto follow = [&] {
		if (!std::exchange(is_followed, true)) {
			rays.follow(document.get_scene());
		}
	};
	if (viewport.pick) {
		const ViewportPick pick = *viewport.pick;
		viewport.pick.reset();
		follow();
		const std::optional<SceneRays::Hit> hit =
				rays.find_nearest(pick.origin_world, pick.direction_world);
		document.select(hit ? hit->instance->node : nullptr);
	}
	const Node3D *selected = document.get_selected();
	if (!is_changed && selected == guided_node) {
		return;
	}
	followed_count = p_drawn_count;
	viewport.is_guide_changed = false;
	guided_node = selected;
	viewport.penumbra_lines.clear();
	if (!viewport.shows_penumbra || dynamic_cast<const Light3D *>(selected) == nullptr) {
		return;
	}
	try {
		const auto scene = r_context.build_viewport_snapshot();
		if (const LightSnapshot *light = scene->find_light(selected->name)) {
			const bool is_moving =
					r_context.is_image_coarse || document.get_timeline().is_playing();
			follow();
			viewport.penumbra_lines = find_penumbra_lines(
					rays, *scene, *light, is_moving ? MOVING_EDGE_COUNT : EDGE_COUNT);
		}
	} catch (const std::exception &) {
		// Drawing the scene fails too, and reports why.
	}
}

} // namespace gnomon
