#include "modules/render_graph/render_graph.h"

#include "modules/core/error.h"
#include "modules/render_graph/render_graph_types.h"
#include "modules/render_graph/transient_pool.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

RenderGraph::RenderGraph(RenderingDevice &p_device, TransientPool &p_pool) :
		device(p_device), pool(p_pool) {}

RenderGraph::~RenderGraph() {
	for (BufferRID buffer : uploads) {
		device.free(buffer);
	}
}

RGTexture RenderGraph::create_texture(const TextureDesc &p_desc) {
	Resource resource;
	resource.name = p_desc.name;
	resource.is_texture = true;
	resource.texture_desc = p_desc;
	resources.push_back(std::move(resource));
	return { static_cast<uint32_t>(resources.size() - 1) };
}

RGBuffer RenderGraph::create_buffer(const BufferDesc &p_desc) {
	Resource resource;
	resource.name = p_desc.name;
	resource.buffer_desc = p_desc;
	resources.push_back(std::move(resource));
	return { static_cast<uint32_t>(resources.size() - 1) };
}

RGBuffer RenderGraph::upload(
		const std::string &p_name, BufferUsage p_usage, std::span<const uint8_t> p_bytes) {
	GNOMON_ASSERT(!p_bytes.empty(), "upload of ", p_name, " has no bytes");
	const BufferRID buffer =
			device.create_buffer({ p_name, p_bytes.size(), p_usage, MemoryKind::UPLOAD });
	uploads.push_back(buffer);
	std::memcpy(device.get_mapped(buffer), p_bytes.data(), p_bytes.size());
	return import_buffer(buffer);
}

RGTexture RenderGraph::import_texture(TextureRID p_texture, ImportedContent p_content) {
	const RGTexture handle = create_texture(device.get_desc(p_texture));
	Resource &resource = resources.back();
	resource.is_imported = true;
	resource.texture = p_texture;
	resource.has_content = p_content == ImportedContent::PRESERVED;
	return handle;
}

RGBuffer RenderGraph::import_buffer(BufferRID p_buffer) {
	for (uint32_t index = 0; index < resources.size(); ++index) {
		if (resources[index].is_imported && resources[index].buffer == p_buffer) {
			return { { index } };
		}
	}
	const RGBuffer handle = create_buffer(device.get_desc(p_buffer));
	Resource &resource = resources.back();
	resource.is_imported = true;
	resource.buffer = p_buffer;
	resource.has_content = true;
	return handle;
}

RGTexture RenderGraph::import_window_image(std::function<std::optional<TextureRID>()> p_acquire) {
	const RGTexture handle = create_texture({ .name = "window image" });
	resources.back().is_imported = true;
	resources.back().acquire = std::move(p_acquire);
	return handle;
}

TextureDesc RenderGraph::get_desc(RGTexture p_texture) const {
	GNOMON_ASSERT(p_texture && resources[p_texture.index].is_texture, "not a texture");
	return resources[p_texture.index].texture_desc;
}

BufferDesc RenderGraph::get_desc(RGBuffer p_buffer) const {
	GNOMON_ASSERT(p_buffer && !resources[p_buffer.index].is_texture, "not a buffer");
	return resources[p_buffer.index].buffer_desc;
}

PassBuilder RenderGraph::add_pass(const std::string &p_name) {
	passes.push_back({});
	passes.back().name = pass_prefix + p_name;
	return PassBuilder(*this, static_cast<uint32_t>(passes.size() - 1));
}

void RenderGraph::add_use(uint32_t p_pass_index, Use p_use) {
	Pass &pass = passes[p_pass_index];
	GNOMON_ASSERT(p_use.resource < resources.size(), "pass ", pass.name, ": an empty handle");
	for (Use &use : pass.uses) {
		if (use.resource != p_use.resource) {
			continue;
		}
		// One layout and one barrier per pass and resource; UNIFORM_READ covers all stages.
		GNOMON_ASSERT(use.access == p_use.access, "pass ", pass.name, " uses ",
				resources[use.resource].name, " in two ways");
		use.is_written |= p_use.is_written;
		use.needs_content |= p_use.needs_content;
		return;
	}
	pass.uses.push_back(p_use);
}

std::vector<std::string> RenderGraph::get_culled_passes() const {
	std::vector<std::string> names;
	for (const Pass &pass : passes) {
		if (pass.is_culled) {
			names.push_back(pass.name);
		}
	}
	return names;
}

void RenderGraph::cull() {
	std::vector<bool> is_needed(resources.size());
	for (size_t index = 0; index < resources.size(); ++index) {
		// Imported resources outlive the frame, so that passes that write them are needed.
		is_needed[index] = resources[index].is_imported;
	}
	for (auto pass = passes.rbegin(); pass != passes.rend(); ++pass) {
		pass->is_culled = !pass->is_retained &&
				std::none_of(pass->uses.begin(), pass->uses.end(), [&](const Use &p_use) {
					return p_use.is_written && is_needed[p_use.resource];
				});
		if (pass->is_culled) {
			continue;
		}
		for (const Use &use : pass->uses) {
			is_needed[use.resource] = is_needed[use.resource] || use.needs_content;
		}
	}
}

void RenderGraph::compute_lifetimes() {
	for (uint32_t index = 0; index < passes.size(); ++index) {
		if (passes[index].is_culled) {
			continue;
		}
		for (const Use &use : passes[index].uses) {
			Resource &resource = resources[use.resource];
			const bool is_first = resource.first_pass == ~0u;
			GNOMON_ASSERT(!is_first || resource.is_imported || use.is_written, "pass ",
					passes[index].name, " reads ", resource.name, ", which no pass wrote");
			resource.first_pass = std::min(resource.first_pass, index);
			resource.last_pass = index;
		}
	}
}

void RenderGraph::allocate() {
	std::vector<TransientRequest> requests;
	std::vector<uint32_t> requested;
	for (uint32_t index = 0; index < resources.size(); ++index) {
		const Resource &resource = resources[index];
		if (resource.is_imported || resource.first_pass == ~0u) {
			continue;
		}
		requests.push_back({ resource.is_texture, resource.texture_desc, resource.buffer_desc,
				resource.first_pass, resource.last_pass });
		requested.push_back(index);
	}
	const TransientPlacement &placement = pool.place(requests);
	unaliased_bytes = placement.unaliased_bytes;
	aliased_bytes = placement.aliased_bytes;
	for (size_t index = 0; index < requested.size(); ++index) {
		Resource &resource = resources[requested[index]];
		resource.texture = placement.textures[index];
		resource.buffer = placement.buffers[index];
		for (uint32_t predecessor : placement.predecessors[index]) {
			// What the earlier user did last decides what has to be waited for.
			const Resource &earlier = resources[requested[predecessor]];
			for (const Use &use : passes[earlier.last_pass].uses) {
				if (use.resource == requested[predecessor]) {
					resource.earlier_users.push_back(use.access);
				}
			}
		}
	}
}

std::string RenderGraph::to_dot() const {
	std::string dot = "digraph frame {\n\trankdir=LR;\n\tnode [fontname=\"sans-serif\"];\n";
	for (size_t index = 0; index < passes.size(); ++index) {
		dot += text("\tp", index, " [shape=box, label=\"", passes[index].name, "\"",
				passes[index].is_culled ? ", style=dashed" : "", "];\n");
		for (const Use &use : passes[index].uses) {
			if (use.is_written) {
				dot += text("\tp", index, " -> r", use.resource, ";\n");
			}
			if (use.needs_content) {
				dot += text("\tr", use.resource, " -> p", index, ";\n");
			}
		}
	}
	for (size_t index = 0; index < resources.size(); ++index) {
		dot += text("\tr", index, " [label=\"", resources[index].name, "\"",
				resources[index].is_imported ? ", peripheries=2" : "", "];\n");
	}
	return dot + "}\n";
}

} // namespace gnomon
