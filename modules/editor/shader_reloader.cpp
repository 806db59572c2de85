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
	std::vector<std::string> reloaded;
	std::map<std::string, std::string> &errors = r_context.shader_errors;
	for (ShaderChange &change : watcher.poll()) {
		errors.erase(change.name);
		if (change.failure.empty()) {
			try {
				device.replace_shader(change.name, std::move(change.spirv));
				reloaded.push_back(change.name);
			} catch (const Error &error) {
				change.failure = error.what();
			}
		}
		if (!change.failure.empty()) {
			r_context.complain(change.failure);
			errors[change.name] = change.failure;
		}
	}
	if (reloaded.empty()) {
		return false;
	}
	r_context.viewport.needs_picture = true;
	if (errors.empty()) {
		r_context.say(reloaded.size() == 1
						? text("Shader ", reloaded.front(), " was compiled anew.")
						: text(reloaded.size(), " shaders were compiled anew."));
	}
	return true;
}

} // namespace gnomon
