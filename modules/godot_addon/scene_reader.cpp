#include "modules/godot_addon/scene_reader.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/godot_addon/server_casters.h"
#include "modules/scene/box_mesh.h"

#include <algorithm>

namespace gnomon {

namespace {

using godot::GeometryInstance3D;

const float MAX_COORDINATE_M = 1e8f;   // nodes beyond are not found
const size_t MAX_PASSES = 64;		   // of materials
const size_t MAX_MOVED_INSTANCES = 64; // of a node, each moved by vertex() in its own way
const double MAX_MOVE_PER_SIDE = 4.0;  // of find_move_margin, times the box's longest side
const double MIN_SCENE_SIZE_M = 1e-9;  // it is a divisor, also in a world without casters
// In a MultiMesh's buffer: floats of an instance's colour, and of its custom data.
const size_t COLOR_FLOATS = 4;

/// Returns how far vertex() may move vertices out of the box of their mesh, in metres.
double find_move_margin(const Bounds &p_box) {
	const glm::dvec3 size = p_box.maximum - p_box.minimum;
	return MAX_MOVE_PER_SIDE * std::max({ size.x, size.y, size.z });
}

/// Returns the id of each node in the world once. All instances of a node, and its gizmos, have the
/// node's id.
std::vector<uint64_t> find_instances(godot::RID p_scenario) {
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	const godot::AABB everywhere = { glm::vec3(-MAX_COORDINATE_M),
		glm::vec3(2 * MAX_COORDINATE_M) };
	const godot::PackedInt64Array found = server.instances_cull_aabb(everywhere, p_scenario);
	std::vector<uint64_t> ids(found.get_values().begin(), found.get_values().end());
	std::sort(ids.begin(), ids.end());
	ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
	return ids;
}

glm::dmat4 read_instance_transform(std::span<const float> p_floats, bool p_is_3d) {
	// 3 or 2 rows of 4 columns. In 2D the third column is unused.
	glm::dmat4 matrix(1.0);
	for (int row = 0; row < (p_is_3d ? 3 : 2); ++row) {
		for (int column = 0; column < 4; ++column) {
			if (p_is_3d || column != 2) {
				matrix[column][row] = p_floats[size_t(row) * 4 + size_t(column)];
			}
		}
	}
	return matrix;
}

bool has_fog_or_gi(const godot::Environment &p_environment) {
	return p_environment &&
			(p_environment.is_volumetric_fog_enabled() || p_environment.is_sdfgi_enabled());
}

/// Returns how often Godot draws a surface with the material, at most. One with a depth prepass is
/// in the lists of opaque and of blended surfaces.
size_t count_passes(const godot::Ref<godot::Material> &p_material, ShadowMaterials &r_materials) {
	size_t count = p_material ? 0 : 1;
	for (godot::Ref<godot::Material> pass = p_material; pass && count < MAX_PASSES;
			pass = pass.get_next_pass()) {
		count += r_materials.read(pass).kind == ShadowKind::CUT_OUT ? 2 : 1;
	}
	return count;
}

/// Returns how often Godot draws surfaces of a node's mesh, at most.
size_t count_draws(
		const GeometryInstance3D &p_node, const godot::Mesh &p_mesh, ShadowMaterials &r_materials) {
	const auto mesh_instance = godot::cast<godot::MeshInstance3D>(p_node);
	const godot::Ref<godot::Material> override_material = p_node.get_material_override();
	const godot::Ref<godot::Material> overlay = p_node.get_material_overlay();
	const size_t overlay_count = overlay ? count_passes(overlay, r_materials) : 0;
	size_t count = 0;
	for (int64_t index = 0; p_mesh && index < p_mesh.get_surface_count(); ++index) {
		const godot::Ref<godot::Material> material = mesh_instance
				? mesh_instance.get_active_material(index)
				: override_material ? godot::Ref<godot::Material>::share(override_material)
									: p_mesh.surface_get_material(index);
		count += count_passes(material, r_materials) + overlay_count;
	}
	return count;
}

size_t count_draws(const GeometryInstance3D &p_node, ShadowMaterials &r_materials) {
	if (const auto mesh_instance = godot::cast<godot::MeshInstance3D>(p_node)) {
		return count_draws(p_node, mesh_instance.get_mesh(), r_materials);
	}
	if (const auto multi = godot::cast<godot::MultiMeshInstance3D>(p_node)) {
		const godot::Ref<godot::MultiMesh> multi_mesh = multi.get_multimesh();
		return multi_mesh ? count_draws(p_node, multi_mesh.get_mesh(), r_materials) : 0;
	}
	return MAX_PASSES; // few surfaces: CSG shapes, sprites, labels, particles
}

void set_casting(SceneBody &r_body, int64_t p_setting) {
	r_body.casts_shadow = p_setting != GeometryInstance3D::SHADOW_CASTING_SETTING_OFF;
	r_body.is_double_sided = p_setting == GeometryInstance3D::SHADOW_CASTING_SETTING_DOUBLE_SIDED;
	r_body.is_drawn = p_setting != GeometryInstance3D::SHADOW_CASTING_SETTING_SHADOWS_ONLY;
}

/// Whether the box by which Godot culls a node cannot be read: physics or bones set it.
bool has_hidden_culling_box(const godot::ObjectHandle &p_node) {
	const auto mesh_instance = godot::cast<godot::MeshInstance3D>(p_node);
	return godot::cast<godot::SoftBody3D>(p_node) ||
			(mesh_instance && mesh_instance.get_skin_reference());
}

/// Whether Godot draws a sprite or label into shadow maps: only if its alpha is cut.
template <typename Node> bool is_alpha_cut(const Node &p_node) {
	return p_node && p_node.get_alpha_cut_mode() != Node::ALPHA_CUT_DISABLED;
}

/// Whether Godot draws any of the materials of particles into shadow maps.
bool cast_particles(const std::vector<godot::Ref<godot::Mesh>> &p_meshes,
		const godot::Material &p_override, ShadowMaterials &r_materials) {
	for (const godot::Ref<godot::Mesh> &mesh : p_meshes) {
		for (int64_t index = 0; mesh && index < mesh.get_surface_count(); ++index) {
			const godot::Ref<godot::Material> own = mesh.surface_get_material(index);
			const ShadowSurface surface = p_override ? r_materials.read(p_override)
					: own							 ? r_materials.read(own)
													 : ShadowSurface();
			if (surface.kind != ShadowKind::NONE) {
				return true;
			}
		}
	}
	return false;
}

/// Whether a camera of the world needs Godot's shadows: for volumetric fog, for SDFGI, or because
/// no masks are made for its projection.
bool needs_godot_shadows(const godot::SceneTree &p_tree, godot::RID p_scenario) {
	bool needs = false;
	for_each_camera(
			p_tree, p_scenario, [&](const godot::Viewport &, const godot::Camera3D &p_camera) {
				const godot::Ref<godot::World3D> world = p_camera.get_world_3d();
				const godot::Ref<godot::Environment> of_world = world.get_environment();
				const godot::Ref<godot::Environment> of_camera = p_camera.get_environment();
				needs = needs || has_fog_or_gi(of_world) || has_fog_or_gi(of_camera) ||
						p_camera.get_projection() != godot::Camera3D::PROJECTION_PERSPECTIVE;
			});
	return needs;
}

} // namespace

void SceneReader::add_notice(const SceneBody &p_body, const std::string &p_text) {
	if (notices.is_logged(p_text)) {
		return;
	}
	notices.add(p_text, text("\"", p_body.node.get_path().to_utf8(), "\""), p_text);
}

bool SceneReader::add_view_notices(const std::vector<ViewDetail> &p_views) {
	bool has_masked_view = p_views.empty(); // views that Godot's scene tree does not know
	for (const ViewDetail &view : p_views) {
		const bool is_masked = view.orthogonal_camera.empty();
		has_masked_view = has_masked_view || is_masked;
		if (!is_masked) {
			notices.add("orthogonal", text("\"", view.orthogonal_camera, "\""),
					"has an orthogonal projection: its view has Godot's own shadows. Gnomon's need "
					"a perspective camera.");
		}
	}
	return has_masked_view;
}

std::string SceneReader::find_unknown_motion(
		const SceneBody &p_body, const VertexMotion &p_motion) {
	if (!p_motion.unknown_reason.empty() || !p_motion.function) {
		return p_motion.unknown_reason;
	}
	const VertexTranslation &translation = p_motion.function->translation;
	if (translation.uses_node && p_body.instance_count > MAX_MOVED_INSTANCES) {
		return text("moves more than ", MAX_MOVED_INSTANCES, " instances in vertex()");
	}
	if (translation.uses_color && p_body.has_instance_colors) {
		return "moves its vertices in vertex() by colours of instances";
	}
	return {};
}

VertexMove SceneReader::read_move(const SceneBody &p_body, const Mesh &p_mesh,
		const ShadowSurface &p_shadow, const godot::Material &p_material,
		const glm::dmat4 &p_world_from_mesh) {
	VertexSource source;
	source.node = godot::cast<GeometryInstance3D>(p_body.node);
	source.world_from_mesh = p_world_from_mesh;
	source.time_s = p_shadow.motion.function->translation.uses_time ? shader_time.use() : 0;
	source.instance = static_cast<uint32_t>(p_body.instance);
	source.bounds = p_mesh.bounds_node;
	glm::dvec3 margin_m(0.0);
	if (const auto node = godot::cast<godot::MeshInstance3D>(p_body.node)) {
		const godot::AABB box = get_culling_box(node);
		source.bounds = { box.position, box.position + box.size };
		margin_m += node.get_extra_cull_margin();
		if (node.get_custom_aabb().size == glm::vec3(0.0f)) {
			margin_m += find_move_margin(source.bounds);
		}
	} else {
		margin_m += find_move_margin(source.bounds);
	}
	source.bounds.minimum -= margin_m;
	source.bounds.maximum += margin_m;
	return materials.read_move(p_shadow, p_material, source);
}

void SceneReader::read_mesh(const SceneBody &p_body, const godot::Mesh &p_mesh,
		const glm::dmat4 &p_world_from_mesh, SceneSnapshot &r_scene) {
	const auto geometry = godot::cast<GeometryInstance3D>(p_body.node);
	const auto mesh_instance = godot::cast<godot::MeshInstance3D>(p_body.node);
	for (const ReadSurface &surface : meshes.read(p_mesh, p_body.name)) {
		if (!surface.mesh) {
			continue;
		}
		godot::Ref<godot::Material> material;
		if (mesh_instance) {
			material = mesh_instance.get_active_material(surface.index);
		} else {
			if (geometry) {
				material = geometry.get_material_override();
			}
			if (!material) {
				material = p_mesh.surface_get_material(surface.index);
			}
		}
		const ShadowSurface shadow = material ? materials.read(material) : ShadowSurface();
		const VertexMotion &motion = shadow.motion;
		const bool is_moved = motion != VertexMotion();
		ReadSurface drawn = surface;
		const std::string unknown_reason = find_unknown_motion(p_body, motion);
		const bool has_program = motion.function && unknown_reason.empty();
		if (motion.grow_m != 0) {
			drawn.mesh = meshes.grow(surface, motion.grow_m);
		} else if (has_program) {
			drawn.mesh = meshes.make_movable(surface, p_mesh, motion.function->translation);
		}
		const bool is_billboard = motion.billboard != VertexMotion::Billboard::NONE;
		const std::vector<ViewDetail> &views = world_frame->views;
		InstanceSnapshot instance = make_instance(drawn.mesh, shadow.cut_out,
				is_billboard && !views.empty() ? turn_to_camera(motion, p_world_from_mesh,
														 views.front().camera.to_matrix())
											   : p_world_from_mesh,
				p_body.name);
		instance.layers = p_body.layers;
		instance.casts_shadow = instance.casts_shadow && p_body.casts_shadow &&
				shadow.kind != ShadowKind::NONE && unknown_reason.empty();
		const bool is_ready = meshes.is_ready(drawn) &&
				(instance.caster_mesh == drawn.mesh || meshes.is_cut_ready(instance.caster_mesh));
		if (has_program || (mesh_instance && drawn.mesh->attributes.rig)) {
			const bool is_own = has_program && motion.function->translation.uses_node;
			const PoseReader::Key key = { godot::get_instance_id(p_body.node.get_object()),
				godot::get_instance_id(p_mesh.get_object()), surface.index,
				is_own ? p_body.instance : 0 };
			// Instances that vertex() moves alike have one pose.
			if (!poses.repeat(key, instance)) {
				poses.pose(key, mesh_instance, drawn.mesh,
						has_program ? read_move(p_body, *drawn.mesh, shadow, material,
											  p_world_from_mesh)
									: VertexMove(),
						instance);
			}
		}
		receivers.read(
				p_body, material, p_mesh, surface.index, instance.bounds_world, unknown_reason);
		if (instance.casts_shadow && !is_ready) {
			instance.casts_shadow = false;
			++pending_count;
		}
		if (is_billboard) {
			for (ViewDetail &view : world_frame->views) {
				InstanceSnapshot turned = make_instance(drawn.mesh, shadow.cut_out,
						turn_to_camera(motion, p_world_from_mesh, view.camera.to_matrix()),
						p_body.name);
				turned.layers = instance.layers;
				turned.casts_shadow = instance.casts_shadow;
				view.billboards.emplace_back(r_scene.instances.size(), std::move(turned));
			}
		}
		if (instance.casts_shadow && shadow.culling != ShadowCulling::NONE &&
				!p_body.is_double_sided && !is_billboard && !instance.pose &&
				instance.caster_mesh == drawn.mesh) {
			culled.push_back({ r_scene.instances.size(), shadow.culling });
		}
		if (surface.levels && !is_moved) {
			details.push_back({ r_scene.instances.size(), surface.levels, /*bounds_world=*/{},
					/*scale=*/1 }); // finish_details sets both
		}
		r_scene.instances.push_back(std::move(instance));
	}
}

void SceneReader::read_light_node(const godot::Light3D &p_light) {
	const bool is_listed = std::any_of(world.other_lights.begin(), world.other_lights.end(),
			[&](const godot::Light3D &p_listed) {
				return p_listed.get_object() == p_light.get_object();
			});
	if (p_light.is_visible_in_tree() && !is_listed) {
		world.other_lights.push_back(p_light); // read() removes the masked ones
	}
}

void SceneReader::finish_details(
		const SceneBody &p_body, size_t p_first, const SceneSnapshot &p_scene) {
	if (p_first == details.size()) {
		return;
	}
	Bounds bounds_world;
	for (size_t index = p_first; index < details.size(); ++index) {
		const InstanceSnapshot &instance = p_scene.instances[details[index].instance];
		bounds_world.add(instance.bounds_world);
		if (instance.pose && instance.pose->get_joints().empty()) {
			// Godot's box includes all blend shapes, whatever their weights. With a skeleton, it
			// follows the bones, as bounds_world does.
			const godot::AABB box = godot::cast<godot::VisualInstance3D>(p_body.node).get_aabb();
			bounds_world.add(transform_bounds(
					{ box.position, box.position + box.size }, instance.world_from_node));
		}
	}
	const glm::dmat3 axes(get_drawn_transform(p_body.node).to_matrix());
	const double scale =
			std::max({ glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]) });
	for (size_t index = p_first; index < details.size(); ++index) {
		details[index].bounds_world = bounds_world;
		details[index].scale = static_cast<float>(scale) * p_body.detail_bias;
	}
}

void SceneReader::read_grid_map(
		SceneBody p_body, const godot::GridMap &p_grid_map, SceneSnapshot &r_scene) {
	const godot::Ref<godot::MeshLibrary> library = p_grid_map.get_mesh_library();
	const godot::Array listed = p_grid_map.get_meshes();
	if (!library) {
		return;
	}
	// Both lists have the cells in the same order; get_meshes() leaves out items without a mesh.
	const godot::Array cells = p_grid_map.get_used_cells();
	int64_t mesh_index = 0;
	p_body.instance_count = size_t(cells.get_size());
	for (int64_t index = 0; index < cells.get_size(); ++index) {
		const int64_t item =
				p_grid_map.get_cell_item(glm::ivec3(cells.get_value(index).to_vector3()));
		const godot::Ref<godot::Mesh> mesh = library.get_item_mesh(item);
		if (!mesh || mesh_index + 1 >= listed.get_size()) {
			continue;
		}
		set_casting(p_body, library.get_item_mesh_cast_shadow(item));
		p_body.instance = size_t(index);
		read_mesh(p_body, mesh,
				get_drawn_transform(p_body.node).to_matrix() *
						listed.get_value(mesh_index).to_transform().to_matrix(),
				r_scene);
		mesh_index += 2;
	}
}

void SceneReader::read_mesh_list(
		const SceneBody &p_body, const godot::Array &p_meshes, SceneSnapshot &r_scene) {
	const glm::dmat4 world_from_node = get_drawn_transform(p_body.node).to_matrix();
	for (int64_t index = 0; index + 1 < p_meshes.get_size(); index += 2) {
		const godot::Mesh mesh = godot::cast<godot::Mesh>(
				godot::ObjectHandle(p_meshes.get_value(index + 1).to_object()));
		if (mesh) {
			read_mesh(p_body, mesh,
					world_from_node * p_meshes.get_value(index).to_transform().to_matrix(),
					r_scene);
		}
	}
}

void SceneReader::read_multi_mesh(
		SceneBody p_body, const godot::MultiMesh &p_multi_mesh, SceneSnapshot &r_scene) {
	const godot::Ref<godot::Mesh> mesh = p_multi_mesh.get_mesh();
	const int64_t visible_count = p_multi_mesh.get_visible_instance_count();
	const int64_t instance_count = p_multi_mesh.get_instance_count();
	const size_t count = size_t(visible_count < 0 ? instance_count : visible_count);
	if (!mesh || count == 0) {
		return;
	}
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	// Makes Godot keep the transforms on the CPU, so that later frames read them without the GPU.
	server.multimesh_instance_get_transform(p_multi_mesh.get_rid(), 0);
	const godot::PackedFloat32Array buffer = server.multimesh_get_buffer(p_multi_mesh.get_rid());
	const bool is_3d = p_multi_mesh.get_transform_format() == godot::MultiMesh::TRANSFORM_3D;
	// Floats per instance: 3 or 2 rows of the transform, colour, custom data.
	const size_t stride = (is_3d ? 12 : 8) + (p_multi_mesh.is_using_colors() ? COLOR_FLOATS : 0) +
			(p_multi_mesh.is_using_custom_data() ? COLOR_FLOATS : 0);
	const glm::dmat4 world_from_node = get_drawn_transform(p_body.node).to_matrix();
	p_body.instance_count = count;
	p_body.has_instance_colors = p_multi_mesh.is_using_colors();
	for (size_t index = 0; index < count && (index + 1) * stride <= buffer.get_values().size();
			++index) {
		p_body.instance = index;
		const std::span<const float> floats = buffer.get_values().subspan(index * stride, stride);
		read_mesh(p_body, mesh, world_from_node * read_instance_transform(floats, is_3d), r_scene);
	}
}

bool SceneReader::casts_in_godot(const godot::ObjectHandle &p_node) {
	std::vector<godot::Ref<godot::Mesh>> meshes_of_particles;
	if (const auto particles = godot::cast<godot::GPUParticles3D>(p_node)) {
		for (int64_t pass = 0; pass < particles.get_draw_passes(); ++pass) {
			meshes_of_particles.push_back(particles.get_draw_pass_mesh(pass));
		}
	} else if (const auto cpu_particles = godot::cast<godot::CPUParticles3D>(p_node)) {
		meshes_of_particles.push_back(cpu_particles.get_mesh());
	} else if (const auto sprite = godot::cast<godot::SpriteBase3D>(p_node)) {
		return is_alpha_cut(sprite);
	} else if (const auto label = godot::cast<godot::Label3D>(p_node)) {
		return is_alpha_cut(label);
	} else {
		return true;
	}
	const godot::Ref<godot::Material> override_material =
			godot::cast<GeometryInstance3D>(p_node).get_material_override();
	return cast_particles(meshes_of_particles, override_material, materials);
}

void SceneReader::read_box(
		const SceneBody &p_body, const GeometryInstance3D &p_instance, SceneSnapshot &r_scene) {
	static const std::shared_ptr<const Mesh> box =
			make_box_mesh("box", /*p_half_size_m=*/glm::vec3(0.5f));
	const godot::AABB bounds = get_culling_box(p_instance);
	if (glm::any(glm::lessThanEqual(bounds.size, glm::vec3(0.0f)))) {
		return;
	}
	glm::dmat4 node_from_box =
			glm::translate(glm::dmat4(1.0), glm::dvec3(bounds.position + 0.5f * bounds.size));
	node_from_box = glm::scale(node_from_box, glm::dvec3(bounds.size));
	InstanceSnapshot instance = make_instance(box, nullptr,
			get_drawn_transform(p_body.node).to_matrix() * node_from_box, p_body.name);
	instance.casts_shadow = false;
	receivers.read_other(p_body, instance.bounds_world);
	r_scene.instances.push_back(std::move(instance));
}

void SceneReader::read_node(uint64_t p_id, SceneSnapshot &r_scene) {
	const godot::ObjectHandle object(godot::get_instance(p_id));
	SceneBody body;
	body.node = godot::cast<godot::Node3D>(object);
	if (const auto light = godot::cast<godot::Light3D>(object)) {
		read_light_node(light);
	}
	if (godot::cast<godot::ReflectionProbe>(object) || godot::cast<godot::VoxelGI>(object)) {
		world.uses_godot_shadows = true;
	}
	const auto visual = godot::cast<godot::VisualInstance3D>(object);
	const auto geometry = godot::cast<GeometryInstance3D>(object);
	const auto grid_map = godot::cast<godot::GridMap>(object);
	if (!body.node || (!geometry && !grid_map) || !body.node.is_visible_in_tree()) {
		return;
	}
	body.name = godot::Variant::of_type(godot::BuiltInType::STRING_NAME, body.node.get_name().get())
						.to_utf8();
	if (visual) {
		body.layers = static_cast<uint32_t>(visual.get_layer_mask());
	}
	const bool has_range = geometry && ViewVisibility::has_range(geometry);
	if (geometry) {
		set_casting(body, geometry.get_cast_shadows_setting());
		body.detail_bias = static_cast<float>(geometry.get_lod_bias());
		body.is_faded =
				geometry.get_transparency() > 0 || (has_range && visibility.is_faded(geometry));
	}
	if (unknown_objects.is_checking() && grid_map) {
		unknown_objects.add_everywhere(size_t(grid_map.get_meshes().get_size()) * MAX_PASSES);
	} else if (unknown_objects.is_checking() && has_hidden_culling_box(object)) {
		unknown_objects.add_everywhere(count_draws(geometry, materials));
	} else if (unknown_objects.is_checking()) {
		unknown_objects.add(geometry, count_draws(geometry, materials));
	}
	const size_t first_instance = r_scene.instances.size();
	const size_t first_detail = details.size();
	if (const auto mesh_instance = godot::cast<godot::MeshInstance3D>(object)) {
		const godot::Ref<godot::Mesh> mesh = mesh_instance.get_mesh();
		if (!mesh) {
			return;
		}
		if (body.casts_shadow && godot::cast<godot::SoftBody3D>(object)) {
			body.casts_shadow = false;
			add_notice(body,
					"casts no shadow of Gnomon: the vertices of a SoftBody3D, which physics "
					"moves, cannot be read. Set its cast_shadow to Off.");
		}
		read_mesh(body, mesh, get_drawn_transform(body.node).to_matrix(), r_scene);
	} else if (const auto multi = godot::cast<godot::MultiMeshInstance3D>(object)) {
		if (const godot::Ref<godot::MultiMesh> multi_mesh = multi.get_multimesh()) {
			read_multi_mesh(body, multi_mesh, r_scene);
		}
	} else if (const auto shape = godot::cast<godot::CSGShape3D>(object)) {
		if (shape.is_root_shape()) {
			read_mesh_list(body, shape.get_meshes(), r_scene);
		}
	} else if (grid_map) {
		read_grid_map(body, grid_map, r_scene);
	} else {
		if (body.casts_shadow && casts_in_godot(object)) {
			add_notice(body,
					text("casts no shadow of Gnomon: the mesh of a ",
							godot::Object(object.get_object()).get_class().to_utf8(),
							" cannot be read. Set its cast_shadow to Off, or use a "
							"MeshInstance3D."));
		}
		read_box(body, geometry, r_scene);
	}
	if (has_range) {
		visibility.hide(geometry, first_instance, r_scene.instances.size());
	}
	finish_details(body, first_detail, r_scene);
}

void SceneReader::read_server_casters(SceneSnapshot &r_scene) {
	for (const auto &[rid, caster] : get_server_casters().get()) {
		for (size_t surface = 0; surface < caster.surfaces.size(); ++surface) {
			const ReadSurface &read = caster.surfaces[surface];
			InstanceSnapshot instance = make_instance(read.mesh, caster.cut_outs[surface],
					caster.world_from_mesh.to_matrix(), read.mesh->name);
			instance.layers = caster.layers;
			meshes.prepare(read.mesh);
			const bool is_ready = meshes.is_ready(read) &&
					(instance.caster_mesh == read.mesh ||
							meshes.is_cut_ready(instance.caster_mesh));
			if (instance.casts_shadow && !is_ready) {
				instance.casts_shadow = false;
				++pending_count;
			}
			// It keeps Godot's light and shadow: its material has no resource to be replaced by.
			receivers.add(ReceiverKind::GODOT, instance.bounds_world, caster.layers);
			unknown_objects.add(instance.bounds_world, MAX_PASSES);
			r_scene.instances.push_back(std::move(instance));
		}
	}
}

LightSnapshot SceneReader::read_light(const ShadowNode &p_node, double p_scene_size_m) {
	using godot::Light3D;
	const Light3D node = p_node.find_light();
	const glm::dmat4 world_from_light = get_drawn_transform(node).to_matrix();
	LightSnapshot light;
	light.name = p_node.get_path();
	light.type = godot::cast<godot::OmniLight3D>(node) ? LightType::OMNI
			: godot::cast<godot::SpotLight3D>(node)	   ? LightType::SPOT
													   : LightType::DIRECTIONAL;
	light.position_world = glm::dvec3(world_from_light[3]);
	light.world_from_light = compute_orientation(world_from_light, "Light", light.name);
	light.caster_layers = static_cast<uint32_t>(node.get_shadow_caster_mask());
	if (light.type != LightType::DIRECTIONAL) {
		light.range_m = static_cast<float>(node.get_param(Light3D::PARAM_RANGE));
	}
	if (light.type == LightType::SPOT) {
		light.outer_cone_rad =
				glm::radians(static_cast<float>(node.get_param(Light3D::PARAM_SPOT_ANGLE)));
	}
	light.properties = p_node.make_light_properties(light.type == LightType::DIRECTIONAL);
	light.decide_settings(p_scene_size_m);
	return light;
}

void SceneReader::cull_faces(const ShadowNode &p_node, SceneSnapshot &r_scene) {
	if (p_node.casts_back_faces()) {
		return;
	}
	const LightSnapshot &light = r_scene.lights.back();
	const uint64_t light_id = godot::get_instance_id(p_node.get_node().get_object());
	const bool is_reversed = p_node.find_light().get_shadow_reverse_cull_face();
	const glm::dvec4 light_world = light.type == LightType::DIRECTIONAL
			? glm::dvec4(-light.get_direction_world(), 0.0)
			: glm::dvec4(light.position_world, 1.0);
	for (const CulledInstance &entry : culled) {
		InstanceSnapshot &instance = r_scene.instances.edit(entry.instance);
		const bool is_back = (entry.culling == ShadowCulling::BACK) != is_reversed;
		const std::shared_ptr<const Mesh> mesh = facing.select(instance.caster_mesh,
				{ light_id, entry.instance }, glm::inverse(instance.world_from_node) * light_world,
				is_back ? ShadowCulling::BACK : ShadowCulling::FRONT);
		if (mesh != instance.caster_mesh) {
			instance.caster_meshes_of_lights[light.name] = mesh;
		}
	}
}

ReadWorld SceneReader::read(godot::RID p_scenario, const godot::SceneTree &p_tree,
		std::span<ShadowNode *const> p_nodes, std::vector<godot::Light3D> p_hidden_lights) {
	if (!unculled) {
		unculled = std::make_unique<UnculledNodes>(p_tree);
	}
	auto scene = std::make_shared<SceneSnapshot>();
	scene->has_far_sides = true;
	auto frame = std::make_shared<ScenarioFrame>();
	world = {};
	world.other_lights = std::move(p_hidden_lights);
	frame->number = frame_number;
	pending_count = 0;
	details.clear();
	culled.clear();
	world_frame = frame;
	frame->views = find_view_details(p_tree, p_scenario);
	visibility.begin_world(frame->views);
	unknown_objects.begin_world(p_scenario, frame->views, frame_number);
	const bool has_masked_view = add_view_notices(frame->views);
	std::vector<uint64_t> ids = find_instances(p_scenario);
	const std::vector<uint64_t> unculled_ids = unculled->find(p_scenario);
	ids.insert(ids.end(), unculled_ids.begin(), unculled_ids.end());
	for (const uint64_t id : ids) {
		try {
			read_node(id, *scene);
		} catch (const Error &error) {
			if (warned.insert({ id, "" }).second) {
				log_warning(error.what());
			}
		}
	}
	const godot::Ref<godot::World3D> main_world = p_tree.get_root().find_world_3d();
	if (main_world && main_world.get_scenario() == p_scenario) {
		read_server_casters(*scene);
	}
	world.unknown_object_count = unknown_objects.end_world();
	scene->scene_size_m = std::max(MIN_SCENE_SIZE_M, scene->compute_caster_bounds().get_diagonal());
	world.receivers = receivers.take();
	for (ShadowNode *node : p_nodes) {
		node->pending_caster_count = pending_count;
		node->makes_mask = has_masked_view &&
				(node->shows_mask() || node->get_request() ||
						reaches(node->find_light(), world.receivers.masked));
		if (!node->makes_mask) {
			continue;
		}
		try {
			scene->lights.push_back(read_light(*node, scene->scene_size_m));
		} catch (const Error &error) {
			const uint64_t id = godot::get_instance_id(node->get_node().get_object());
			if (warned.insert({ id, error.what() }).second) {
				log_warning(error.what(),
						" Until this is corrected, Gnomon draws no shadow for this light.");
			}
			node->makes_mask = false;
			continue;
		}
		cull_faces(*node, *scene);
		world.masked_lights.push_back(node->find_light());
		if (node->shows_mask()) {
			frame->shown_lights.insert(scene->lights.back().name);
		}
		if (const std::shared_ptr<MaskRequest> request = node->get_request()) {
			request->light = scene->lights.back().name;
			frame->requests.push_back(request);
		}
	}
	frame->scene = std::move(scene);
	frame->details = details;
	frame->has_faded = world.receivers.has_faded;
	world_frame.reset();
	world.frame = std::move(frame);
	std::erase_if(world.other_lights, [this](const godot::Light3D &p_light) {
		return std::any_of(world.masked_lights.begin(), world.masked_lights.end(),
				[&](const godot::Light3D &p_masked) {
					return p_masked.get_object() == p_light.get_object();
				});
	});
	world.uses_godot_shadows = world.uses_godot_shadows || needs_godot_shadows(p_tree, p_scenario);
	return std::exchange(world, {});
}

void SceneReader::end_frame() {
	meshes.forget_unused();
	poses.end_frame();
	materials.forget_unused();
	visibility.forget_unused();
	unknown_objects.forget_unused();
	facing.forget_unused();
	std::erase_if(warned,
			[](const auto &p_entry) { return godot::get_instance(p_entry.first) == nullptr; });
}

} // namespace gnomon
