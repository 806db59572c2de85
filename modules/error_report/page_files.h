#pragma once

#include <span>
#include <string_view>

namespace gnomon {

/// A file of a module's folder page/ (HTML, CSS, JavaScript, licences), embedded by the build (see
/// add_page_files in modules/modules_builders.py).
struct PageFile {
	std::string_view name; // path relative to page/
	std::string_view text; // content
};

/// Returns the files of modules/error_report/page, sorted by name.
std::span<const PageFile> get_page_files();

} // namespace gnomon
