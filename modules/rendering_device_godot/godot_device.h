#pragma once

#include "modules/rendering_device/command_list.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device/slot_table.h"
#include "modules/rendering_device/spirv_reflection.h"
#include "modules/rendering_device_godot/godot_compile_list.h"

#include <godot_api.gen.h>

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <variant>

namespace gnomon {

/// Godot makes no array textures of fewer layers.
const uint32_t MIN_ARRAY_LAYER_COUNT = 2;

struct GodotBuffer {
	BufferDesc desc;
	godot::RID rid;				// none: READBACK, which lives on the CPU alone
	std::vector<uint8_t> bytes; // for UPLOAD and READBACK: the mapped memory
	bool is_stale = false;		// `bytes` has changes that the buffer lacks
};

struct GodotTexture {
	TextureDesc desc;
	godot::RID rid;
	bool is_imported = false;			   // Godot, or the host, owns and frees it
	std::map<uint32_t, godot::RID> layers; // single-layer views of an array texture
};

struct GodotSampler {
	SamplerDesc desc;
	godot::RID rid;
};

struct GodotPipeline {
	std::string name;
	std::variant<ComputePipelineDesc, RasterPipelineDesc> desc;
	std::vector<std::string> shader_names;
	godot::RID shader;						// empty until the pipeline is compiled
	std::vector<ReflectedBinding> bindings; // ordered by binding
	std::vector<uint32_t> boolean_constants;
	uint32_t push_constant_bytes = 0;
	glm::uvec3 local_size = glm::uvec3(1);
	int64_t vertex_format = -1; // -1: no vertex attributes
	/// Godot's pipelines, each compiled when it is bound for the first time. Compute pipelines have
	/// one entry, with key 0; raster pipelines have one per framebuffer format.
	std::map<int64_t, godot::RID> by_framebuffer_format;
};

/// Thrown by submit_commands after commands that only compile, see GodotDevice::compile_only.
class NothingExecuted : public std::runtime_error {
public:
	NothingExecuted() : std::runtime_error("the commands were not executed") {}
};

/// A device on top of one of Godot's RenderingDevices: MAIN, the one that draws Godot's frames,
/// with Gnomon's commands in between, or a separate LOCAL one. Godot inserts barriers and layout
/// transitions and may reorder independent commands. Each call is passed to Godot immediately, so
/// that abandoned commands still run, but they write to resources that are no longer read.
///
/// Features that Godot's device lacks are false in get_features. Use it only on the render thread.
class GodotDevice final : public RenderingDevice, private CommandList {
public:
	enum class Kind { MAIN, LOCAL };
	GodotDevice(godot::RenderingDevice p_device, Kind p_kind, const DeviceOptions &p_options = {});
	~GodotDevice() override;

	/// Imports a texture that Godot owns. It must be freed here before Godot frees it.
	TextureRID import_texture(godot::RID p_texture, const TextureDesc &p_desc);
	/// Whether textures can have 2 samples. If not, Godot makes them with one sample without
	/// reporting it. All devices have 1 and 4 samples.
	bool has_two_samples();
	/// Lists the live resources: "texture 'albedo'", "buffer 'edges'".
	std::vector<std::string> list_live_resources();
	/// While p_count has a value, commands compile up to this many pipelines, which are bound for
	/// the first time, and are not executed: submit_commands throws NothingExecuted.
	void compile_only(std::optional<uint32_t> p_count);
	/// Whether the last commands after compile_only bound no further pipeline to compile.
	bool has_compiled_all() const { return compile_list.get_compilations_left() > 0; }
	uint32_t get_pipeline_count() const { return static_cast<uint32_t>(pipelines.size()); }
	/// Returns Godot's RID, for use with Godot itself, such as in materials.
	godot::RID get_rid(TextureRID p_texture) const { return textures.get(p_texture).rid; }

	const DeviceInfo &get_info() const override { return info; }
	const DeviceFeatures &get_features() const override { return features; }
	MemoryUse get_memory_use() const override;
	CommandCounts get_command_counts() const override { return counts; }

	BufferRID create_buffer(const BufferDesc &p_desc) override;
	BufferRID create_buffer_with_data(BufferDesc p_desc, std::span<const uint8_t> p_bytes) override;
	TextureRID create_texture(const TextureDesc &p_desc) override;
	TextureRID create_texture_with_data(
			TextureDesc p_desc, std::span<const uint8_t> p_bytes) override;
	SamplerRID create_sampler(const SamplerDesc &p_desc) override;
	PipelineRID get_compute_pipeline(const ComputePipelineDesc &p_desc) override;
	PipelineRID get_raster_pipeline(const RasterPipelineDesc &p_desc) override;
	/// Always an Error: shaders are edited in Gnomon's own editor.
	void replace_shaders(const std::map<std::string, std::vector<uint32_t>> &) override;
	void free(BufferRID p_buffer) override;
	void free(TextureRID p_texture) override;
	void free(SamplerRID p_sampler) override;
	void free(MemoryRID p_memory) override;

	const BufferDesc &get_desc(BufferRID p_buffer) const override;
	const TextureDesc &get_desc(TextureRID p_texture) const override;
	uint8_t *get_mapped(BufferRID p_buffer) override;

	PlacementRequirements get_placement_requirements(const TextureDesc &p_desc) override;
	MemoryRID create_texture_memory(const std::string &p_name, uint64_t p_size_bytes) override;
	TextureRID create_placed_texture(
			const TextureDesc &p_desc, MemoryRID p_memory, uint64_t p_offset_bytes) override;

	CommandList &begin_commands() override;
	void submit_commands(SubmitMode p_mode) override;
	void abandon_commands() override;
	void wait_idle() override;
	void read_back(BufferRID p_buffer, ReadBackCallback p_callback) override;
	void read_back(TextureRID p_texture, uint32_t p_layer, ReadBackCallback p_callback) override;
	const std::vector<GpuSpan> &get_gpu_spans() const override { return spans; }

private:
	friend class GodotCompileList;
	// CommandList
	void begin_span(const std::string &p_name, bool p_needs_time = false) override;
	void end_span() override;
	void barriers(std::span<const Barrier> p_barriers) override;
	void begin_rendering(
			std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) override;
	void begin_rendering_without_targets(glm::uvec2 p_size_px) override;
	void end_rendering() override;
	void set_viewport(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) override;
	void set_scissor(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) override;
	void set_depth_bounds(float p_min, float p_max) override;
	void bind_pipeline(PipelineRID p_pipeline) override;
	void bind_resources(std::span<const Binding> p_bindings) override;
	void push_constants(std::span<const uint8_t> p_bytes) override;
	void bind_vertex_buffers(std::span<const BufferRID> p_buffers) override;
	void bind_index_buffer(BufferRID p_buffer) override;
	void draw(uint32_t p_vertex_count, uint32_t p_instance_count) override;
	void draw_indexed(uint32_t p_index_count, uint32_t p_first_index) override;
	/// An error: Godot's draw lists have no first instance.
	void draw_instances(
			uint32_t p_index_count, uint32_t p_instance_count, uint32_t p_first_instance) override;
	void draw_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) override;
	void begin_conditional(BufferRID p_predicate, uint64_t p_offset_bytes) override;
	void end_conditional() override;
	void dispatch(glm::uvec3 p_group_count) override;
	void dispatch_items(glm::uvec3 p_item_count) override;
	void dispatch_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) override;
	void clear_buffer(BufferRID p_buffer) override;
	void copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
			uint64_t p_source_offset_bytes, uint64_t p_target_offset_bytes) override;
	void copy_texture_to_buffer(TextureRID p_source, BufferRID p_target, uint32_t p_layer) override;
	void copy_buffer_to_texture(BufferRID p_source, TextureRID p_target, uint32_t p_layer,
			uint64_t p_source_offset_bytes) override;
	void copy_texture(TextureRID p_source, TextureRID p_target) override;
	void clear_color(TextureRID p_texture, glm::vec4 p_value, uint32_t p_layer) override;

	/// Key of a Godot object that is made from several resources: their ids, and other numbers.
	/// Ids are above 2^32, so that remove_dependents cannot mistake another number for an id.
	using Key = std::vector<uint64_t>;
	struct Cached {
		godot::RID rid;
		uint64_t last_use = 0;
	};
	using Cache = std::map<Key, Cached>;

	uint32_t measure_subgroup_size();
	bool measure_two_samples();
	godot::RID create_godot_buffer(const BufferDesc &p_desc, std::span<const uint8_t> p_bytes);
	/// Returns a view of the layer; the texture itself for ALL_LAYERS or if it is no array.
	godot::RID get_layer(GodotTexture &r_texture, uint32_t p_layer);
	PipelineRID add_pipeline(GodotPipeline &&p_pipeline, std::span<const std::string> p_shaders);
	godot::RID get_shader(std::span<const std::string> p_names);
	size_t get_index(PipelineRID p_pipeline) const; // in `pipelines`
	/// Returns Godot's pipeline, compiled now if it is bound for the first time.
	godot::RID compile(GodotPipeline &r_pipeline, int64_t p_framebuffer_format);
	godot::RID make_raster_pipeline(const GodotPipeline &p_pipeline, int64_t p_framebuffer_format);
	godot::RID get_uniform_set(
			const GodotPipeline &p_pipeline, std::span<const Binding> p_bindings);
	godot::RID get_framebuffer(std::span<const ColorTarget> p_colors, const DepthTarget *p_depth);
	godot::RID get_empty_framebuffer(glm::uvec2 p_size_px);
	void begin_draw_list(godot::RID p_framebuffer, int64_t p_flags,
			std::span<const glm::vec4> p_clear_colors, float p_clear_depth);
	/// Binds the vertex array of the bound pipeline and buffers; does nothing if the pipeline has
	/// no vertex attributes.
	void bind_vertex_array(uint32_t p_vertex_count);
	void begin_compute_list();
	void end_compute_list();
	void flush_uploads();
	/// Removes the cached objects that were made from the resource. Godot frees them with the
	/// resource.
	void remove_dependents(godot::RID p_resource);
	/// Frees entries that were not used for more than MAX_UNUSED_FRAMES submissions.
	void prune(Cache &r_cache, bool (*p_is_valid)(const godot::RenderingDevice &, godot::RID));
	void prune_spare_uploads();
	void call_read_backs();
	/// Sets timed_ms from the timestamps of the newest frame that has finished.
	void read_timestamps();
	void add_read_back(std::span<const uint8_t> p_bytes, ReadBackCallback &&p_callback);
	godot::Callable make_callable(ReadBackCallback p_callback) const;

	godot::RenderingDevice rd;
	const Kind kind;
	DeviceInfo info;
	DeviceFeatures features;
	std::optional<bool> two_samples; // result of measure_two_samples()
	CommandCounts counts;
	MemoryUse use;
	/// Of the newest submission. Only those that need a time have one, of an earlier frame: Godot
	/// times what is between two timestamps, and has room for few of them.
	std::vector<GpuSpan> spans;
	static constexpr std::string_view TIMED_SPAN_PREFIX = "Gnomon: "; // of timestamps
	bool is_any_timed = false;										  // some span needed a time
	bool is_span_timed = false;				// the last timestamp began a span
	std::map<std::string, double> timed_ms; // by span

	SlotTable<BufferRID, GodotBuffer> buffers{ "buffer" };
	SlotTable<TextureRID, GodotTexture> textures{ "texture" };
	SlotTable<SamplerRID, GodotSampler> samplers{ "sampler" };
	std::deque<GodotPipeline> pipelines; // handles are 1 + index
	std::map<ComputePipelineDesc, PipelineRID> compute_pipelines;
	std::map<RasterPipelineDesc, PipelineRID> raster_pipelines;
	std::map<std::vector<std::string>, godot::RID> shaders;
	Cache uniform_sets;
	Cache framebuffers;
	Cache vertex_arrays;
	Cache index_arrays;
	std::map<Key, int64_t> vertex_formats;
	/// Unused UPLOAD buffers by size and usage, for reuse: each frame's constants then have the
	/// same ids as those of the frame before, so that cached uniform sets can be reused too.
	std::map<std::pair<uint64_t, BufferUsage>, std::vector<Cached>> spare_uploads;
	std::vector<BufferRID> stale_uploads;
	/// For a local device: data that was read back, and the callbacks to call.
	std::deque<std::pair<std::vector<uint8_t>, ReadBackCallback>> read_backs;
	/// Shared with the callbacks that Godot stores, which do nothing if one of them is false.
	std::shared_ptr<bool> is_not_abandoned = std::make_shared<bool>(true); // one per recording
	std::shared_ptr<bool> is_alive = std::make_shared<bool>(true); // false: device destroyed

	// State of the recording and of the last submission.
	uint64_t submission = 0; // number of the newest one, the one being recorded included
	bool is_recording = false;
	bool is_submitted = false; // a local device's last submission has not been waited for
	// Godot's ids of the open lists, and of the draw list's framebuffer format; -1: none.
	int64_t compute_list = -1;
	int64_t draw_list = -1;
	int64_t framebuffer_format = -1;
	const GodotPipeline *bound = nullptr; // the bound pipeline
	bool is_compiling_only = false;
	GodotCompileList compile_list{ *this };
	std::vector<BufferRID> vertex_buffers;
	BufferRID index_buffer;
};

} // namespace gnomon
