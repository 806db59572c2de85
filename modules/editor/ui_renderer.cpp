#include "modules/editor/ui_renderer.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include "editor/ui_shared.h"

#include <imgui.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace gnomon {

namespace {

struct UiVertex {
	glm::vec2 position_px;
	glm::vec2 uv;
	glm::vec4 color; // sRGB-encoded, alpha not premultiplied
};

/// One draw call: a scissor rectangle, a texture and a range of the indices.
struct UiDraw {
	glm::uvec2 offset_px = glm::uvec2(0);
	glm::uvec2 size_px = glm::uvec2(0);
	size_t texture = 0; // index in UiRenderer::textures
	uint32_t first_index = 0;
	uint32_t index_count = 0;
};

struct UiGeometry {
	std::vector<UiVertex> vertices;
	std::vector<uint32_t> indices;
	std::vector<UiDraw> draws;
};

void *to_texture_id(size_t p_index) {
	return reinterpret_cast<void *>(p_index + 1);
}

void append_list(const ImDrawList &p_list, glm::vec2 p_size_px, UiGeometry &r_geometry) {
	const uint32_t first_vertex = static_cast<uint32_t>(r_geometry.vertices.size());
	for (const ImDrawVert &vertex : p_list.VtxBuffer) {
		const ImVec4 color = ImGui::ColorConvertU32ToFloat4(vertex.col);
		r_geometry.vertices.push_back({ { vertex.pos.x, vertex.pos.y },
				{ vertex.uv.x, vertex.uv.y }, { color.x, color.y, color.z, color.w } });
	}
	for (const ImDrawCmd &command : p_list.CmdBuffer) {
		GNOMON_ASSERT(command.UserCallback == nullptr, "the editor's windows use no callbacks");
		const glm::vec2 clip_min = glm::clamp(
				glm::vec2(command.ClipRect.x, command.ClipRect.y), glm::vec2(0.0f), p_size_px);
		const glm::vec2 clip_max = glm::clamp(
				glm::vec2(command.ClipRect.z, command.ClipRect.w), glm::vec2(0.0f), p_size_px);
		if (clip_max.x <= clip_min.x || clip_max.y <= clip_min.y) {
			continue;
		}
		r_geometry.draws.push_back({ glm::uvec2(clip_min), glm::uvec2(clip_max - clip_min),
				reinterpret_cast<size_t>(command.TextureId) - 1,
				static_cast<uint32_t>(r_geometry.indices.size()), command.ElemCount });
		for (uint32_t index = 0; index < command.ElemCount; ++index) {
			r_geometry.indices.push_back(first_vertex + command.VtxOffset +
					p_list.IdxBuffer[int(command.IdxOffset + index)]);
		}
	}
}

} // namespace

UiRenderer::UiRenderer(RenderingDevice &p_device) : device(p_device) {
	unsigned char *pixels = nullptr;
	int width = 0;
	int height = 0;
	ImFontAtlas &fonts = *ImGui::GetIO().Fonts;
	fonts.GetTexDataAsRGBA32(&pixels, &width, &height);
	const glm::uvec2 size_px(static_cast<uint32_t>(width), static_cast<uint32_t>(height));
	font = OwnedTexture(device,
			device.create_texture_with_data(
					{ "editor font", Format::RGBA8_UNORM, size_px, /*layer_count=*/1,
							TextureUsage::SAMPLED | TextureUsage::COPY_TARGET },
					std::span(pixels, size_t(4) * size_px.x * size_px.y)));
	fonts.SetTexID(to_texture_id(0));
	sampler = OwnedSampler(
			device, device.create_sampler({ "editor images", Filter::LINEAR, Filter::LINEAR }));
	textures.push_back([this] { return font.get(); });
}

void *UiRenderer::add_texture(GetTexture p_get_texture) {
	textures.push_back(std::move(p_get_texture));
	return to_texture_id(textures.size() - 1);
}

void UiRenderer::add_pass(RenderGraph &r_graph, RGTexture p_target, const ImDrawData &p_data) {
	const glm::vec2 size_px(p_data.DisplaySize.x, p_data.DisplaySize.y);
	UiGeometry geometry;
	for (int list = 0; list < p_data.CmdListsCount; ++list) {
		append_list(*p_data.CmdLists[list], size_px, geometry);
	}
	std::vector<std::optional<RGTexture>> shown;
	for (const GetTexture &get_texture : textures) {
		const TextureRID texture = get_texture();
		shown.push_back(texture ? std::optional(r_graph.import_texture(
										  texture, RenderGraph::ImportedContent::PRESERVED))
								: std::nullopt);
	}
	textures.resize(1);
	std::erase_if(geometry.draws, [&](const UiDraw &p_draw) { return !shown[p_draw.texture]; });
	if (geometry.draws.empty()) {
		return;
	}
	RasterPipelineDesc desc;
	desc.name = "editor";
	desc.vertex_shader = "editor/ui.vert";
	desc.fragment_shader = "editor/ui.frag";
	// Each: location, index of the vertex buffer, format and number of components, offset.
	desc.attributes = { { 0, 0, Format::R32_SFLOAT, 2, offsetof(UiVertex, position_px) },
		{ 1, 0, Format::R32_SFLOAT, 2, offsetof(UiVertex, uv) },
		{ 2, 0, Format::R32_SFLOAT, 4, offsetof(UiVertex, color) } };
	desc.vertex_strides_bytes = { sizeof(UiVertex) };
	desc.color_formats = { Format::RGBA8_UNORM };
	desc.blend = BlendMode::ALPHA;
	desc.has_depth = false;
	desc.writes_depth = false;
	const PipelineRID pipeline = device.get_raster_pipeline(desc);
	const RGBuffer vertices = r_graph.upload("editor vertices", BufferUsage::VERTEX,
			bytes_of(std::span<const UiVertex>(geometry.vertices)));
	const RGBuffer indices = r_graph.upload("editor indices", BufferUsage::INDEX,
			bytes_of(std::span<const uint32_t>(geometry.indices)));
	PassBuilder pass = r_graph.add_pass("editor");
	pass.reads(vertices, Access::VERTEX_READ).reads(indices, Access::VERTEX_READ);
	for (const std::optional<RGTexture> &texture : shown) {
		if (texture) {
			pass.reads(*texture, Access::SHADER_READ_FRAGMENT);
		}
	}
	pass.color(p_target, LoadOp::KEEP)
			.execute([=, sampler_rid = sampler.get(), draws = std::move(geometry.draws)](
							 PassContext &p_context) {
				CommandList &commands = p_context.commands;
				const BufferRID buffers[] = { p_context.get(vertices) };
				commands.bind_pipeline(pipeline);
				commands.push_constants(shader::UiPush{ 2.0f / size_px, glm::vec2(0.0f) });
				commands.bind_vertex_buffers(buffers);
				commands.bind_index_buffer(p_context.get(indices));
				for (const UiDraw &draw : draws) {
					commands.set_scissor(draw.offset_px, draw.size_px);
					commands.bind_resources(
							{ { UI_BINDING_TEXTURE, p_context.get(*shown[draw.texture]) },
									{ UI_BINDING_SAMPLER, sampler_rid } });
					commands.draw_indexed(draw.index_count, draw.first_index);
				}
			});
}

} // namespace gnomon
