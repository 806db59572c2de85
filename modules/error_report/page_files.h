#pragma once

#include <span>
#include <string_view>

namespace gnomon {

/// A file of page/, embedded by the build. Its name is its path below page/.
struct PageFile {
	std::string_view name;
	std::string_view text;
};

/// Ordered by name.
std::span<const PageFile> get_page_files();

} // namespace gnomon
