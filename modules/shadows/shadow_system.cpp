#include "modules/shadows/shadow_system.h"

#include "modules/core/limits.h"
#include "modules/core/log.h"
#include "modules/core/text.h"
#include "modules/shadows/camera_view.h"

namespace gnomon {

namespace {

bool differ_in_camera_only(const SceneSnapshot &p_before, const SceneSnapshot &p_scene) {
	return p_before.instances.shares_items_with(p_scene.instances) &&
			p_before.lights.shares_items_with(p_scene.lights) &&
			p_before.has_far_sides == p_scene.has_far_sides &&
			p_before.scene_size_m == p_scene.scene_size_m;
}

void add_cut_out_lines(
		std::span<const InstanceSnapshot> p_instances, std::vector<std::string> &r_lines) {
	for (const InstanceSnapshot &instance : p_instances) {
		if (instance.casts_shadow && instance.cut_block_size_px > 0) {
			r_lines.push_back(
					text("holes of \"", instance.node_name, "\" as squares, one for each block of ",
							instance.cut_block_size_px, " texels"));
		}
	}
}

} // namespace

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
		slot.derived_run = {};
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

void ShadowSystem::explain(const std::string &p_light_name, const ProbedReceiver &p_receiver,
		ProbeEntry &r_explanation) const {
	const auto slot = slots.find({ p_light_name, 0 });
	if (slot != slots.end()) {
		slot->second.technique->explain(p_receiver, r_explanation);
	}
}

void ShadowSystem::begin_frame(const SceneSnapshot &p_scene, glm::uvec2 p_size_px) {
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
	++frame;
	if (!derived_scene.scene || !differ_in_camera_only(*derived_scene.scene, p_scene)) {
		derive_scene(p_scene);
	}
	if (!derived_camera.is_valid || derived_camera.camera_hash != p_scene.camera.compute_hash(0) ||
			derived_camera.size_px != p_size_px) {
		derive_camera(p_scene, p_size_px);
	}
	std::erase_if(slots, [&](const auto &p_slot) {
		return frame - p_slot.second.last_frame > MAX_UNUSED_FRAMES ||
				p_scene.find_light(p_slot.first.first) == nullptr;
	});
}

void ShadowSystem::derive_scene(const SceneSnapshot &p_scene) {
	derived_scene.scene = p_scene;
	derived_scene.summary.update(p_scene.instances);
	++derived_scene.revision;
	const SceneSummary &summary = derived_scene.summary;
	warn_once("scene_size", describe_scene_size_problem(p_scene.scene_size_m, summary));
	derived_scene.cut_out_lines.clear();
	for (size_t page = 0; page < summary.get_pages().size(); ++page) {
		if (summary.get_pages()[page].cut_block_count > 0) {
			add_cut_out_lines(p_scene.instances.get_page(page), derived_scene.cut_out_lines);
		}
	}
	derived_camera.is_valid = false;
}

void ShadowSystem::derive_camera(const SceneSnapshot &p_scene, glm::uvec2 p_size_px) {
	const uint64_t camera_hash = p_scene.camera.compute_hash(0);
	const LightView view = make_shifted_camera_view(p_scene.camera, p_size_px);
	const bool is_same_view = derived_camera.camera_hash == camera_hash &&
			derived_camera.size_px == p_size_px &&
			derived_camera.scene_size_m == p_scene.scene_size_m;
	derived_camera = { /*is_valid=*/true, camera_hash, p_size_px, p_scene.instances,
		p_scene.scene_size_m,
		compute_frame_constants(p_scene, derived_scene.summary.get_caster_bounds(), p_size_px),
		is_same_view ? find_visible_receivers(p_scene, view, derived_camera.receivers,
							   p_scene.instances.find_changed_pages(derived_camera.instances))
					 : find_visible_receivers(p_scene, view),
		/*lit_receivers=*/{} };
	for (auto &[key, slot] : slots) {
		slot.derived_run.light = nullptr;
		if (slot.derived_light.selection) {
			auto selection = std::make_shared<SceneSnapshot>(*slot.derived_light.selection);
			selection->camera = p_scene.camera;
			slot.derived_light.selection = std::move(selection);
		}
	}
}

const VisibleReceivers &ShadowSystem::derive_lit_receivers(const LightSnapshot &p_light) {
	const auto [entry, is_new] = derived_camera.lit_receivers.try_emplace(&p_light);
	if (is_new) {
		entry->second = find_lit_receivers(p_light, derived_camera.receivers);
	}
	return entry->second;
}

void ShadowSystem::derive_light(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, DerivedLight &r_light) {
	if (r_light.light == &p_light && r_light.scene_revision == derived_scene.revision) {
		return;
	}
	r_light.light = &p_light;
	r_light.scene_revision = derived_scene.revision;
	r_light.selection =
			r_light.casters.update(p_scene, p_light, derived_scene.summary.get_bounds());
	if (r_light.selection) {
		r_light.selection_summary.update(r_light.selection->instances);
	} else {
		r_light.selection_summary = {};
	}
	const SceneSummary &summary = r_light.get_summary(derived_scene);
	r_light.translucent = summary.get_whole().has_translucent_casters
			? find_translucent_casters(r_light.selection ? *r_light.selection : p_scene, p_light)
			: TranslucentCasters();
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
