// Checks that the silhouette edges that a geometry shader finds are exactly those of the CPU.

#include "modules/mesh_tools/silhouette.h"
#include "modules/mesh_tools/tests/silhouette_edges.h"
#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/rendering_device/tests/device_fixture.h"
#include "modules/shadows/gpu_topology.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// The push constants of silhouette.geom.
struct SilhouettePush {
	glm::vec4 light_position_node;
	glm::vec4 size_px;
};

struct GeometryShaderFixture : DeviceFixture {
	/// Returns a mask per face: bit i is set if the face owns its edge i and this is a silhouette.
	std::vector<uint32_t> run(const GpuTopology &p_gpu, const glm::vec4 &p_light_position_node) {
		const uint32_t face_count = p_gpu.topology->get_face_count();
		const glm::uvec2 size_px(64, (face_count + 63) / 64);
		const OwnedTexture target(*device,
				device->create_texture({ .name = "found",
						.format = Format::R32_UINT,
						.size_px = size_px,
						.usage = TextureUsage::COLOR_ATTACHMENT | TextureUsage::COPY_SOURCE }));
		RasterPipelineDesc desc;
		desc.name = "silhouette";
		desc.vertex_shader = "tests/silhouette.vert";
		desc.geometry_shader = "tests/silhouette.geom";
		desc.fragment_shader = "tests/silhouette.frag";
		desc.attributes = { { /*location=*/0, /*buffer_index=*/0, Format::R32_SFLOAT,
				/*component_count=*/4, /*offset_bytes=*/0 } };
		desc.vertex_strides_bytes = { sizeof(glm::vec4) };
		desc.topology = Topology::TRIANGLES_WITH_ADJACENCY;
		desc.color_formats = { Format::R32_UINT };
		desc.has_depth = false;
		desc.writes_depth = false;
		const PipelineRID pipeline = device->get_raster_pipeline(desc);
		CommandList &commands = device->begin_commands();
		const Barrier barrier = { .texture = target.get(), .after = Access::COLOR_WRITE };
		commands.barriers({ &barrier, 1 });
		const ColorTarget color = { target.get() };
		commands.begin_rendering({ &color, 1 }, nullptr);
		commands.bind_pipeline(pipeline);
		commands.bind_resources({ { /*binding=*/0, p_gpu.face_flags.get() } });
		commands.push_constants(
				SilhouettePush{ p_light_position_node, glm::vec4(glm::vec2(size_px), 0.0f, 0.0f) });
		const BufferRID positions = p_gpu.positions.get();
		commands.bind_vertex_buffers({ &positions, 1 });
		commands.bind_index_buffer(p_gpu.adjacency_indices.get());
		commands.draw_indexed(p_gpu.adjacency_index_count);
		commands.end_rendering();
		device->submit_commands(RenderingDevice::SubmitMode::WAIT);
		std::vector<uint32_t> found = read_texture<uint32_t>(target.get(), Access::COLOR_WRITE);
		found.resize(face_count);
		return found;
	}
};

/// Builds the same masks from the CPU's list of edges.
std::vector<uint32_t> build_expected(
		const MeshTopology &p_topology, const std::vector<uint32_t> &p_edges) {
	std::vector<uint32_t> found(p_topology.get_face_count(), 0);
	for (uint32_t index : p_edges) {
		const MeshEdge &edge = p_topology.edges[index];
		for (uint32_t corner = 0; corner < 3; ++corner) {
			const uint32_t *corners = &p_topology.triangles[3 * size_t(edge.face0)];
			if (corners[corner] == edge.a && corners[(corner + 1) % 3] == edge.b) {
				found[edge.face0] |= 1u << corner;
			}
		}
	}
	return found;
}

std::vector<std::pair<const char *, Mesh>> make_meshes() {
	using namespace test_meshes;
	return { { "cube", make_cube() }, { "cube with split corners", unweld(make_cube()) },
		{ "sphere", make_sphere(3) }, { "torus", make_torus(40, 20) }, { "quad", make_quad() },
		{ "moebius band", make_moebius(30) },
		{ "two cubes that share an edge", join(make_cube(), make_cube(glm::vec3(2, 2, 0))) },
		{ "soup", make_soup(3, 14, 40) } };
}

} // namespace

TEST_CASE("[GPU][Silhouette] a geometry shader finds the CPU's edges on meshes of every class") {
	GeometryShaderFixture fixture;
	TestRandom random;
	for (const auto &[name, mesh] : make_meshes()) {
		CAPTURE(name);
		const auto shared = make_mesh(name, mesh.positions_node, {}, mesh.indices);
		GpuTopology gpu(shared);
		gpu.upload(*fixture.device,
				TopologyBuffer::POSITIONS | TopologyBuffer::FACE_FLAGS | TopologyBuffer::ADJACENCY);
		for (int repeat = 0; repeat < 12; ++repeat) {
			// Near and far point lights, a directional one, and two in planes of the cube's faces.
			glm::vec4 light(glm::vec3(random.next_unit() * random.next(0.2, 20.0)), 1.0f);
			light = repeat == 9	   ? glm::vec4(1, 1, 1, 0)
					: repeat == 10 ? glm::vec4(0, 1, 0, 0)
					: repeat == 11 ? glm::vec4(3, 1, 0, 1)
								   : light;
			const std::vector<uint32_t> edges = find_silhouette_edges(*gpu.topology, light);
			CHECK(fixture.run(gpu, light) == build_expected(*gpu.topology, edges));
		}
	}
}

TEST_CASE("[Silhouette] in general position float32 finds the edges that double finds") {
	TestRandom random;
	for (const auto &[name, mesh] : make_meshes()) {
		CAPTURE(name);
		const MeshTopology topology = build_topology(mesh);
		if (topology.counts.zero_area_triangle_count > 0) {
			continue; // rounding may make faces without area light-facing in float32
		}
		for (int repeat = 0; repeat < 20; ++repeat) {
			const glm::vec4 light(glm::vec3(random.next_unit() * random.next(4.0, 20.0)),
					repeat % 2 == 0 ? 1.0f : 0.0f);
			std::vector<uint32_t> expected;
			for (const SilhouetteEdge &edge : build_silhouette(topology, light).edges) {
				expected.push_back(edge.edge_index);
			}
			CHECK(find_silhouette_edges(topology, light) == expected);
		}
	}
}
