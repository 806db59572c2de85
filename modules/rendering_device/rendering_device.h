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
/// { &DeviceFeatures::geometry_shader, ... }
using FeatureList = std::vector<bool DeviceFeatures::*>;

/// The user's choices for the device.
struct DeviceOptions {
	std::string
			device; // index ("0") or part of a name, any case; empty = discrete > integrated > CPU
	bool validation = false; // validation and synchronization layers
	/// 0 = $GNOMON_MEMORY_BUDGET_MIB, else what the device reports, but at most 90 % of its heap.
	uint64_t memory_budget_bytes = 0;
	/// Timeout without progress, in seconds: a wait in which no submission ends and no pass begins
	/// for this long is an Error. 0 = no timeout. Absent = $GNOMON_DEVICE_TIMEOUT_S, else 60 s (600
	/// s on a CPU device).
	std::optional<double> wait_limit_s;
	bool needs_surface = false;					  // a window will be shown
	std::vector<std::string> instance_extensions; // what the window system needs
	/// Features to treat as absent even if the device has them.
	FeatureList denied_features;
};

/// One device as `gnomon info` lists it.
struct DeviceInfo {
	uint32_t index = 0;
	std::string name;
	std::string driver;		   // name and version
	std::string type;		   // "discrete GPU", "integrated GPU", "CPU", "virtual GPU", "other"
	std::string api_version;   // "1.3.230"
	uint64_t memory_bytes = 0; // of the largest device-local heap
	bool is_usable = false;
	std::string refusal; // why it is unusable: "Vulkan 1.1, 1.3 is needed"
};

/// What the device can do beyond the minimum that Gnomon requires: compute shaders, 128 bytes of
/// push constants, and 32-bit depth that shaders read.
/// Geometry shaders, aliased memory, conditional rendering, depth bounds, storage texel buffers and
/// copies to textures
/// make frames faster; without them the masks are the same.
struct DeviceFeatures {
	/// Geometry shaders, and gl_PrimitiveID in fragment shaders.
	bool geometry_shader = false;
	bool aliased_memory = false; // create_texture_memory, create_placed_texture
	bool depth_clamp = false;
	bool depth_bounds = false;
	bool conditional_rendering = false;
	bool fragment_stores = false;
	bool storage_texel_buffers = false; // buffers that are STORAGE and TEXEL at once
	bool copies_to_textures = false; // copy_buffer_to_texture from GPU memory; from UPLOAD always
	bool timestamps = false;
	uint64_t max_storage_buffer_bytes = 0;
	uint32_t max_texture_size_px = 0;
	uint32_t subgroup_size = 0;
	bool subgroup_operations = false; // vote, arithmetic, ballot and shuffle in compute shaders
};

struct MemoryUse {
	uint64_t used_bytes = 0;	  // by resources
	uint64_t allocated_bytes = 0; // blocks taken from the driver
	uint64_t budget_bytes = 0;
	uint64_t peak_bytes = 0; // highest used_bytes since the device began
};

/// Commands recorded since the device was created; those under a condition count too.
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

/// A device and everything that lives on it. The backend that the program is linked with implements
/// it, and for tests what modules/rendering_device/tests/testing.h has. One thread uses it. Every
/// failure is an Error that names the object, the value, the limit and the next step; after a lost
/// device every call fails with the text of the first report, which names the last pass that had
/// begun. Those are DeviceLost, and so is a device that makes no progress, see
/// DeviceOptions::wait_limit_s.
///
/// Resources are handles. free() may be called while the GPU still uses the resource: it is
/// destroyed when the submission that was recorded last has finished. What is still alive when the
/// device ends is reported by name, once each, as an error in the log.
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

	// Creates resources. Beyond the budget or the device's limits: an Error naming resource, size
	// and limit.
	virtual BufferRID create_buffer(const BufferDesc &p_desc) = 0;
	/// Creates a device-local buffer, filled with the bytes before the next submission's commands.
	virtual BufferRID create_buffer_with_data(
			BufferDesc p_desc, std::span<const uint8_t> p_bytes) = 0;
	virtual TextureRID create_texture(const TextureDesc &p_desc) = 0;
	/// Creates a texture filled with tightly packed texels (layer 0), ready for SAMPLED use.
	virtual TextureRID create_texture_with_data(
			TextureDesc p_desc, std::span<const uint8_t> p_bytes) = 0;
	virtual SamplerRID create_sampler(const SamplerDesc &p_desc) = 0;
	/// Creates the pipeline from the embedded SPIR-V, or returns a cached one with an equal
	/// description. The device owns it.
	virtual PipelineRID get_compute_pipeline(const ComputePipelineDesc &p_desc) = 0;
	virtual PipelineRID get_raster_pipeline(const RasterPipelineDesc &p_desc) = 0;
	/// Replaces the SPIR-V of these entry points and recreates all pipelines that use one of them,
	/// after the GPU is done. Handles stay valid. SPIR-V that the device refuses, or that has
	/// bindings or push constants other than this build's, is an Error that leaves everything
	/// unchanged. Not allowed while commands are being recorded; SPIR-V of another stage is a
	/// programming error.
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
	struct PlacementNeeds {
		uint64_t size_bytes = 0;
		uint64_t alignment_bytes = 1;
	};
	virtual PlacementNeeds compute_placement_needs(const TextureDesc &p_desc) = 0;
	/// Memory that any texture made with a GPU-only usage can be placed in.
	virtual MemoryRID create_texture_memory(const std::string &p_name, uint64_t p_size_bytes) = 0;
	virtual TextureRID create_placed_texture(
			const TextureDesc &p_desc, MemoryRID p_memory, uint64_t p_offset_bytes) = 0;

	// Frames. begin -> record -> submit; at most two submissions are in flight.
	/// Starts recording. Waits when two submissions are in flight; collects deferred frees.
	virtual CommandList &begin_commands() = 0;
	/// Submits what was recorded. WAIT: also waits for the end, so that READBACK memory is valid. A
	/// swapchain image that the recorded barriers brought to Access::PRESENT is presented.
	enum class SubmitMode { QUEUE, WAIT };
	virtual void submit_commands(SubmitMode p_mode) = 0;
	/// Discards what was recorded since begin_commands, for when an Error ends a frame early. An
	/// acquired swapchain image stays acquired. Does nothing if no commands are being recorded.
	virtual void abandon_commands() = 0;
	virtual void wait_idle() = 0;
	/// Copies the buffer, as it is at this command (usage COPY_SOURCE, Access::COPY_READ), and
	/// calls p_callback with its bytes once the submission that is being recorded has ended: in a
	/// later begin_commands, submit_commands(WAIT) or wait_idle, in the order of the calls. Never
	/// when the commands are abandoned, or the device is lost or ends. p_callback may not begin
	/// commands.
	using ReadBackCallback = std::function<void(std::span<const uint8_t>)>;
	virtual void read_back(BufferRID p_buffer, ReadBackCallback p_callback) = 0;
	/// Reads back a texture's layer in the same way: tightly packed rows; for depth textures the
	/// depth.
	virtual void read_back(TextureRID p_texture, uint32_t p_layer, ReadBackCallback p_callback) = 0;
	/// Spans of the newest finished submission, in recording order.
	virtual const std::vector<GpuSpan> &get_gpu_spans() const = 0;
};

// The backend that is linked into the program defines these functions.

/// Creates the device. No driver or no usable device is an Error that names the package to install
/// and the reason for each device.
std::unique_ptr<RenderingDevice> create_rendering_device(const DeviceOptions &p_options);
/// Never throws: without a driver the list is empty.
std::vector<DeviceInfo> find_rendering_devices();
/// Validation messages (warnings and errors, synchronization included) since the program began.
unsigned get_validation_message_count();
/// A device of this process hangs and could not be destroyed. Its resources are leaked, and the
/// program must exit with std::_Exit, because the driver would wait for the device too.
bool has_device_hung();

/// Frees the resource when it goes out of scope.
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
