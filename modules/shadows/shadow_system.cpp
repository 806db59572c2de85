#include "modules/shadows/shadow_system.h"

#include "modules/core/limits.h"
#include "modules/core/log.h"

namespace gnomon {

ShadowSystem::ShadowSystem(RenderingDevice &p_device, std::shared_ptr<MeshStore> p_meshes) :
		device(p_device),
		meshes(p_meshes ? std::move(p_meshes) : std::make_shared<MeshStore>(p_device)) {}

ShadowSystem::Slot &ShadowSystem::get_slot(
		const SlotKey &p_key, const ShadowTechniqueInfo &p_info) {
	Slot &slot = slots[p_key];
	if (!slot.technique || slot.technique_id != p_info.id) {
		slot.technique.reset(); // first, so that the resources of both never exist at once
		slot.technique = p_info.make();
		slot.technique_id = p_info.id;
	}
	slot.last_frame = frame;
	return slot;
}

float ShadowSystem::get_standard_error(const std::string &p_light_name) const {
	const auto slot = slots.find({ p_light_name, 0 });
	return slot == slots.end() ? 0.0f : slot->second.technique->get_standard_error();
}

std::vector<WorkCounter> ShadowSystem::get_counters(const std::string &p_light_name) const {
	std::vector<WorkCounter> counters;
	const auto slot = slots.find({ p_light_name, 0 });
	if (slot != slots.end()) {
		slot->second.technique->get_counters(counters);
	}
	return counters;
}

void ShadowSystem::begin_frame(const SceneSnapshot &p_scene) {
	if (technique_revision != ShadowRegistry::get_revision()) {
		technique_revision = ShadowRegistry::get_revision();
		slots.clear();
		warned.clear(); // a warning is due again after modules were switched
	}
	if (filter_revision != MaskFilterRegistry::get_revision()) {
		filter_revision = MaskFilterRegistry::get_revision();
		filters.clear();
		for (const MaskFilterInfo &info : MaskFilterRegistry::get_all()) {
			filters.push_back(info.make());
		}
	}
	warn_once("scene_size", describe_scene_size_problem(p_scene));
	++frame;
	std::erase_if(slots, [&](const auto &p_slot) {
		return frame - p_slot.second.last_frame > MAX_UNUSED_FRAMES ||
				p_scene.find_light(p_slot.first.first) == nullptr;
	});
}

void ShadowSystem::warn_once(const std::string &p_warning) {
	warn_once(p_warning, p_warning);
}

void ShadowSystem::warn_once(const std::string &p_key, const std::string &p_warning) {
	if (!p_warning.empty() && warned.insert(p_key).second) {
		log_warning(p_warning);
	}
}

} // namespace gnomon
