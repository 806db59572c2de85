#pragma once

#include "modules/desktop/window.h"

namespace gnomon {

/// Dear ImGui for one window. One at a time.
class UiContext {
public:
	explicit UiContext(Window &p_window);
	~UiContext();
	UiContext(const UiContext &) = delete;
	UiContext &operator=(const UiContext &) = delete;
	/// Reads the window's events; then widgets can be drawn until ImGui::Render.
	void begin_frame();
};

} // namespace gnomon
