#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

/// Where the text of an entry point is, and the macro that is defined in it.
struct ShaderSource {
	std::string file;  // "tests/answer.comp", also for the variant "tests/answer.storage.comp"
	std::string macro; // "VARIANT_STORAGE" for that one; empty: none
};
ShaderSource find_shader_source(const std::string &p_name);

/// The SPIR-V of an entry point, compiled as at build time. p_name: its path below p_folder, which
/// is also where includes are looked for, with the name of a variant if it is one; the ending names
/// the stage: .vert, .geom, .frag, .comp.
/// What the compiler reports, line by line with file and line number, is the text of an Error; so
/// are a missing file and another ending. Any thread.
std::vector<uint32_t> compile_shader(
		const std::filesystem::path &p_folder, const std::string &p_name);

/// The files that a shader's text includes, by their paths below the folder of shaders.
std::vector<std::string> find_includes(const std::string &p_text);

} // namespace gnomon
