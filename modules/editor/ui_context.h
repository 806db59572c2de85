#pragma once

#include "modules/desktop/window.h"

namespace gnomon {

/// The Dear ImGui context of one window. Only one may exist at a time.
class UiContext {
public:
	explicit UiContext(Window &p_window);
	~UiContext();
	UiContext(const UiContext &) = delete;
	UiContext &operator=(const UiContext &) = delete;
	/// Processes the window's events and begins an ImGui frame, which ImGui::Render ends.
	void begin_frame();
};

} // namespace gnomon
