#pragma once

#include "modules/render_graph/render_graph.h"

#include <optional>

// Private to render_graph: the graph's records of resources and passes.

namespace gnomon {

struct RenderGraph::Resource {
	std::string name;
	bool is_texture = false;
	bool is_imported = false;
	std::function<std::optional<TextureRID>()> acquire; // only for the window's image
	bool has_content = false;							// of an imported resource
	TextureDesc texture_desc;
	BufferDesc buffer_desc;
	TextureRID texture;
	BufferRID buffer;
	// Indices of the first and last pass that use it, without culled passes.
	// first_pass > last_pass: unused.
	uint32_t first_pass = ~0u;
	uint32_t last_pass = 0;
	/// Last accesses to the resources that used the same (aliased) memory before.
	std::vector<Access> earlier_users;
	Access last_access = Access::NONE; // latest access for which a barrier was derived
};

struct RenderGraph::Use {
	uint32_t resource = 0;
	Access access = Access::NONE;
	bool is_written = false;
	bool needs_content = true; // false: earlier content is discarded
};

struct RenderGraph::Pass {
	std::string name;
	std::vector<Use> uses;
	// Attachments. The `texture` of ColorTarget and DepthTarget is set when the pass is recorded.
	std::vector<std::pair<RGTexture, ColorTarget>> colors;
	std::optional<std::pair<RGTexture, DepthTarget>> depth;
	std::optional<glm::uvec2> size_without_targets_px;
	bool needs_time = false; // see PassBuilder::needs_time
	bool is_retained = false;
	bool is_culled = false;
	std::function<void(PassContext &)> record;
	std::function<void(HostContext &)> run_on_host;
};

} // namespace gnomon
