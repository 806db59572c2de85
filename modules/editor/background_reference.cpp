#include "modules/editor/background_reference.h"

#include "modules/core/error.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>

namespace gnomon {

namespace {

const uint32_t ROUND_SAMPLE_FACTOR = 4; // ratio of the rays of a round to those of the previous one
const int NICENESS = 15;				// 0 is the normal, 19 the lowest priority

} // namespace

void BackgroundReference::start(
		std::function<std::unique_ptr<ReferenceSource>()> p_make, uint32_t p_sample_count) {
	stop();
	is_cancelled = false;
	is_busy = true;
	progress = 0.0f;
	round_sample_count = std::min(FIRST_SAMPLE_COUNT, p_sample_count);
	thread = std::thread([this, make = std::move(p_make), p_sample_count] {
		// On Linux the id 0 is this thread, not the process, and threads that it creates inherit
		// the value. On failure the thread keeps its priority.
		setpriority(PRIO_PROCESS, 0, NICENESS);
		try {
			run(make, p_sample_count);
		} catch (const std::exception &error) {
			const std::lock_guard lock(mutex);
			failure = describe_failure(error);
		}
		is_busy = false;
	});
}

void BackgroundReference::stop() {
	is_cancelled = true;
	if (thread.joinable()) {
		thread.join();
	}
	is_busy = false; // also if the thread could not be created
	const std::lock_guard lock(mutex);
	finished_round.reset();
	failure.clear();
}

std::optional<ReferenceRound> BackgroundReference::take() {
	const std::lock_guard lock(mutex);
	if (!failure.empty()) {
		fail(std::exchange(failure, std::string()));
	}
	return std::exchange(finished_round, std::nullopt);
}

void BackgroundReference::run(
		const std::function<std::unique_ptr<ReferenceSource>()> &p_make, uint32_t p_sample_count) {
	const auto start = std::chrono::steady_clock::now();
	const std::unique_ptr<ReferenceSource> source = p_make();
	uint32_t sample_count = std::min(FIRST_SAMPLE_COUNT, p_sample_count);
	while (!is_cancelled) {
		round_sample_count = sample_count;
		ReferenceResult result = source->trace(
				sample_count, is_cancelled, [&](float p_fraction) { progress = p_fraction; });
		if (!result.is_complete) {
			return;
		}
		{
			const std::lock_guard lock(mutex);
			finished_round = ReferenceRound{ std::move(result.visibility), result.standard_error,
				sample_count,
				std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() };
		}
		if (sample_count >= p_sample_count) {
			return;
		}
		sample_count = std::min(sample_count * ROUND_SAMPLE_FACTOR, p_sample_count);
	}
}

} // namespace gnomon
