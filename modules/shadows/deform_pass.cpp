#include "modules/shadows/deform_pass.h"

#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/scene/mesh_pose.h"

#include <algorithm>

namespace gnomon {

namespace {

/// Joint influences and morph targets of a mesh at rest, as deform.comp reads them.
struct GpuRig {
	OwnedBuffer influences;
	OwnedBuffer targets;
};

OwnedBuffer upload(RenderingDevice &p_device, const std::string &p_name, const auto &p_values) {
	const std::span<const uint8_t> bytes = bytes_of(std::span(p_values));
	return OwnedBuffer(p_device,
			p_device.create_buffer_with_data(
					{ p_name, bytes.size(), BufferUsage::STORAGE | BufferUsage::COPY_TARGET },
					bytes));
}

GpuRig upload_rig(RenderingDevice &p_device, const Mesh &p_mesh) {
	const MeshRig &rig = *p_mesh.attributes.rig;
	GpuRig gpu;
	std::vector<glm::uvec2> influences;
	for (size_t i = 0; i < rig.joints.size(); ++i) {
		influences.emplace_back(rig.joints[i], glm::floatBitsToUint(rig.weights[i]));
	}
	influences.resize(std::max<size_t>(influences.size(), 1)); // buffers must not be empty
	gpu.influences = upload(p_device, p_mesh.name + " joints", influences);
	std::vector<glm::vec3> values;
	for (const MorphTarget &target : rig.targets) {
		for (const std::vector<glm::vec3> *kind :
				{ &target.positions, &target.normals, &target.tangents }) {
			values.insert(values.end(), kind->begin(), kind->end());
			values.resize(values.size() + rig.vertex_count - kind->size(), glm::vec3(0.0f));
		}
	}
	values.resize(std::max<size_t>(values.size(), 1));
	gpu.targets = upload(p_device, p_mesh.name + " morph targets", values);
	return gpu;
}

/// Packs three matrix rows per joint, then the morph targets' weights.
std::vector<glm::vec4> pack_pose(const MeshPose &p_pose) {
	std::vector<glm::vec4> pose_data;
	for (const glm::dmat4 &joint : p_pose.get_joints()) {
		const glm::mat4 rows(glm::transpose(joint));
		pose_data.insert(pose_data.end(), { rows[0], rows[1], rows[2] });
	}
	for (size_t target = 0; target < p_pose.get_weights().size(); ++target) {
		if (target % 4 == 0) {
			pose_data.emplace_back(0.0f);
		}
		pose_data.back()[int(target % 4)] = p_pose.get_weights()[target];
	}
	pose_data.resize(std::max<size_t>(pose_data.size(), 1));
	return pose_data;
}

/// What vertex programs read of each vertex of a mesh at rest.
struct GpuProgramInputs {
	OwnedBuffer inputs;
};

GpuProgramInputs upload_program_inputs(RenderingDevice &p_device, const Mesh &p_mesh) {
	const MeshAttributes &attributes = p_mesh.attributes;
	std::vector<float> inputs;
	inputs.reserve(p_mesh.positions_node.size() * PROGRAM_INPUT_FLOATS);
	const auto add = [&](const auto &p_values, size_t p_vertex, auto p_default) {
		const auto value = p_vertex < p_values.size() ? p_values[p_vertex] : p_default;
		for (int component = 0; component < p_default.length(); ++component) {
			inputs.push_back(value[component]);
		}
	};
	for (size_t vertex = 0; vertex < p_mesh.positions_node.size(); ++vertex) {
		add(attributes.uvs[0], vertex, glm::vec2(0.0f));
		add(attributes.uvs[1], vertex, glm::vec2(0.0f));
		add(attributes.colors, vertex, glm::vec4(1.0f));
		add(attributes.tangents, vertex, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
	}
	return { upload(p_device, p_mesh.name + " program inputs", inputs) };
}

/// The points of a mesh that was cut out of another one, as deform_points.comp reads them.
struct GpuPoints {
	OwnedBuffer points;
};

GpuPoints upload_points(RenderingDevice &p_device, const Mesh &p_mesh) {
	std::vector<shader::DeformPoint> points;
	for (const TrianglePoint &point : p_mesh.source.points) {
		points.push_back({ glm::uvec4(point.corners, 0), glm::vec4(point.weights, 0.0f) });
	}
	return { upload(p_device, p_mesh.name + " points", points) };
}

/// For each welded vertex: one of the vertices that were welded into it, and its adjacent faces.
struct GpuWeld {
	OwnedBuffer vertices;
	OwnedBuffer faces;
};

GpuWeld upload_weld(RenderingDevice &p_device, const Mesh &p_mesh, const MeshTopology &p_topology) {
	const size_t welded_count = p_topology.welded_positions_node.size();
	std::vector<uint32_t> vertices(welded_count, 0);
	for (size_t vertex = p_topology.welded_from_position.size(); vertex-- > 0;) {
		const uint32_t welded = p_topology.welded_from_position[vertex];
		if (welded != NO_VERTEX) {
			vertices[welded] = static_cast<uint32_t>(vertex);
		}
	}
	// Counting sort. The buffer has the index of each vertex's first face, one end index, then the
	// faces.
	std::vector<uint32_t> faces(welded_count + 1 + p_topology.triangles.size(), 0);
	for (const uint32_t welded : p_topology.triangles) {
		++faces[welded + 1];
	}
	faces[0] = static_cast<uint32_t>(welded_count + 1);
	for (size_t welded = 0; welded < welded_count; ++welded) {
		faces[welded + 1] += faces[welded];
	}
	std::vector<uint32_t> next(faces.begin(), faces.begin() + ptrdiff_t(welded_count));
	for (size_t corner = 0; corner < p_topology.triangles.size(); ++corner) {
		faces[next[p_topology.triangles[corner]]++] = static_cast<uint32_t>(corner / 3);
	}
	return { upload(p_device, p_mesh.name + " welded vertices", vertices),
		upload(p_device, p_mesh.name + " faces of vertices", faces) };
}

const GpuRig &get_rig(MeshStore &r_store, const std::shared_ptr<const Mesh> &p_mesh) {
	return r_store.get_derived<GpuRig>(
			p_mesh, [&] { return upload_rig(r_store.get_device(), *p_mesh); });
}

const GpuProgramInputs &get_program_inputs(
		MeshStore &r_store, const std::shared_ptr<const Mesh> &p_mesh) {
	return r_store.get_derived<GpuProgramInputs>(
			p_mesh, [&] { return upload_program_inputs(r_store.get_device(), *p_mesh); });
}

const GpuPoints &get_points(MeshStore &r_store, const std::shared_ptr<const Mesh> &p_mesh) {
	return r_store.get_derived<GpuPoints>(
			p_mesh, [&] { return upload_points(r_store.get_device(), *p_mesh); });
}

const GpuWeld &get_weld(MeshStore &r_store, const std::shared_ptr<const Mesh> &p_mesh) {
	return r_store.get_derived<GpuWeld>(p_mesh,
			[&] { return upload_weld(r_store.get_device(), *p_mesh, *get_topology(p_mesh)); });
}

} // namespace

DeformPass::DeformPass(MeshStore &r_store, const SceneSnapshot &p_scene, RenderGraph &r_graph) :
		store(r_store) {
	for (const InstanceSnapshot &instance : p_scene.instances) {
		if (!instance.pose || slots.contains(instance.mesh->slot_id)) {
			continue;
		}
		store.get(instance.mesh); // uploads it; count_moved looks it up in the store
		const std::vector<glm::vec4> pose_data = pack_pose(*instance.pose);
		Slot &slot = slots[instance.mesh->slot_id];
		slot.pose = instance.pose;
		slot.mesh = instance.mesh;
		slot.pose_data =
				r_graph.upload("pose", BufferUsage::STORAGE, bytes_of(std::span(pose_data)));
		prepare_program(slot, r_graph);
	}
	if (!slots.empty()) {
		const auto get_pipeline = [&](const char *p_shader) {
			return store.device.get_compute_pipeline({ p_shader, p_shader, {} });
		};
		rigged = get_pipeline("shadows/deform.comp");
		tangents = get_pipeline("shadows/deform_tangents.comp");
		points = get_pipeline("shadows/deform_points.comp");
		welded = get_pipeline("shadows/deform_welded.comp");
		normals = get_pipeline("shadows/deform_normals.comp");
	}
}

void DeformPass::prepare_program(Slot &r_slot, RenderGraph &r_graph) {
	const VertexMove &move = r_slot.pose->get_move();
	if (!move.program) {
		return;
	}
	GNOMON_ASSERT(move.textures.empty() || store.texture_source, "no source of textures for ",
			move.program->shader);
	const std::string &shader = move.program->shader;
	if (store.added_programs.insert(shader).second) {
		replace_embedded_shader(shader, move.program->spirv);
	}
	r_slot.program = store.device.get_compute_pipeline({ shader, shader, {} });
	r_slot.program_values = r_graph.upload(
			"vertex program", BufferUsage::STORAGE, bytes_of(std::span(move.values)));
}

uint32_t DeformPass::count_moved() const {
	return static_cast<uint32_t>(std::count_if(slots.begin(), slots.end(), [&](const auto &p_slot) {
		const Slot &slot = p_slot.second;
		return store.meshes.at(slot.mesh->id).pose_hash != slot.pose->get_hash();
	}));
}

std::vector<RGBuffer> DeformPass::list_inputs() const {
	std::vector<RGBuffer> inputs;
	for (const auto &[id, slot] : slots) {
		inputs.push_back(slot.pose_data);
		if (slot.program) {
			inputs.push_back(slot.program_values);
		}
	}
	return inputs;
}

const DeformPass::Slot *DeformPass::find_slot(const std::weak_ptr<const Mesh> &p_mesh) const {
	const std::shared_ptr<const Mesh> mesh = p_mesh.lock();
	const auto found = mesh ? slots.find(mesh->slot_id) : slots.end();
	return found == slots.end() ? nullptr : &found->second;
}

void DeformPass::deform_rigged(PassContext &p_context, const Slot &p_slot, GpuMesh &r_gpu) {
	const std::shared_ptr<const Mesh> &rest_mesh = p_slot.mesh->rest;
	const MeshRig &rig = *rest_mesh->attributes.rig;
	const GpuMesh &rest = store.get(rest_mesh);
	const GpuRig &gpu_rig = get_rig(store, rest_mesh);
	const MeshPose &pose = *p_slot.pose;
	const shader::DeformPush push = { static_cast<uint32_t>(rig.vertex_count),
		pose.get_joints().empty() ? 0 : rig.influence_count,
		static_cast<uint32_t>(pose.get_joints().size()),
		static_cast<uint32_t>(std::min(rig.targets.size(), pose.get_weights().size())) };
	const std::vector<Binding> common = { { DEFORM_BINDING_INFLUENCES, gpu_rig.influences.get() },
		{ DEFORM_BINDING_TARGETS, gpu_rig.targets.get() },
		{ DEFORM_BINDING_POSE, p_context.get(p_slot.pose_data) } };
	Work work = { rigged, common, { r_gpu.positions.get(), r_gpu.normals.get() }, push };
	work.bindings.emplace_back(DEFORM_BINDING_POSITIONS, rest.positions.get());
	work.bindings.emplace_back(DEFORM_BINDING_NORMALS, rest.normals.get());
	work.bindings.emplace_back(DEFORM_BINDING_RESULT, r_gpu.positions.get());
	work.bindings.emplace_back(DEFORM_BINDING_NORMAL_RESULT, r_gpu.normals.get());
	pending.push_back(std::move(work));
	if (r_gpu.tangents) {
		Work tangent_work = { tangents, common, { r_gpu.tangents.get() }, push };
		tangent_work.bindings.emplace_back(DEFORM_BINDING_POSITIONS, r_gpu.rest_tangents);
		tangent_work.bindings.emplace_back(DEFORM_BINDING_RESULT, r_gpu.tangents.get());
		pending.push_back(std::move(tangent_work));
	}
}

void DeformPass::move_by_program(PassContext &p_context, const Slot &p_slot, GpuMesh &r_gpu) {
	const VertexMove &move = p_slot.pose->get_move();
	const std::shared_ptr<const Mesh> &rest = p_slot.mesh->rest;
	Work work = { p_slot.program,
		{ { PROGRAM_BINDING_POSITIONS, r_gpu.positions.get() },
				{ PROGRAM_BINDING_NORMALS, r_gpu.normals.get() },
				{ PROGRAM_BINDING_INPUTS, get_program_inputs(store, rest).inputs.get() },
				{ PROGRAM_BINDING_VALUES, p_context.get(p_slot.program_values) } },
		{ r_gpu.positions.get() },
		{ static_cast<uint32_t>(rest->positions_node.size()), 0, 0, 0 } };
	for (size_t index = 0; index < move.textures.size(); ++index) {
		const TextureRID texture = store.texture_source(move.textures[index]);
		if (!texture) {
			return; // the host engine has freed it
		}
		work.bindings.emplace_back(static_cast<uint32_t>(PROGRAM_BINDING_FIRST_TEXTURE + index),
				texture, store.get_sampler(move.textures[index]));
	}
	pending.push_back(std::move(work));
}

void DeformPass::deform_points(
		const Slot &p_slot, const std::shared_ptr<const Mesh> &p_mesh, GpuMesh &r_gpu) {
	pending.push_back({ points,
			{ { MOVE_BINDING_POSITIONS, store.get(p_slot.mesh).positions.get() },
					{ MOVE_BINDING_SOURCES, get_points(store, p_mesh).points.get() },
					{ MOVE_BINDING_RESULT, r_gpu.positions.get() } },
			{ r_gpu.positions.get() },
			{ static_cast<uint32_t>(p_mesh->source.points.size()), 0, 0, 0 } });
}

void DeformPass::deform_welded(const std::shared_ptr<const Mesh> &p_mesh, GpuTopology &r_gpu) {
	pending.push_back({ welded,
			{ { MOVE_BINDING_POSITIONS, store.get(p_mesh).positions.get() },
					{ MOVE_BINDING_SOURCES, get_weld(store, p_mesh).vertices.get() },
					{ MOVE_BINDING_RESULT, r_gpu.positions.get() } },
			{ r_gpu.positions.get() },
			{ static_cast<uint32_t>(r_gpu.topology->welded_positions_node.size()), 0, 0, 0 } });
}

void DeformPass::deform_normals(const std::shared_ptr<const Mesh> &p_mesh, GpuTopology &r_gpu) {
	pending.push_back({ normals,
			{ { MOVE_BINDING_POSITIONS, r_gpu.positions.get() },
					{ MOVE_BINDING_SOURCES, get_weld(store, p_mesh).faces.get() },
					{ MOVE_BINDING_TRIANGLES, r_gpu.triangles.get() },
					{ MOVE_BINDING_RESULT, r_gpu.normals.get() } },
			{ r_gpu.normals.get() },
			{ static_cast<uint32_t>(r_gpu.topology->welded_positions_node.size()), 0, 0, 0 } });
}

void DeformPass::run(CommandList &r_commands) {
	const Access READERS[] = { Access::VERTEX_READ, Access::SHADER_READ_VERTEX,
		Access::SHADER_READ_FRAGMENT, Access::SHADER_READ_COMPUTE, Access::COPY_READ };
	std::vector<Barrier> before; // the buffers' earlier readers -> these writes
	std::vector<Barrier> after;	 // these writes -> later readers
	for (const Work &work : pending) {
		for (const BufferRID buffer : work.written) {
			for (const Access reader : READERS) {
				before.push_back({ buffer, {}, reader, Access::SHADER_WRITE_COMPUTE, {} });
				after.push_back({ buffer, {}, Access::SHADER_WRITE_COMPUTE, reader, {} });
			}
		}
	}
	r_commands.barriers(before);
	for (const Work &work : pending) {
		r_commands.bind_pipeline(work.pipeline);
		r_commands.bind_resources(work.bindings);
		r_commands.push_constants(work.push);
		r_commands.dispatch_items({ work.push.vertex_count, 1, 1 });
	}
	r_commands.barriers(after);
	pending.clear();
}

void DeformPass::record(PassContext &p_context) {
	struct Item {
		const Slot *slot;
		std::shared_ptr<const Mesh> mesh;
		GpuMesh *gpu = nullptr;
		GpuTopology *topology = nullptr;
	};
	std::vector<Item> meshes;
	for (auto &[id, gpu] : store.meshes) {
		const Slot *slot = find_slot(gpu.mesh);
		if (slot && gpu.pose_hash != slot->pose->get_hash()) {
			meshes.push_back({ slot, gpu.mesh.lock(), &gpu });
			gpu.pose_hash = slot->pose->get_hash();
		}
	}
	std::vector<Item> topologies;
	for (auto &[id, topology] : store.topologies) {
		const Slot *slot = find_slot(topology.mesh);
		if (slot && topology.positions && topology.pose_hash != slot->pose->get_hash()) {
			topologies.push_back({ slot, topology.mesh.lock(), nullptr, &topology });
			topology.pose_hash = slot->pose->get_hash();
		}
	}
	for (const Item &item : meshes) {
		if (item.mesh == item.slot->mesh) {
			deform_rigged(p_context, *item.slot, *item.gpu);
		}
	}
	run(p_context.commands);
	for (const Item &item : meshes) {
		if (item.mesh == item.slot->mesh && item.slot->program) {
			move_by_program(p_context, *item.slot, *item.gpu);
		}
	}
	run(p_context.commands);
	for (const Item &item : meshes) {
		if (item.mesh != item.slot->mesh) {
			deform_points(*item.slot, item.mesh, *item.gpu);
		}
	}
	run(p_context.commands);
	for (const Item &item : topologies) {
		deform_welded(item.mesh, *item.topology);
	}
	run(p_context.commands);
	for (const Item &item : topologies) {
		if (item.topology->normals) {
			deform_normals(item.mesh, *item.topology);
		}
	}
	run(p_context.commands);
}

void MeshStore::prepare_deform(const std::shared_ptr<const Mesh> &p_mesh, bool p_has_topology) {
	// Each of these functions uploads the data on its first call.
	if (p_has_topology) {
		get_weld(*this, p_mesh);
	}
	if (p_mesh->attributes.rig) {
		get_rig(*this, p_mesh);
		if (!p_mesh->attributes.rig->program_inputs.empty()) {
			get_program_inputs(*this, p_mesh);
		}
	} else {
		get_points(*this, p_mesh);
	}
}

void MeshStore::forget_poses() {
	++forget_count;
	for (auto &[id, mesh] : meshes) {
		mesh.pose_hash = 0;
	}
	for (auto &[id, topology] : topologies) {
		topology.pose_hash = 0;
	}
}

uint32_t MeshStore::add_deform_pass(
		RenderGraph &r_graph, const SceneSnapshot &p_scene, bool p_may_reuse) {
	if (!p_may_reuse) {
		forget_poses();
	}
	const auto pass = std::make_shared<DeformPass>(*this, p_scene, r_graph);
	if (!pass->is_needed()) {
		return 0;
	}
	PassBuilder builder = r_graph.add_pass(DEFORM_PASS_NAME);
	for (const RGBuffer input : pass->list_inputs()) {
		builder.reads(input, Access::SHADER_READ_COMPUTE);
	}
	builder.keep().execute([pass](PassContext &p_context) { pass->record(p_context); });
	return pass->count_moved();
}

} // namespace gnomon
