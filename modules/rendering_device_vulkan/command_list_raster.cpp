#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/access.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

namespace gnomon {

namespace {

VkClearColorValue make_clear_value(Format p_format, glm::vec4 p_value) {
	VkClearColorValue value = {};
	for (int channel = 0; channel < 4; ++channel) {
		if (is_uint_format(p_format)) {
			value.uint32[channel] = static_cast<uint32_t>(p_value[channel]);
		} else {
			value.float32[channel] = p_value[channel];
		}
	}
	return value;
}

std::string describe_formats(
		const std::vector<Format> &p_formats, const std::optional<Format> &p_depth) {
	std::string description;
	for (const Format format : p_formats) {
		description += text(get_format_name(format), " ");
	}
	return description + (p_depth ? text("with ", get_format_name(*p_depth)) : "without depth");
}

} // namespace

void VulkanCommandList::begin_rendering(
		std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) {
	GNOMON_ASSERT(!p_colors.empty() || p_depth,
			"begin_rendering without targets; begin_rendering_without_targets gives the size");
	const TextureRID first = p_colors.empty() ? p_depth->texture : p_colors.front().texture;
	begin_rendering_of_size(device->textures.get(first).desc.size_px, p_colors, p_depth);
}

void VulkanCommandList::begin_rendering_without_targets(glm::uvec2 p_size_px) {
	begin_rendering_of_size(p_size_px, {}, nullptr);
}

void VulkanCommandList::begin_rendering_of_size(
		glm::uvec2 p_size_px, std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) {
	check_recording("begin_rendering");
	GNOMON_ASSERT(!is_rendering, "begin_rendering before end_rendering");
	target_color_formats.clear();
	color_attachments.clear();
	const auto get_target = [&](TextureRID p_texture, TextureUsage p_usage) -> TextureResource & {
		TextureResource &texture = device->textures.get(p_texture);
		GNOMON_ASSERT(texture.desc.size_px == p_size_px, "target '", texture.desc.name, "' is ",
				texture.desc.size_px.x, " x ", texture.desc.size_px.y, " px, the first one ",
				p_size_px.x, " x ", p_size_px.y);
		GNOMON_ASSERT(has_usage(texture.desc.usage, p_usage), "target '", texture.desc.name,
				"' lacks the usage ", describe_usage(p_usage));
		return texture;
	};
	for (const ColorTarget &target : p_colors) {
		TextureResource &texture = get_target(target.texture, TextureUsage::COLOR_ATTACHMENT);
		const VkImageView view = device->get_view(
				texture, ViewUse::ATTACHMENT, target.layer, /*p_is_arrayed=*/false);
		VkRenderingAttachmentInfo &info = color_attachments.emplace_back(
				VkRenderingAttachmentInfo{ .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
						.imageView = view,
						.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
						.loadOp = static_cast<VkAttachmentLoadOp>(target.load),
						.storeOp = VK_ATTACHMENT_STORE_OP_STORE });
		info.clearValue.color = make_clear_value(texture.desc.format, target.clear);
		target_color_formats.push_back(texture.desc.format);
	}
	VkRenderingAttachmentInfo &depth = depth_attachment;
	depth = { .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO };
	target_depth_format.reset();
	is_target_depth_read_only = false;
	if (p_depth) {
		TextureResource &texture = get_target(p_depth->texture, TextureUsage::DEPTH_ATTACHMENT);
		const Format format = texture.desc.format;
		target_depth_format = format;
		const VkImageLayout read_only =
				get_layout_for_format(VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, format);
		is_target_depth_read_only = texture.recorded_layout == read_only;
		GNOMON_ASSERT(!is_target_depth_read_only || p_depth->load == LoadOp::KEEP, "target '",
				texture.desc.name, "' has Access::DEPTH_READ and must be LoadOp::KEEP");
		depth.imageView = device->get_view(
				texture, ViewUse::ATTACHMENT, p_depth->layer, /*p_is_arrayed=*/false);
		depth.imageLayout = is_target_depth_read_only
				? read_only
				: get_layout_for_format(VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, format);
		depth.loadOp = static_cast<VkAttachmentLoadOp>(p_depth->load);
		// Storing counts as a write, even if the depth was only tested against.
		depth.storeOp = is_target_depth_read_only ? VK_ATTACHMENT_STORE_OP_NONE
												  : VK_ATTACHMENT_STORE_OP_STORE;
		depth.clearValue.depthStencil.depth = p_depth->clear;
	}
	const bool has_target_stencil = target_depth_format && has_stencil(*target_depth_format);
	rendering = { .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
		.renderArea = { .extent = { p_size_px.x, p_size_px.y } },
		.layerCount = 1,
		.colorAttachmentCount = static_cast<uint32_t>(color_attachments.size()),
		.pColorAttachments = color_attachments.data(),
		.pDepthAttachment = p_depth ? &depth : nullptr,
		.pStencilAttachment = has_target_stencil ? &depth : nullptr };
	GNOMON_ASSERT(!is_conditional, "begin_rendering between begin_conditional and end_conditional");
	vkCmdBeginRendering(commands, &rendering);
	part_triangle_count = 0;
	is_rendering = true;
	set_viewport(glm::uvec2(0), p_size_px);
	set_depth_bounds(0.0f, 1.0f);
}

void VulkanCommandList::end_rendering() {
	check_recording("end_rendering");
	GNOMON_ASSERT(is_rendering, "end_rendering without begin_rendering");
	GNOMON_ASSERT(!is_conditional, "end_rendering before end_conditional");
	vkCmdEndRendering(commands);
	is_rendering = false;
}

void VulkanCommandList::set_viewport(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) {
	check_recording("set_viewport");
	const glm::vec2 offset(p_offset_px);
	const glm::vec2 size(p_size_px);
	const VkViewport viewport = { offset.x, offset.y, size.x, size.y, 0.0f, 1.0f };
	vkCmdSetViewport(commands, 0, 1, &viewport);
	set_scissor(p_offset_px, p_size_px);
}

void VulkanCommandList::set_scissor(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) {
	check_recording("set_scissor");
	const VkRect2D scissor = { { static_cast<int32_t>(p_offset_px.x),
									   static_cast<int32_t>(p_offset_px.y) },
		{ p_size_px.x, p_size_px.y } };
	vkCmdSetScissor(commands, 0, 1, &scissor);
}

void VulkanCommandList::set_depth_bounds(float p_min, float p_max) {
	check_recording("set_depth_bounds");
	GNOMON_ASSERT(p_min >= 0.0f && p_min <= p_max && p_max <= 1.0f, "depth bounds ", p_min, " to ",
			p_max);
	vkCmdSetDepthBounds(commands, p_min, p_max);
}

void VulkanCommandList::bind_vertex_buffers(std::span<const BufferRID> p_buffers) {
	check_recording("bind_vertex_buffers");
	std::vector<VkBuffer> handles;
	for (const BufferRID buffer : p_buffers) {
		handles.push_back(device->buffers.get(buffer).buffer);
	}
	const std::vector<VkDeviceSize> offsets(handles.size(), 0);
	if (!handles.empty()) {
		vkCmdBindVertexBuffers(
				commands, 0, static_cast<uint32_t>(handles.size()), handles.data(), offsets.data());
	}
	bound_vertex_buffer_count = static_cast<uint32_t>(handles.size());
}

void VulkanCommandList::bind_index_buffer(BufferRID p_buffer) {
	check_recording("bind_index_buffer");
	vkCmdBindIndexBuffer(commands, device->buffers.get(p_buffer).buffer, 0, VK_INDEX_TYPE_UINT32);
	is_index_buffer_bound = true;
}

void VulkanCommandList::check_draw(const char *p_call) const {
	check_bound(p_call);
	GNOMON_ASSERT(is_rendering, p_call, " outside begin_rendering .. end_rendering");
	GNOMON_ASSERT(bound_pipeline->bind_point == VK_PIPELINE_BIND_POINT_GRAPHICS, p_call,
			" with compute pipeline '", bound_pipeline->name, "'");
	GNOMON_ASSERT(bound_pipeline->color_formats == target_color_formats &&
					bound_pipeline->depth_format == target_depth_format,
			"pipeline '", bound_pipeline->name, "' draws into ",
			describe_formats(bound_pipeline->color_formats, bound_pipeline->depth_format),
			", the targets are ", describe_formats(target_color_formats, target_depth_format));
	GNOMON_ASSERT(!is_target_depth_read_only || !bound_pipeline->writes_depth, "pipeline '",
			bound_pipeline->name, "' writes depth, the depth target has Access::DEPTH_READ");
	GNOMON_ASSERT(bound_vertex_buffer_count >= bound_pipeline->vertex_buffer_count, "pipeline '",
			bound_pipeline->name, "' reads ", bound_pipeline->vertex_buffer_count,
			" vertex buffers, ", bound_vertex_buffer_count, " are bound");
}

void VulkanCommandList::begin_part_if_full(uint64_t p_triangle_count) {
	part_triangle_count += p_triangle_count;
	// A condition ends with the part that it began in. A part has at least one draw.
	if (part_triangle_count <= device->max_part_triangles || is_conditional ||
			part_triangle_count == p_triangle_count) {
		return;
	}
	vkCmdEndRendering(commands);
	const VkMemoryBarrier2 barrier = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
		.srcStageMask = VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT,
		.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
		.dstStageMask = VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT,
		.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT };
	const VkDependencyInfo dependency = { .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
		.memoryBarrierCount = 1,
		.pMemoryBarriers = &barrier };
	vkCmdPipelineBarrier2(commands, &dependency);
	for (VkRenderingAttachmentInfo &color : color_attachments) {
		color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
	}
	depth_attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
	vkCmdBeginRendering(commands, &rendering);
	part_triangle_count = p_triangle_count;
	++device->continued_part_count;
}

void VulkanCommandList::draw(uint32_t p_vertex_count, uint32_t p_instance_count) {
	check_draw("draw");
	++device->command_counts.draws;
	begin_part_if_full(uint64_t(p_vertex_count / 3) * p_instance_count);
	vkCmdDraw(commands, p_vertex_count, p_instance_count, 0, 0);
}

void VulkanCommandList::draw_indexed(uint32_t p_index_count, uint32_t p_first_index) {
	check_draw("draw_indexed");
	GNOMON_ASSERT(is_index_buffer_bound, "pipeline '", bound_pipeline->name,
			"': draw_indexed before bind_index_buffer");
	++device->command_counts.draws;
	begin_part_if_full(p_index_count / 3);
	vkCmdDrawIndexed(commands, p_index_count, 1, p_first_index, 0, 0);
}

void VulkanCommandList::draw_instances(
		uint32_t p_index_count, uint32_t p_instance_count, uint32_t p_first_instance) {
	check_draw("draw_instances");
	GNOMON_ASSERT(is_index_buffer_bound, "pipeline '", bound_pipeline->name,
			"': draw_instances before bind_index_buffer");
	const uint64_t triangles = std::max<uint64_t>(p_index_count / 3, 1);
	const auto instances_per_draw = static_cast<uint32_t>(std::clamp<uint64_t>(
			device->max_part_triangles / triangles, 1, std::max(p_instance_count, 1u)));
	for (uint32_t first = 0; first < p_instance_count; first += instances_per_draw) {
		const uint32_t count = std::min(instances_per_draw, p_instance_count - first);
		++device->command_counts.draws;
		begin_part_if_full(triangles * count);
		vkCmdDrawIndexed(commands, p_index_count, count, /*firstIndex=*/0, /*vertexOffset=*/0,
				p_first_instance + first);
	}
}

void VulkanCommandList::draw_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) {
	check_draw("draw_indirect");
	++device->command_counts.draws;
	vkCmdDrawIndirect(commands, device->buffers.get(p_arguments).buffer, p_offset_bytes, 1, 0);
}

void VulkanCommandList::begin_conditional(BufferRID p_predicate, uint64_t p_offset_bytes) {
	check_recording("begin_conditional");
	GNOMON_ASSERT(device->begin_conditional_rendering,
			"begin_conditional on a device without conditional rendering");
	GNOMON_ASSERT(!is_conditional, "begin_conditional before end_conditional");
	const BufferResource &predicate = device->buffers.get(p_predicate);
	GNOMON_ASSERT(has_usage(predicate.desc.usage, BufferUsage::CONDITIONAL), "buffer '",
			predicate.desc.name, "' lacks the usage CONDITIONAL");
	GNOMON_ASSERT(p_offset_bytes % sizeof(uint32_t) == 0 &&
					p_offset_bytes + sizeof(uint32_t) <= predicate.desc.size_bytes,
			"begin_conditional at byte ", p_offset_bytes, " of buffer '", predicate.desc.name, "'");
	const VkConditionalRenderingBeginInfoEXT info = {
		.sType = VK_STRUCTURE_TYPE_CONDITIONAL_RENDERING_BEGIN_INFO_EXT,
		.buffer = predicate.buffer,
		.offset = p_offset_bytes
	};
	device->begin_conditional_rendering(commands, &info);
	is_conditional = true;
}

void VulkanCommandList::end_conditional() {
	check_recording("end_conditional");
	GNOMON_ASSERT(is_conditional, "end_conditional without begin_conditional");
	is_conditional = false;
	device->end_conditional_rendering(commands);
}

void VulkanCommandList::clear_color(TextureRID p_texture, glm::vec4 p_value, uint32_t p_layer) {
	check_copy("clear_color");
	const TextureResource &texture = device->textures.get(p_texture);
	GNOMON_ASSERT(!is_depth_format(texture.desc.format), "clear_color of depth texture '",
			texture.desc.name, "'");
	const VkClearColorValue value = make_clear_value(texture.desc.format, p_value);
	const bool is_one = p_layer != Binding::ALL_LAYERS;
	const VkImageSubresourceRange range = { .aspectMask = VK_IMAGE_ASPECT_COLOR_BIT,
		.levelCount = 1,
		.baseArrayLayer = is_one ? p_layer : 0,
		.layerCount = is_one ? 1 : texture.desc.layer_count };
	vkCmdClearColorImage(
			commands, texture.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
}

} // namespace gnomon
