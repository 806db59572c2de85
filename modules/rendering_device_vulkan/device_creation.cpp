#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

#include <algorithm>

namespace gnomon {

namespace {

/// The feature structures that Gnomon asks for, chained.
struct FeatureChain {
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

	explicit FeatureChain(bool p_has_conditional_rendering) {
		v10.pNext = &v12;
		v12.pNext = &v13;
		v13.pNext = p_has_conditional_rendering ? &conditional : nullptr;
	}
	FeatureChain(const FeatureChain &) = delete;
	FeatureChain &operator=(const FeatureChain &) = delete;
};

/// What the device has, of what Gnomon uses; nothing else is enabled, so that the layers notice
/// when a shader relies on more.
void choose_features(
		const FeatureChain &p_present, const PretendedLimits &p_limits, FeatureChain &r_wanted) {
	const VkPhysicalDeviceFeatures &present = p_present.v10.features;
	VkPhysicalDeviceFeatures &wanted = r_wanted.v10.features;
	wanted.geometryShader = !p_limits.geometry_shader && present.geometryShader;
	wanted.depthClamp = !p_limits.depth_clamp && present.depthClamp;
	wanted.depthBounds = !p_limits.depth_bounds && present.depthBounds;
	wanted.independentBlend = present.independentBlend;
	wanted.fragmentStoresAndAtomics = !p_limits.fragment_stores && present.fragmentStoresAndAtomics;
	wanted.vertexPipelineStoresAndAtomics = present.vertexPipelineStoresAndAtomics;
	wanted.occlusionQueryPrecise = present.occlusionQueryPrecise;
	wanted.shaderStorageImageExtendedFormats = present.shaderStorageImageExtendedFormats;
	wanted.shaderStorageImageReadWithoutFormat = present.shaderStorageImageReadWithoutFormat;
	wanted.shaderStorageImageWriteWithoutFormat = present.shaderStorageImageWriteWithoutFormat;
	wanted.shaderImageGatherExtended = present.shaderImageGatherExtended;
	wanted.shaderInt64 = present.shaderInt64;
	r_wanted.v12.shaderBufferInt64Atomics = p_present.v12.shaderBufferInt64Atomics;
	r_wanted.v12.scalarBlockLayout = p_present.v12.scalarBlockLayout;
	r_wanted.v12.separateDepthStencilLayouts = p_present.v12.separateDepthStencilLayouts;
	r_wanted.v12.timelineSemaphore = VK_TRUE;
	r_wanted.v13.dynamicRendering = VK_TRUE;
	r_wanted.v13.synchronization2 = VK_TRUE;
	r_wanted.v13.maintenance4 = VK_TRUE;
	r_wanted.v13.shaderDemoteToHelperInvocation = p_present.v13.shaderDemoteToHelperInvocation;
	r_wanted.conditional.conditionalRendering = p_present.conditional.conditionalRendering;
}

uint64_t find_timestamp_mask(const PhysicalDevice &p_device) {
	uint32_t count = 0;
	vkGetPhysicalDeviceQueueFamilyProperties(p_device.handle, &count, nullptr);
	std::vector<VkQueueFamilyProperties> families(count);
	vkGetPhysicalDeviceQueueFamilyProperties(p_device.handle, &count, families.data());
	const uint32_t bits = families[p_device.queue_family].timestampValidBits;
	return bits == 0 ? 0 : ~uint64_t(0) >> (64 - bits);
}

} // namespace

std::unique_ptr<RenderingDevice> create_rendering_device(const DeviceOptions &p_options) {
	return create_limited_rendering_device(p_options, {});
}

std::unique_ptr<RenderingDevice> create_limited_rendering_device(
		const DeviceOptions &p_options, const PretendedLimits &p_limits) {
	auto device = std::make_unique<VulkanDevice>();
	device->initialize(p_options, p_limits);
	return device;
}

VulkanDevice::~VulkanDevice() {
	shutdown();
}

void VulkanDevice::initialize(const DeviceOptions &p_options, const PretendedLimits &p_limits) {
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
	const bool has_conditional = !p_limits.conditional_rendering &&
			enable_if_present(VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME);
	const bool has_budget = enable_if_present(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
	if (p_options.needs_surface) {
		enable_if_present(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
	}
	FeatureChain present(has_conditional);
	vkGetPhysicalDeviceFeatures2(physical.handle, &present.v10);
	FeatureChain wanted(has_conditional);
	choose_features(present, p_limits, wanted);

	const VkPhysicalDeviceFeatures &enabled = wanted.v10.features;
	features.geometry_shader = enabled.geometryShader;
	features.aliased_memory = !p_limits.aliased_memory;
	features.depth_clamp = enabled.depthClamp;
	features.depth_bounds = enabled.depthBounds;
	features.conditional_rendering = wanted.conditional.conditionalRendering;
	features.precise_occlusion_query = enabled.occlusionQueryPrecise;
	features.fragment_stores = enabled.fragmentStoresAndAtomics;
	features.storage_texel_buffers = !p_limits.storage_texel_buffers;
	features.timestamps = timestamp_mask != 0;
	features.timestamp_period_ns = limits.timestampPeriod;
	features.max_storage_buffer_bytes = limits.maxStorageBufferRange;
	features.max_texture_size_px = limits.maxImageDimension2D;
	features.max_texel_buffer_elements = limits.maxTexelBufferElements;
	features.subgroup_size = subgroup.subgroupSize;
	const VkSubgroupFeatureFlags operations = VK_SUBGROUP_FEATURE_BASIC_BIT |
			VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
			VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
	features.subgroup_operations = !p_limits.subgroup_operations &&
			(subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
			(subgroup.supportedOperations & operations) == operations;

	const float priority = 1.0f;
	const VkDeviceQueueCreateInfo queue_info = { .sType =
														 VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
		.queueFamilyIndex = physical.queue_family,
		.queueCount = 1,
		.pQueuePriorities = &priority };
	const VkDeviceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
		.pNext = &wanted.v10,
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
	create_slots();
	load_pipeline_cache();
}

void VulkanDevice::shutdown() {
	if (!device) {
		return; // creation failed before there was one
	}
	GNOMON_ASSERT(!swapchain, "The swapchain must end before its device.");
	if (!has_ended()) {
		log_error("The device is left as it is, since it does not answer.");
		instance->abandon();
		return;
	}
	for (const std::string &name : list_live_resources()) {
		log_error("Leaked ", name, ". Free it before the device ends.");
	}
	save_pipeline_cache();
	for (PendingUpload &upload : pending_uploads) {
		destroy(upload.staging);
	}
	drop_read_backs(0);
	for (DeferredFree &freed : deferred_frees) {
		std::visit([&](auto &r_resource) { destroy(r_resource); }, freed.resource);
	}
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

std::vector<std::string> VulkanDevice::list_live_resources() {
	std::vector<std::string> names;
	buffers.for_each([&](BufferRID, const BufferResource &p_buffer) {
		names.push_back("buffer '" + p_buffer.desc.name + "'");
	});
	textures.for_each([&](TextureRID, const TextureResource &p_texture) {
		if (!p_texture.is_swapchain) {
			names.push_back("texture '" + p_texture.desc.name + "'");
		}
	});
	samplers.for_each([&](SamplerRID, const SamplerResource &p_sampler) {
		names.push_back("sampler '" + p_sampler.desc.name + "'");
	});
	memories.for_each([&](MemoryRID, const MemoryResource &p_memory) {
		names.push_back("memory '" + p_memory.desc.name + "'");
	});
	std::sort(names.begin(), names.end());
	return names;
}

const DeviceInfo &VulkanDevice::get_info() const {
	return physical.info;
}

const DeviceFeatures &VulkanDevice::get_features() const {
	return features;
}

CommandCounts VulkanDevice::get_command_counts() const {
	return command_counts;
}

MemoryUse VulkanDevice::get_memory_use() const {
	return allocator.get_use();
}

} // namespace gnomon
