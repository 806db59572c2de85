#include "modules/core/error.h"
#include "modules/editor/background_reference.h"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>
#include <vector>

using namespace gnomon;

namespace {

/// Controls a ScriptedSource, and records how it was called.
struct Script {
	std::vector<uint32_t> sample_counts;
	std::atomic<bool> blocks = false; // a round waits until this is false or it is cancelled
	std::atomic<bool> was_cancelled = false;
	bool fails = false;
};

class ScriptedSource : public ReferenceSource {
public:
	explicit ScriptedSource(Script &r_script) : script(r_script) {}

	ReferenceResult trace(uint32_t p_sample_count, const std::atomic<bool> &p_is_cancelled,
			const std::function<void(float)> &p_progress) override {
		script.sample_counts.push_back(p_sample_count);
		if (script.fails) {
			fail("No rays today.");
		}
		p_progress(0.5f);
		while (script.blocks && !p_is_cancelled) {
			std::this_thread::sleep_for(std::chrono::milliseconds(1));
		}
		script.was_cancelled = p_is_cancelled.load();
		ReferenceResult result;
		result.visibility = { 1.0f / float(p_sample_count) };
		result.is_complete = !p_is_cancelled;
		return result;
	}

private:
	Script &script;
};

void start(BackgroundReference &r_reference, Script &r_script, uint32_t p_sample_count) {
	r_reference.start([&] { return std::make_unique<ScriptedSource>(r_script); }, p_sample_count);
}

void wait_for_end(const BackgroundReference &p_reference) {
	while (p_reference.is_running()) {
		std::this_thread::sleep_for(std::chrono::milliseconds(1));
	}
}

} // namespace

TEST_CASE("Each round of a reference has four times the rays, up to the requested number") {
	Script script;
	BackgroundReference reference;
	CHECK(!reference.take());
	start(reference, script, 1000);
	wait_for_end(reference);
	CHECK(script.sample_counts == std::vector<uint32_t>{ 16, 64, 256, 1000 });
	const std::optional<ReferenceRound> round = reference.take();
	REQUIRE(round);
	CHECK(round->sample_count == 1000);
	CHECK(round->visibility == std::vector<float>{ 0.001f });
	CHECK(!reference.take()); // only once
}

TEST_CASE("A reference of fewer rays than the first round has takes one round") {
	Script script;
	BackgroundReference reference;
	start(reference, script, 4);
	wait_for_end(reference);
	CHECK(script.sample_counts == std::vector<uint32_t>{ 4 });
}

TEST_CASE("A stopped reference trace ends at once without a result, and can start again") {
	Script script;
	script.blocks = true;
	BackgroundReference reference;
	start(reference, script, 1000);
	while (reference.get_progress() < 0.5f) {
		std::this_thread::sleep_for(std::chrono::milliseconds(1));
	}
	CHECK(reference.is_running());
	reference.stop();
	CHECK(!reference.is_running());
	CHECK(script.was_cancelled);
	CHECK(script.sample_counts.size() == 1);
	CHECK(!reference.take());
	script.blocks = false;
	start(reference, script, 16);
	wait_for_end(reference);
	CHECK(reference.take());
}

TEST_CASE("A failure in the background trace is thrown once, by the next take()") {
	Script script;
	script.fails = true;
	BackgroundReference reference;
	start(reference, script, 64);
	wait_for_end(reference);
	CHECK_THROWS_WITH_AS(reference.take(), "No rays today.", Error);
	CHECK(!reference.take());
}
