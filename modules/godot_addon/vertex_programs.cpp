#include "modules/godot_addon/vertex_programs.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/godot_addon/variant_numbers.h"

#include <glm/gtc/color_space.hpp>

#include <bit>
#include <cstring>

namespace gnomon {

namespace {

/// Appends the numbers of a uniform, as the program reads them; missing ones are 0.
void add_words(const VertexUniform &p_uniform, std::vector<double> p_numbers,
		std::vector<uint32_t> &r_words) {
	const size_t per_element = p_uniform.count_words();
	p_numbers.resize(per_element * p_uniform.count, 0.0);
	for (size_t index = 0; index < p_numbers.size(); ++index) {
		const double number = p_numbers[index];
		switch (p_uniform.type[0]) {
			case 'i':
			case 'u':
				r_words.push_back(static_cast<uint32_t>(static_cast<int64_t>(number)));
				break;
			case 'b':
				r_words.push_back(number != 0 ? 1 : 0);
				break;
			default: {
				const bool is_srgb = p_uniform.is_color && index % per_element < 3;
				const auto value = static_cast<float>(number);
				r_words.push_back(std::bit_cast<uint32_t>(
						is_srgb ? glm::convertSRGBToLinear(glm::vec3(value)).x : value));
			}
		}
	}
}

void add_floats(const glm::dvec3 &p_values, std::vector<uint32_t> &r_words) {
	for (int axis = 0; axis < 3; ++axis) {
		r_words.push_back(std::bit_cast<uint32_t>(static_cast<float>(p_values[axis])));
	}
}

} // namespace

std::shared_ptr<const VertexFunction> make_vertex_function(
		const ShaderText &p_shader, std::string &r_unknown_reason) {
	auto function = std::make_shared<VertexFunction>();
	function->translation = translate_vertex(p_shader);
	r_unknown_reason = function->translation.unknown_reason;
	if (!r_unknown_reason.empty()) {
		return nullptr;
	}
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	const auto source = godot::Ref<godot::RDShaderSource>::create();
	source.set_language(godot::RenderingDevice::SHADER_LANGUAGE_GLSL);
	source.set_stage_source(
			godot::RenderingDevice::SHADER_STAGE_COMPUTE, function->translation.code);
	const godot::Ref<godot::RDShaderSPIRV> compiled =
			server.get_rendering_device().shader_compile_spirv_from_source(
					source, /*allow_cache=*/true);
	const godot::PackedByteArray bytes = compiled
			? compiled.get_stage_bytecode(godot::RenderingDevice::SHADER_STAGE_COMPUTE)
			: godot::PackedByteArray();
	const std::span<const uint8_t> spirv = bytes.get_values();
	if (spirv.empty()) {
		r_unknown_reason = "moves its vertices in vertex(), which cannot be compiled for shadows";
		return nullptr;
	}
	auto program = std::make_shared<VertexProgram>();
	program->shader = text("vertex_program/", compute_hash(spirv, 1));
	program->spirv.resize(spirv.size() / sizeof(uint32_t));
	std::memcpy(program->spirv.data(), spirv.data(), program->spirv.size() * sizeof(uint32_t));
	function->program = std::move(program);
	return function;
}

VertexValues::~VertexValues() {
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	for (const auto &[hint, texture] : default_textures) {
		server.free_rid(texture);
	}
}

godot::RID VertexValues::get_default_texture(const std::string &p_hint) {
	godot::RID &texture = default_textures[p_hint];
	if (!texture) {
		const bool is_black = p_hint == "hint_default_black";
		const bool is_transparent = p_hint == "hint_default_transparent";
		const uint8_t color = is_black || is_transparent ? 0 : 255;
		const std::vector<uint8_t> texel = { color, color, color,
			uint8_t(is_transparent ? 0 : 255) };
		texture = godot::RenderingServer(godot::find_singleton("RenderingServer"))
						  .texture_2d_create(godot::Image::create_from_data(1, 1,
								  /*use_mipmaps=*/false, godot::Image::FORMAT_RGBA8,
								  godot::PackedByteArray(std::span(texel))));
	}
	return texture;
}

ProgramTexture VertexValues::read_texture(
		const VertexUniform &p_uniform, const godot::ShaderMaterial &p_material) {
	ProgramTexture texture;
	texture.is_nearest = p_uniform.is_nearest;
	texture.repeats = p_uniform.repeats;
	texture.is_srgb = p_uniform.is_color;
	godot::Ref<godot::Texture2D> source =
			godot::Ref<godot::Texture2D>::share(godot::cast<godot::Texture2D>(godot::ObjectHandle(
					p_material.get_shader_parameter(p_uniform.name.c_str()).to_object())));
	if (!source) {
		const godot::Ref<godot::Texture> by_default =
				p_material.get_shader().get_default_texture_parameter(
						p_uniform.name.c_str(), /*index=*/0);
		source = godot::Ref<godot::Texture2D>::share(godot::cast<godot::Texture2D>(by_default));
	}
	if (!source) {
		texture.id = get_default_texture(p_uniform.default_texture).id;
		return texture;
	}
	Watched &watched = textures[godot::get_instance_id(source.get_object())];
	if (!watched.resource) {
		watched.resource = std::make_unique<WatchedResource>(source);
	}
	if (watched.resource->take_change()) {
		++watched.version;
	}
	texture.id = source.get_rid().id;
	// What a viewport draws changes without a signal.
	texture.version = godot::cast<godot::ViewportTexture>(source) ? frame : watched.version;
	return texture;
}

VertexMove VertexValues::read(const std::shared_ptr<const VertexFunction> &p_function,
		const godot::ShaderMaterial &p_material, const VertexSource &p_source) {
	const VertexTranslation &translation = p_function->translation;
	VertexMove move;
	move.program = p_function->program;
	move.bounds = p_source.bounds;
	std::vector<uint32_t> &words = move.values;
	words.push_back(std::bit_cast<uint32_t>(static_cast<float>(p_source.time_s)));
	words.push_back(translation.uses_node ? p_source.instance : 0);
	const glm::mat4 node(translation.uses_node ? p_source.world_from_mesh : glm::dmat4(1.0));
	for (int element = 0; element < 16; ++element) {
		words.push_back(std::bit_cast<uint32_t>(node[element / 4][element % 4]));
	}
	add_floats(p_source.bounds.minimum, words);
	add_floats(p_source.bounds.maximum, words);
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	const godot::RID shader = p_material.get_shader().get_rid();
	for (const VertexUniform &uniform : translation.uniforms) {
		const char *name = uniform.name.c_str();
		if (uniform.is_sampler()) {
			move.textures.push_back(read_texture(uniform, p_material));
			continue;
		}
		std::vector<double> numbers;
		if (!uniform.is_instance) {
			numbers = to_numbers(p_material.get_shader_parameter(name));
		} else if (p_source.node) {
			numbers = to_numbers(p_source.node.get_instance_shader_parameter(name));
		}
		if (numbers.empty()) {
			numbers = to_numbers(server.shader_get_parameter_default(shader, name));
		}
		add_words(uniform, std::move(numbers), words);
	}
	return move;
}

void VertexValues::forget_unused() {
	++frame;
	std::erase_if(
			textures, [](const auto &p_entry) { return !p_entry.second.resource->is_alive(); });
}

} // namespace gnomon
