#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

/// The source file of an entry point, and the macro that selects its variant.
struct ShaderSource {
	/// "tests/answer.comp", for the entry point of that name and for its variant
	/// "tests/answer.storage.comp".
	std::string file;
	std::string macro; // "VARIANT_STORAGE" for "tests/answer.storage.comp"; empty: no variant
};
/// Returns the source of an entry point. p_name: <path>.<stage> or, for a variant,
/// <path>.<variant>.<stage>.
ShaderSource find_shader_source(const std::string &p_name);

/// Compiles an entry point to SPIR-V with the settings of the build. p_folder: root of the shader
/// sources and of their includes. p_name: name of the entry point relative to p_folder, see
/// find_shader_source; its extension is the stage: .vert, .geom, .frag or .comp. Throws an Error
/// with the compiler's messages (file and line number) if the shader does not compile, and for a
/// missing file or another extension. Thread-safe.
std::vector<uint32_t> compile_shader(
		const std::filesystem::path &p_folder, const std::string &p_name);

/// Returns the paths in the #include "..." lines of a shader source, in order. They are relative to
/// the root of the shader sources. Does not follow them.
std::vector<std::string> find_includes(const std::string &p_text);

} // namespace gnomon
