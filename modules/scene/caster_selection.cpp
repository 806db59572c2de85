#include "modules/scene/caster_selection.h"

#include "modules/core/files.h"
#include "modules/scene/cut_levels.h"
#include "modules/scene/mesh_pose.h"

#include <algorithm>
#include <optional>

namespace gnomon {

namespace {

/// Returns the level of detail that suits the light if the instance is cut out; otherwise its
/// caster mesh.
std::shared_ptr<const Mesh> choose_caster_mesh(const InstanceSnapshot &p_instance,
		const LightSnapshot &p_light, const Bounds &p_scene_bounds) {
	if (!p_instance.caster_levels) {
		return p_instance.caster_mesh;
	}
	const CutLevels &levels = *p_instance.caster_levels;
	const std::shared_ptr<const Mesh> mesh = levels.get_mesh(levels.choose_level(
			p_instance.compute_max_penumbra_half_width(p_light, p_scene_bounds)));
	if (!mesh) {
		return p_instance.caster_mesh;
	}
	return p_instance.pose_slot ? p_instance.pose_slot->get_deformed(mesh) : mesh;
}

/// What an instance casts of a light.
struct Choice {
	bool casts_shadow = false;
	std::shared_ptr<const Mesh> caster_mesh;
	bool has_own_mesh = false; // see InstanceSnapshot::caster_meshes_of_lights
};

/// Empty: the instance casts what it says.
std::optional<Choice> choose(const InstanceSnapshot &p_instance, const LightSnapshot &p_light,
		const Bounds &p_scene_bounds) {
	if (!p_instance.casts_shadow) {
		return {};
	}
	const auto of_light = p_instance.caster_meshes_of_lights.find(p_light.name);
	const bool has_own = of_light != p_instance.caster_meshes_of_lights.end();
	Choice choice;
	choice.casts_shadow =
			(p_instance.layers & p_light.caster_layers) != 0 && (!has_own || of_light->second);
	choice.has_own_mesh = choice.casts_shadow && has_own;
	choice.caster_mesh = !choice.casts_shadow ? p_instance.caster_mesh
			: has_own						  ? of_light->second
					  : choose_caster_mesh(p_instance, p_light, p_scene_bounds);
	if (choice.casts_shadow && choice.caster_mesh == p_instance.caster_mesh) {
		return {};
	}
	return choice;
}

uint64_t hash_light(const LightSnapshot &p_light) {
	const uint64_t hash = p_light.compute_hash(compute_text_hash(p_light.name));
	return compute_value_hash(p_light.caster_layers, hash);
}

} // namespace

std::shared_ptr<const SceneSnapshot> CasterSelection::update(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, const Bounds &p_bounds) {
	const uint64_t hash = hash_light(p_light);
	if (hash != light_hash || p_bounds.minimum != bounds_world.minimum ||
			p_bounds.maximum != bounds_world.maximum) {
		source = {};
	}
	light_hash = hash;
	bounds_world = p_bounds;
	const SharedVector<InstanceSnapshot> &instances = p_scene.instances;
	const std::vector<uint32_t> changed = instances.find_changed_pages(source);
	const SharedVector<InstanceSnapshot> before = selected;
	selected = instances;
	differs.resize(instances.get_page_count());
	for (const uint32_t page : changed) {
		differs[page] = 0;
	}
	for (size_t page = 0; page < differs.size(); ++page) {
		if (differs[page] != 0) { // so the page has not changed
			selected.share_page(page, before);
		}
	}
	for (const uint32_t page : changed) {
		size_t index = page * SharedVector<InstanceSnapshot>::PAGE_SIZE;
		for (const InstanceSnapshot &instance : instances.get_page(page)) {
			if (std::optional<Choice> choice = choose(instance, p_light, p_bounds)) {
				InstanceSnapshot &chosen = selected.edit(index);
				chosen.casts_shadow = choice->casts_shadow;
				chosen.caster_mesh = std::move(choice->caster_mesh);
				if (choice->has_own_mesh) {
					chosen.cut_hash = chosen.caster_mesh->content_hash;
				}
				differs[page] = 1;
			}
			++index;
		}
	}
	source = instances;
	if (std::ranges::none_of(differs, [](uint8_t p_differs) { return p_differs != 0; })) {
		return nullptr;
	}
	auto selection = std::make_shared<SceneSnapshot>(p_scene);
	selection->instances = selected;
	return selection;
}

std::shared_ptr<const SceneSnapshot> SceneSnapshot::select_casters(
		const LightSnapshot &p_light) const {
	return CasterSelection().update(*this, p_light, compute_bounds());
}

} // namespace gnomon
