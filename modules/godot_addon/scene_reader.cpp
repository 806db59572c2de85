#include "modules/godot_addon/scene_reader.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/scene/box_mesh.h"

#include <algorithm>

namespace gnomon {

namespace {

using godot::GeometryInstance3D;

const float MAX_COORDINATE_M = 1e8f;  // nodes beyond are not found
const double MIN_SCENE_SIZE_M = 1e-9; // it is a divisor, also in a world without casters
// In a MultiMesh's buffer: floats of an instance's colour, and of its custom data.
const size_t COLOR_FLOATS = 4;

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

void SceneReader::warn_once(const SceneBody &p_body, const std::string &p_warning) {
	if (warned.insert({ godot::get_instance_id(p_body.node.get_object()), p_warning }).second) {
		log_warning("\"", p_body.node.get_path().to_utf8(), "\" ", p_warning);
	}
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
		InstanceSnapshot instance =
				make_instance(surface.mesh, shadow.cut_out, p_world_from_mesh, p_body.name);
		instance.layers = p_body.layers;
		instance.casts_shadow =
				instance.casts_shadow && p_body.casts_shadow && shadow.kind != ShadowKind::NONE;
		const bool is_ready = meshes.is_ready(surface) &&
				(instance.caster_mesh == surface.mesh || meshes.is_cut_ready(instance.caster_mesh));
		if (mesh_instance && surface.mesh->attributes.rig) {
			poses.pose(mesh_instance, surface.mesh, surface.index, instance);
		}
		receivers.read(p_body, material, p_mesh, surface.index, instance.bounds_world);
		if (instance.casts_shadow && shadow.kind == ShadowKind::CUT_OUT && !shadow.cut_out) {
			warn_once(p_body,
					"is cut out by alpha in a way that is not read, and casts the shadow of its "
					"whole surface. Use a StandardMaterial3D with alpha scissor, without triplanar "
					"coordinates, MSDF textures and albedo from vertex colours.");
		}
		if (instance.casts_shadow && !is_ready) {
			instance.casts_shadow = false;
			++pending_count;
		}
		if (surface.levels) {
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
		const SceneBody &p_body, const godot::MultiMesh &p_multi_mesh, SceneSnapshot &r_scene) {
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
	for (size_t index = 0; index < count && (index + 1) * stride <= buffer.get_values().size();
			++index) {
		const std::span<const float> floats = buffer.get_values().subspan(index * stride, stride);
		read_mesh(p_body, mesh, world_from_node * read_instance_transform(floats, is_3d), r_scene);
	}
}

void SceneReader::read_box(const SceneBody &p_body, const godot::VisualInstance3D &p_instance,
		SceneSnapshot &r_scene) {
	static const std::shared_ptr<const Mesh> box =
			make_box_mesh("box", /*p_half_size_m=*/glm::vec3(0.5f));
	const godot::AABB bounds = p_instance.get_aabb();
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
	if (geometry) {
		const int64_t casting = geometry.get_cast_shadows_setting();
		body.casts_shadow = casting != GeometryInstance3D::SHADOW_CASTING_SETTING_OFF;
		body.is_drawn = casting != GeometryInstance3D::SHADOW_CASTING_SETTING_SHADOWS_ONLY;
		body.detail_bias = static_cast<float>(geometry.get_lod_bias());
	}
	const size_t first_detail = details.size();
	if (const auto mesh_instance = godot::cast<godot::MeshInstance3D>(object)) {
		const godot::Ref<godot::Mesh> mesh = mesh_instance.get_mesh();
		if (!mesh) {
			return;
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
		read_mesh_list(body, grid_map.get_meshes(), r_scene);
	} else {
		if (body.casts_shadow) {
			warn_once(body,
					text("casts no shadow of Gnomon: the mesh of a ",
							godot::Object(object.get_object()).get_class().to_utf8(),
							" cannot be read. Set its cast_shadow to Off, or use a "
							"MeshInstance3D."));
		}
		read_box(body, visual, r_scene);
	}
	finish_details(body, first_detail, r_scene);
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

ReadWorld SceneReader::read(godot::RID p_scenario, const godot::SceneTree &p_tree,
		std::span<ShadowNode *const> p_nodes, std::vector<godot::Light3D> p_hidden_lights) {
	if (!grid_maps) {
		grid_maps = std::make_unique<GridMaps>(p_tree);
	}
	auto scene = std::make_shared<SceneSnapshot>();
	auto frame = std::make_shared<ScenarioFrame>();
	world = {};
	world.other_lights = std::move(p_hidden_lights);
	frame->number = frame_number;
	pending_count = 0;
	details.clear();
	std::vector<uint64_t> ids = find_instances(p_scenario);
	const std::vector<uint64_t> grid_map_ids = grid_maps->find(p_scenario);
	ids.insert(ids.end(), grid_map_ids.begin(), grid_map_ids.end());
	for (const uint64_t id : ids) {
		try {
			read_node(id, *scene);
		} catch (const Error &error) {
			if (warned.insert({ id, "" }).second) {
				log_warning(error.what());
			}
		}
	}
	scene->scene_size_m = std::max(MIN_SCENE_SIZE_M, scene->compute_caster_bounds().get_diagonal());
	world.receivers = receivers.take();
	for (ShadowNode *node : p_nodes) {
		node->pending_caster_count = pending_count;
		node->makes_mask = node->shows_mask() || node->get_request() ||
				reaches(node->find_light(), world.receivers.masked);
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
	frame->views = find_view_details(p_tree, p_scenario);
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
	std::erase_if(warned,
			[](const auto &p_entry) { return godot::get_instance(p_entry.first) == nullptr; });
}

} // namespace gnomon
