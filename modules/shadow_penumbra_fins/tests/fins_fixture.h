#pragma once

#include "modules/shadow_penumbra_fins/fin_passes.h"
#include "modules/shadow_penumbra_fins/layer_passes.h"
#include "modules/shadows/mesh_store.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <cstring>

namespace gnomon {

/// Runs only the passes of this module and reads back their textures.
struct FinsFixture : MaskFixture {
	using MaskFixture::MaskFixture;

	MeshStore meshes{ *device };
	TransientPool transient_pool{ *device };

	/// What make_inputs needs: a scene and the views of its first light.
	struct Frame {
		std::shared_ptr<const SceneSnapshot> scene;
		SceneSummary summary;
		std::vector<LightView> views;
		std::vector<CasterList> casters;
		PropertyValues properties;
		PropertyValues settings;
	};

	/// Builds the frame's light views. All instances are casters of every view.
	Frame make_frame(const SmallScene &p_scene, uint32_t p_map_size_px, float p_margin_m = 0) {
		Frame frame;
		frame.scene = p_scene.snap();
		frame.summary.update(frame.scene->instances);
		frame.views = build_light_views(
				frame.scene->lights[0], *frame.scene, p_map_size_px, /*p_border_px=*/2, p_margin_m);
		CasterList all;
		for (uint32_t index = 0; index < frame.scene->instances.size(); ++index) {
			all.instances.push_back(index);
		}
		frame.casters.assign(frame.views.size(), all);
		return frame;
	}

	ShadowTechnique::Inputs make_inputs(const Frame &p_frame) {
		// The passes of depth layers and fins read no textures and buffers of the frame.
		return { *device, meshes, *p_frame.scene, p_frame.summary, p_frame.scene->lights[0],
			p_frame.properties, p_frame.settings, p_frame.views, p_frame.casters, glm::uvec2(1), {},
			{}, {}, {}, {}, {},
			/*may_skip=*/false };
	}

	/// Calls p_add(graph, inputs) and runs the graph.
	template <typename Function> void run(const Frame &p_frame, Function p_add) {
		RenderGraph graph(*device, transient_pool);
		const ShadowTechnique::Inputs inputs = make_inputs(p_frame);
		p_add(graph, inputs);
		graph.execute(RenderGraph::Mode::WAIT);
	}

	/// Adds a pass that copies one array layer of the texture to r_bytes when the graph runs.
	static void read_back(RenderGraph &r_graph, RGTexture p_texture, uint32_t p_layer,
			std::vector<uint8_t> &r_bytes) {
		const TextureDesc desc = r_graph.get_desc(p_texture);
		const uint64_t size_bytes =
				uint64_t(desc.size_px.x) * desc.size_px.y * get_texel_size_bytes(desc.format);
		const RGBuffer buffer = r_graph.create_buffer(
				{ "readback", size_bytes, BufferUsage::COPY_TARGET, MemoryKind::READBACK });
		r_graph.add_pass("read back")
				.reads(p_texture, Access::COPY_READ)
				.writes(buffer, Access::COPY_WRITE)
				.execute([=](PassContext &p_context) {
					p_context.commands.copy_texture_to_buffer(
							p_context.get(p_texture), p_context.get(buffer), p_layer);
				});
		copy_to_host(r_graph, buffer, size_bytes, r_bytes);
	}
	static void read_back(RenderGraph &r_graph, RGBuffer p_buffer, uint64_t p_size_bytes,
			std::vector<uint8_t> &r_bytes) {
		const RGBuffer buffer = r_graph.create_buffer(
				{ "readback", p_size_bytes, BufferUsage::COPY_TARGET, MemoryKind::READBACK });
		r_graph.add_pass("read back")
				.reads(p_buffer, Access::COPY_READ)
				.writes(buffer, Access::COPY_WRITE)
				.execute([=](PassContext &p_context) {
					p_context.commands.copy_buffer(
							p_context.get(p_buffer), p_context.get(buffer), p_size_bytes);
				});
		copy_to_host(r_graph, buffer, p_size_bytes, r_bytes);
	}

	template <typename T> static std::vector<T> cast(const std::vector<uint8_t> &p_bytes) {
		std::vector<T> values(p_bytes.size() / sizeof(T));
		std::memcpy(values.data(), p_bytes.data(), p_bytes.size());
		return values;
	}

	/// Returns the depth layers of every view as [view][layer][texel].
	std::vector<std::vector<std::vector<float>>> find_layers(
			const Frame &p_frame, uint32_t p_layer_count, Peeling p_peeling) {
		const uint32_t view_count = static_cast<uint32_t>(p_frame.views.size());
		std::vector<std::vector<std::vector<uint8_t>>> bytes(
				view_count, std::vector<std::vector<uint8_t>>(p_layer_count));
		run(p_frame, [&](RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs) {
			std::vector<RGTexture> layers;
			for (uint32_t layer = 0; layer < p_layer_count; ++layer) {
				layers.push_back(r_graph.create_texture(
						{ "layer", Format::D32_SFLOAT, p_frame.views[0].size_px, view_count,
								TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED |
										TextureUsage::COPY_TARGET | TextureUsage::COPY_SOURCE,
								true }));
			}
			RGBuffer texels;
			for (uint32_t view = 0; view < view_count; ++view) {
				add_layer_passes(r_graph, p_inputs, view, layers, p_peeling, texels);
				for (uint32_t layer = 0; layer < p_layer_count; ++layer) {
					read_back(r_graph, layers[layer], view, bytes[view][layer]);
				}
			}
		});
		std::vector<std::vector<std::vector<float>>> depths(view_count);
		for (uint32_t view = 0; view < view_count; ++view) {
			for (const std::vector<uint8_t> &layer : bytes[view]) {
				depths[view].push_back(cast<float>(layer));
			}
		}
		return depths;
	}

	struct PenumbraMaps {
		std::vector<uint8_t> color; // two 16-bit floats per texel, R and G
		std::vector<float> depth;
	};

	/// Draws the penumbra maps of view 0 and reads them back.
	PenumbraMaps draw_fins(const Frame &p_frame, const FinsSettings &p_settings) {
		PenumbraMaps maps;
		std::vector<uint8_t> depth;
		run(p_frame, [&](RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs) {
			const glm::uvec2 size_px = p_frame.views[0].size_px;
			const TextureUsage usage = TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE;
			const TextureDesc layer_desc = { "layer", Format::D32_SFLOAT, size_px,
				/*layer_count=*/2, usage | TextureUsage::DEPTH_ATTACHMENT, /*is_array=*/true };
			const std::vector<RGTexture> layers = { r_graph.create_texture(layer_desc),
				r_graph.create_texture(layer_desc) };
			RGBuffer texels;
			add_layer_passes(r_graph, p_inputs, 0, layers, Peeling::PASSES, texels);
			const FinTargets targets = { r_graph.create_texture(
												 { "color", Format::RG16_SFLOAT, size_px, 1,
														 usage | TextureUsage::COLOR_ATTACHMENT }),
				r_graph.create_texture({ "penumbra depth", Format::D32_SFLOAT, size_px, 1,
						usage | TextureUsage::DEPTH_ATTACHMENT }),
				layers[0], layers[1] };
			const SilhouetteCasters casters = build_silhouette_casters(
					p_inputs, collect_casters(p_inputs, { 0 }), get_vertices_per_edge(p_settings));
			SilhouetteLists lists;
			if (p_settings.method == FinMethod::COMPUTE) {
				lists = add_silhouette_passes(r_graph, *device, casters);
			}
			add_fin_pass(r_graph, p_inputs, 0, p_settings, casters, lists, targets);
			read_back(r_graph, targets.color, 0, maps.color);
			read_back(r_graph, targets.penumbra_depth, 0, depth);
		});
		maps.depth = cast<float>(depth);
		return maps;
	}

private:
	static void copy_to_host(RenderGraph &r_graph, RGBuffer p_buffer, uint64_t p_size_bytes,
			std::vector<uint8_t> &r_bytes) {
		r_graph.add_pass("keep")
				.reads(p_buffer, Access::HOST_READ)
				.keep()
				.execute_on_host([=, &r_bytes](HostContext &p_context) {
					const uint8_t *mapped = p_context.get_mapped(p_buffer);
					r_bytes.assign(mapped, mapped + p_size_bytes);
				});
	}
};

} // namespace gnomon
