#pragma once

#include "modules/shadows/reference_source.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace gnomon {

/// The result of one refinement round of a reference mask.
struct ReferenceRound {
	std::vector<float> visibility; // 0..1, one per pixel of the requested image
	float standard_error = 0;	   // of visibility in penumbra pixels; -1: unknown
	uint32_t sample_count = 0;	   // rays per pixel
	double seconds = 0;			   // total over all rounds so far
};

/// Traces a light's reference mask on its own thread, in rounds: each has four times as many rays
/// per pixel as the previous one, but at most the requested number. The thread has a low priority
/// (nice), so that the user interface stays responsive.
class BackgroundReference {
public:
	static constexpr uint32_t FIRST_SAMPLE_COUNT = 16; // rays per pixel of the first round

	BackgroundReference() = default;
	~BackgroundReference() { stop(); }
	BackgroundReference(const BackgroundReference &) = delete;
	BackgroundReference &operator=(const BackgroundReference &) = delete;

	/// Cancels a running trace and starts a new one. p_make creates its source, on the thread.
	/// p_sample_count: rays per pixel of the last round.
	void start(std::function<std::unique_ptr<ReferenceSource>()> p_make, uint32_t p_sample_count);
	/// Cancels the trace and waits for the thread, at most until it has traced one more pixel or
	/// built the ray acceleration structure of a new source. Discards a result that was not taken.
	void stop();
	/// Returns the newest round that finished since the last call, or nothing. A failure on the
	/// thread is thrown here, once, as an Error.
	std::optional<ReferenceRound> take();

	bool is_running() const { return is_busy; }
	/// Returns the progress of the running round, 0..1.
	float get_progress() const { return progress; }
	/// Returns the rays per pixel of the running round.
	uint32_t get_sample_count() const { return round_sample_count; }

private:
	void run(const std::function<std::unique_ptr<ReferenceSource>()> &p_make,
			uint32_t p_sample_count);

	std::thread thread;
	std::atomic<bool> is_cancelled = false;
	std::atomic<bool> is_busy = false;
	std::atomic<float> progress = 0.0f;
	std::atomic<uint32_t> round_sample_count = 0;
	std::mutex mutex; // guards the next two members
	std::optional<ReferenceRound> finished_round;
	std::string failure;
};

} // namespace gnomon
