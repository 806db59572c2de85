#include "modules/godot_addon/notices.h"

#include "modules/core/log.h"

namespace gnomon {

void Notices::add(
		const std::string &p_kind, const std::string &p_subject, const std::string &p_text) {
	if (logged.contains(p_kind)) {
		return;
	}
	Notice &notice = pending[p_kind];
	if (notice.subjects.empty()) {
		notice.first_subject = p_subject;
		notice.text = p_text;
	}
	notice.subjects.insert(p_subject);
}

void Notices::flush() {
	for (const auto &[kind, notice] : pending) {
		const size_t others = notice.subjects.size() - 1;
		log_warning(notice.first_subject, " ", notice.text,
				others > 0 ? text(" So with ", others, others == 1 ? " other." : " others.") : "");
		logged.insert(kind);
	}
	pending.clear();
}

} // namespace gnomon
