#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

/// The SPIR-V of an entry point, compiled as at build time. p_name: its path below p_folder, which
/// is also where includes are looked for; the ending says the stage: .vert, .geom, .frag, .comp.
/// What the compiler says, line by line with file and line number, is the text of an Error; so are
/// a missing file and another ending. Any thread.
std::vector<uint32_t> compile_shader(
		const std::filesystem::path &p_folder, const std::string &p_name);

/// The files that a shader's text includes, by their paths below the folder of shaders.
std::vector<std::string> find_includes(const std::string &p_text);

} // namespace gnomon
