#include "modules/shadow_edge_count/count_rounds.h"

#include "modules/core/text.h"

#include <algorithm>

namespace gnomon {

namespace {

// Memory of the states between two rounds: those of 7,168 receivers with 256 points.
constexpr uint64_t MAX_STATE_BYTES = 7168 * sizeof(uint32_t) * EDGE_COUNT_STATE_WORDS(4);
// Rounds that find no unfinished subgroup take a few microseconds each.
constexpr uint64_t MAX_ROUNDS = 24;

} // namespace

CountShape get_count_shape(const RenderingDevice &p_device, uint32_t p_sample_set_count) {
	const DeviceFeatures &features = p_device.get_features();
	const uint32_t lanes = features.runs_on_cpu ? 1 : p_sample_set_count;
	return { std::min<uint32_t>(features.subgroup_size, EDGE_COUNT_MAX_SUBGROUP), lanes,
		p_sample_set_count / lanes };
}

CountRoundLimits choose_round_limits(
		glm::uvec2 p_size_px, uint32_t p_edge_count, const CountShape &p_shape) {
	// An edge needs at most 1.5 iterations, and some more to walk through the tree. Lights with a
	// third of the edges that need rounds have them too, so that a scene in which more and more
	// casters come into view does not suddenly take more memory.
	const uint64_t iterations = uint64_t(p_edge_count) * 2;
	if (3 * iterations <= EDGE_COUNT_MAX_ITERATIONS) {
		return {};
	}
	const glm::uvec2 blocks =
			(p_size_px + (EDGE_COUNT_BLOCK_PX - 1u)) / uint32_t(EDGE_COUNT_BLOCK_PX);
	const uint32_t block_lanes = EDGE_COUNT_BLOCK_PIXELS * p_shape.lanes_per_receiver;
	const uint32_t lanes = blocks.x * blocks.y * block_lanes;
	const uint32_t state_bytes = sizeof(uint32_t) * EDGE_COUNT_STATE_WORDS(p_shape.sets_per_lane);
	const uint32_t slot_lanes = std::min(lanes,
			static_cast<uint32_t>(MAX_STATE_BYTES / state_bytes / block_lanes) * block_lanes);
	const uint64_t rounds =
			(iterations / EDGE_COUNT_MAX_ITERATIONS + 1) * ((lanes + slot_lanes - 1) / slot_lanes);
	return { slot_lanes / p_shape.subgroup_size,
		static_cast<uint32_t>(std::min(rounds, MAX_ROUNDS)) };
}

void CountRounds::bind_queue(std::vector<PassBinding> &r_bindings) const {
	const auto update = PassBuilder::Content::UPDATE;
	r_bindings.push_back(PassBinding::write(COUNT_BINDING_UNFINISHED_COUNTS, counts, update));
	r_bindings.push_back(PassBinding::write(COUNT_BINDING_UNFINISHED_ITEMS, items, update));
	r_bindings.push_back(
			PassBinding::write(COUNT_BINDING_NEXT_DISPATCH, dispatches.front(), update));
}

std::vector<RGBuffer> CountRounds::list_cleared() const {
	std::vector<RGBuffer> cleared = dispatches;
	cleared.push_back(counts);
	return cleared;
}

CountRounds create_rounds_buffers(RenderGraph &r_graph, const shader::CountLightConstants &p_light,
		const CountShape &p_shape) {
	const auto make_words = [&](const std::string &p_name, uint64_t p_count,
									BufferUsage p_usage = BufferUsage::STORAGE) {
		return r_graph.create_buffer({ p_name, p_count * sizeof(uint32_t), p_usage });
	};
	const uint64_t slot_count = p_light.unfinished_slot_count;
	CountRounds rounds;
	rounds.counts = make_words("unfinished counts", EDGE_COUNT_UNFINISHED_COUNTS,
			BufferUsage::STORAGE | BufferUsage::COPY_TARGET);
	// Without rounds nothing is added, but the passes need buffers.
	const uint64_t subgroup_count = uint64_t(p_light.leaf_capacity) * EDGE_COUNT_BLOCK_PIXELS *
			p_shape.lanes_per_receiver / p_shape.subgroup_size;
	rounds.items = make_words("unfinished subgroups", slot_count == 0 ? 1 : subgroup_count);
	for (uint32_t round = 0; round <= p_light.unfinished_round_count; ++round) {
		rounds.dispatches.push_back(make_words(text("dispatch of round ", round), 3,
				BufferUsage::STORAGE | BufferUsage::INDIRECT | BufferUsage::COPY_TARGET));
	}
	if (slot_count > 0) {
		rounds.states = make_words("states of subgroups",
				slot_count * p_shape.subgroup_size * EDGE_COUNT_STATE_WORDS(p_shape.sets_per_lane));
		for (RGBuffer &slots : rounds.slots) {
			slots = make_words("slots of a round", 2 * slot_count);
		}
	}
	return rounds;
}

void add_rounds_pass(RenderGraph &r_graph, const CountRounds &p_rounds, PipelineRID p_pipeline,
		const std::vector<PassBinding> &p_bindings) {
	const auto update = PassBuilder::Content::UPDATE;
	std::vector<ComputeStep> steps;
	for (uint32_t round = 0; round + 1 < p_rounds.dispatches.size(); ++round) {
		std::vector<PassBinding> bindings = p_bindings;
		p_rounds.bind_queue(bindings);
		bindings.back().buffer = p_rounds.dispatches[round + 1];
		bindings.push_back(
				PassBinding::write(COUNT_BINDING_UNFINISHED_STATES, p_rounds.states, update));
		bindings.push_back(
				PassBinding::write(COUNT_BINDING_ROUND, p_rounds.slots[round % 2], update));
		bindings.push_back(PassBinding::write(
				COUNT_BINDING_NEXT_ROUND, p_rounds.slots[(round + 1) % 2], update));
		const shader::CountLeafPush push = { .kind = EDGE_COUNT_LEAVES_UNLISTED, .round = round };
		steps.push_back({ .pipeline = p_pipeline,
				.bindings = std::move(bindings),
				.push = make_push_bytes(push),
				.arguments = p_rounds.dispatches[round] });
	}
	add_compute_steps(r_graph, "resolve unfinished", std::move(steps));
}

} // namespace gnomon
