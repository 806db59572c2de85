#include "modules/editor/shader_reloader.h"

#include "modules/core/error.h"
#include "modules/core/text.h"

namespace gnomon {

namespace {

const std::chrono::milliseconds CHECK_INTERVAL{ 500 };

} // namespace

bool ShaderReloader::update(EditorContext &r_context, Clock::time_point p_now) {
	if (p_now < next_check) {
		return false;
	}
	next_check = p_now + CHECK_INTERVAL;
	std::map<std::string, std::string> &errors = r_context.shader_errors;
	std::map<std::string, std::vector<uint32_t>> compiled;
	const auto report_failure = [&](const std::string &p_shader, const std::string &p_failure) {
		r_context.report_error(p_failure);
		errors[p_shader] = p_failure;
	};
	for (ShaderChange &change : watcher.poll()) {
		errors.erase(change.name);
		refused.erase(change.name);
		if (change.failure.empty()) {
			compiled[change.name] = std::move(change.spirv);
		} else {
			report_failure(change.name, change.failure);
		}
	}
	if (compiled.empty()) {
		return false;
	}
	compiled.merge(refused);
	refused.clear();
	try {
		device.replace_shaders(compiled); // all at once: a pipeline's stages must match
	} catch (const Error &error) {
		report_failure(compiled.begin()->first, error.what()); // one entry: none of them is used
		refused = std::move(compiled);
		return false;
	}
	for (const auto &[name, spirv] : compiled) {
		errors.erase(name);
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
