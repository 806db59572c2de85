#pragma once

#include "modules/rendering_device/command_list.h"
#include "modules/rendering_device/rendering_device.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// A texture or buffer of one graph. Transient resources live from their first to their last pass.
struct RGResource {
	uint32_t index = ~0u;
	explicit operator bool() const { return index != ~0u; }
	bool operator==(const RGResource &) const = default;
};
struct RGTexture : RGResource {};
struct RGBuffer : RGResource {};

class RenderGraph;
class TransientPool;

/// Passed to a pass's function: the command list, and the resources behind the graph's handles.
class PassContext {
public:
	CommandList &commands;

	TextureRID get(RGTexture p_texture) const;
	BufferRID get(RGBuffer p_buffer) const;
	RenderingDevice &get_device() const;

	PassContext(CommandList &p_commands, const RenderGraph &p_graph) :
			commands(p_commands), graph(p_graph) {}

private:
	const RenderGraph &graph;
};

/// Passed to a host pass: its buffers as mapped memory, after the GPU has finished its work.
class HostContext {
public:
	uint8_t *get_mapped(RGBuffer p_buffer) const;

	explicit HostContext(const RenderGraph &p_graph) : graph(p_graph) {}

private:
	const RenderGraph &graph;
};

/// Time of one pass. gpu_ms is the time between two timestamps; wall_ms is what the CPU's clock saw
/// from recording to the end of the pass, known only when passes ran one by one.
struct PassTiming {
	std::string name;
	double gpu_ms = 0;
	double wall_ms = 0;
	bool is_on_host = false; // a host pass: its cost is wall_ms, its gpu_ms is 0
};

/// Declares one pass: what it reads, what it writes, then the function that records it.
class PassBuilder {
public:
	/// Shader reads, vertex and index buffers, indirect arguments, uniforms, copies.
	PassBuilder &reads(RGResource p_resource, Access p_access);
	/// Storage images and buffers, copies. FRESH: the pass writes every texel that is read later,
	/// and earlier content is discarded. UPDATE: earlier content is preserved.
	enum class Content { FRESH, UPDATE };
	PassBuilder &writes(RGResource p_resource, Access p_access, Content p_content = Content::FRESH);
	/// Attachments: the graph begins and ends the rendering around the pass's function.
	PassBuilder &color(RGTexture p_texture, LoadOp p_load = LoadOp::CLEAR,
			glm::vec4 p_clear = glm::vec4(0.0f), uint32_t p_layer = 0);
	PassBuilder &depth(
			RGTexture p_texture, LoadOp p_load, float p_clear = 0.0f, uint32_t p_layer = 0);
	/// Renders without attachments, at a given size: for fragment shaders that only store.
	PassBuilder &without_targets(glm::uvec2 p_size_px);
	/// Keeps the pass even if nothing reads its output.
	PassBuilder &keep();
	void execute(std::function<void(PassContext &)> p_record);
	/// Runs on the CPU: everything before it is submitted and waited for. Its buffers are READBACK
	/// (HOST_READ) or UPLOAD (HOST_WRITE) ones.
	void execute_on_host(std::function<void(HostContext &)> p_run);

	PassBuilder(RenderGraph &p_graph, uint32_t p_pass_index) :
			graph(p_graph), pass_index(p_pass_index) {}

private:
	RenderGraph &graph;
	uint32_t pass_index;
};

/// The passes of one frame, in the order in which they were added. Passes declare reads and
/// writes; the graph culls passes whose results are unused, gives transient textures memory
/// that they share when they do not live at the same time, and puts the barriers between passes.
///
/// Recreated each frame; what can be reused (memory) is cached in the TransientPool.
class RenderGraph {
public:
	RenderGraph(RenderingDevice &p_device, TransientPool &p_pool);
	~RenderGraph();
	RenderGraph(const RenderGraph &) = delete;
	RenderGraph &operator=(const RenderGraph &) = delete;

	RGTexture create_texture(const TextureDesc &p_desc);
	RGBuffer create_buffer(const BufferDesc &p_desc);
	/// Creates a buffer with these bytes; for constants and small lists of this frame.
	RGBuffer upload(
			const std::string &p_name, BufferUsage p_usage, std::span<const uint8_t> p_bytes);
	/// For storage blocks of std140 layout, or for uniform blocks. Mesa's lavapipe 22.3 compiles a
	/// shader again for each value of a uniform block that its branches depend on, for each light
	/// and frame that is; of a storage block it never does. But it loads nothing from storage
	/// blocks in helper invocations, which derivatives need, and slower ones in fragment shaders.
	template <typename T>
	RGBuffer upload_constants(const std::string &p_name, const T &p_block,
			BufferUsage p_usage = BufferUsage::STORAGE) {
		return upload(
				p_name, p_usage, std::span(reinterpret_cast<const uint8_t *>(&p_block), sizeof(T)));
	}
	/// A resource that outlives the frame. Between frames imported textures rest as
	/// SHADER_READ_COMPUTE. NONE: it has no content yet (it was just made).
	enum class ImportedContent { NONE, PRESERVED };
	RGTexture import_texture(TextureRID p_texture, ImportedContent p_content);
	RGBuffer import_buffer(BufferRID p_buffer);
	/// Imports the window's next image, acquired by p_acquire when its first pass is recorded and
	/// presented when that pass is submitted; one pass uses it. The pass is skipped if p_acquire
	/// returns nothing.
	RGTexture import_window_image(std::function<std::optional<TextureRID>()> p_acquire);

	/// Returned by value, because creating another resource would invalidate a reference.
	TextureDesc get_desc(RGTexture p_texture) const;
	BufferDesc get_desc(RGBuffer p_buffer) const;

	PassBuilder add_pass(const std::string &p_name);
	/// Sets the prefix of the names of passes added from now on: "Lamp: ". Empty = no prefix.
	void set_pass_prefix(const std::string &p_prefix) { pass_prefix = p_prefix; }

	/// QUEUE: returns at once; timings() then belong to an earlier frame. WAIT: returns when the
	/// GPU has finished. ONE_BY_ONE: each pass is a submission of its own that is waited for, so
	/// that wall_ms is known.
	enum class Mode { QUEUE, WAIT, ONE_BY_ONE };
	/// Compiles and runs the passes; at most once.
	void execute(Mode p_mode);

	const std::vector<PassTiming> &get_timings() const { return timings; }
	/// Wall time of execute(), in milliseconds, from the first to the last command.
	double get_wall_ms() const { return wall_ms; }
	/// Names of the passes that were culled because nothing uses their output.
	std::vector<std::string> get_culled_passes() const;
	/// Bytes of transient textures without aliasing, and as placed. Valid after execute().
	uint64_t get_unaliased_bytes() const { return unaliased_bytes; }
	uint64_t get_aliased_bytes() const { return aliased_bytes; }
	/// Graphviz text: passes as boxes, resources as ellipses, culled passes dashed.
	std::string to_dot() const;

private:
	friend class PassBuilder;
	friend class PassContext;
	friend class HostContext;
	struct Resource;
	struct Use;
	struct Pass;

	void add_use(uint32_t p_pass_index, Use p_use);
	void cull();
	void compute_lifetimes();
	void allocate();
	void collect_barriers(uint32_t p_pass_index, std::vector<Barrier> &r_barriers);
	void run_passes(Mode p_mode);
	void record_pass(Pass &p_pass, CommandList &p_commands);
	void rest_imported(std::vector<Barrier> &r_barriers);
	Resource *find_window_image(const Pass &p_pass);
	void collect_spans();

	RenderingDevice &device;
	TransientPool &pool;
	std::vector<Resource> resources; // textures and buffers; a handle's index points here
	std::vector<Pass> passes;
	std::vector<PassTiming> timings;
	std::vector<BufferRID> uploads; // freed with the graph
	std::string pass_prefix;
	double wall_ms = 0;
	uint64_t unaliased_bytes = 0;
	uint64_t aliased_bytes = 0;
	bool is_executed = false;
};

} // namespace gnomon
