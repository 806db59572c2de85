// build: alone
// It calls a generated function, which small programs that link other files of core lack.
#include "modules/core/embedded_shaders.h"

#include "modules/core/error.h"

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

namespace {

std::vector<EmbeddedShader> added_shaders;
std::map<std::string, std::vector<uint32_t>, std::less<>> replaced_shaders;

const EmbeddedShader *find_shader(
		std::span<const EmbeddedShader> p_shaders, std::string_view p_name) {
	for (const EmbeddedShader &shader : p_shaders) {
		if (shader.name == p_name) {
			return &shader;
		}
	}
	return nullptr;
}

} // namespace

void add_embedded_shaders(std::span<const EmbeddedShader> p_shaders) {
	added_shaders.insert(added_shaders.end(), p_shaders.begin(), p_shaders.end());
}

void replace_embedded_shader(std::string_view p_name, std::vector<uint32_t> p_spirv) {
	if (p_spirv.empty()) {
		replaced_shaders.erase(std::string(p_name));
	} else {
		replaced_shaders.insert_or_assign(std::string(p_name), std::move(p_spirv));
	}
}

std::span<const uint32_t> find_embedded_shader(std::string_view p_name) {
	const auto replaced = replaced_shaders.find(p_name);
	return replaced != replaced_shaders.end() ? replaced->second : find_original_shader(p_name);
}

std::span<const uint32_t> find_original_shader(std::string_view p_name) {
	const EmbeddedShader *shader = find_shader(get_embedded_shaders(), p_name);
	if (shader == nullptr) {
		shader = find_shader(added_shaders, p_name);
	}
	if (shader != nullptr) {
		return shader->spirv;
	}
	fail("Shader \"", p_name, "\" is not in this build. It must be a file below shaders/, in the ",
			"folder of a module that is built.");
}

} // namespace gnomon
