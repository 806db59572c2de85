#pragma once

#include "modules/core/property.h"

#include <godot_api.gen.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// A mask that was read back, and the camera that saw it.
struct ReadMask {
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<float> visibility; // rows from the top; -1: no receiver
	godot::Transform3D camera;
};

/// Masks of one light that a caller waits for. Filled on the render thread.
struct MaskRequest {
	std::string light;
	std::mutex mutex; // of what follows
	std::vector<ReadMask> masks;
};

/// What GnomonShadow3D is in addition to a Node3D. Main thread only.
class ShadowNode {
public:
	explicit ShadowNode(void *p_object) : node(p_object) {}

	const godot::Node3D &get_node() const { return node; }
	/// Its parent; empty: that is no light.
	godot::Light3D find_light() const;
	/// Of the node, unique in the tree; for messages too.
	std::string get_path() const;

	/// The project's where the node has the default one.
	const std::string &get_technique() const;
	bool shows_mask() const;
	PropertyValue get_value(size_t p_property) const;
	/// A value out of range is an Error that names the node, and changes nothing.
	void set_value(size_t p_property, const PropertyValue &p_value);
	/// As LightSettings::properties.
	PropertyValues make_light_properties(bool p_is_directional) const;
	/// Of properties of other techniques than the one that is set.
	bool is_hidden(size_t p_property) const;

	/// For the scene tree of Godot's editor.
	std::vector<std::string> find_warnings() const;
	/// Updates what is shown where they changed. Once a frame in the editor.
	void update_warnings();

	void read_masks(const godot::Variant &p_callback);
	/// What the frame about to be drawn has to read; null: nothing.
	std::shared_ptr<MaskRequest> get_request() const { return request; }
	/// Hands over what was read.
	void call_back();

	int64_t pending_caster_count = 0;
	bool makes_mask = false; // in the last frame

private:
	godot::Node3D node;
	PropertyValues values; // what differs from the default
	std::vector<std::string> shown_warnings;
	std::vector<godot::Variant> callbacks;
	std::shared_ptr<MaskRequest> request;
};

/// Of nodes with DEFAULT_TECHNIQUE. Main thread only.
void set_default_technique(const std::string &p_technique);

/// Registers the class GnomonShadow3D, or removes it.
void register_shadow_node_class();
void unregister_shadow_node_class();
/// Called when one enters the scene tree, and at once where one is in it. Empty: nothing.
void set_shadow_node_listener(std::function<void()> p_listener);
/// Called with the shader of a material that Material::inspect_native_shader_code was called of
/// while one of the nodes was in the group of its viewers. Empty: nothing.
void set_shader_listener(std::function<void(godot::RID)> p_listener);
/// All nodes of that class in the scene tree.
const std::vector<ShadowNode *> &get_shadow_nodes();

} // namespace gnomon
