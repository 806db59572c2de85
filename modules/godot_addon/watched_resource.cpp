#include "modules/godot_addon/watched_resource.h"

namespace gnomon {

WatchedResource::WatchedResource(const godot::Resource &p_resource) :
		id(godot::get_instance_id(p_resource.get_object())),
		on_changed([has_changed = has_changed](auto) { *has_changed = true; }) {
	p_resource.connect("changed", on_changed, /*flags=*/0);
}

WatchedResource::~WatchedResource() {
	if (void *alive = godot::get_instance(id)) {
		godot::Object(alive).disconnect("changed", on_changed);
	}
}

} // namespace gnomon
