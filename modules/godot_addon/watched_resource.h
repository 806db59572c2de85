#pragma once

#include <godot_api.gen.h>

#include <memory>

namespace gnomon {

/// Reports whether a Resource of Godot has changed since the last query. It does not keep the
/// resource alive. Main thread only.
class WatchedResource {
public:
	explicit WatchedResource(const godot::Resource &p_resource);
	~WatchedResource();
	WatchedResource(const WatchedResource &) = delete;
	WatchedResource &operator=(const WatchedResource &) = delete;

	bool take_change() { return std::exchange(*has_changed, false); }
	bool is_alive() const { return godot::get_instance(id) != nullptr; }

private:
	uint64_t id;
	std::shared_ptr<bool> has_changed = std::make_shared<bool>(false);
	godot::Callable on_changed;
};

} // namespace gnomon
