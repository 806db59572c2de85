// Compiles compute pipelines with the first Vulkan device, as the engine would, and prints what the
// driver reports about each. Needs no GPU: RADV compiles for AMD's GPUs on a null device.
//
//     gnomon_pipelines [--nir FOLDER] < JOBS
//
// JOBS: a line per pipeline, "LABEL FILE.spv [ID=VALUE]...", with the values of specialization
// constants; "subgroup" as a value is the size that the engine requests. The first line of the
// output is the device, each other line a pipeline, as JSON. FOLDER receives LABEL.txt, the
// driver's first representation of the shader (Mesa's NIR).

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/rendering_device/spirv_reflection.h"
#include "modules/rendering_device_vulkan/subgroups.h"
#include "modules/rendering_device_vulkan/vulkan_instance.h"

#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <iostream>

namespace {

using namespace gnomon;

constexpr uint32_t PUSH_CONSTANT_BYTES = 128; // as much as any device has

void check(VkResult p_result, const std::string &p_call) {
	if (p_result < 0) {
		fail(p_call, " failed: ", get_result_name(p_result), ".");
	}
}

struct Device {
	VkPhysicalDevice physical = VK_NULL_HANDLE;
	VkDevice handle = VK_NULL_HANDLE;
	VkPhysicalDeviceProperties properties = {};
	SubgroupSizes subgroup_sizes;
	bool has_uniform_control_flow = false;
};

/// Creates a device with all features, so that any shader of the program can be compiled.
Device create_device(const VulkanInstance &p_instance) {
	const std::vector<VkPhysicalDevice> found =
			list_all<VkPhysicalDevice>(vkEnumeratePhysicalDevices, p_instance.get());
	if (found.empty()) {
		fail("There is no Vulkan device. Set VK_ICD_FILENAMES to the file of a driver.");
	}
	Device device;
	device.physical = found[0];
	vkGetPhysicalDeviceProperties(device.physical, &device.properties);
	device.subgroup_sizes = find_subgroup_sizes(device.physical);
	VkPhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR flow = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_FEATURES_KHR
	};
	VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executables = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR
	};
	VkPhysicalDeviceVulkan13Features v13 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, .pNext = &executables
	};
	VkPhysicalDeviceVulkan12Features v12 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13
	};
	VkPhysicalDeviceFeatures2 features = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
		.pNext = &v12 };
	std::vector<const char *> extensions = { VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME };
	if (!has_device_extension(device.physical, extensions[0])) {
		fail("Device \"", device.properties.deviceName, "\" lacks ", extensions[0],
				". Choose another driver with VK_ICD_FILENAMES.");
	}
	if (has_device_extension(
				device.physical, VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME)) {
		extensions.push_back(VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME);
		executables.pNext = &flow;
	}
	vkGetPhysicalDeviceFeatures2(device.physical, &features);
	device.has_uniform_control_flow = flow.shaderSubgroupUniformControlFlow;
	const float priority = 1.0f;
	const VkDeviceQueueCreateInfo queue = { .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
		.queueCount = 1,
		.pQueuePriorities = &priority };
	features.features.robustBufferAccess = VK_FALSE; // it adds instructions
	const VkDeviceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
		.pNext = &features,
		.queueCreateInfoCount = 1,
		.pQueueCreateInfos = &queue,
		.enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
		.ppEnabledExtensionNames = extensions.data() };
	check(vkCreateDevice(device.physical, &info, nullptr, &device.handle), "vkCreateDevice");
	return device;
}

struct Job {
	std::string label;
	std::string file;
	std::vector<SpecializationConstant> constants;
};

uint32_t parse_number(std::string_view p_text, const std::string &p_line) {
	uint32_t number = 0;
	const auto result = std::from_chars(p_text.begin(), p_text.end(), number);
	if (result.ec != std::errc() || result.ptr != p_text.end()) {
		fail("\"", p_text, "\" in the line \"", p_line,
				"\" is no number. Write LABEL FILE.spv [ID=VALUE]...");
	}
	return number;
}

Job parse_job(const std::string &p_line, uint32_t p_subgroup_size) {
	std::istringstream stream(p_line);
	Job job;
	stream >> job.label >> job.file;
	for (std::string word; stream >> word;) {
		const size_t split = word.find('=');
		const std::string value = split == std::string::npos ? "" : word.substr(split + 1);
		job.constants.push_back({ parse_number(std::string_view(word).substr(0, split), p_line),
				value == "subgroup" ? p_subgroup_size : parse_number(value, p_line) });
	}
	return job;
}

VkPipelineLayout create_layout(const Device &p_device, const ReflectedShader &p_shader) {
	std::vector<VkDescriptorSetLayoutBinding> bindings;
	for (const ReflectedBinding &binding : p_shader.bindings) {
		if (binding.is_used) {
			bindings.push_back({ .binding = binding.binding,
					.descriptorType = static_cast<VkDescriptorType>(binding.kind),
					.descriptorCount = 1,
					.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT });
		}
	}
	const VkDescriptorSetLayoutCreateInfo set_info = {
		.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
		.bindingCount = static_cast<uint32_t>(bindings.size()),
		.pBindings = bindings.data()
	};
	VkDescriptorSetLayout set = VK_NULL_HANDLE;
	check(vkCreateDescriptorSetLayout(p_device.handle, &set_info, nullptr, &set),
			"vkCreateDescriptorSetLayout");
	const VkPushConstantRange range = { VK_SHADER_STAGE_COMPUTE_BIT, 0, PUSH_CONSTANT_BYTES };
	const VkPipelineLayoutCreateInfo info = { .sType =
													  VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
		.setLayoutCount = 1,
		.pSetLayouts = &set,
		.pushConstantRangeCount = 1,
		.pPushConstantRanges = &range };
	VkPipelineLayout layout = VK_NULL_HANDLE;
	check(vkCreatePipelineLayout(p_device.handle, &info, nullptr, &layout),
			"vkCreatePipelineLayout");
	return layout;
}

template <typename Function> Function load(const Device &p_device, const char *p_name) {
	return reinterpret_cast<Function>(vkGetDeviceProcAddr(p_device.handle, p_name));
}

/// Prints a pipeline's size of subgroups and its statistics as a JSON object, and saves its NIR.
void report(const Device &p_device, VkPipeline p_pipeline, const std::string &p_label,
		double p_compile_ms, const std::filesystem::path &p_nir_folder) {
	const auto get_properties = load<PFN_vkGetPipelineExecutablePropertiesKHR>(
			p_device, "vkGetPipelineExecutablePropertiesKHR");
	const auto get_statistics = load<PFN_vkGetPipelineExecutableStatisticsKHR>(
			p_device, "vkGetPipelineExecutableStatisticsKHR");
	const auto get_representations = load<PFN_vkGetPipelineExecutableInternalRepresentationsKHR>(
			p_device, "vkGetPipelineExecutableInternalRepresentationsKHR");
	const VkPipelineInfoKHR pipeline = { .sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR,
		.pipeline = p_pipeline };
	uint32_t count = 1; // a compute pipeline has one executable
	VkPipelineExecutablePropertiesKHR properties = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR
	};
	check(get_properties(p_device.handle, &pipeline, &count, &properties),
			"vkGetPipelineExecutableProperties");
	std::printf("{\"label\": \"%s\", \"compile_ms\": %.0f, \"subgroup_size\": %u", p_label.c_str(),
			p_compile_ms, properties.subgroupSize);
	const VkPipelineExecutableInfoKHR executable = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = p_pipeline
	};
	get_statistics(p_device.handle, &executable, &count, nullptr);
	std::vector<VkPipelineExecutableStatisticKHR> statistics(
			count, { .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR });
	get_statistics(p_device.handle, &executable, &count, statistics.data());
	for (const VkPipelineExecutableStatisticKHR &statistic : statistics) {
		if (statistic.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR) {
			std::printf(", \"%s\": %llu", statistic.name,
					static_cast<unsigned long long>(statistic.value.u64));
		}
	}
	std::printf("}\n");
	get_representations(p_device.handle, &executable, &count, nullptr);
	if (p_nir_folder.empty() || count == 0) {
		return;
	}
	std::vector<VkPipelineExecutableInternalRepresentationKHR> representations(
			count, { .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR });
	get_representations(p_device.handle, &executable, &count, representations.data());
	std::vector<uint8_t> bytes(representations[0].dataSize);
	representations[0].pData = bytes.data();
	count = 1; // the others are not needed
	get_representations(p_device.handle, &executable, &count, representations.data());
	save_file_atomically(p_nir_folder / (p_label + ".txt"), bytes);
}

void compile(const Device &p_device, const Job &p_job, const std::filesystem::path &p_nir_folder) {
	const std::vector<uint8_t> bytes = load_file(p_job.file);
	std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
	std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
	const ReflectedShader shader = reflect_spirv(p_job.file, words, p_job.constants);
	if (p_device.has_uniform_control_flow && shader.uses_subgroups) {
		words = declare_uniform_control_flow(words);
	}
	const VkShaderModuleCreateInfo module_info = {
		.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
		.codeSize = words.size() * sizeof(uint32_t),
		.pCode = words.data()
	};
	VkShaderModule module = VK_NULL_HANDLE;
	check(vkCreateShaderModule(p_device.handle, &module_info, nullptr, &module),
			"vkCreateShaderModule of " + p_job.label);
	std::vector<VkSpecializationMapEntry> entries;
	for (const SpecializationConstant &constant : p_job.constants) {
		entries.push_back({ constant.constant_id,
				static_cast<uint32_t>(entries.size() * sizeof(SpecializationConstant) +
						offsetof(SpecializationConstant, value)),
				sizeof(uint32_t) });
	}
	const VkSpecializationInfo specialization = { static_cast<uint32_t>(entries.size()),
		entries.data(), p_job.constants.size() * sizeof(SpecializationConstant),
		p_job.constants.data() };
	const SubgroupRequest request(p_device.subgroup_sizes);
	VkComputePipelineCreateInfo info = { .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
		.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR |
				VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR,
		.stage = { .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
				.stage = VK_SHADER_STAGE_COMPUTE_BIT,
				.module = module,
				.pName = "main",
				.pSpecializationInfo = &specialization },
		.layout = create_layout(p_device, shader) };
	request.add_to(info.stage, shader);
	VkPipeline pipeline = VK_NULL_HANDLE;
	const std::clock_t start = std::clock(); // of the CPU, which does not depend on other programs
	check(vkCreateComputePipelines(p_device.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
			"vkCreateComputePipelines of " + p_job.label);
	const double compile_ms = 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
	report(p_device, pipeline, p_job.label, compile_ms, p_nir_folder);
	vkDestroyPipeline(p_device.handle, pipeline, nullptr);
	vkDestroyShaderModule(p_device.handle, module, nullptr);
	// Layouts are few and small; they end with the process.
}

void compile_all(const std::filesystem::path &p_nir_folder) {
	const VulkanInstance instance{ DeviceOptions{ .validation = true } };
	const Device device = create_device(instance);
	std::printf("{\"device\": \"%s\", \"driver_version\": \"%u.%u.%u\", \"subgroup_size\": %u, "
				"\"has_uniform_control_flow\": %s}\n",
			device.properties.deviceName, VK_API_VERSION_MAJOR(device.properties.driverVersion),
			VK_API_VERSION_MINOR(device.properties.driverVersion),
			VK_API_VERSION_PATCH(device.properties.driverVersion),
			choose_subgroup_size(device.subgroup_sizes),
			device.has_uniform_control_flow ? "true" : "false");
	for (std::string line; std::getline(std::cin, line);) {
		compile(device, parse_job(line, choose_subgroup_size(device.subgroup_sizes)), p_nir_folder);
	}
	if (get_validation_message_count() > 0) {
		fail(get_validation_message_count(), " messages of the validation layers, see above.");
	}
}

} // namespace

int main(int p_count, char **p_arguments) {
	try {
		const bool has_nir_folder = p_count == 3 && std::string_view(p_arguments[1]) == "--nir";
		if (p_count != 1 && !has_nir_folder) {
			fail("Usage: gnomon_pipelines [--nir FOLDER] < JOBS");
		}
		compile_all(has_nir_folder ? p_arguments[2] : "");
		std::fflush(stdout);
		std::_Exit(0); // the device is not destroyed: its layouts still exist
	} catch (const std::exception &error) {
		std::fprintf(stderr, "ERROR: %s\n", error.what());
		return 1;
	}
}
