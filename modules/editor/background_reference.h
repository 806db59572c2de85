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

/// One refinement round of a reference mask.
struct ReferenceRound {
	std::vector<float> visibility; // 0..1, one per pixel of the question
	float standard_error = 0;	   // see ReferenceAnswer
	uint32_t sample_count = 0;	   // rays a pixel
	double seconds = 0;			   // of all rounds so far
};

/// Traces a light's reference mask on a thread of its own, first coarsely, then with four times the
/// rays each round. The thread gives way to the others (it is nice), so that the interface stays
/// quick.
class BackgroundReference {
public:
	static constexpr uint32_t FIRST_SAMPLE_COUNT = 16;

	BackgroundReference() = default;
	~BackgroundReference() { stop(); }
	BackgroundReference(const BackgroundReference &) = delete;
	BackgroundReference &operator=(const BackgroundReference &) = delete;

	/// Ends what was under way. p_make is called on the thread.
	void start(std::function<std::unique_ptr<ReferenceSource>()> p_make, uint32_t p_sample_count);
	/// Waits for the thread's end: a pixel's rays, or once a question the tree over its casters.
	/// What was not taken is lost.
	void stop();
	/// A round that has ended since the last call, the newest. A failure on the thread is thrown
	/// here, once, as an Error.
	std::optional<ReferenceRound> take();

	bool is_running() const { return is_busy; }
	/// Of the round under way, 0..1, and its rays a pixel.
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
	std::mutex mutex; // of the two below
	std::optional<ReferenceRound> ended_round;
	std::string failure;
};

} // namespace gnomon
