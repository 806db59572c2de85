#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

#include <algorithm>
#include <utility>

namespace gnomon {

namespace {

// Below this, a texel buffer might not hold a large scene's faces, so storage buffers replace them
// (see fetch_inc.glsl). Desktop GPUs have at least this many.
const uint32_t MIN_TEXEL_BUFFER_ELEMENTS = 1u << 26;

// Of a pass, see VulkanDevice::max_part_triangles. lavapipe 22.3 keeps about 400 bytes for each
// textured triangle, up to 36 MB for each of several scenes. 64 copies of a model of 16,000
// triangles took 267 MB without a limit, 185 with 64,000, 161 with 32,000 and 151 with 16,000 (one
// copy: 144), in the same time within 2 %.
const uint64_t MAX_SOFTWARE_PART_TRIANGLES = 32000;

/// Extensions whose features Gnomon enables.
struct OptionalExtensions {
	bool conditional_rendering = false;
	bool uniform_control_flow = false;
};

/// The feature structures that Gnomon enables, chained.
struct FeatureChain {
	VkPhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR uniform_control_flow = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_FEATURES_KHR
	};
	VkPhysicalDeviceConditionalRenderingFeaturesEXT conditional = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CONDITIONAL_RENDERING_FEATURES_EXT
	};
	VkPhysicalDeviceVulkan13Features v13 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES
	};
	VkPhysicalDeviceVulkan12Features v12 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES
	};
	VkPhysicalDeviceFeatures2 v10 = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2 };

	explicit FeatureChain(const OptionalExtensions &p_extensions) {
		v10.pNext = &v12;
		v12.pNext = &v13;
		if (p_extensions.conditional_rendering) {
			append(conditional);
		}
		if (p_extensions.uniform_control_flow) {
			append(uniform_control_flow);
		}
	}
	FeatureChain(const FeatureChain &) = delete;
	FeatureChain &operator=(const FeatureChain &) = delete;

private:
	template <typename Structure> void append(Structure &r_structure) {
		r_structure.pNext = std::exchange(v13.pNext, &r_structure);
	}
};

/// Enables the features of a fixed list that the device has. All others stay disabled, so that the
/// validation layers notice if a shader relies on one. p_features: the device's features without
/// the denied ones.
void choose_features(
		const FeatureChain &p_present, const DeviceFeatures &p_features, FeatureChain &r_enabled) {
	const VkPhysicalDeviceFeatures &present = p_present.v10.features;
	VkPhysicalDeviceFeatures &enabled = r_enabled.v10.features;
	enabled.geometryShader = p_features.geometry_shader;
	enabled.depthClamp = p_features.depth_clamp;
	enabled.depthBounds = p_features.depth_bounds;
	enabled.independentBlend = present.independentBlend;
	enabled.fragmentStoresAndAtomics = p_features.fragment_stores;
	enabled.vertexPipelineStoresAndAtomics = present.vertexPipelineStoresAndAtomics;
	enabled.occlusionQueryPrecise = present.occlusionQueryPrecise;
	enabled.shaderStorageImageExtendedFormats = present.shaderStorageImageExtendedFormats;
	enabled.shaderStorageImageReadWithoutFormat = present.shaderStorageImageReadWithoutFormat;
	enabled.shaderStorageImageWriteWithoutFormat = present.shaderStorageImageWriteWithoutFormat;
	enabled.shaderImageGatherExtended = present.shaderImageGatherExtended;
	enabled.shaderInt64 = present.shaderInt64;
	r_enabled.v12.shaderBufferInt64Atomics = p_present.v12.shaderBufferInt64Atomics;
	r_enabled.v12.scalarBlockLayout = p_present.v12.scalarBlockLayout;
	r_enabled.v12.separateDepthStencilLayouts = p_present.v12.separateDepthStencilLayouts;
	r_enabled.v12.timelineSemaphore = VK_TRUE;
	r_enabled.v13.dynamicRendering = VK_TRUE;
	r_enabled.v13.synchronization2 = VK_TRUE;
	r_enabled.v13.maintenance4 = VK_TRUE;
	r_enabled.v13.subgroupSizeControl = p_present.v13.subgroupSizeControl;
	r_enabled.v13.computeFullSubgroups = p_present.v13.computeFullSubgroups;
	r_enabled.v13.shaderDemoteToHelperInvocation = p_present.v13.shaderDemoteToHelperInvocation;
	r_enabled.conditional.conditionalRendering = p_features.conditional_rendering;
	r_enabled.uniform_control_flow.shaderSubgroupUniformControlFlow =
			p_present.uniform_control_flow.shaderSubgroupUniformControlFlow;
}

uint64_t find_timestamp_mask(const PhysicalDevice &p_device) {
	const auto families = list_all<VkQueueFamilyProperties>(
			vkGetPhysicalDeviceQueueFamilyProperties, p_device.handle);
	const uint32_t bits = families[p_device.queue_family].timestampValidBits;
	return bits == 0 ? 0 : ~uint64_t(0) >> (64 - bits);
}

} // namespace

std::unique_ptr<RenderingDevice> create_rendering_device(const DeviceOptions &p_options) {
	auto device = std::make_unique<VulkanDevice>();
	device->initialize(p_options);
	return device;
}

void VulkanDevice::initialize(const DeviceOptions &p_options) {
	options = p_options;
	instance = std::make_unique<VulkanInstance>(p_options);
	physical = choose_device(
			find_physical_devices(instance->get(), p_options.needs_surface), p_options.device);

	read_environment();
	VkPhysicalDeviceMaintenance4Properties maintenance4 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES
	};
	VkPhysicalDeviceSubgroupProperties subgroup = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, .pNext = &maintenance4
	};
	VkPhysicalDeviceProperties2 properties = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup
	};
	vkGetPhysicalDeviceProperties2(physical.handle, &properties);
	limits = properties.properties.limits;
	max_buffer_bytes = maintenance4.maxBufferSize;
	timestamp_mask = find_timestamp_mask(physical);

	std::vector<const char *> extensions;
	const auto enable_if_present = [&](const char *p_name) {
		const bool is_present = has_device_extension(physical.handle, p_name);
		if (is_present) {
			extensions.push_back(p_name);
		}
		return is_present;
	};
	const OptionalExtensions optional = { .conditional_rendering = enable_if_present(
												  VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME),
		.uniform_control_flow =
				enable_if_present(VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME) };
	const bool has_budget = enable_if_present(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
	if (p_options.needs_surface) {
		enable_if_present(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
	}
	FeatureChain present(optional);
	vkGetPhysicalDeviceFeatures2(physical.handle, &present.v10);
	const VkPhysicalDeviceFeatures &present_v10 = present.v10.features;
	features.geometry_shader = present_v10.geometryShader;
	features.aliased_memory = true;
	features.depth_clamp = present_v10.depthClamp;
	features.depth_bounds = present_v10.depthBounds;
	features.conditional_rendering = present.conditional.conditionalRendering;
	features.fragment_stores = present_v10.fragmentStoresAndAtomics;
	features.storage_and_texel_buffers = limits.maxTexelBufferElements >= MIN_TEXEL_BUFFER_ELEMENTS;
	features.copies_to_textures = true;
	features.timestamps = timestamp_mask != 0;
	features.max_storage_buffer_bytes = limits.maxStorageBufferRange;
	features.max_texture_size_px = limits.maxImageDimension2D;
	subgroup_sizes = find_subgroup_sizes(physical.handle);
	has_uniform_control_flow = present.uniform_control_flow.shaderSubgroupUniformControlFlow;
	features.subgroup_size = choose_subgroup_size(subgroup_sizes);
	const VkSubgroupFeatureFlags operations = VK_SUBGROUP_FEATURE_BASIC_BIT |
			VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
			VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
	features.subgroup_operations = features.subgroup_size >= MIN_SUBGROUP_SIZE &&
			(subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
			(subgroup.supportedOperations & operations) == operations;
	features.runs_on_cpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
	for (bool DeviceFeatures::*const denied : options.denied_features) {
		features.*denied = false;
	}
	FeatureChain enabled(optional);
	choose_features(present, features, enabled);

	const float priority = 1.0f;
	const VkDeviceQueueCreateInfo queue_info = { .sType =
														 VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
		.queueFamilyIndex = physical.queue_family,
		.queueCount = 1,
		.pQueuePriorities = &priority };
	const VkDeviceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
		.pNext = &enabled.v10,
		.queueCreateInfoCount = 1,
		.pQueueCreateInfos = &queue_info,
		.enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
		.ppEnabledExtensionNames = extensions.data() };
	check(vkCreateDevice(physical.handle, &info, nullptr, &device), "vkCreateDevice");
	vkGetDeviceQueue(device, physical.queue_family, 0, &queue);
	if (instance->has_debug_utils()) {
		const auto load = [&](const char *p_name) {
			return vkGetInstanceProcAddr(instance->get(), p_name);
		};
		set_object_name = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
				load("vkSetDebugUtilsObjectNameEXT"));
		begin_label = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
				load("vkCmdBeginDebugUtilsLabelEXT"));
		end_label = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
				load("vkCmdEndDebugUtilsLabelEXT"));
	}
	if (features.conditional_rendering) {
		begin_conditional_rendering = reinterpret_cast<PFN_vkCmdBeginConditionalRenderingEXT>(
				vkGetDeviceProcAddr(device, "vkCmdBeginConditionalRenderingEXT"));
		end_conditional_rendering = reinterpret_cast<PFN_vkCmdEndConditionalRenderingEXT>(
				vkGetDeviceProcAddr(device, "vkCmdEndConditionalRenderingEXT"));
	}
	allocator.initialize(physical.handle, device, has_budget, options.memory_budget_bytes);
	recording.device = this;
	if (physical.info.type == "CPU") {
		max_part_triangles = MAX_SOFTWARE_PART_TRIANGLES;
	}
	create_slots();
	load_pipeline_cache();
}

VulkanDevice::~VulkanDevice() {
	if (!device) {
		return; // creation failed before there was one
	}
	GNOMON_ASSERT(!swapchain, "The swapchain must end before its device.");
	if (!try_wait_idle()) {
		log_error("The device does not respond; it is not destroyed.");
		instance->abandon();
		return;
	}
	for (const LiveResource &resource : find_live_resources()) {
		log_error("Leaked ", resource.name, ". Free it before the device ends.");
	}
	save_pipeline_cache();
	for (PendingUpload &upload : pending_uploads) {
		destroy(upload.staging);
	}
	drop_read_backs(/*p_after_submission_number=*/0);  // all
	destroy_freed(/*p_finished_number=*/~uint64_t(0)); // all
	textures.for_each([&](TextureRID, TextureResource &r_texture) { destroy(r_texture); });
	buffers.for_each([&](BufferRID, BufferResource &r_buffer) { destroy(r_buffer); });
	samplers.for_each([&](SamplerRID, SamplerResource &r_sampler) { destroy(r_sampler); });
	memories.for_each([&](MemoryRID, MemoryResource &r_memory) { destroy(r_memory); });
	for (PipelineResource &pipeline : pipelines) {
		destroy(pipeline);
	}
	vkDestroyPipelineCache(device, pipeline_cache, nullptr);
	destroy_slots();
	allocator.destroy();
	vkDestroyDevice(device, nullptr);
}

} // namespace gnomon
