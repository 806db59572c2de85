#include "modules/error_report/report_scene.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

bool casts_shadow(const Light3D &p_light) {
	return get_bool(Light3D::get_property_list(), p_light.properties, "shadow_enabled");
}

} // namespace

ReportView find_report_view(const ReportScene &p_scene) {
	if (!p_scene.scene) {
		fail(p_scene.failure);
	}
	const std::vector<Camera3D *> cameras = p_scene.scene->find_nodes<Camera3D>();
	if (cameras.empty()) {
		fail("Scene \"", p_scene.name, "\" has no perspective camera. Add one, and export it too.");
	}
	ReportView view = { cameras.front(), p_scene.scene->find_nodes<Light3D>() };
	std::erase_if(view.lights, [](const Light3D *p_light) { return !casts_shadow(*p_light); });
	if (view.lights.empty()) {
		fail("Scene \"", p_scene.name, "\" has no light that casts shadows. Add one ",
				"(KHR_lights_punctual) with extras.shadow_enabled true.");
	}
	return view;
}

} // namespace gnomon
