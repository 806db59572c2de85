#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

#include <deque>

namespace gnomon {

namespace {

// Sets per descriptor pool; a submission that needs more gets further pools, which are reused
// later.
constexpr uint32_t SETS_PER_POOL = 256;
// The factors are averages per set. A pool that runs out of one kind of descriptor is full.
constexpr VkDescriptorPoolSize POOL_SIZES[] = {
	{ VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2 * SETS_PER_POOL },
	{ VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4 * SETS_PER_POOL },
	{ VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, SETS_PER_POOL },
	{ VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 2 * SETS_PER_POOL },
	{ VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 4 * SETS_PER_POOL },
	{ VK_DESCRIPTOR_TYPE_SAMPLER, SETS_PER_POOL },
	{ VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4 * SETS_PER_POOL },
};

static_assert(uint32_t(ResourceKind::TEXEL_BUFFER) == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER &&
		uint32_t(ResourceKind::STORAGE_BUFFER) == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER &&
		uint32_t(ShaderStage::COMPUTE) == VK_SHADER_STAGE_COMPUTE_BIT);

/// Collects the writes of one descriptor set. The infos are in deques, so that pointers to them
/// stay valid.
struct SetWriter {
	VulkanDevice &device;
	const PipelineResource &pipeline;
	VkDescriptorSet set;
	std::vector<VkWriteDescriptorSet> writes;
	std::deque<VkDescriptorBufferInfo> buffer_infos;
	std::deque<VkDescriptorImageInfo> image_infos;

	void add(const ReflectedBinding &p_reflected, const Binding &p_binding) {
		VkWriteDescriptorSet write = { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
			.dstSet = set,
			.dstBinding = p_reflected.binding,
			.descriptorCount = 1,
			.descriptorType = static_cast<VkDescriptorType>(p_reflected.kind) };
		switch (p_reflected.kind) {
			case ResourceKind::UNIFORM_BUFFER:
				write.pBufferInfo = add_buffer(p_binding, BufferUsage::UNIFORM, "UNIFORM");
				break;
			case ResourceKind::STORAGE_BUFFER:
				write.pBufferInfo = add_buffer(p_binding, BufferUsage::STORAGE, "STORAGE");
				break;
			case ResourceKind::TEXEL_BUFFER:
				write.pTexelBufferView =
						&get_buffer(p_binding, BufferUsage::TEXEL, "TEXEL").texel_view;
				break;
			case ResourceKind::STORAGE_TEXTURE:
				write.pImageInfo = add_image(p_reflected, p_binding, VK_IMAGE_LAYOUT_GENERAL);
				break;
			default:
				write.pImageInfo =
						add_image(p_reflected, p_binding, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
				break;
		}
		writes.push_back(write);
	}

private:
	const BufferResource &get_buffer(
			const Binding &p_binding, BufferUsage p_usage, const char *p_usage_name) {
		GNOMON_ASSERT(p_binding.buffer, "pipeline '", pipeline.name, "': binding ",
				p_binding.binding, " needs a buffer");
		const BufferResource &buffer = device.buffers.get(p_binding.buffer);
		GNOMON_ASSERT(has_usage(buffer.desc.usage, p_usage), "pipeline '", pipeline.name,
				"': buffer '", buffer.desc.name, "' at binding ", p_binding.binding,
				" lacks the usage ", p_usage_name);
		return buffer;
	}

	const VkDescriptorBufferInfo *add_buffer(
			const Binding &p_binding, BufferUsage p_usage, const char *p_usage_name) {
		const BufferResource &buffer = get_buffer(p_binding, p_usage, p_usage_name);
		return &buffer_infos.emplace_back(
				VkDescriptorBufferInfo{ buffer.buffer, 0, VK_WHOLE_SIZE });
	}

	const VkDescriptorImageInfo *add_image(
			const ReflectedBinding &p_reflected, const Binding &p_binding, VkImageLayout p_layout) {
		VkDescriptorImageInfo info = {};
		const bool needs_sampler = p_reflected.kind == ResourceKind::SAMPLER ||
				p_reflected.kind == ResourceKind::TEXTURE_WITH_SAMPLER;
		if (needs_sampler) {
			GNOMON_ASSERT(p_binding.sampler, "pipeline '", pipeline.name, "': binding ",
					p_binding.binding, " needs a sampler");
			info.sampler = device.samplers.get(p_binding.sampler).sampler;
		}
		if (p_reflected.kind != ResourceKind::SAMPLER) {
			GNOMON_ASSERT(p_binding.texture, "pipeline '", pipeline.name, "': binding ",
					p_binding.binding, " needs a texture");
			TextureResource &texture = device.textures.get(p_binding.texture);
			const bool is_storage = p_reflected.kind == ResourceKind::STORAGE_TEXTURE;
			GNOMON_ASSERT(has_usage(texture.desc.usage,
								  is_storage ? TextureUsage::STORAGE : TextureUsage::SAMPLED),
					"pipeline '", pipeline.name, "': texture '", texture.desc.name, "' at binding ",
					p_binding.binding, " lacks the usage ", is_storage ? "STORAGE" : "SAMPLED");
			const bool is_array = texture.desc.is_array && p_binding.layer == Binding::ALL_LAYERS;
			GNOMON_ASSERT(is_array == p_reflected.is_arrayed, "pipeline '", pipeline.name,
					"': texture '", texture.desc.name, "' at binding ", p_binding.binding,
					is_array ? " is an array, but the shader declares none"
							 : " is no array, but the shader declares one");
			info.imageView = device.get_view(
					texture, ViewUse::SHADER, p_binding.layer, p_reflected.is_arrayed);
			info.imageLayout = p_layout;
		}
		return &image_infos.emplace_back(info);
	}
};

const Binding *find_binding(std::span<const Binding> p_bindings, uint32_t p_number) {
	for (const Binding &binding : p_bindings) {
		if (binding.binding == p_number) {
			return &binding;
		}
	}
	return nullptr;
}

void check_no_extra(const PipelineResource &p_pipeline, std::span<const Binding> p_bindings) {
	for (size_t index = 0; index < p_bindings.size(); ++index) {
		const uint32_t number = p_bindings[index].binding;
		bool is_declared = false;
		for (const ReflectedBinding &slot : p_pipeline.bindings) {
			is_declared = is_declared || slot.binding == number;
		}
		GNOMON_ASSERT(is_declared, "pipeline '", p_pipeline.name, "' declares no binding ", number);
		GNOMON_ASSERT(find_binding(p_bindings, number) == &p_bindings[index], "pipeline '",
				p_pipeline.name, "': binding ", number, " is given twice");
	}
}

} // namespace

VkDescriptorSet VulkanDevice::allocate_set(VkDescriptorSetLayout p_layout) {
	SubmissionSlot &slot = get_recording_slot();
	while (true) {
		const bool is_new = slot.descriptor_pool_index == slot.descriptor_pools.size();
		if (is_new) {
			const VkDescriptorPoolCreateInfo info = {
				.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
				.maxSets = SETS_PER_POOL,
				.poolSizeCount = static_cast<uint32_t>(std::size(POOL_SIZES)),
				.pPoolSizes = POOL_SIZES
			};
			VkDescriptorPool pool = VK_NULL_HANDLE;
			check(vkCreateDescriptorPool(device, &info, nullptr, &pool), "vkCreateDescriptorPool");
			set_name(VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool, "resources of a submission");
			slot.descriptor_pools.push_back(pool);
		}
		const VkDescriptorSetAllocateInfo info = {
			.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
			.descriptorPool = slot.descriptor_pools[slot.descriptor_pool_index],
			.descriptorSetCount = 1,
			.pSetLayouts = &p_layout
		};
		VkDescriptorSet set = VK_NULL_HANDLE;
		const VkResult result = vkAllocateDescriptorSets(device, &info, &set);
		const bool is_full =
				result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
		if (!is_full || is_new) {
			check(result, "vkAllocateDescriptorSets");
			return set;
		}
		++slot.descriptor_pool_index;
	}
}

void VulkanCommandList::bind_resources(std::span<const Binding> p_bindings) {
	check_recording("bind_resources");
	GNOMON_ASSERT(bound_pipeline, "bind_resources before bind_pipeline");
	const PipelineResource &pipeline = *bound_pipeline;
	check_no_extra(pipeline, p_bindings);
	are_resources_bound = true;
	if (!pipeline.uses_resources) {
		return;
	}
	SetWriter writer{ *device, pipeline, device->allocate_set(pipeline.set_layout), {}, {}, {} };
	for (const ReflectedBinding &slot : pipeline.bindings) {
		if (slot.is_used) {
			const Binding *binding = find_binding(p_bindings, slot.binding);
			GNOMON_ASSERT(binding, "pipeline '", pipeline.name, "': binding ", slot.binding,
					" is missing");
			writer.add(slot, *binding);
		}
	}
	vkUpdateDescriptorSets(device->device, static_cast<uint32_t>(writer.writes.size()),
			writer.writes.data(), 0, nullptr);
	vkCmdBindDescriptorSets(
			commands, pipeline.bind_point, pipeline.layout, 0, 1, &writer.set, 0, nullptr);
}

} // namespace gnomon
