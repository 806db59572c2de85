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

/// A mask that was read back from the GPU, and the camera of its view.
struct ReadMask {
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<float> visibility; // 0 to 1, rows from the top; -1: no receiver
	godot::Transform3D camera;
};

/// A request to read back the masks of one light. Filled on the render thread.
struct MaskRequest {
	std::string light; // name in the frame's SceneSnapshot
	std::mutex mutex;  // guards masks
	std::vector<ReadMask> masks;
};

/// The native data of a GnomonShadow3D node. Main thread only.
class ShadowNode {
public:
	explicit ShadowNode(void *p_object) : node(p_object) {}

	const godot::Node3D &get_node() const { return node; }
	/// Returns the parent; empty if that is not a light.
	godot::Light3D find_light() const;
	/// Returns the node's path, which is unique in the scene tree; also used in messages.
	std::string get_path() const;

	/// Returns the technique's id; the project's if the node is set to DEFAULT_TECHNIQUE.
	const std::string &get_technique() const;
	bool shows_mask() const;
	bool casts_back_faces() const;
	/// p_property: index in get_shadow_properties().
	PropertyValue get_value(size_t p_property) const;
	/// Throws an Error that names the node, and changes nothing, if the value is out of range.
	void set_value(size_t p_property, const PropertyValue &p_value);
	/// Returns the properties of the node and of its light, as a LightSnapshot has them.
	PropertyValues make_light_properties(bool p_is_directional) const;
	/// True for the properties of techniques other than the node's.
	bool is_hidden(size_t p_property) const;

	/// Returns the configuration warnings for Godot's editor.
	std::vector<std::string> find_warnings() const;
	/// Updates the warnings that the editor shows. Call once per frame in the editor.
	void update_warnings();

	/// Calls p_callback with the mask (an Image) and the camera's Transform3D for each view of the
	/// next frame.
	void read_masks(const godot::Variant &p_callback);
	/// Returns the request that read_masks() made for the next frame; null: there is none.
	std::shared_ptr<MaskRequest> get_request() const { return request; }
	/// Calls the callbacks of read_masks if their masks were read back meanwhile.
	void call_back();

	int64_t pending_caster_count = 0; // casters of the world whose edges are not computed yet
	bool makes_mask = false;		  // in the last frame

private:
	godot::Node3D node;
	PropertyValues values; // only those that differ from the default
	std::vector<std::string> shown_warnings;
	std::vector<godot::Variant> callbacks;
	std::shared_ptr<MaskRequest> request;
};

/// Sets the technique of nodes that are set to DEFAULT_TECHNIQUE. Main thread only.
void set_default_technique(const std::string &p_technique);

/// Register and unregister the class GnomonShadow3D.
void register_shadow_node_class();
void unregister_shadow_node_class();
/// Sets a function that is called when a GnomonShadow3D enters the scene tree, and at once if one
/// is already there. Empty: no function.
void set_shadow_node_listener(std::function<void()> p_listener);
/// Sets a function that is called when the last GnomonShadow3D leaves the scene tree. Empty: no
/// function.
void set_last_shadow_node_listener(std::function<void()> p_listener);
/// Sets a function that gets the shader of each material whose inspect_native_shader_code() was
/// called while a GnomonShadow3D was in the group of Godot's native shader viewer (see
/// ReceiverMaterials). Empty: no function.
void set_shader_listener(std::function<void(godot::RID)> p_listener);
/// Returns all GnomonShadow3D nodes in the scene tree.
const std::vector<ShadowNode *> &get_shadow_nodes();

} // namespace gnomon
