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

/// Every entry point of the modules in this build, ordered by module and name.
std::span<const EmbeddedShader> get_embedded_shaders();
/// More entry points, found after those of the build and valid until the program ends: the test
/// runner's kernels. Before any pipeline is made.
void add_embedded_shaders(std::span<const EmbeddedShader> p_shaders);
/// Other SPIR-V for an entry point, from now on; empty: that of the build again. Pipelines that are
/// there already do not change: see RenderingDevice::replace_shaders. One thread.
void replace_embedded_shader(std::string_view p_name, std::vector<uint32_t> p_spirv);
/// The SPIR-V that this build has of an entry point, whatever replaces it.
std::span<const uint32_t> find_built_shader(std::string_view p_name);
/// The SPIR-V of one entry point, valid until it is replaced. An unknown name is an Error naming
/// it.
std::span<const uint32_t> find_embedded_shader(std::string_view p_name);

} // namespace gnomon
