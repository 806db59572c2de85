#pragma once

#include "modules/scene/nodes.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// A scene of a project, or why it could not be loaded.
struct ReportScene {
	std::string name;
	std::shared_ptr<const Scene> scene;
	std::string failure;
};

/// What of a scene is measured: how it is seen, and the masks of which lights.
struct ReportView {
	Camera3D *camera = nullptr;
	std::vector<Light3D *> lights; // those that cast shadows; at least one
};
/// An Error where the scene was not loaded, has no camera, or no light that casts shadows.
ReportView find_report_view(const ReportScene &p_scene);

} // namespace gnomon
