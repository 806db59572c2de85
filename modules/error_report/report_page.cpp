// Base64: Debian has it in C and C++ only as a small part of large libraries (OpenSSL, GLib).
#include "modules/error_report/report_page.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/error_report/page_files.h"
#include "modules/error_report/report_part.h"
#include "modules/masks/mask_png.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <set>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

/// So many that neighbouring colours look the same; odd, so that the middle one is error 0.
const uint32_t HEAT_MAP_COLOR_COUNT = 129;

std::string encode_base64(std::span<const uint8_t> p_bytes) {
	static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	std::string encoded;
	encoded.reserve((p_bytes.size() + 2) / 3 * 4);
	for (size_t first = 0; first < p_bytes.size(); first += 3) {
		const size_t count = std::min<size_t>(3, p_bytes.size() - first);
		uint32_t bits = 0;
		for (size_t index = 0; index < 3; ++index) {
			bits = bits << 8 | (index < count ? p_bytes[first + index] : 0u);
		}
		for (size_t digit = 0; digit < 4; ++digit) {
			encoded += digit <= count ? DIGITS[bits >> (18 - 6 * digit) & 63] : '=';
		}
	}
	return encoded;
}

std::string replace_all(std::string_view p_text, std::string_view p_old, std::string_view p_new) {
	std::string replaced;
	size_t begin = 0;
	for (size_t found; (found = p_text.find(p_old, begin)) != std::string_view::npos;
			begin = found + p_old.size()) {
		replaced.append(p_text, begin, found - begin).append(p_new);
	}
	return replaced.append(p_text, begin);
}

void replace_marker(std::string_view p_marker, std::string_view p_text, std::string &r_page) {
	GNOMON_ASSERT(r_page.find(p_marker) != std::string::npos, "the page has no ", p_marker);
	r_page = replace_all(r_page, p_marker, p_text);
}

std::string escape_html(const std::string &p_text) {
	return replace_all(replace_all(replace_all(p_text, "&", "&amp;"), "<", "&lt;"), ">", "&gt;");
}

/// Returns the embedded files of the page and of all report parts, in this order.
std::vector<PageFile> list_page_files() {
	const std::span<const PageFile> own = get_page_files();
	std::vector<PageFile> files(own.begin(), own.end());
	for (const ReportPartInfo &info : ReportPartRegistry::get_all()) {
		const std::span<const PageFile> added = info.part->get_page_files();
		files.insert(files.end(), added.begin(), added.end());
	}
	return files;
}

/// Concatenates the embedded files of a folder that have the extension p_extension.
std::string join_files(std::string_view p_folder, std::string_view p_extension) {
	std::string joined;
	for (const PageFile &file : list_page_files()) {
		const size_t slash = file.name.rfind('/');
		const std::string_view folder =
				slash == std::string_view::npos ? std::string_view() : file.name.substr(0, slash);
		if (folder == p_folder && file.name.ends_with(p_extension)) {
			joined += file.text;
			joined += "\n";
		}
	}
	GNOMON_ASSERT(!joined.empty(), "no page file in ", p_folder, " ends with ", p_extension);
	return joined;
}

std::string join_licenses() {
	std::string joined;
	for (const PageFile &file : list_page_files()) {
		if (file.name.find("LICENSE") != std::string_view::npos) {
			joined += text(file.name, ":\n", file.text, "\n");
		}
	}
	return joined;
}

void add_image(const Json &p_owner, const RecordStore &p_store, Json &r_images) {
	const std::string name = p_owner.is_object() ? p_owner.value("image", "") : "";
	if (name.empty()) {
		return;
	}
	const std::vector<uint8_t> bytes = p_store.load_image(make_path(name).stem().string());
	if (!bytes.empty()) {
		r_images[name] = "data:image/png;base64," + encode_base64(bytes);
	}
}

} // namespace

std::string build_report_page(const Json &p_report, const RecordStore &p_store) {
	Json data = p_report;
	Json images = Json::object();
	std::set<size_t> with_images; // indices of configurations whose cells have images
	for (const Json &cell : p_report.at("cells")) {
		add_image(cell, p_store, images);
		if (!cell.value("image", "").empty()) {
			with_images.insert(cell.at("configuration").get<size_t>());
		}
	}
	const Json &configurations = p_report.at("configurations");
	for (size_t index = 0; index < configurations.size(); ++index) {
		const Json &configuration = configurations[index];
		// Most cells of report parts have no images of techniques; their references are omitted.
		if (configuration.contains("reference_mask") &&
				(configuration.value("group", "") == MATRIX_GROUP ||
						with_images.count(index) != 0)) {
			add_image(configuration.at("reference_mask"), p_store, images);
		}
	}
	for (const Json &scene_image : p_report.at("scene_images")) {
		add_image(scene_image, p_store, images);
	}
	data["images"] = std::move(images);
	Json colors = Json::array();
	for (const glm::u8vec3 &color : compute_heat_map_colors(HEAT_MAP_COLOR_COUNT)) {
		colors.push_back({ color.x, color.y, color.z });
	}
	data["heat_map"] = { { "range", HEAT_MAP_RANGE }, { "colors", std::move(colors) },
		{ "no_receiver", HEAT_MAP_NO_RECEIVER } };

	std::string page = join_files("", ".html");
	// The data is inserted last, because it may contain the text of a marker.
	replace_marker("{{TITLE}}",
			escape_html("Error against run time: " + p_report.value("project", "")), page);
	replace_marker("{{LICENSES}}", join_licenses(), page);
	replace_marker("{{STYLE}}", join_files("", ".css"), page);
	replace_marker("{{LIBRARIES}}", join_files("third_party", ".js"), page);
	replace_marker("{{SCRIPT}}", join_files("", ".js"), page);
	const std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
	replace_marker("{{DATA}}", replace_all(json, "<", "\\u003c"), page); // "<" could end the script
	return page;
}

} // namespace gnomon
