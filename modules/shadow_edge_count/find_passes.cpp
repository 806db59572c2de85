#include "modules/shadow_edge_count/find_passes.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/shadow_edge_count/work_groups.h"
#include "modules/shadows/fetched_buffers.h"

#include <algorithm>
#include <utility>

namespace gnomon {

namespace {

using Content = PassBuilder::Content;

/// The casters and meshes as the passes over casters read them.
struct CasterBuffers {
	RGBuffer casters;	  // shader::CountCasterRecord
	RGBuffer work_groups; // shader::CountWorkGroup, those of all passes
	RGBuffer mesh_faces;
	RGBuffer mesh_edges;
	RGBuffer points;
};

/// A range of work groups, and the number of all items.
struct CasterWork {
	uint32_t first_group = 0;
	uint32_t group_count = 0;
	uint32_t item_count = 0;
};

/// A buffer in GPU memory, since work groups of all passes read it, and the bytes to copy there.
struct Upload {
	RGBuffer target;
	RGBuffer source;
	uint64_t size_bytes = 0;
};

Upload make_upload(RenderGraph &r_graph, BufferDesc p_desc, const auto &p_values) {
	const std::span<const uint8_t> bytes = bytes_of(std::span(p_values));
	p_desc.size_bytes = bytes.size();
	p_desc.usage = p_desc.usage | BufferUsage::COPY_TARGET;
	return { r_graph.create_buffer(p_desc),
		r_graph.upload(p_desc.name, BufferUsage::COPY_SOURCE, bytes), bytes.size() };
}

/// Adds a pass that uploads the casters and the work groups. p_owned: buffers that must exist until
/// the graph has run.
void upload_casters(RenderGraph &r_graph, const RenderingDevice &p_device,
		const CountCasters &p_casters, const std::vector<shader::CountWorkGroup> &p_groups,
		std::vector<SharedBuffer> p_owned, CasterBuffers &r_buffers) {
	const std::vector<Upload> uploads = { make_upload(r_graph,
												  make_fetched_buffer_desc(p_device, "casters",
														  /*p_size_bytes=*/0, Format::RGBA32_UINT),
												  p_casters.records),
		make_upload(r_graph, { .name = "caster work groups", .usage = BufferUsage::STORAGE },
				p_groups) };
	r_buffers.casters = uploads[0].target;
	r_buffers.work_groups = uploads[1].target;
	PassBuilder pass = r_graph.add_pass("upload casters");
	for (const Upload &upload : uploads) {
		pass.reads(upload.source, Access::COPY_READ).writes(upload.target, Access::COPY_WRITE);
	}
	pass.execute([uploads, owned = std::move(p_owned)](PassContext &p_context) {
		for (const Upload &upload : uploads) {
			p_context.commands.copy_buffer(
					p_context.get(upload.source), p_context.get(upload.target), upload.size_bytes);
		}
	});
}

/// Adds a pass that copies the vertices of deformed meshes to the pool of all meshes, if some have
/// another pose than those in the pool.
void add_pose_pass(RenderGraph &r_graph, const CountCasters &p_casters, BufferRID p_buffer) {
	std::vector<CountCaster> posed;
	for (const uint32_t index : p_casters.posed) {
		const CountCaster &caster = p_casters.casters[index];
		if (caster.posed->pose_hash != caster.pose_hash || caster.posed->buffer != p_buffer) {
			posed.push_back(caster);
		}
	}
	if (posed.empty()) {
		return;
	}
	const RGBuffer points = r_graph.import_buffer(p_buffer);
	// The deform pass orders its writes before all copies of the frame, see DeformPass::run.
	r_graph.add_pass("copy deformed casters")
			.writes(points, Access::COPY_WRITE, Content::UPDATE)
			.execute([points, posed = std::move(posed)](PassContext &p_context) {
				const BufferRID target = p_context.get(points);
				for (const CountCaster &caster : posed) {
					const ItemPool::Range &range = caster.posed->points;
					p_context.commands.copy_buffer(caster.posed_positions, target,
							uint64_t(range.get_count()) * ItemPool::ITEM_BYTES,
							/*p_source_offset_bytes=*/0,
							uint64_t(range.get_first()) * ItemPool::ITEM_BYTES);
					caster.posed->pose_hash = caster.pose_hash;
					caster.posed->buffer = target;
				}
			});
}

/// Adds a pass over work groups of casters, in one dispatch.
void add_caster_pass(RenderGraph &r_graph, RenderingDevice &p_device,
		const CountFindPasses &p_passes, const CasterBuffers &p_buffers, const CasterWork &p_work,
		const char *p_name, const std::string &p_shader, std::vector<PassBinding> p_bindings) {
	if (p_work.group_count == 0) {
		return;
	}
	p_bindings.push_back(PassBinding::read(FIND_BINDING_CASTERS, p_buffers.casters));
	p_bindings.push_back(PassBinding::read(FIND_BINDING_GROUPS, p_buffers.work_groups));
	const shader::CountFindPush push = { p_work.first_group, p_work.group_count, p_work.item_count,
		p_passes.is_directional ? 1u : 0u, static_cast<float>(p_passes.casters.disc_radius),
		p_passes.casters.side_tolerance, p_passes.capacities.edge_count, /*padding=*/0 };
	add_compute_pass(r_graph, p_name,
			p_device.get_compute_pipeline(
					{ p_name, choose_fetching_shader(p_device, p_shader), /*constants=*/{} }),
			std::move(p_bindings), { p_work.group_count * FIND_GROUP_SIZE, 1, 1 },
			std::span(reinterpret_cast<const uint8_t *>(&push), sizeof(push)));
}

void add_edge_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const CountFindPasses &p_passes, const CasterBuffers &p_casters, const CasterWork &p_marked,
		const CasterWork &p_listed) {
	const CountFrameBuffers buffers = p_passes.buffers;
	add_caster_pass(r_graph, p_device, p_passes, p_casters, p_marked, "mark edges",
			"shadow_edge_count/mark_edges.comp",
			{ PassBinding::read(FIND_BINDING_POINTS, p_casters.points),
					PassBinding::read(FIND_BINDING_MESH_EDGES, p_casters.mesh_edges),
					PassBinding::read(COUNT_BINDING_PLANES, buffers.planes),
					PassBinding::write(FIND_BINDING_WORDS, buffers.words, Content::UPDATE),
					PassBinding::write(FIND_BINDING_RUNS, buffers.runs, Content::UPDATE) });
	add_caster_pass(r_graph, p_device, p_passes, p_casters, p_listed, "list edges",
			"shadow_edge_count/list_edges.comp",
			{ PassBinding::read(FIND_BINDING_POINTS, p_casters.points),
					PassBinding::read(FIND_BINDING_MESH_EDGES, p_casters.mesh_edges),
					PassBinding::read(FIND_BINDING_WORDS, buffers.words),
					PassBinding::read(FIND_BINDING_RUNS, buffers.runs),
					PassBinding::write(COUNT_BINDING_EDGES, buffers.edges, Content::UPDATE),
					PassBinding::write(COUNT_BINDING_TOTALS, buffers.totals, Content::UPDATE) });
}

/// Adds a pass that finds the bounds of clusters and nodes, of all faces and edges.
void add_bound_pass(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountFindPasses &p_passes) {
	const CountFrameBuffers buffers = p_passes.buffers;
	const CountCapacities &capacities = p_passes.capacities;
	const uint32_t item_count = std::max(capacities.face_count, capacities.edge_count);
	const std::vector<PassBinding> bindings = { PassBinding::constants(
														COUNT_BINDING_LIGHT, p_passes.constants),
		PassBinding::read(COUNT_BINDING_TOTALS, buffers.totals),
		PassBinding::write(COUNT_BINDING_NODES, buffers.nodes, Content::UPDATE) };
	std::vector<PassBinding> cluster_bindings = bindings;
	cluster_bindings.push_back(PassBinding::read(COUNT_BINDING_EDGES, buffers.edges));
	cluster_bindings.push_back(PassBinding::read(COUNT_BINDING_FACES, buffers.faces));
	std::vector<ComputeStep> steps;
	const uint32_t tree_count = 2;
	const std::string clusters =
			choose_fetching_shader(p_device, "shadow_edge_count/bound_clusters.comp");
	steps.push_back(
			{ .pipeline = p_device.get_compute_pipeline({ clusters, clusters, /*constants=*/{} }),
					.bindings = std::move(cluster_bindings),
					.item_count = { count_nodes(item_count, 0), 1, tree_count } });
	const uint32_t levels_per_step = 3;
	for (uint32_t level = 1; count_nodes(item_count, level - 1) > EDGE_COUNT_NODE_WIDTH;
			level += levels_per_step) {
		const char *nodes = "shadow_edge_count/bound_nodes.comp";
		steps.push_back({ .pipeline = p_device.get_compute_pipeline(
								  { nodes, nodes, { { EDGE_COUNT_CONSTANT_FIRST_LEVEL, level } } }),
				.bindings = bindings,
				.item_count = { count_nodes(item_count, level), 1, tree_count } });
	}
	add_compute_steps(r_graph, "bound clusters", std::move(steps));
}

} // namespace

void add_find_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountFindPasses &p_passes) {
	const CountFrameBuffers buffers = p_passes.buffers;
	const CountCasters &casters = p_passes.casters;
	const CountMeshPools &meshes = p_passes.meshes;
	std::vector<shader::CountWorkGroup> groups;
	const auto add_work = [&](const std::vector<shader::CountWorkGroup> &p_added,
								  uint32_t p_item_count) {
		const CasterWork work = { uint32_t(groups.size()), uint32_t(p_added.size()), p_item_count };
		groups.insert(groups.end(), p_added.begin(), p_added.end());
		return work;
	};
	std::vector<CasterItems> moved_faces;
	std::vector<CasterItems> moved_words;
	for (const uint32_t index : casters.moved) {
		const CountCaster &caster = casters.casters[index];
		const shader::CountCasterRecord &record = casters.records[index];
		moved_faces.push_back({ record.first_face, caster.face_count });
		moved_words.push_back({ record.first_word, caster.word_count });
	}
	const CasterWork face_work =
			add_work(select_work_groups(casters.face_groups, moved_faces), casters.face_count);
	const CasterWork marked =
			add_work(select_work_groups(casters.word_groups, moved_words), casters.word_count);
	const CasterWork listed = add_work(casters.word_groups, casters.word_count);
	if (!groups.empty()) {
		CasterBuffers inputs;
		upload_casters(r_graph, p_device, casters, groups,
				{ meshes.get_faces(), meshes.get_edges(), meshes.get_points() }, inputs);
		inputs.mesh_faces = r_graph.import_buffer(meshes.get_faces().get());
		inputs.points = r_graph.import_buffer(meshes.get_points().get());
		add_pose_pass(r_graph, casters, meshes.get_points().get());
		add_caster_pass(r_graph, p_device, p_passes, inputs, face_work, "caster faces",
				"shadow_edge_count/caster_faces.comp",
				{ PassBinding::read(FIND_BINDING_POINTS, inputs.points),
						PassBinding::read(FIND_BINDING_MESH_FACES, inputs.mesh_faces),
						PassBinding::write(COUNT_BINDING_PLANES, buffers.planes, Content::UPDATE),
						PassBinding::write(COUNT_BINDING_FACES, buffers.faces, Content::UPDATE) });
		if (listed.group_count > 0) {
			inputs.mesh_edges = r_graph.import_buffer(meshes.get_edges().get());
		}
		add_edge_passes(r_graph, p_device, p_passes, inputs, marked, listed);
	}
	add_bound_pass(r_graph, p_device, p_passes);
	if (p_passes.capacities.cut_face_count > 0) {
		add_compute_pass(r_graph, "list cut faces",
				p_device.get_compute_pipeline({ "list cut faces",
						choose_fetching_shader(p_device, "shadow_edge_count/list_cut_faces.comp"),
						/*constants=*/{} }),
				{ PassBinding::constants(COUNT_BINDING_LIGHT, p_passes.constants),
						PassBinding::read(COUNT_BINDING_FACES, buffers.faces),
						PassBinding::write(COUNT_BINDING_TOTALS, buffers.totals, Content::UPDATE),
						PassBinding::write(
								COUNT_BINDING_CUT_FACES, buffers.cut_faces, Content::UPDATE) },
				{ 1, 1, 1 });
	}
}

} // namespace gnomon
