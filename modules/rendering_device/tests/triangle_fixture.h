#pragma once

#include "modules/rendering_device/tests/device_fixture.h"

// One triangle, and the targets that it is drawn into.

namespace gnomon {

/// Covers the upper left half of the image, at depth 0.25.
inline const std::vector<float> TRIANGLE = { -1, -1, 0.25f, -1, 1, 0.25f, 1, -1, 0.25f };

struct TriangleTargets {
	OwnedTexture color, depth;
	explicit TriangleTargets(DeviceFixture &r_fixture) {
		color = OwnedTexture(*r_fixture.device,
				r_fixture.device->create_texture({ .name = "color",
						.size_px = glm::uvec2(8),
						.usage = TextureUsage::COLOR_ATTACHMENT | TextureUsage::COPY_SOURCE }));
		depth = OwnedTexture(*r_fixture.device,
				r_fixture.device->create_texture({ .name = "depth",
						.format = Format::D32_SFLOAT,
						.size_px = glm::uvec2(8),
						.usage = TextureUsage::DEPTH_ATTACHMENT | TextureUsage::COPY_SOURCE }));
	}
	std::vector<Barrier> get_barriers() const {
		return { { .texture = color.get(), .after = Access::COLOR_WRITE },
			{ .texture = depth.get(), .after = Access::DEPTH_WRITE } };
	}
};

inline RasterPipelineDesc make_triangle_desc() {
	return { .name = "triangle",
		.vertex_shader = "tests/triangle.vert",
		.fragment_shader = "tests/triangle.frag",
		.attributes = { { .location = 0 } },
		.vertex_strides_bytes = { 3 * sizeof(float) },
		.color_formats = { Format::RGBA8_UNORM } };
}

inline void draw_triangle(CommandList &r_commands, PipelineRID p_pipeline, BufferRID p_vertices) {
	r_commands.bind_pipeline(p_pipeline);
	r_commands.push_constants(glm::vec4(1, 0, 0, 1));
	r_commands.bind_vertex_buffers({ &p_vertices, 1 });
	r_commands.draw(3);
}

} // namespace gnomon
