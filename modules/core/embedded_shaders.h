#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace gnomon {

/// One shader entry point, compiled at build time. Its name is its path under shaders/.
struct EmbeddedShader {
	std::string_view name; // "shadow_map/resolve.comp"
	std::span<const uint32_t> spirv;
};

/// Returns every entry point of the modules in this build, ordered by module and name.
std::span<const EmbeddedShader> get_embedded_shaders();
/// Adds entry points to those of the build, such as the kernels of the test runner. If the build
/// has an entry point of the same name, that one is used. The data must stay valid until the
/// program ends. Call it before any pipeline is created.
void add_embedded_shaders(std::span<const EmbeddedShader> p_shaders);
/// Replaces the SPIR-V of an entry point; an empty vector restores that of the build. Existing
/// pipelines do not change, see RenderingDevice::replace_shaders. Call it from one thread only.
void replace_embedded_shader(std::string_view p_name, std::vector<uint32_t> p_spirv);
/// Returns the SPIR-V that the build embedded for an entry point, even if it has been replaced. An
/// unknown name is an Error.
std::span<const uint32_t> find_original_shader(std::string_view p_name);
/// Returns the SPIR-V to use for an entry point: its replacement, or else what the build embedded.
/// Valid until it is replaced. An unknown name is an Error that names it.
std::span<const uint32_t> find_embedded_shader(std::string_view p_name);

} // namespace gnomon
