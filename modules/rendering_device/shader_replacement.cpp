#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/rendering_device/rendering_device_impl.h"

namespace gnomon {

namespace {

bool uses_shader(const ComputePipelineDesc &p_desc, const std::string &p_shader) {
	return p_desc.shader == p_shader;
}

bool uses_shader(const RasterPipelineDesc &p_desc, const std::string &p_shader) {
	return p_desc.vertex_shader == p_shader || p_desc.geometry_shader == p_shader ||
			p_desc.fragment_shader == p_shader;
}

const ReflectedBinding *find_binding(const PipelineResource &p_pipeline, uint32_t p_number) {
	for (const ReflectedBinding &binding : p_pipeline.bindings) {
		if (binding.binding == p_number) {
			return &binding;
		}
	}
	return nullptr;
}

bool is_same_kind(const ReflectedBinding &p_left, const ReflectedBinding &p_right) {
	return p_left.type == p_right.type && p_left.is_arrayed == p_right.is_arrayed;
}

/// The program gives a pipeline what its shaders declared when the program was built: they may use
/// less of it than they did, and no more.
void check_interface(const std::string &p_shader, const PipelineResource &p_before,
		const PipelineResource &p_now) {
	const auto refuse = [&](const std::string &p_what) {
		fail("Shader \"", p_shader, "\" ", p_what,
				", which the program does not know of. Build the program and start it again.");
	};
	for (const ReflectedBinding &binding : p_now.bindings) {
		const ReflectedBinding *known = find_binding(p_before, binding.binding);
		if (binding.is_used &&
				(known == nullptr || !known->is_used || !is_same_kind(*known, binding))) {
			refuse(text("uses binding ", binding.binding, " in another way than before"));
		}
	}
	for (const ReflectedBinding &binding : p_before.bindings) {
		if (find_binding(p_now, binding.binding) == nullptr) {
			refuse(text("declares binding ", binding.binding, " no more"));
		}
	}
	if (p_before.push_constant_bytes != p_now.push_constant_bytes) {
		refuse(text("has ", p_now.push_constant_bytes, " bytes of push constants, before ",
				p_before.push_constant_bytes));
	}
}

} // namespace

void RenderingDevice::replace_shader(const std::string &p_name, std::vector<uint32_t> p_spirv) {
	impl->fail_if_lost();
	const std::span<const uint32_t> now = find_embedded_shader(p_name);
	std::vector<uint32_t> before(now.begin(), now.end());
	replace_embedded_shader(p_name, std::move(p_spirv));
	std::vector<std::pair<size_t, PipelineResource>> made;
	try {
		for (size_t index = 0; index < impl->pipelines.size(); ++index) {
			std::visit(
					[&](const auto &p_desc) {
						if (uses_shader(p_desc, p_name)) {
							made.emplace_back(index, impl->make_pipeline(p_desc));
							check_interface(p_name, impl->pipelines[index], made.back().second);
						}
					},
					impl->pipelines[index].desc);
		}
		wait_idle();
	} catch (...) {
		for (auto &[index, pipeline] : made) {
			impl->destroy(pipeline);
		}
		replace_embedded_shader(p_name, std::move(before));
		throw;
	}
	for (auto &[index, pipeline] : made) {
		std::swap(impl->pipelines[index], pipeline);
		impl->set_name(VK_OBJECT_TYPE_PIPELINE, impl->pipelines[index].pipeline,
				impl->pipelines[index].name);
		impl->destroy(pipeline);
	}
}

} // namespace gnomon
