#pragma once

#include <map>
#include <set>
#include <string>

namespace gnomon {

/// Warnings about nodes and materials of the user's scenes. There is one line for each kind in a
/// run, with the number of nodes that had it when it was first found. Main thread only.
class Notices {
public:
	/// Whether the kind was logged already, so that add() does nothing.
	bool is_logged(const std::string &p_kind) const { return logged.contains(p_kind); }
	/// p_kind: what nodes with this warning have in common. p_subject: the node or material, named.
	/// p_text: the rest of the line, after the subject; that of the kind's first subject is used.
	void add(const std::string &p_kind, const std::string &p_subject, const std::string &p_text);
	/// Logs the kinds that are new since the last call. Call once per frame.
	void flush();

private:
	struct Notice {
		std::string first_subject;
		std::string text;
		std::set<std::string> subjects;
	};
	std::map<std::string, Notice> pending; // by kind
	std::set<std::string> logged;		   // kinds
};

} // namespace gnomon
