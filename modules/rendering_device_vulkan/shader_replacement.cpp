#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

namespace gnomon {

namespace {

using Replacements = std::map<std::string, std::vector<uint32_t>>;

bool is_same_kind(const ReflectedBinding &p_left, const ReflectedBinding &p_right) {
	return p_left.kind == p_right.kind && p_left.is_arrayed == p_right.is_arrayed;
}

bool uses_any(const ComputePipelineDesc &p_desc, const Replacements &p_shaders) {
	return p_shaders.contains(p_desc.shader);
}

bool uses_any(const RasterPipelineDesc &p_desc, const Replacements &p_shaders) {
	return p_shaders.contains(p_desc.vertex_shader) || p_shaders.contains(p_desc.geometry_shader) ||
			p_shaders.contains(p_desc.fragment_shader);
}

const ReflectedBinding *find_declared_binding(const ReflectedShader &p_shader, uint32_t p_number) {
	for (const ReflectedBinding &binding : p_shader.bindings) {
		if (binding.binding == p_number) {
			return &binding;
		}
	}
	return nullptr;
}

/// The program binds what the shader declared when the program was built. A new version must
/// declare all of those bindings, of the same kinds, and as many bytes of push constants. It may
/// use only bindings that the built version uses; it may declare more of them, unused.
void check_interface(const std::string &p_name, std::span<const uint32_t> p_words) {
	const ReflectedShader built = reflect_spirv(p_name, find_original_shader(p_name), {});
	const ReflectedShader replacement = reflect_spirv(p_name, p_words, {});
	const auto refuse = [&](const std::string &p_what) {
		fail("Shader \"", p_name, "\" ", p_what,
				"; the running program was built for another interface. Build it and start it "
				"again.");
	};
	for (const ReflectedBinding &binding : replacement.bindings) {
		const ReflectedBinding *built_binding = find_declared_binding(built, binding.binding);
		// A shader may declare one number several times; find_declared_binding returns the first.
		if (!is_same_kind(*find_declared_binding(replacement, binding.binding), binding)) {
			refuse(text("declares binding ", binding.binding, " as two kinds of resource"));
		}
		if ((built_binding != nullptr && !is_same_kind(*built_binding, binding)) ||
				(binding.is_used && (built_binding == nullptr || !built_binding->is_used))) {
			refuse(text("uses binding ", binding.binding, " in another way than before"));
		}
	}
	for (const ReflectedBinding &binding : built.bindings) {
		if (find_declared_binding(replacement, binding.binding) == nullptr) {
			refuse(text("no longer declares binding ", binding.binding));
		}
	}
	if (built.push_constant_bytes != replacement.push_constant_bytes) {
		refuse(text("has ", replacement.push_constant_bytes, " bytes of push constants, before ",
				built.push_constant_bytes));
	}
}

} // namespace

void VulkanDevice::replace_shaders(const Replacements &p_spirv_by_name) {
	fail_if_lost();
	Replacements before;
	for (const auto &[name, words] : p_spirv_by_name) {
		check_interface(name, words);
		const std::span<const uint32_t> current = find_embedded_shader(name);
		before[name].assign(current.begin(), current.end());
	}
	for (const auto &[name, words] : p_spirv_by_name) {
		replace_embedded_shader(name, words);
	}
	std::vector<std::pair<size_t, PipelineResource>> made;
	try {
		for (size_t index = 0; index < pipelines.size(); ++index) {
			std::visit(
					[&](const auto &p_desc) {
						if (uses_any(p_desc, p_spirv_by_name)) {
							made.emplace_back(index, make_pipeline(p_desc));
						}
					},
					pipelines[index].desc);
		}
		wait_idle();
	} catch (...) {
		for (auto &[index, pipeline] : made) {
			destroy(pipeline);
		}
		for (auto &[name, words] : before) {
			replace_embedded_shader(name, std::move(words));
		}
		throw;
	}
	for (auto &[index, pipeline] : made) {
		std::swap(pipelines[index], pipeline);
		set_name(VK_OBJECT_TYPE_PIPELINE, pipelines[index].pipeline, pipelines[index].name);
		destroy(pipeline);
	}
}

} // namespace gnomon
