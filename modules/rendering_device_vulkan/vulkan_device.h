#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/rendering_device/slot_table.h"
#include "modules/rendering_device/spirv_reflection.h"
#include "modules/rendering_device_vulkan/injected_fault.h"
#include "modules/rendering_device_vulkan/memory_allocator.h"
#include "modules/rendering_device_vulkan/memory_pattern.h"
#include "modules/rendering_device_vulkan/subgroups.h"
#include "modules/rendering_device_vulkan/vulkan_command_list.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"
#include "modules/rendering_device_vulkan/vulkan_instance.h"

#include <deque>
#include <map>
#include <optional>
#include <variant>

namespace gnomon {

class VulkanSwapchain;

struct BufferResource {
	BufferDesc desc;
	VkBuffer buffer = VK_NULL_HANDLE;
	VkBufferView texel_view = VK_NULL_HANDLE;
	Allocation memory;
};

/// SHADER views of a depth-stencil texture have the depth aspect alone; ATTACHMENT views have both.
enum class ViewUse { ATTACHMENT, SHADER };
struct TextureView {
	ViewUse use = ViewUse::ATTACHMENT;
	uint32_t layer = 0; // or Binding::ALL_LAYERS
	bool is_arrayed = false;
	VkImageView view = VK_NULL_HANDLE;
};

struct TextureResource {
	TextureDesc desc;
	VkImage image = VK_NULL_HANDLE;
	Allocation memory; // empty for placed textures and those of a swapchain
	MemoryRID placed_in;
	bool is_swapchain = false;
	/// Layout after the commands recorded so far. begin_rendering finds from it whether a depth
	/// attachment is read-only.
	VkImageLayout recorded_layout = VK_IMAGE_LAYOUT_UNDEFINED;
	std::vector<TextureView> views; // made when first needed
};

struct SamplerResource {
	SamplerDesc desc;
	VkSampler sampler = VK_NULL_HANDLE;
};

struct MemoryResource {
	struct Desc {
		std::string name;
		uint64_t size_bytes = 0;
	} desc;
	Allocation memory;
	uint32_t texture_count = 0; // textures placed here and not yet freed
};

struct PipelineResource {
	std::string name;
	VkPipeline pipeline = VK_NULL_HANDLE;
	VkPipelineLayout layout = VK_NULL_HANDLE;
	VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
	VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
	std::vector<ReflectedBinding> bindings; // of all stages
	bool uses_resources = false;			// a stage reads or writes at least one binding
	uint32_t push_constant_bytes = 0;		// rounded up to a multiple of 16
	VkShaderStageFlags push_constant_stages = 0;
	glm::uvec3 local_size = glm::uvec3(1);
	// For raster pipelines: compared with the render targets at each draw.
	std::vector<Format> color_formats;
	std::optional<Format> depth_format;
	bool writes_depth = false; // or stencil
	uint32_t vertex_buffer_count = 0;
	/// The description that it was created from.
	std::variant<ComputePipelineDesc, RasterPipelineDesc> desc;
};

/// A freed resource that the submission of this number may still use.
struct DeferredFree {
	uint64_t submission_number = 0;
	std::variant<BufferResource, TextureResource, SamplerResource, MemoryResource> resource;
};

/// Data for a new resource; its copy is recorded before the next submission's commands.
struct PendingUpload {
	BufferResource staging;
	uint64_t size_bytes = 0;
	BufferRID buffer; // either this or the texture
	uint64_t buffer_offset_bytes = 0;
	TextureRID texture;
	uint32_t layer_count = 1;
};

/// A live resource, for reports of leaks and of exhausted memory.
struct LiveResource {
	std::string name; // "texture 'albedo'"
	uint64_t size_bytes = 0;
};

/// A copy to the CPU that has been recorded and whose callback has not been called yet.
struct PendingReadBack {
	uint64_t submission_number = 0;
	BufferResource staging;
	RenderingDevice::ReadBackCallback callback;
};

/// Resources of one of the two submissions in flight.
struct SubmissionSlot {
	uint64_t number = 0; // of the submission last recorded here; 0: none yet
	VkCommandPool pool = VK_NULL_HANDLE;
	VkCommandBuffer commands = VK_NULL_HANDLE;
	VkCommandBuffer uploads = VK_NULL_HANDLE; // runs before `commands`
	std::vector<VkDescriptorPool> descriptor_pools;
	size_t descriptor_pool_index = 0;
	std::vector<VkQueryPool> query_pools;
	std::vector<std::string> span_names;
	bool has_unread_spans = false;
	/// The GPU sets word i to the submission's number when it begins span i, so that after a loss
	/// of the device the last span that began can be found.
	BufferResource breadcrumbs;
};

/// The Vulkan device. Its source files share this class; it is hidden outside this module.
class VulkanDevice final : public RenderingDevice {
public:
	// device_creation.cpp
	~VulkanDevice() override;
	/// Must be called once, before everything else; if it fails, the destructor cleans up.
	void initialize(const DeviceOptions &p_options);

	const DeviceInfo &get_info() const override { return physical.info; }
	const DeviceFeatures &get_features() const override { return features; }
	MemoryUse get_memory_use() const override { return allocator.get_use(); }
	CommandCounts get_command_counts() const override { return command_counts; }

	// buffers.cpp, textures.cpp, placed_textures.cpp
	BufferRID create_buffer(const BufferDesc &p_desc) override;
	BufferRID create_buffer_with_data(BufferDesc p_desc, std::span<const uint8_t> p_bytes) override;
	TextureRID create_texture(const TextureDesc &p_desc) override;
	TextureRID create_texture_with_data(
			TextureDesc p_desc, std::span<const uint8_t> p_bytes) override;
	SamplerRID create_sampler(const SamplerDesc &p_desc) override;
	void free(BufferRID p_buffer) override;
	void free(TextureRID p_texture) override;
	void free(SamplerRID p_sampler) override;
	void free(MemoryRID p_memory) override;
	const BufferDesc &get_desc(BufferRID p_buffer) const override {
		return buffers.get(p_buffer).desc;
	}
	const TextureDesc &get_desc(TextureRID p_texture) const override {
		return textures.get(p_texture).desc;
	}
	uint8_t *get_mapped(BufferRID p_buffer) override;
	PlacementRequirements get_placement_requirements(const TextureDesc &p_desc) override;
	MemoryRID create_texture_memory(const std::string &p_name, uint64_t p_size_bytes) override;
	TextureRID create_placed_texture(
			const TextureDesc &p_desc, MemoryRID p_memory, uint64_t p_offset_bytes) override;

	// pipelines.cpp, raster_pipelines.cpp, shader_replacement.cpp
	PipelineRID get_compute_pipeline(const ComputePipelineDesc &p_desc) override;
	PipelineRID get_raster_pipeline(const RasterPipelineDesc &p_desc) override;
	void replace_shaders(
			const std::map<std::string, std::vector<uint32_t>> &p_spirv_by_name) override;

	// submission.cpp, device_waits.cpp
	CommandList &begin_commands() override;
	void submit_commands(SubmitMode p_mode) override;
	void abandon_commands() override;
	void wait_idle() override;
	const std::vector<GpuSpan> &get_gpu_spans() const override { return gpu_spans; }

	// read_backs.cpp
	void read_back(BufferRID p_buffer, ReadBackCallback p_callback) override;
	void read_back(TextureRID p_texture, uint32_t p_layer, ReadBackCallback p_callback) override;

	static constexpr uint32_t SLOT_COUNT = 2;
	static constexpr VkCommandBufferBeginInfo BEGIN_INFO = {
		.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
		.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT
	};
	static constexpr uint32_t MAX_BREADCRUMBS = 1024; // later spans of a submission have none

	DeviceOptions options;
	std::unique_ptr<VulkanInstance> instance;
	PhysicalDevice physical;
	VkPhysicalDeviceLimits limits = {};
	uint64_t max_buffer_bytes = 0;
	uint64_t timestamp_mask = 0; // the valid bits of a timestamp; 0: no timestamps
	DeviceFeatures features;
	SubgroupSizes subgroup_sizes;
	bool has_uniform_control_flow = false; // see declare_uniform_control_flow
	VkDevice device = VK_NULL_HANDLE;
	VkQueue queue = VK_NULL_HANDLE;
	MemoryAllocator allocator;

	SlotTable<BufferRID, BufferResource> buffers{ "buffer" };
	SlotTable<TextureRID, TextureResource> textures{ "texture" };
	SlotTable<SamplerRID, SamplerResource> samplers{ "sampler" };
	SlotTable<MemoryRID, MemoryResource> memories{ "memory" };
	std::deque<PipelineResource> pipelines; // RID = index + 1
	std::map<ComputePipelineDesc, PipelineRID> compute_pipelines;
	std::map<RasterPipelineDesc, PipelineRID> raster_pipelines;
	VkPipelineCache pipeline_cache = VK_NULL_HANDLE;
	uint64_t saved_cache_hash = 0; // of the pipeline cache on disk; 0: there is none

	std::deque<DeferredFree> deferred_frees; // in the order of their submissions
	std::vector<PendingUpload> pending_uploads;
	uint64_t pending_upload_bytes = 0;
	std::deque<PendingReadBack> read_backs; // in the order of their submissions

	VkSemaphore timeline = VK_NULL_HANDLE; // counts finished submissions
	uint64_t submitted_number = 0;
	CommandCounts command_counts;
	/// Passes with more triangles are recorded in parts, each of which ends before the next begins.
	/// Software drivers keep the triangles of all passes that they have not drawn yet in memory.
	uint64_t max_part_triangles = ~uint64_t(0);
	uint64_t continued_part_count = 0; // recorded so far, without the first part of each pass
	SubmissionSlot slots[SLOT_COUNT];
	VulkanCommandList recording;
	std::vector<GpuSpan> gpu_spans;
	VulkanSwapchain *swapchain = nullptr;

	InjectedFault injected_fault;
	std::optional<MemoryPattern> memory_pattern; // of new buffers
	uint32_t random_memory = 1;					 // state of MemoryPattern::RANDOM
	VkSemaphore hang_semaphore = VK_NULL_HANDLE; // not signalled; an injected hang waits for it
	double wait_limit_s = 0;					 // of waits and compilations; 0: none
	bool is_hung = false;  // lost because of a timeout; the GPU may still use everything
	std::string lost_text; // empty while the device works

	PFN_vkSetDebugUtilsObjectNameEXT set_object_name = nullptr;
	PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;
	PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;
	PFN_vkCmdBeginConditionalRenderingEXT begin_conditional_rendering =
			nullptr; // null if the device lacks it
	PFN_vkCmdEndConditionalRenderingEXT end_conditional_rendering = nullptr;

	// device_environment.cpp
	void read_environment();

	// failures.cpp
	/// Throws an Error unless the call succeeded. For a lost device, DeviceLost names the last pass
	/// that began.
	void check(VkResult p_result, const char *p_call);
	void fail_if_lost() const;
	/// p_where: the end of the sentence "The device was lost ...".
	[[noreturn]] void fail_as_lost(const std::string &p_where);
	/// Where the device was lost, for fail_as_lost: during the last pass that began, as far as
	/// known.
	std::string describe_last_span() const;
	static std::string describe_begun_span(const std::string &p_span_name);
	[[noreturn]] void fail_out_of_memory(
			const std::string &p_resource, const MemoryRequest &p_request);
	/// Lists live resources by name, without the images of the swapchain.
	std::vector<LiveResource> find_live_resources();
	template <typename Handle>
	void set_name(VkObjectType p_type, Handle p_handle, const std::string &p_name) {
		set_name_of(p_type, reinterpret_cast<uint64_t>(p_handle), p_name);
	}
	void set_name_of(VkObjectType p_type, uint64_t p_handle, const std::string &p_name);

	// buffers.cpp, textures.cpp, pipelines.cpp, raster_pipelines.cpp
	Allocation allocate(const std::string &p_resource, const MemoryRequest &p_request);
	BufferResource make_buffer(const BufferDesc &p_desc);
	TextureResource make_image(const TextureDesc &p_desc);
	VkImageCreateInfo make_image_info(const TextureDesc &p_desc);
	void check_texture_limits(const TextureDesc &p_desc);
	VkImageView get_view(
			TextureResource &r_texture, ViewUse p_use, uint32_t p_layer, bool p_is_arrayed);
	void destroy(BufferResource &r_buffer);
	void destroy(TextureResource &r_texture);
	void destroy(SamplerResource &r_sampler);
	void destroy(MemoryResource &r_memory);
	void destroy(PipelineResource &r_pipeline);
	PipelineResource make_pipeline(const ComputePipelineDesc &p_desc);
	PipelineResource make_pipeline(const RasterPipelineDesc &p_desc);

	// uploads.cpp
	void add_buffer_upload(BufferRID p_buffer, std::span<const uint8_t> p_bytes);
	void add_texture_upload(TextureRID p_texture, std::span<const uint8_t> p_bytes);
	BufferResource make_staging(const std::string &p_name, std::span<const uint8_t> p_bytes);
	/// Records into the slot's command buffer for uploads.
	VkCommandBufferSubmitInfo record_uploads(const SubmissionSlot &p_slot);
	/// Submits the pending uploads and waits for them, if they have reached MAX_PENDING_BYTES.
	void flush_uploads_when_many();
	/// Discards the pending uploads to a buffer or texture that is being freed.
	template <typename Handle> void drop_uploads(Handle p_target);

	// read_backs.cpp
	/// Adds a read-back to the submission that is being recorded. Returns the buffer to copy into.
	BufferResource &add_read_back(
			const std::string &p_resource, uint64_t p_size_bytes, ReadBackCallback &&p_callback);
	/// Calls the callbacks of finished submissions. Must not be called while commands are being
	/// recorded.
	void call_read_backs();
	/// Discards the read-backs of later submissions, which will not be submitted.
	void drop_read_backs(uint64_t p_after_submission_number);

	// submission.cpp
	SubmissionSlot &get_recording_slot() { return slots[(submitted_number + 1) % SLOT_COUNT]; }
	void create_slots();
	void destroy_slots();
	uint64_t get_finished_number();
	void destroy_freed(uint64_t p_finished_number);
	/// Destroys what finished submissions no longer use, and reads the timestamps of the newest.
	void collect();
	template <typename Resource> void defer_free(Resource &&p_resource);
	void submit();
	/// Throws the failure that a test injects into this submission; returns true if it should hang.
	bool apply_injected_fault(const SubmissionSlot &p_slot);

	// device_waits.cpp
	/// Waits for a submission. Throws DeviceLost if there is no progress for wait_limit_s.
	void wait_for(uint64_t p_submission_number);
	VkResult wait_at_most(uint64_t p_submission_number, double p_seconds);
	size_t count_begun_spans(const SubmissionSlot &p_slot) const;
	[[noreturn]] void fail_as_hung(uint64_t p_finished_number);
	/// Waits until the device is idle. Returns false if it hangs; then nothing may be destroyed.
	bool try_wait_idle();

	// gpu_spans.cpp
	void read_spans(SubmissionSlot &r_slot);
	/// Reads the first p_count timestamps of the pool, of a submission that has ended.
	std::vector<uint64_t> read_timestamps(VkQueryPool p_pool, uint32_t p_count);

	// pipelines.cpp, raster_pipelines.cpp, pipeline_cache_file.cpp
	const PipelineResource &get_pipeline(PipelineRID p_pipeline) const;
	PipelineRID add_pipeline(PipelineResource &&p_pipeline);
	/// Calls p_compile, and warns if it takes longer than wait_limit_s. p_call: its name, for
	/// check.
	void compile(const std::string &p_pipeline, const char *p_call,
			const std::function<VkResult()> &p_compile);
	void check_raster_features(const RasterPipelineDesc &p_desc) const;
	VkPipeline create_raster_pipeline(const RasterPipelineDesc &p_desc, VkPipelineLayout p_layout,
			std::span<const VkPipelineShaderStageCreateInfo> p_stages);
	void create_layout(PipelineResource &r_pipeline, std::span<const ReflectedShader> p_shaders);
	std::string get_cache_name() const;
	void load_pipeline_cache();
	void save_pipeline_cache();

	// descriptors.cpp
	VkDescriptorSet allocate_set(VkDescriptorSetLayout p_layout);
};

} // namespace gnomon
