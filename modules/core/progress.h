#pragma once

#include <chrono>
#include <string>

namespace gnomon {

/// Shows the progress of a long job on stderr while it exists: a bar on a terminal, a plain line
/// every 10 % elsewhere. A job that ends within a second shows nothing. Neither does one that
/// begins while another Progress exists.
class Progress {
public:
	/// p_what: name of the job, printed in front of its progress.
	explicit Progress(std::string p_what);
	~Progress();
	Progress(const Progress &) = delete;
	Progress &operator=(const Progress &) = delete;

	/// p_fraction: completed part of the job, 0..1; a value smaller than an earlier one is ignored.
	void update(double p_fraction);

private:
	std::string what;
	std::chrono::steady_clock::time_point start;
	bool is_terminal;
	bool is_inner;			// another Progress existed when this one began
	int shown_percent = -1; // -1: nothing shown yet
};

} // namespace gnomon
