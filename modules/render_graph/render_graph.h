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

/// Passed to the function that records a pass: the command list, and access to the resources of the
/// graph's handles.
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

/// Passed to the function of a host pass: access to its buffers as mapped memory. The GPU has
/// finished all earlier passes.
class HostContext {
public:
	uint8_t *get_mapped(RGBuffer p_buffer) const;

	explicit HostContext(const RenderGraph &p_graph) : graph(p_graph) {}

private:
	const RenderGraph &graph;
};

/// Time of one pass. gpu_ms is the time between two GPU timestamps. wall_ms is the wall time from
/// the start of recording to the end of the pass; it is measured only for host passes and with
/// Mode::ONE_BY_ONE.
struct PassTiming {
	std::string name;
	double gpu_ms = 0;
	double wall_ms = 0;
	bool is_on_host = false; // a host pass; its gpu_ms is 0

	double get_cost_ms() const { return is_on_host ? wall_ms : gpu_ms; }
};

/// Declares one pass: first what it reads and writes, then the function that records it.
class PassBuilder {
public:
	/// Declares a read: by shaders, as vertex or index buffer, indirect arguments or uniforms, or
	/// by copies.
	PassBuilder &reads(RGResource p_resource, Access p_access);
	/// Declares a write: to a storage texture or buffer, or by copies. FRESH: the pass writes every
	/// texel that is read later, and earlier content is discarded. UPDATE: earlier content is
	/// preserved.
	enum class Content { FRESH, UPDATE };
	PassBuilder &writes(RGResource p_resource, Access p_access, Content p_content = Content::FRESH);
	/// Declares an attachment. The graph begins and ends the rendering around the pass's function.
	PassBuilder &color(RGTexture p_texture, LoadOp p_load = LoadOp::CLEAR,
			glm::vec4 p_clear = glm::vec4(0.0f), uint32_t p_layer = 0);
	PassBuilder &depth(
			RGTexture p_texture, LoadOp p_load, float p_clear = 0.0f, uint32_t p_layer = 0);
	/// Renders without attachments, at a given size: for fragment shaders that only store.
	PassBuilder &without_targets(glm::uvec2 p_size_px);
	/// Prevents culling of the pass, even if nothing reads its output.
	PassBuilder &keep();
	/// Its time is wanted also on devices that time only few passes, see CommandList::begin_span.
	PassBuilder &needs_time();
	/// Sets the function that records the pass.
	void execute(std::function<void(PassContext &)> p_record);
	/// Makes it a host pass: p_run is called on the CPU after all earlier passes have been
	/// submitted and have finished. It uses only READBACK buffers (HOST_READ) and UPLOAD buffers
	/// (HOST_WRITE).
	void execute_on_host(std::function<void(HostContext &)> p_run);

	PassBuilder(RenderGraph &p_graph, uint32_t p_pass_index) :
			graph(p_graph), pass_index(p_pass_index) {}

private:
	RenderGraph &graph;
	uint32_t pass_index;
};

/// The passes of one frame, in the order in which they were added. Passes declare reads and writes;
/// the graph culls passes whose results are unused, lets transient textures with disjoint lifetimes
/// share memory, and records the barriers between passes.
///
/// A graph is created for each frame. Its memory is cached in the TransientPool.
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
	/// Uploads a struct of constants for a storage block of std140 layout, or for a uniform block.
	/// Mesa's lavapipe 22.3 recompiles a shader for each new value in a uniform block on which the
	/// shader's branches depend, which can be for each light and frame. For storage blocks it does
	/// not recompile. But it loads nothing from storage blocks in helper invocations, which
	/// derivatives need, and in fragment shaders it loads from them more slowly.
	template <typename T>
	RGBuffer upload_constants(const std::string &p_name, const T &p_block,
			BufferUsage p_usage = BufferUsage::STORAGE) {
		return upload(
				p_name, p_usage, std::span(reinterpret_cast<const uint8_t *>(&p_block), sizeof(T)));
	}
	/// Imports a resource that outlives the frame. Between frames, imported textures are in
	/// Access::SHADER_READ_COMPUTE. NONE: the texture has no content yet, or none that is needed.
	enum class ImportedContent { NONE, PRESERVED };
	RGTexture import_texture(TextureRID p_texture, ImportedContent p_content);
	/// A buffer that is imported again has the same handle, so that barriers separate its users.
	RGBuffer import_buffer(BufferRID p_buffer);
	/// Imports the window's next image, acquired by p_acquire when the pass that uses it is
	/// recorded, and presented when that pass is submitted. Only one pass may use it. The pass is
	/// skipped if p_acquire returns nothing.
	RGTexture import_window_image(std::function<std::optional<TextureRID>()> p_acquire);

	/// Returned by value, because creating another resource would invalidate a reference.
	TextureDesc get_desc(RGTexture p_texture) const;
	BufferDesc get_desc(RGBuffer p_buffer) const;

	PassBuilder add_pass(const std::string &p_name);
	/// Sets the prefix of the names of passes added from now on: "Lamp: ". Empty = no prefix.
	void set_pass_prefix(const std::string &p_prefix) { pass_prefix = p_prefix; }

	/// QUEUE: returns without waiting for the passes after the last host pass; for these,
	/// get_timings() has the times of an earlier frame. WAIT: returns when the GPU has finished.
	/// ONE_BY_ONE: submits each pass separately and waits for it, to measure PassTiming::wall_ms.
	enum class Mode { QUEUE, WAIT, ONE_BY_ONE };
	/// Culls passes, allocates resources, then records and submits the passes. Call it at most
	/// once.
	void execute(Mode p_mode);

	const std::vector<PassTiming> &get_timings() const { return timings; }
	/// Wall time of execute(), in milliseconds, from the first to the last command.
	double get_wall_ms() const { return wall_ms; }
	/// Names of the passes that were culled because nothing uses their output.
	std::vector<std::string> get_culled_passes() const;
	/// Bytes of the transient textures without and with aliasing. Valid after execute().
	uint64_t get_unaliased_bytes() const { return unaliased_bytes; }
	uint64_t get_aliased_bytes() const { return aliased_bytes; }
	/// Graphviz text: passes as boxes (culled ones dashed), resources as ellipses (imported ones
	/// with a double outline).
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
	/// Returns imported textures to the access that they have between frames.
	void transition_imported(std::vector<Barrier> &r_barriers);
	Resource *find_window_image(const Pass &p_pass);
	/// Appends the GPU times of the newest finished submission to the timings.
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
