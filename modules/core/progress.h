#pragma once

#include <chrono>
#include <string>

namespace gnomon {

/// Shows how far a long job is: a bar on a terminal, a plain line every 10 % elsewhere. On stderr.
/// A job that ends within a second shows nothing, nor does one inside another that is shown.
class Progress {
public:
	explicit Progress(std::string p_what);
	~Progress();
	Progress(const Progress &) = delete;
	Progress &operator=(const Progress &) = delete;

	/// p_fraction in 0..1; smaller values than before are ignored.
	void update(double p_fraction);

private:
	std::string what;
	std::chrono::steady_clock::time_point start;
	bool is_terminal;
	bool is_inner; // another one is alive
	int shown_percent = -1;
};

} // namespace gnomon
