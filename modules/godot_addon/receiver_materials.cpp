#include "modules/godot_addon/receiver_materials.h"

#include "modules/core/log.h"
#include "modules/godot_addon/shadow_node.h"

namespace gnomon {

namespace {

const char VIEWER_GROUP[] = "_native_shader_source_visualizer";

// Usually Godot returns all shaders after one frame. A warning is logged after this many
// consecutive frames without some of them.
const int MAX_INCOMPLETE_FRAMES = 60;

// Looks as Godot's surfaces without a material. The values were measured.
const char BARE_SHADER[] = "shader_type spatial;\n"
						   "void fragment() {\n"
						   "\tALBEDO = vec3(0.6);\n\tROUGHNESS = 0.8;\n\tMETALLIC = 0.2;\n"
						   "}\n";

std::string describe(const godot::Material &p_material, const godot::Node &p_owner) {
	const std::string path = p_material.get_path().to_utf8();
	const std::string name = p_material.get_name().to_utf8();
	return text(path.empty() && name.empty() ? "A material"
					: path.empty()			 ? name
											 : path,
			" of \"", p_owner.get_path().to_utf8(), "\"");
}

} // namespace

ReceiverMaterials::ReceiverMaterials(Notices &r_notices) :
		notices(r_notices), server(godot::find_singleton("RenderingServer")) {
	set_shader_listener([this](godot::RID p_shader) { inspected_shaders.push_back(p_shader); });
}

ReceiverMaterials::~ReceiverMaterials() {
	set_shader_listener({});
	clear();
}

void ReceiverMaterials::free(godot::RID &r_owned) const {
	if (r_owned.id) {
		server.free_rid(std::exchange(r_owned, {}));
	}
}

void ReceiverMaterials::copy_code(const MaterialState &p_state, Copy &r_copy) {
	const godot::RID original = p_state.original;
	r_copy.receiver =
			make_receiver_shader(server.shader_get_code(original).to_utf8(), p_state.is_generated);
	if (r_copy.receiver.kind != ReceiverKind::PATCHED) {
		return;
	}
	if (!r_copy.shader.id) {
		r_copy.shader = server.shader_create();
	}
	copies_left -= copies_left == 0 || copies_left == UNLIMITED ? 0 : 1;
	server.shader_set_code(r_copy.shader, godot::String(r_copy.receiver.code));
	const godot::Array parameters = server.get_shader_parameter_list(original);
	for (int64_t index = 0; index < parameters.get_size(); ++index) {
		const std::string name = parameters.get_value(index).get_keyed("name").to_utf8();
		const godot::RID texture =
				server.shader_get_default_texture_parameter(original, name.c_str(), /*index=*/0);
		if (texture.id) {
			server.shader_set_default_texture_parameter(r_copy.shader, name.c_str(), texture, 0);
		}
	}
	// Godot does not report compile errors, but a shader that does not compile has no parameters.
	if (server.get_shader_parameter_list(r_copy.shader).get_size() < parameters.get_size()) {
		free(r_copy.shader);
		r_copy.receiver.kind = ReceiverKind::GODOT;
		r_copy.receiver.reason =
				"has a shader that does not compile with Gnomon's light(), see above";
	}
}

ReceiverMaterials::Copy &ReceiverMaterials::find_copy(
		const MaterialState &p_state, const godot::Material &p_material) {
	Copy &copy = copies[p_state.original];
	if (!copy.holder) {
		if (p_state.is_generated) {
			// The duplicate has the same features, so it shares the generated shader and keeps it
			// alive.
			copy.holder = p_material.duplicate(/*deep=*/false);
		} else {
			const godot::Ref<godot::Shader> shader =
					godot::cast<godot::ShaderMaterial>(p_material).get_shader();
			copy.watched = std::make_unique<WatchedResource>(shader);
			copy.holder = godot::Ref<godot::Resource>::share(shader);
		}
		copy_code(p_state, copy);
	} else if (copy.watched && copy.watched->take_change()) {
		copy_code(p_state, copy);
	}
	return copy;
}

ReceiverKind ReceiverMaterials::use(const godot::Material &p_material, const godot::Node &p_owner,
		const std::string &p_unknown_reason) {
	MaterialState &state = materials[godot::get_instance_id(p_material.get_object())];
	state.is_used = true;
	state.is_generated = bool(godot::cast<godot::BaseMaterial3D>(p_material));
	if (const auto custom = godot::cast<godot::ShaderMaterial>(p_material)) {
		const godot::Ref<godot::Shader> shader = custom.get_shader();
		state.original = shader ? shader.get_rid() : godot::RID();
	}
	if (state.applied.id && state.applied != state.original && !may_copy(state.original)) {
		restore(godot::get_instance_id(p_material.get_object()), state);
		state.applied = {};
	}
	ReceiverKind kind =
			state.is_generated || state.original.id ? ReceiverKind::GODOT : ReceiverKind::UNLIT;
	if (state.original.id && may_copy(state.original)) {
		const Copy &copy = find_copy(state, p_material);
		kind = copy.receiver.kind == ReceiverKind::PATCHED && !p_unknown_reason.empty()
				? ReceiverKind::GODOT
				: copy.receiver.kind;
		const std::string &reason =
				copy.receiver.reason.empty() ? p_unknown_reason : copy.receiver.reason;
		if (kind == ReceiverKind::PATCHED && state.applied != state.original) {
			server.material_set_shader(p_material.get_rid(), copy.shader);
			state.applied = state.original;
		} else if (kind != ReceiverKind::PATCHED && state.applied.id) {
			restore(godot::get_instance_id(p_material.get_object()), state);
			state.applied = {};
		}
		if (kind == ReceiverKind::GODOT && !notices.is_logged(reason)) {
			notices.add(reason, describe(p_material, p_owner),
					reason + ": it keeps Godot's light and shadows, without Gnomon's.");
		}
	}
	if (const godot::Ref<godot::Material> next = p_material.get_next_pass()) {
		// One GODOT pass makes the whole material GODOT. UNLIT passes do not count.
		const ReceiverKind of_next = use(next, p_owner);
		kind = of_next == ReceiverKind::GODOT || kind == ReceiverKind::UNLIT ? of_next : kind;
	}
	return kind;
}

void ReceiverMaterials::restore(uint64_t p_material, const MaterialState &p_state) const {
	const godot::Material material(godot::get_instance(p_material));
	if (material && p_state.applied.id) {
		server.material_set_shader(material.get_rid(), p_state.original);
	}
}

void ReceiverMaterials::restore_bare(uint64_t p_mesh) const {
	const godot::Mesh mesh(godot::get_instance(p_mesh));
	for (int64_t surface = 0; mesh && surface < mesh.get_surface_count(); ++surface) {
		if (server.mesh_surface_get_material(mesh.get_rid(), surface) == bare_material) {
			server.mesh_surface_set_material(mesh.get_rid(), surface, {});
		}
	}
}

void ReceiverMaterials::make_bare_material() {
	if (bare_material.id) {
		return;
	}
	copies_left -= copies_left == UNLIMITED ? 0 : 1;
	bare_shader = server.shader_create();
	server.shader_set_code(bare_shader, godot::String(make_receiver_shader(BARE_SHADER).code));
	bare_material = server.material_create();
	server.material_set_shader(bare_material, bare_shader);
}

ReceiverKind ReceiverMaterials::use_bare(const godot::Mesh &p_mesh, int64_t p_surface) {
	if (!bare_material.id && copies_left == 0) {
		return ReceiverKind::GODOT;
	}
	make_bare_material();
	const uint64_t id = godot::get_instance_id(p_mesh.get_object());
	bare_meshes.insert(id);
	used_bare_meshes.insert(id);
	if (!server.mesh_surface_get_material(p_mesh.get_rid(), p_surface).id) {
		server.mesh_surface_set_material(p_mesh.get_rid(), p_surface, bare_material);
	}
	return ReceiverKind::PATCHED;
}

void ReceiverMaterials::take_inspected_shaders() {
	if (inspected_shaders.size() == queried.size()) { // else one of them has no shader yet
		incomplete_frames = 0;
		for (size_t index = 0; index < queried.size(); ++index) {
			const auto state = materials.find(queried[index]);
			if (state != materials.end()) {
				state->second.original = inspected_shaders[index];
			}
		}
	} else if (++incomplete_frames == MAX_INCOMPLETE_FRAMES) {
		log_warning("In ", MAX_INCOMPLETE_FRAMES,
				" frames in a row, Godot returned the shaders of only some built-in materials (at "
				"last ",
				inspected_shaders.size(), " of ", queried.size(),
				"). Those whose shader is not known keep Godot's light and shadows, without "
				"Gnomon's. Use Godot 4.6, or ShaderMaterials that include gnomon.gdshaderinc.");
	}
	inspected_shaders.clear();
	queried.clear();
}

void ReceiverMaterials::end_frame(const godot::Node &p_node, const godot::SceneTree &p_tree) {
	std::erase_if(bare_meshes, [this](uint64_t p_id) {
		const bool is_used = used_bare_meshes.contains(p_id);
		if (!is_used) {
			restore_bare(p_id);
		}
		return !is_used;
	});
	used_bare_meshes.clear();
	// The editor's own nodes of the group would open a window, so they leave it meanwhile.
	const godot::Array viewers = p_tree.get_nodes_in_group(VIEWER_GROUP);
	const auto for_each_viewer = [&](auto p_function) {
		for (int64_t index = 0; index < viewers.get_size(); ++index) {
			p_function(godot::Node(viewers.get_value(index).to_object()));
		}
	};
	for_each_viewer([](const godot::Node &p_viewer) { p_viewer.remove_from_group(VIEWER_GROUP); });
	p_node.add_to_group(VIEWER_GROUP, /*persistent=*/false);
	for (auto &[id, state] : materials) {
		if (state.is_used && state.is_generated) {
			godot::Material(godot::get_instance(id)).inspect_native_shader_code();
			queried.push_back(id);
		} else if (!state.is_used) {
			restore(id, state);
			state.applied = {};
		}
		state.is_used = false;
	}
	p_node.remove_from_group(VIEWER_GROUP);
	for_each_viewer([](const godot::Node &p_viewer) {
		p_viewer.add_to_group(VIEWER_GROUP, /*persistent=*/false);
	});
}

void ReceiverMaterials::begin_frame(uint32_t p_max_copies) {
	max_copies = p_max_copies;
	copies_left = p_max_copies;
	take_inspected_shaders();
	std::erase_if(materials,
			[](const auto &p_entry) { return godot::get_instance(p_entry.first) == nullptr; });
	std::set<godot::RID> in_use;
	for (const auto &[id, state] : materials) {
		in_use.insert({ state.original, state.applied });
	}
	for (auto entry = copies.begin(); entry != copies.end();) {
		if (in_use.contains(entry->first)) {
			++entry;
			continue;
		}
		free(entry->second.shader);
		entry = copies.erase(entry);
	}
}

void ReceiverMaterials::clear() {
	for (const auto &[id, state] : materials) {
		restore(id, state);
	}
	materials.clear();
	for (auto &[original, copy] : copies) {
		free(copy.shader);
	}
	copies.clear();
	queried.clear();
	inspected_shaders.clear();
	for (const uint64_t id : bare_meshes) {
		restore_bare(id);
	}
	bare_meshes.clear();
	used_bare_meshes.clear();
	free(bare_material);
	free(bare_shader);
}

} // namespace gnomon
