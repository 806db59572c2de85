#pragma once

#include <chrono>
#include <string>

namespace gnomon {

/// Shows the progress of a long job on stderr: a bar on a terminal, a plain line every 10 %
/// elsewhere. A job that ends within a second shows nothing, nor does a job nested in one that is
/// shown.
class Progress {
public:
	explicit Progress(std::string p_what);
	~Progress();
	Progress(const Progress &) = delete;
	Progress &operator=(const Progress &) = delete;

	/// p_fraction is in 0..1; a value smaller than an earlier one is ignored.
	void update(double p_fraction);

private:
	std::string what;
	std::chrono::steady_clock::time_point start;
	bool is_terminal;
	bool is_inner; // another Progress is alive
	int shown_percent = -1;
};

} // namespace gnomon
