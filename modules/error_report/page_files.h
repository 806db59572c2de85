#pragma once

#include <span>
#include <string_view>

namespace gnomon {

/// A file of the folder page/ (HTML, CSS, JavaScript, licences), embedded by the build.
struct PageFile {
	std::string_view name; // path relative to page/
	std::string_view text; // content
};

/// Returns all files, sorted by name.
std::span<const PageFile> get_page_files();

} // namespace gnomon
