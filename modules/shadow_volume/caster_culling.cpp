#include "modules/shadow_volume/caster_culling.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/render_graph/fill_pass.h"
#include "modules/rendering_device/work_groups.h"
#include "modules/shadow_volume/culling_boxes.h"
#include "modules/shadow_volume/occluders.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace gnomon {

namespace {

const size_t MIN_CASTER_COUNT = 64;		// with fewer casters, AUTO does not cull
const double MIN_HIDDEN_FRACTION = 0.1; // fraction of casters; below it, AUTO pauses
const uint64_t PAUSE_FRAMES = 60;		// length of the pause
const size_t HEADER_BYTES = CULLING_HEADER_WORDS * sizeof(uint32_t);

/// Size of the buffer of predicates. The number of casters is rounded up to a power of two, so that
/// a few casters more or less do not resize the buffer.
size_t compute_words_bytes(size_t p_caster_count) {
	return HEADER_BYTES + std::bit_ceil(p_caster_count) * sizeof(uint32_t);
}

/// Equal keys mean the same views, and the same casters and transforms in the same order.
uint64_t compute_culling_key(
		const ShadowTechnique::Inputs &p_inputs, const std::vector<uint32_t> &p_instances) {
	uint64_t key = compute_value_hash(uint64_t(p_instances.size()), 1);
	for (const uint32_t index : p_instances) {
		key = p_inputs.scene.instances[index].compute_hash(key);
	}
	for (const CasterList &casters : p_inputs.casters) {
		key = compute_value_hash(casters.content_hash, key);
	}
	return key;
}

shader::CullingConstants make_constants(
		const ShadowTechnique::Inputs &p_inputs, const glm::dvec3 &p_origin_world) {
	shader::CullingConstants constants = {};
	for (size_t i = 0; i < p_inputs.views.size(); ++i) {
		const LightView &view = p_inputs.views[i];
		shader::CullingView &target = constants.views[i];
		target.view_from_relative =
				glm::mat4(view.view_from_world * glm::translate(glm::dmat4(1.0), p_origin_world));
		target.half_extent = view.half_extent;
		target.near_m = view.near_m;
		target.far_m = view.far_m;
		target.is_orthographic = view.is_orthographic ? 1 : 0;
	}
	constants.view_count = static_cast<uint32_t>(p_inputs.views.size());
	return constants;
}

} // namespace

std::vector<uint32_t> CasterCulling::plan(const ShadowTechnique::Inputs &p_inputs, Mode p_mode,
		const std::vector<uint32_t> &p_instances, TechniquePlan &r_plan) {
	++frame;
	tested_instances.reset();
	map = {};
	process_readback();
	if (p_mode == Mode::OFF || !p_inputs.may_skip || p_inputs.views.empty() ||
			p_inputs.views.size() > CULLING_MAX_VIEWS) {
		return p_instances;
	}
	const auto skip = [&](const char *p_reason) {
		r_plan.skip("occlusion culling", p_reason);
		return p_instances;
	};
	if (p_mode == Mode::AUTO && p_instances.size() < MIN_CASTER_COUNT) {
		return skip("few casters");
	}
	const uint64_t last_key = std::exchange(key, compute_culling_key(p_inputs, p_instances));
	const bool has_same_count = p_inputs.may_reuse && last_result &&
			last_result->is_hidden.size() == p_instances.size();
	// The debug view shows the occluders, so they must be drawn in this frame.
	if (!p_inputs.wants_debug_views && has_same_count && last_result->key == key) {
		return cull_hidden(p_instances, r_plan);
	}
	if (p_mode == Mode::AUTO && frame < paused_until_frame) {
		return skip("few casters were hidden in recent frames");
	}
	if (!p_inputs.device.get_features().conditional_rendering && key != last_key) {
		return skip("if the light or a caster moves, this needs conditional rendering, which this "
					"device lacks");
	}
	occluders = choose_occluders(
			p_inputs, p_instances, has_same_count ? last_result->is_hidden : std::vector<bool>());
	if (occluders.empty()) {
		return skip("no caster is large enough to hide another");
	}
	tested_instances = std::make_shared<const std::vector<uint32_t>>(p_instances);
	return p_instances;
}

void CasterCulling::report(TechniquePlan &r_plan) const {
	if (tested_instances) {
		r_plan.run(text("occlusion culling, casters: ", tested_instances->size(),
				", occluders: ", occluders.size()));
	}
}

std::vector<uint32_t> CasterCulling::cull_hidden(
		const std::vector<uint32_t> &p_instances, TechniquePlan &r_plan) const {
	std::vector<uint32_t> seen;
	for (size_t i = 0; i < p_instances.size(); ++i) {
		if (!last_result->is_hidden[i]) {
			seen.push_back(p_instances[i]);
		}
	}
	if (seen.size() < p_instances.size()) {
		r_plan.skip(text("volumes of ", p_instances.size() - seen.size(), " casters"),
				"others hide them from the light");
	}
	return seen;
}

DrawPredicates CasterCulling::add_passes(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs) {
	if (!tested_instances) {
		return {};
	}
	const OccluderMap drawn = add_occluder_passes(r_graph, p_inputs, occluders);
	map = drawn.depth;
	const RGBuffer bounds = drawn.bounds;
	std::vector<Bounds> boxes_world;
	for (const uint32_t index : *tested_instances) {
		boxes_world.push_back(p_inputs.scene.instances[index].bounds_world);
	}
	const glm::dvec3 origin_world(glm::inverse(p_inputs.views[0].view_from_world)[3]);
	const CullingBoxes culling_boxes = build_culling_boxes(boxes_world, origin_world);
	shader::CullingConstants block = make_constants(p_inputs, origin_world);
	block.subtree_count = culling_boxes.subtree_count;
	block.key_low = static_cast<uint32_t>(key);
	block.key_high = static_cast<uint32_t>(key >> 32);
	const RGBuffer constants = r_graph.upload_constants("culling constants", block);
	const RGBuffer boxes = r_graph.upload(
			"culling boxes", BufferUsage::STORAGE, bytes_of(std::span(culling_boxes.boxes)));
	const RGBuffer words =
			r_graph.create_buffer({ "seen casters", compute_words_bytes(tested_instances->size()),
					BufferUsage::STORAGE | BufferUsage::COPY_SOURCE | BufferUsage::CONDITIONAL });
	add_fill_pass(r_graph, p_inputs.device, "all casters are seen", words, 1);
	const PipelineRID pipeline =
			p_inputs.device.get_compute_pipeline({ "cull", "shadow_volume/cull.comp", {} });
	r_graph.add_pass("casters hidden from the light")
			.reads(constants, Access::UNIFORM_READ)
			.reads(bounds, Access::SHADER_READ_COMPUTE)
			.reads(boxes, Access::SHADER_READ_COMPUTE)
			.writes(words, Access::SHADER_WRITE_COMPUTE, PassBuilder::Content::UPDATE)
			.execute([=, count = block.subtree_count](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(pipeline);
				commands.bind_resources({ { CULLING_BINDING_CONSTANTS, p_context.get(constants) },
						{ CULLING_BINDING_BOUNDS, p_context.get(bounds) },
						{ CULLING_BINDING_BOXES, p_context.get(boxes) },
						{ CULLING_BINDING_WORDS, p_context.get(words) } });
				commands.dispatch(arrange_work_groups({ count, 1, 1 }));
			});
	add_readback(r_graph, words);
	return decides_draws(p_inputs) ? DrawPredicates{ words, HEADER_BYTES, tested_instances }
								   : DrawPredicates{};
}

void CasterCulling::get_debug_views(std::vector<ShadowTechnique::DebugView> &r_views) const {
	if (map) {
		r_views.push_back({ "occluders", map });
		r_views.back().is_light_depth = true;
	}
}

void CasterCulling::add_readback(RenderGraph &r_graph, RGBuffer p_words) {
	const auto receive = [latest_readback = latest_readback, key = key,
								 caster_count = tested_instances->size()](
								 std::span<const uint8_t> p_bytes) {
		std::vector<uint32_t> words(CULLING_HEADER_WORDS + caster_count);
		std::memcpy(words.data(), p_bytes.data(), words.size() * sizeof(uint32_t));
		const uint64_t found_key = words[0] | uint64_t(words[1]) << 32;
		if (found_key == key) { // not so if no caster has a valid box: cull.comp did not run
			*latest_readback = { key, { words.begin() + CULLING_HEADER_WORDS, words.end() } };
		}
	};
	r_graph.add_pass("read seen casters")
			.reads(p_words, Access::COPY_READ)
			.keep()
			.execute([=](PassContext &p_context) {
				p_context.get_device().read_back(p_context.get(p_words), receive);
			});
}

void CasterCulling::process_readback() {
	if (!*latest_readback) {
		return;
	}
	const Readback result = *std::exchange(*latest_readback, std::nullopt);
	last_result = { result.key, {} };
	size_t hidden_count = 0;
	for (const uint32_t word : result.words) {
		last_result->is_hidden.push_back(word == 0);
		hidden_count += word == 0 ? 1 : 0;
	}
	if (hidden_count < MIN_HIDDEN_FRACTION * static_cast<double>(result.words.size())) {
		paused_until_frame = frame + PAUSE_FRAMES;
	}
}

} // namespace gnomon
