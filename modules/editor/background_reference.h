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
	float standard_error = 0;	   // see ReferenceAnswer
	uint32_t sample_count = 0;	   // rays per pixel
	double seconds = 0;			   // total over all rounds so far
};

/// Traces a light's reference mask on its own thread, first coarsely, then with four times the rays
/// each round. The thread has a low priority (nice), so that the interface stays responsive.
class BackgroundReference {
public:
	static constexpr uint32_t FIRST_SAMPLE_COUNT = 16;

	BackgroundReference() = default;
	~BackgroundReference() { stop(); }
	BackgroundReference(const BackgroundReference &) = delete;
	BackgroundReference &operator=(const BackgroundReference &) = delete;

	/// Cancels a running trace and starts a new one. p_make is called on the thread.
	void start(std::function<std::unique_ptr<ReferenceSource>()> p_make, uint32_t p_sample_count);
	/// Stops and waits for the thread, at most for the rays of a pixel, or for the ray acceleration
	/// structure of a new request. Results that were not taken are discarded.
	void stop();
	/// Returns the newest round finished since the last call. A failure on the thread is thrown
	/// here, once, as an Error.
	std::optional<ReferenceRound> take();

	bool is_running() const { return is_busy; }
	/// Progress of the running round, 0..1, and its rays per pixel.
	float get_progress() const { return progress; }
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
	std::optional<ReferenceRound> ended_round;
	std::string failure;
};

} // namespace gnomon
