#include "modules/godot_addon/receiver_reader.h"

#include <algorithm>

namespace gnomon {

namespace {

using godot::GeometryInstance3D;

} // namespace

bool reaches(const godot::Light3D &p_light, const std::vector<Receiver> &p_receivers) {
	const bool is_everywhere = bool(godot::cast<godot::DirectionalLight3D>(p_light));
	const glm::dvec3 position(get_drawn_transform(p_light).to_matrix()[3]);
	const double range_m = p_light.get_param(godot::Light3D::PARAM_RANGE);
	const int64_t mask = p_light.get_cull_mask();
	return std::any_of(p_receivers.begin(), p_receivers.end(), [&](const Receiver &p_receiver) {
		return (mask & int64_t(p_receiver.layers)) != 0 &&
				(is_everywhere || p_receiver.bounds_world.compute_distance(position) <= range_m);
	});
}

void ReceiverReader::read(const SceneBody &p_body, const godot::Material &p_material,
		const godot::Mesh &p_mesh, int64_t p_surface, const Bounds &p_bounds_world,
		const std::string &p_unknown_reason) {
	if (!p_body.is_drawn) {
		return;
	}
	add_receiver(p_body,
			p_material ? materials.use(p_material, p_body.node, p_unknown_reason)
					   : materials.use_bare(p_mesh, p_surface),
			p_bounds_world);
	const auto geometry = godot::cast<GeometryInstance3D>(p_body.node);
	if (const godot::Ref<godot::Material> overlay =
					geometry ? geometry.get_material_overlay() : godot::Ref<godot::Material>()) {
		add_receiver(p_body, materials.use(overlay, p_body.node), p_bounds_world);
	}
}

void ReceiverReader::read_mesh(
		const SceneBody &p_body, const godot::Mesh &p_mesh, const Bounds &p_bounds_world) {
	const godot::Ref<godot::Material> override_material =
			godot::cast<GeometryInstance3D>(p_body.node).get_material_override();
	for (int64_t index = 0; p_mesh && index < p_mesh.get_surface_count(); ++index) {
		const godot::Ref<godot::Material> own = p_mesh.surface_get_material(index);
		read(p_body, override_material ? override_material : own, p_mesh, index, p_bounds_world);
	}
}

void ReceiverReader::read_other(const SceneBody &p_body, const Bounds &p_bounds_world) {
	if (const auto particles = godot::cast<godot::GPUParticles3D>(p_body.node)) {
		for (int64_t pass = 0; pass < particles.get_draw_passes(); ++pass) {
			const godot::Ref<godot::Mesh> mesh = particles.get_draw_pass_mesh(pass);
			read_mesh(p_body, mesh, p_bounds_world);
		}
	} else if (const auto cpu_particles = godot::cast<godot::CPUParticles3D>(p_body.node)) {
		const godot::Ref<godot::Mesh> mesh = cpu_particles.get_mesh();
		read_mesh(p_body, mesh, p_bounds_world);
	} else if (p_body.is_drawn) {
		const auto sprite = godot::cast<godot::SpriteBase3D>(p_body.node);
		const auto label = godot::cast<godot::Label3D>(p_body.node);
		const bool is_unlit = (sprite && !sprite.get_draw_flag(godot::SpriteBase3D::FLAG_SHADED)) ||
				(label && !label.get_draw_flag(godot::Label3D::FLAG_SHADED));
		add_receiver(p_body, is_unlit ? ReceiverKind::UNLIT : ReceiverKind::GODOT, p_bounds_world);
	}
}

void ReceiverReader::add_receiver(
		const SceneBody &p_body, ReceiverKind p_kind, const Bounds &p_bounds_world) {
	world.has_faded = world.has_faded || p_body.is_faded;
	add(p_body.is_faded && p_kind == ReceiverKind::PATCHED ? ReceiverKind::GODOT : p_kind,
			p_bounds_world, p_body.layers);
}

void ReceiverReader::add(ReceiverKind p_kind, const Bounds &p_bounds_world, uint32_t p_layers) {
	if (p_kind == ReceiverKind::GODOT) {
		world.others.push_back({ p_bounds_world, p_layers });
	} else if (p_kind != ReceiverKind::UNLIT) {
		world.masked.push_back({ p_bounds_world, p_layers });
	}
}

} // namespace gnomon
