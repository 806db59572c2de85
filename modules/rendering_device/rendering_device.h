#pragma once

#include "modules/rendering_device/resource_types.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

class CommandList;
struct DeviceFeatures;
/// A list of features, such as { &DeviceFeatures::geometry_shader, ... }.
using FeatureList = std::vector<bool DeviceFeatures::*>;

/// Options of create_rendering_device.
struct DeviceOptions {
	/// Index ("0") or part of a name, any case. Empty = a usable device of the best type: discrete
	/// GPU, else integrated GPU, virtual GPU, CPU, other.
	std::string device;
	bool validation = false; // validation and synchronization layers
	/// Limit of the memory that resources use. 0 = $GNOMON_MEMORY_BUDGET_MIB if it is set, else the
	/// budget that the device reports, but at most 90 % of its heap.
	uint64_t memory_budget_bytes = 0;
	/// Timeout of waits, in seconds: if no submission ends and no pass begins for this long, the
	/// wait throws DeviceLost. 0 = no timeout. Absent = $GNOMON_DEVICE_TIMEOUT_S, else 60 s (600 s
	/// on a CPU device).
	std::optional<double> wait_limit_s;
	bool needs_surface = false;					  // the device must be able to show a window
	std::vector<std::string> instance_extensions; // Vulkan's, for the window
	/// Features to treat as absent even if the device has them.
	FeatureList denied_features;
};

/// A device, as `gnomon info` lists it.
struct DeviceInfo {
	uint32_t index = 0;
	std::string name;
	std::string driver; // name and version
	/// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other"; inside Godot "of Godot".
	std::string type;
	std::string api_version;   // "1.3.230"
	uint64_t memory_bytes = 0; // of the largest device-local heap
	bool is_usable = false;
	std::string refusal; // why it is unusable: "Vulkan 1.1, 1.3 is needed"
};

/// Shaders size their shared memory for subgroups that are at least this large.
inline constexpr uint32_t MIN_SUBGROUP_SIZE = 4;

/// Optional features of a device. The minimum that Gnomon requires of every device is compute
/// shaders, 128 bytes of push constants, and 32-bit depth that shaders can read. Without geometry
/// shaders, aliased memory, conditional rendering, depth bounds, storage_and_texel_buffers or
/// copies to textures, frames are slower, and masks are the same with one exception: without
/// geometry shaders, the geometric normals are derived from the depth, which can change pixels at
/// edges.
struct DeviceFeatures {
	/// Geometry shaders, and gl_PrimitiveID in fragment shaders.
	bool geometry_shader = false;
	bool aliased_memory = false; // create_texture_memory, create_placed_texture
	bool depth_clamp = false;
	bool depth_bounds = false;
	bool conditional_rendering = false;
	bool fragment_stores = false; // fragment shaders may write storage buffers and textures
	/// Buffers that are BufferUsage::STORAGE and TEXEL at once. Not Vulkan's storage texel buffers,
	/// which no shader may use.
	bool storage_and_texel_buffers = false;
	/// copy_buffer_to_texture from buffers in GPU memory; from UPLOAD buffers it always works.
	bool copies_to_textures = false;
	bool timestamps = false;
	uint64_t max_storage_buffer_bytes = 0;
	uint32_t max_texture_size_px = 0;
	/// Of compute shaders with subgroup operations. If the work group's size is a multiple of it,
	/// all subgroups are full.
	uint32_t subgroup_size = 0;
	/// Vote, arithmetic, ballot and shuffle in compute shaders, with subgroups of at least
	/// MIN_SUBGROUP_SIZE invocations.
	bool subgroup_operations = false;
	/// The device is a CPU driver. Some compute shaders have another shape there.
	bool runs_on_cpu = false;
};

/// Use of GPU memory.
struct MemoryUse {
	uint64_t used_bytes = 0;	  // by resources
	uint64_t allocated_bytes = 0; // from the driver, in blocks
	uint64_t budget_bytes = 0;
	uint64_t peak_bytes = 0; // highest used_bytes since the device was created
};

/// Commands recorded since the device was created, including conditional ones that the GPU skips.
struct CommandCounts {
	uint64_t draws = 0;
	uint64_t dispatches = 0;
	CommandCounts operator-(const CommandCounts &p_earlier) const {
		return { draws - p_earlier.draws, dispatches - p_earlier.dispatches };
	}
};

/// Time of one span between two timestamps of a finished submission.
struct GpuSpan {
	std::string name;
	double gpu_ms = 0;
};

/// A GPU device and its resources. The backend that is linked into the program implements it, and
/// also the functions of modules/rendering_device/tests/testing.h for the tests. Not thread-safe:
/// use it on one thread. Every failure is an Error that names the object, the value, the limit and
/// the next step. If the device is lost, or makes no progress (see DeviceOptions::wait_limit_s),
/// the call that notices it and all later ones throw DeviceLost with the same text, which names the
/// last pass that had begun.
///
/// Resources are handles. free() may be called while the GPU still uses the resource: it is
/// destroyed when the submission that was recorded last has finished. Resources that were not freed
/// when the device is destroyed are each reported by name, as errors in the log.
class RenderingDevice {
public:
	RenderingDevice() = default;
	virtual ~RenderingDevice() = default;
	RenderingDevice(const RenderingDevice &) = delete;
	RenderingDevice &operator=(const RenderingDevice &) = delete;

	virtual const DeviceInfo &get_info() const = 0;
	virtual const DeviceFeatures &get_features() const = 0;
	virtual MemoryUse get_memory_use() const = 0;
	virtual CommandCounts get_command_counts() const = 0;

	// Creation of resources. Exceeding the memory budget or a limit of the device is an Error that
	// names the resource, its size and the limit.
	virtual BufferRID create_buffer(const BufferDesc &p_desc) = 0;
	/// Creates a buffer in GPU memory. The bytes are copied into it before the commands of the next
	/// submission run.
	virtual BufferRID create_buffer_with_data(
			BufferDesc p_desc, std::span<const uint8_t> p_bytes) = 0;
	virtual TextureRID create_texture(const TextureDesc &p_desc) = 0;
	/// Creates a texture filled with tightly packed texels, with all mip levels. The number of
	/// bytes decides whether all layers are filled, or layer 0 alone. It is ready for SAMPLED use.
	virtual TextureRID create_texture_with_data(
			TextureDesc p_desc, std::span<const uint8_t> p_bytes) = 0;
	virtual SamplerRID create_sampler(const SamplerDesc &p_desc) = 0;
	/// Returns the pipeline of this description. It is created from the embedded SPIR-V at the
	/// first call and owned by the device.
	virtual PipelineRID get_compute_pipeline(const ComputePipelineDesc &p_desc) = 0;
	virtual PipelineRID get_raster_pipeline(const RasterPipelineDesc &p_desc) = 0;
	/// Replaces the SPIR-V of these shaders, named as in ComputePipelineDesc::shader, and recreates
	/// all pipelines that use one of them, after the GPU is done. Handles stay valid. SPIR-V that
	/// the device refuses, or that has bindings or push constants other than this build's, is an
	/// Error that leaves everything unchanged. Not allowed while commands are being recorded;
	/// SPIR-V of another stage is a programming error.
	virtual void replace_shaders(
			const std::map<std::string, std::vector<uint32_t>> &p_spirv_by_name) = 0;
	virtual void free(BufferRID p_buffer) = 0;
	virtual void free(TextureRID p_texture) = 0;
	virtual void free(SamplerRID p_sampler) = 0;
	virtual void free(MemoryRID p_memory) = 0;

	virtual const BufferDesc &get_desc(BufferRID p_buffer) const = 0;
	virtual const TextureDesc &get_desc(TextureRID p_texture) const = 0;
	/// Mapped memory of an UPLOAD or READBACK buffer, valid as long as the buffer.
	virtual uint8_t *get_mapped(BufferRID p_buffer) = 0;

	// Aliased memory, for the render graph: textures placed in one block of memory. Needs
	// DeviceFeatures::aliased_memory.
	struct PlacementRequirements {
		uint64_t size_bytes = 0;
		uint64_t alignment_bytes = 1;
	};
	virtual PlacementRequirements get_placement_requirements(const TextureDesc &p_desc) = 0;
	/// Creates a block of GPU memory in which textures of any format and usage can be placed.
	virtual MemoryRID create_texture_memory(const std::string &p_name, uint64_t p_size_bytes) = 0;
	virtual TextureRID create_placed_texture(
			const TextureDesc &p_desc, MemoryRID p_memory, uint64_t p_offset_bytes) = 0;

	// Submissions: begin_commands, record, submit_commands. At most two are in flight.
	/// Starts recording. Waits while two submissions are in flight, and destroys freed resources
	/// that the GPU no longer uses.
	virtual CommandList &begin_commands() = 0;
	/// Submits the recorded commands. They see all writes of earlier submissions and of the host,
	/// and begin when earlier submissions have ended; their own writes are visible to the host when
	/// they have finished. WAIT: also waits until they have finished, so that READBACK memory is
	/// valid. A swapchain image that a recorded barrier brought to Access::PRESENT is presented.
	enum class SubmitMode { QUEUE, WAIT };
	virtual void submit_commands(SubmitMode p_mode) = 0;
	/// Discards what was recorded since begin_commands, for when an Error ends a frame early. An
	/// acquired swapchain image stays acquired. Does nothing if no commands are being recorded.
	virtual void abandon_commands() = 0;
	virtual void wait_idle() = 0;
	/// Records a copy of the buffer (usage COPY_SOURCE, in Access::COPY_READ). After the submission
	/// has finished, a later begin_commands, submit_commands(WAIT) or wait_idle calls p_callback
	/// with the bytes, in the order of the read_back calls. p_callback is not called if the
	/// commands are abandoned, or if the device is lost or destroyed before. It must not begin
	/// commands.
	using ReadBackCallback = std::function<void(std::span<const uint8_t>)>;
	virtual void read_back(BufferRID p_buffer, ReadBackCallback p_callback) = 0;
	/// Reads back a layer of a texture in the same way, in tightly packed rows; of a depth texture,
	/// the depth.
	virtual void read_back(TextureRID p_texture, uint32_t p_layer, ReadBackCallback p_callback) = 0;
	/// Returns the spans of the newest finished submission, in recording order.
	virtual const std::vector<GpuSpan> &get_gpu_spans() const = 0;
};

// The backend that is linked into the program defines these functions.

/// Creates the device. If there is no driver or no usable device, an Error names the package to
/// install and why each device is unusable.
std::unique_ptr<RenderingDevice> create_rendering_device(const DeviceOptions &p_options);
/// Lists all devices, usable or not. Never throws: without a driver the list is empty.
std::vector<DeviceInfo> find_rendering_devices();
/// Returns the number of validation messages (warnings and errors, including synchronization) since
/// the program started.
unsigned get_validation_message_count();
/// Returns whether a device of this process hangs and could not be destroyed. Its resources are
/// then leaked, and the program must exit with std::_Exit: a normal exit runs the driver's own
/// cleanup, which would wait for the device.
bool has_device_hung();

/// Owns a handle: frees the resource when it goes out of scope.
template <typename Handle> class Owned {
public:
	Owned() = default;
	Owned(RenderingDevice &p_device, Handle p_handle) : device(&p_device), handle(p_handle) {}
	Owned(Owned &&p_other) noexcept :
			device(p_other.device), handle(std::exchange(p_other.handle, Handle())) {}
	Owned &operator=(Owned &&p_other) noexcept {
		std::swap(device, p_other.device);
		std::swap(handle, p_other.handle);
		return *this;
	}
	~Owned() { reset(); }
	void reset() {
		if (handle) {
			device->free(std::exchange(handle, Handle()));
		}
	}
	Handle get() const { return handle; }
	explicit operator bool() const { return bool(handle); }

private:
	RenderingDevice *device = nullptr;
	Handle handle;
};
using OwnedBuffer = Owned<BufferRID>;
/// Several owners of one buffer: the last one frees it.
class SharedBuffer {
public:
	SharedBuffer() = default;
	SharedBuffer(OwnedBuffer p_buffer) :
			buffer(std::make_shared<const OwnedBuffer>(std::move(p_buffer))) {}
	BufferRID get() const { return buffer ? buffer->get() : BufferRID(); }
	explicit operator bool() const { return bool(get()); }

private:
	std::shared_ptr<const OwnedBuffer> buffer;
};
using OwnedTexture = Owned<TextureRID>;
using OwnedSampler = Owned<SamplerRID>;
using OwnedMemory = Owned<MemoryRID>;

} // namespace gnomon
