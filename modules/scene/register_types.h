#pragma once

// The build requires this file in every module. Scene registers nothing: file readers create the
// nodes, and other modules find them by class (Scene::find_nodes).
