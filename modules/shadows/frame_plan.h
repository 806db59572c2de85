#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// One line of the plan: a pass that runs, or one that was skipped and why.
struct FramePlanEntry {
	std::string light; // empty: the whole frame
	std::string pass;
	bool runs = true;
	std::string reason; // empty when it runs
};

/// The passes that a frame runs and those that it skips (doc/architecture.md), built before any
/// pass is recorded. Skipping does not change the image, bit for bit (one exception: doc/lean.md).
class FramePlan {
public:
	/// Sets the light of all entries that are added until the next call. Empty: the whole frame.
	void set_light(const std::string &p_name) { light = p_name; }
	/// Adds a pass that runs.
	void run(const std::string &p_pass);
	/// Adds a pass that is skipped. p_reason: why, as shown to the user.
	void skip(const std::string &p_pass, const std::string &p_reason);

	const std::vector<FramePlanEntry> &get_entries() const { return entries; }
	/// True when an entry states that the pass of that light was skipped.
	bool is_skipped(const std::string &p_light, const std::string &p_pass) const;
	/// One line per entry: "Lamp: light view 0: skipped, no casters".
	std::string to_text() const;
	/// [{"light", "pass", "runs", "reason"}, ...]
	std::string to_json() const;

private:
	std::string light;
	std::vector<FramePlanEntry> entries;
};

} // namespace gnomon
