#include "modules/core/progress.h"

#include "modules/core/operating_system.h"

#include <algorithm>
#include <atomic>
#include <cstdio>

namespace gnomon {

namespace {

constexpr double QUIET_SECONDS = 1.0; // before anything is shown
constexpr int BAR_WIDTH = 30;		  // in characters

std::atomic<int> alive_count = 0;

} // namespace

Progress::Progress(std::string p_what) :
		what(std::move(p_what)), start(std::chrono::steady_clock::now()),
		is_terminal(is_error_output_terminal()), is_inner(alive_count++ > 0) {}

Progress::~Progress() {
	--alive_count;
	if (is_terminal && shown_percent >= 0) {
		std::fprintf(stderr, "\r\033[K"); // erases the line
	}
}

void Progress::update(double p_fraction) {
	const double seconds =
			std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	const int step = is_terminal ? 1 : 10; // in percent
	const int percent = static_cast<int>(std::clamp(p_fraction, 0.0, 1.0) * 100) / step * step;
	if (is_inner || seconds < QUIET_SECONDS || percent <= shown_percent) {
		return;
	}
	shown_percent = percent;
	const double left_seconds = p_fraction > 0 ? seconds * (1 - p_fraction) / p_fraction : 0;
	if (is_terminal) {
		const std::string bar(static_cast<size_t>(percent * BAR_WIDTH / 100), '#');
		std::fprintf(stderr, "\r%s [%-*s] %d %%, %.0f s left ", what.c_str(), BAR_WIDTH,
				bar.c_str(), percent, left_seconds);
	} else {
		std::fprintf(stderr, "%s: %d %%, %.0f s left\n", what.c_str(), percent, left_seconds);
	}
	std::fflush(stderr);
}

} // namespace gnomon
