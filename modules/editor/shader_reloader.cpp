#include "modules/editor/shader_reloader.h"

#include "modules/core/error.h"
#include "modules/core/text.h"

namespace gnomon {

namespace {

const std::chrono::milliseconds LOOK_INTERVAL{ 500 };

} // namespace

bool ShaderReloader::update(EditorContext &r_context, Clock::time_point p_now) {
	if (p_now < next_look) {
		return false;
	}
	next_look = p_now + LOOK_INTERVAL;
	std::map<std::string, std::string> &errors = r_context.shader_errors;
	std::map<std::string, std::vector<uint32_t>> compiled;
	const auto refuse = [&](const std::string &p_shader, const std::string &p_failure) {
		r_context.complain(p_failure);
		errors[p_shader] = p_failure;
	};
	for (ShaderChange &change : watcher.poll()) {
		errors.erase(change.name);
		if (change.failure.empty()) {
			compiled[change.name] = std::move(change.spirv);
		} else {
			refuse(change.name, change.failure);
		}
	}
	if (compiled.empty()) {
		return false;
	}
	try {
		device.replace_shaders(compiled); // all at once: stages must fit each other
	} catch (const Error &error) {
		refuse(compiled.begin()->first, error.what());
		return false;
	}
	r_context.viewport.needs_redraw = true;
	if (errors.empty()) {
		r_context.set_status(compiled.size() == 1
						? text("Shader ", compiled.begin()->first, " was recompiled.")
						: text(compiled.size(), " shaders were recompiled."));
	}
	return true;
}

} // namespace gnomon
