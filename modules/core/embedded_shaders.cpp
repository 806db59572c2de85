#include "modules/core/embedded_shaders.h"

#include "modules/core/error.h"

namespace gnomon {

std::span<const uint32_t> find_embedded_shader(std::string_view p_name) {
	for (const EmbeddedShader &shader : get_embedded_shaders()) {
		if (shader.name == p_name) {
			return shader.spirv;
		}
	}
	fail("Shader \"", p_name, "\" is not in this build. It must be a file below shaders/, in the ",
			"folder of a module that is built.");
}

} // namespace gnomon
