#include "modules/editor/editor_settings.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/limits.h"
#include "modules/core/log.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace gnomon {

namespace {

using Json = nlohmann::ordered_json;

const uint32_t MIN_WINDOW_PX = 320;
const uint32_t MAX_SAMPLE_COUNT = 65536; // the limit of ReferenceSource::trace
const uint32_t MAX_AUTOSAVE_S = 600;

std::filesystem::path get_path() {
	return get_config_folder() / "editor.json";
}

template <typename T> void read(const Json &p_json, const char *p_name, T &r_value) {
	if (const auto found = p_json.find(p_name); found != p_json.end()) {
		r_value = found->get<T>();
	}
}

/// Reads a number. A value outside p_min..p_max is ignored. It is parsed as double, because
/// a number in the file may not fit T.
template <typename T>
void read(const Json &p_json, const char *p_name, T &r_value, T p_min, T p_max) {
	double value = double(r_value);
	read(p_json, p_name, value);
	r_value = value >= double(p_min) && value <= double(p_max) ? T(value) : r_value;
}

EditorSettings read_settings(const Json &p_json) {
	EditorSettings settings;
	EditorLayout &layout = settings.layout;
	for (const auto &[name, fraction] : { std::pair<const char *, float *>("left", &layout.left),
				 { "right", &layout.right }, { "bottom", &layout.bottom } }) {
		read(p_json, name, *fraction, EditorLayout::MIN_FRACTION, EditorLayout::MAX_FRACTION);
	}
	read(p_json, "window_width", settings.window_size_px.x, MIN_WINDOW_PX, MAX_IMAGE_SIZE_PX);
	read(p_json, "window_height", settings.window_size_px.y, MIN_WINDOW_PX, MAX_IMAGE_SIZE_PX);
	read(p_json, "tab", settings.tab);
	for (const char *name :
			{ "truth_rays", "reference_rays" }) { // earlier versions used the first name
		read(p_json, name, settings.sample_count, 1u, MAX_SAMPLE_COUNT);
	}
	read(p_json, "shows_penumbra", settings.shows_penumbra);
	read(p_json, "autosave_s", settings.autosave_s, 1u, MAX_AUTOSAVE_S);
	read(p_json, "recent", settings.recent);
	return settings;
}

} // namespace

EditorSettings EditorSettings::load() {
	std::error_code code;
	if (!std::filesystem::exists(get_path(), code)) {
		return {};
	}
	try {
		return read_settings(Json::parse(load_text_file(get_path())));
	} catch (const std::exception &error) {
		log_warning(
				"The editor's settings in ", get_path().string(), " are not used: ", error.what());
		return {};
	}
}

void EditorSettings::save() const {
	const Json json = { { "left", layout.left }, { "right", layout.right },
		{ "bottom", layout.bottom }, { "window_width", window_size_px.x },
		{ "window_height", window_size_px.y }, { "tab", tab }, { "reference_rays", sample_count },
		{ "shows_penumbra", shows_penumbra }, { "autosave_s", autosave_s }, { "recent", recent } };
	try {
		// Invalid UTF-8, which a path may contain, is replaced.
		const std::string text = json.dump(
				/*indent=*/2, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
		save_file_atomically(get_path(), text + "\n");
	} catch (const Error &error) {
		log_warning("The editor's settings are not saved: ", error.what());
	}
}

std::filesystem::path EditorSettings::find_recent() const {
	for (const std::string &scene : recent) {
		std::error_code code;
		if (std::filesystem::exists(scene, code)) {
			return scene;
		}
	}
	return {};
}

void EditorSettings::add_recent(const std::filesystem::path &p_scene) {
	const std::string scene = std::filesystem::absolute(p_scene).lexically_normal().string();
	std::erase(recent, scene);
	recent.insert(recent.begin(), scene);
	recent.resize(std::min(recent.size(), MAX_RECENT_COUNT));
}

} // namespace gnomon
