// There is no library that translates Godot's shading language, see shader_text.cpp.
#include "modules/godot_addon/vertex_translation.h"

#include "modules/core/text.h"

#include "shadows/shadows_shared.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

namespace gnomon {

namespace {

const char PREFIX[] = "moves its vertices in vertex()";
const size_t MAX_ARRAY_COUNT = 1024; // elements of a uniform
const size_t MAX_TEXTURES = 8;

/// Built-ins of vertex() that depend on the view, on data that is not read, or that replace the
/// transforms.
const std::set<std::string, std::less<>> UNREAD = { "VIEW_MATRIX", "INV_VIEW_MATRIX",
	"PROJECTION_MATRIX", "INV_PROJECTION_MATRIX", "MODELVIEW_MATRIX", "MODELVIEW_NORMAL_MATRIX",
	"MAIN_CAM_INV_VIEW_MATRIX", "CAMERA_POSITION_WORLD", "CAMERA_DIRECTION_WORLD",
	"CAMERA_VISIBLE_LAYERS", "NODE_POSITION_VIEW", "VIEWPORT_SIZE", "VIEW_INDEX", "EYE_OFFSET",
	"POSITION", "INSTANCE_CUSTOM", "BONE_INDICES", "BONE_WEIGHTS", "CUSTOM0", "CUSTOM1", "CUSTOM2",
	"CUSTOM3", "Z_CLIP_SCALE", "IN_SHADOW_PASS", "OUTPUT_IS_SRGB", "CLIP_SPACE_FAR", "EXPOSURE" };

/// Built-ins that are global variables of the translation, with their types.
const std::map<std::string, std::string, std::less<>> BUILT_INS = { { "VERTEX", "vec3" },
	{ "NORMAL", "vec3" }, { "TANGENT", "vec3" }, { "BINORMAL", "vec3" }, { "UV", "vec2" },
	{ "UV2", "vec2" }, { "COLOR", "vec4" }, { "POINT_SIZE", "float" }, { "ROUGHNESS", "float" },
	{ "TIME", "float" }, { "MODEL_MATRIX", "mat4" }, { "MODEL_NORMAL_MATRIX", "mat3" },
	{ "NODE_POSITION_WORLD", "vec3" }, { "INSTANCE_ID", "int" }, { "VERTEX_ID", "int" } };

/// Keywords of GLSL that Godot's language allows as names.
const std::set<std::string, std::less<>> RESERVED = { "active", "asm", "attribute", "buffer",
	"cast", "centroid", "class", "coherent", "common", "double", "enum", "extern", "external",
	"filter", "fixed", "goto", "half", "inline", "input", "interface", "layout", "long", "main",
	"namespace", "noinline", "noise1", "noise2", "noise3", "noise4", "output", "partition", "patch",
	"precise", "precision", "public", "readonly", "resource", "restrict", "sample", "shared",
	"short", "sizeof", "static", "subroutine", "superp", "this", "typedef", "union", "unsigned",
	"using", "volatile", "writeonly", "push" };

const std::map<std::string, size_t, std::less<>> WORDS = { { "float", 1 }, { "int", 1 },
	{ "uint", 1 }, { "bool", 1 }, { "vec2", 2 }, { "vec3", 3 }, { "vec4", 4 }, { "ivec2", 2 },
	{ "ivec3", 3 }, { "ivec4", 4 }, { "uvec2", 2 }, { "uvec3", 3 }, { "uvec4", 4 }, { "bvec2", 2 },
	{ "bvec3", 3 }, { "bvec4", 4 }, { "mat2", 4 }, { "mat3", 9 }, { "mat4", 16 } };

bool is_name_character(char p_character) {
	return std::isalnum(static_cast<unsigned char>(p_character)) != 0 || p_character == '_';
}

/// Splits code into names, numbers, and single other characters without spaces.
std::vector<std::string> split(std::string_view p_code) {
	std::vector<std::string> tokens;
	for (size_t index = 0; index < p_code.size();) {
		size_t end = index + 1;
		if (is_name_character(p_code[index])) {
			while (end < p_code.size() && is_name_character(p_code[end])) {
				++end;
			}
		}
		if (std::isspace(static_cast<unsigned char>(p_code[index])) == 0) {
			tokens.emplace_back(p_code.substr(index, end - index));
		}
		index = end;
	}
	return tokens;
}

/// Renames what GLSL reserves.
std::string rename_reserved(std::string_view p_code) {
	std::string renamed;
	for (size_t index = 0; index < p_code.size();) {
		size_t end = index;
		while (end < p_code.size() && is_name_character(p_code[end])) {
			++end;
		}
		const std::string_view word = p_code.substr(index, end - index);
		if (RESERVED.contains(word) || word.starts_with("gl_")) {
			renamed += "user_";
		}
		end = std::max(end, index + 1);
		renamed += p_code.substr(index, end - index);
		index = end;
	}
	return renamed;
}

/// The translation while it is made.
class Translator {
public:
	explicit Translator(const ShaderText &p_shader) : shader(p_shader) {}
	VertexTranslation translate();

private:
	void refuse(const std::string &p_reason) {
		if (result.unknown_reason.empty()) {
			result.unknown_reason = p_reason;
		}
	}
	void find_functions(const ShaderFunction &p_function);
	void find_names();
	void read_statement(const std::string &p_statement);
	void read_uniform(std::vector<std::string> p_tokens);
	void read_varying(std::vector<std::string> p_tokens);
	void read_hints(const std::vector<std::string> &p_tokens, VertexUniform &r_uniform);
	std::string make_code() const;
	std::string make_loads() const;
	bool has(std::string_view p_name) const { return names.contains(p_name); }

	const ShaderText &shader;
	VertexTranslation result;
	std::set<std::string, std::less<>> reached; // functions
	std::set<std::string, std::less<>> names;	// in those, and in constants and structures
	std::string globals;						// constants, structures and varyings
};

void Translator::find_functions(const ShaderFunction &p_function) {
	if (!reached.insert(p_function.name).second) {
		return;
	}
	for (const ShaderFunction &function : shader.get_functions()) {
		if (shader.has_word(p_function, function.name)) {
			find_functions(function);
		}
	}
}

void Translator::find_names() {
	const auto add = [this](std::string_view p_code) {
		for (std::string &token : split(p_code)) {
			if (is_name_character(token[0])) {
				names.insert(std::move(token));
			}
		}
	};
	for (const ShaderFunction &function : shader.get_functions()) {
		if (reached.contains(function.name)) { // all overloads
			add(shader.get_definition(function));
		}
	}
	for (const std::string &statement : shader.get_global_statements()) {
		if (statement.starts_with("const ") || statement.starts_with("struct ")) {
			add(statement);
		}
	}
}

void Translator::read_hints(const std::vector<std::string> &p_tokens, VertexUniform &r_uniform) {
	for (const std::string &token : p_tokens) {
		if (token == "=") {
			break;
		}
		r_uniform.is_color = r_uniform.is_color || token == "source_color";
		r_uniform.is_nearest = r_uniform.is_nearest || token.starts_with("filter_nearest");
		r_uniform.repeats = r_uniform.repeats && token != "repeat_disable";
		if (token.starts_with("hint_default_")) {
			r_uniform.default_texture = token;
		} else if (token.starts_with("hint_") && r_uniform.is_sampler()) {
			refuse(text(PREFIX, " by a texture with ", token));
		}
	}
}

void Translator::read_uniform(std::vector<std::string> p_tokens) {
	VertexUniform uniform;
	bool is_global = false;
	size_t next = 0;
	for (; next < p_tokens.size(); ++next) {
		const std::string &token = p_tokens[next];
		is_global = is_global || token == "global";
		uniform.is_instance = uniform.is_instance || token == "instance";
		if (token != "global" && token != "instance" && token != "uniform" && token != "lowp" &&
				token != "mediump" && token != "highp") {
			break;
		}
	}
	const auto take = [&] { return next < p_tokens.size() ? p_tokens[next++] : std::string(); };
	uniform.type = take();
	const auto take_count = [&] {
		if (next < p_tokens.size() && p_tokens[next] == "[") {
			++next;
			const std::string count = take();
			uniform.is_array = true;
			uniform.count = 0;
			if (!count.empty() && count.size() <= 4 &&
					std::all_of(count.begin(), count.end(), [](unsigned char p_character) {
						return std::isdigit(p_character) != 0;
					})) {
				uniform.count = std::stoul(count);
			}
			take(); // the bracket
		}
	};
	take_count();
	uniform.name = take();
	take_count();
	if (!has(uniform.name)) {
		return;
	}
	if (is_global) {
		refuse(text(PREFIX, " by the global uniform ", uniform.name));
		return;
	}
	const bool is_known = uniform.is_sampler() ? !uniform.is_array : WORDS.contains(uniform.type);
	if (!is_known || uniform.count == 0 || uniform.count > MAX_ARRAY_COUNT) {
		refuse(text(PREFIX, " by the uniform ", uniform.name, " of type ", uniform.type,
				uniform.is_array ? "[]" : ""));
		return;
	}
	read_hints({ p_tokens.begin() + ptrdiff_t(next), p_tokens.end() }, uniform);
	result.uniforms.push_back(uniform);
}

void Translator::read_varying(std::vector<std::string> p_tokens) {
	std::string variable;
	for (const std::string &token : p_tokens) {
		if (token != "varying" && token != "flat" && token != "smooth") {
			variable += token + " ";
		}
	}
	globals += rename_reserved(variable) + ";\n";
}

void Translator::read_statement(const std::string &p_statement) {
	std::vector<std::string> tokens = split(p_statement);
	const std::string &first = tokens[0];
	if (first == "shader_type" || first == "render_mode" || first == "stencil_mode" ||
			first == "group_uniforms") {
		return;
	}
	if (first == "uniform" || first == "global" || first == "instance") {
		read_uniform(std::move(tokens));
	} else if (first == "varying") {
		read_varying(std::move(tokens));
	} else if (first == "const" || first == "struct") {
		globals += rename_reserved(p_statement) + ";\n";
	} else {
		refuse(text(PREFIX, " with a statement that is not read: ", first));
	}
}

std::string Translator::make_loads() const {
	std::string loads;
	size_t word = VERTEX_VALUE_WORDS;
	for (const VertexUniform &uniform : result.uniforms) {
		if (uniform.is_sampler()) {
			continue;
		}
		const size_t words = uniform.count_words();
		const char *convert = uniform.type[0] == 'i' ? "int(gnomon_values["
				: uniform.type[0] == 'u'			 ? "uint(gnomon_values["
				: uniform.type[0] == 'b'			 ? "bool(gnomon_values["
													 : "uintBitsToFloat(gnomon_values[";
		for (size_t element = 0; element < uniform.count; ++element) {
			loads += text("\t", rename_reserved(uniform.name),
					uniform.is_array ? text("[", element, "]") : "", " = ", uniform.type, "(");
			for (size_t component = 0; component < words; ++component) {
				loads += text(component > 0 ? ", " : "", convert, word++, "])");
			}
			loads += ");\n";
		}
	}
	return loads;
}

std::string Translator::make_code() const {
	std::string code = text("#version 460\n"
							"layout(local_size_x = ",
			DEFORM_GROUP_SIZE,
			") in;\n"
			"layout(std430, set = 0, binding = ",
			PROGRAM_BINDING_POSITIONS,
			") buffer GnomonPositions { float gnomon_positions[]; };\n"
			"layout(std430, set = 0, binding = ",
			PROGRAM_BINDING_NORMALS,
			") readonly buffer GnomonNormals { float gnomon_normals[]; };\n"
			"layout(std430, set = 0, binding = ",
			PROGRAM_BINDING_INPUTS,
			") readonly buffer GnomonInputs { float gnomon_inputs[]; };\n"
			"layout(std430, set = 0, binding = ",
			PROGRAM_BINDING_VALUES,
			") readonly buffer GnomonValues { uint gnomon_values[]; };\n"
			"layout(push_constant) uniform GnomonPush { uvec4 gnomon_push; };\n"
			"const float PI = 3.14159265358979;\n"
			"const float TAU = 6.28318530717959;\n"
			"const float E = 2.71828182845905;\n");
	for (const auto &[name, type] : BUILT_INS) {
		code += text(type, " ", name, ";\n");
	}
	uint32_t binding = PROGRAM_BINDING_FIRST_TEXTURE;
	for (const VertexUniform &uniform : result.uniforms) {
		const std::string name = rename_reserved(uniform.name);
		if (uniform.is_sampler()) {
			code += text(
					"layout(set = 0, binding = ", binding++, ") uniform sampler2D ", name, ";\n");
		} else {
			code += text(uniform.type, " ", name,
					uniform.is_array ? text("[", uniform.count, "]") : "", ";\n");
		}
	}
	code += globals;
	for (const ShaderFunction &function : shader.get_functions()) {
		if (reached.contains(function.name)) {
			code += text(rename_reserved(shader.get_definition(function)), "\n");
		}
	}
	const bool is_in_world = shader.has_word("world_vertex_coords");
	code += text(
			"uint gnomon_vertex;\n"
			"float gnomon_value(int p_word) { return uintBitsToFloat(gnomon_values[p_word]); }\n"
			"float gnomon_input(uint p_component) { return gnomon_inputs[gnomon_vertex "
			"* ",
			PROGRAM_INPUT_FLOATS,
			"u + p_component]; }\n"
			"void main() {\n"
			"\tgnomon_vertex = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * "
			"gl_WorkGroupSize.x + "
			"gl_LocalInvocationID.x;\n"
			"\tconst uint first = 3u * gnomon_vertex;\n"
			"\tif (gnomon_vertex >= gnomon_push.x) { return; }\n"
			"\tconst vec3 start = vec3(gnomon_positions[first], gnomon_positions[first + 1u], "
			"gnomon_positions[first + 2u]);\n"
			"\tVERTEX = start;\n"
			"\tNORMAL = vec3(gnomon_normals[first], gnomon_normals[first + 1u], "
			"gnomon_normals[first + 2u]);\n"
			"\tUV = vec2(gnomon_input(0u), gnomon_input(1u));\n"
			"\tUV2 = vec2(gnomon_input(2u), gnomon_input(3u));\n"
			"\tCOLOR = vec4(gnomon_input(4u), gnomon_input(5u), gnomon_input(6u), "
			"gnomon_input(7u));\n"
			"\tTANGENT = vec3(gnomon_input(8u), gnomon_input(9u), gnomon_input(10u));\n"
			"\tBINORMAL = normalize(cross(NORMAL, TANGENT) * gnomon_input(11u));\n"
			"\tPOINT_SIZE = 1.0;\n"
			"\tROUGHNESS = 1.0;\n"
			"\tTIME = gnomon_value(0);\n"
			"\tINSTANCE_ID = int(gnomon_values[1]);\n"
			"\tVERTEX_ID = int(gnomon_vertex);\n"
			"\tfor (int i = 0; i < 16; ++i) { MODEL_MATRIX[i / 4][i % 4] = gnomon_value(2 + i); }\n"
			"\tMODEL_NORMAL_MATRIX = transpose(inverse(mat3(MODEL_MATRIX)));\n"
			"\tNODE_POSITION_WORLD = MODEL_MATRIX[3].xyz;\n",
			make_loads());
	if (is_in_world) {
		code += "\tVERTEX = (MODEL_MATRIX * vec4(VERTEX, 1.0)).xyz;\n"
				"\tNORMAL = MODEL_NORMAL_MATRIX * NORMAL;\n"
				"\tTANGENT = MODEL_NORMAL_MATRIX * TANGENT;\n"
				"\tBINORMAL = MODEL_NORMAL_MATRIX * BINORMAL;\n";
	}
	code += "\tvertex();\n";
	if (is_in_world) {
		code += "\tVERTEX = (inverse(MODEL_MATRIX) * vec4(VERTEX, 1.0)).xyz;\n";
	}
	code += "\tif (any(isnan(VERTEX)) || any(isinf(VERTEX))) { VERTEX = start; }\n"
			"\tVERTEX = clamp(VERTEX, vec3(gnomon_value(18), gnomon_value(19), gnomon_value(20)), "
			"vec3(gnomon_value(21), gnomon_value(22), gnomon_value(23)));\n"
			"\tgnomon_positions[first] = VERTEX.x;\n"
			"\tgnomon_positions[first + 1u] = VERTEX.y;\n"
			"\tgnomon_positions[first + 2u] = VERTEX.z;\n"
			"}\n";
	return code;
}

VertexTranslation Translator::translate() {
	const ShaderFunction *vertex = shader.find_function("vertex");
	if (!vertex) {
		refuse(PREFIX);
		return std::move(result);
	}
	find_functions(*vertex);
	find_names();
	for (const std::string &name : names) {
		if (UNREAD.contains(name)) {
			refuse(text(PREFIX, " by ", name));
		}
	}
	for (const std::string &statement : shader.get_global_statements()) {
		read_statement(statement);
	}
	const auto count = std::count_if(result.uniforms.begin(), result.uniforms.end(),
			[](const VertexUniform &p_uniform) { return p_uniform.is_sampler(); });
	if (size_t(count) > MAX_TEXTURES) {
		refuse(text(PREFIX, " by ", count, " textures"));
	}
	result.uses_time = has("TIME");
	result.uses_node = has("MODEL_MATRIX") || has("MODEL_NORMAL_MATRIX") ||
			has("NODE_POSITION_WORLD") || has("INSTANCE_ID") ||
			shader.has_word("world_vertex_coords") ||
			std::any_of(result.uniforms.begin(), result.uniforms.end(),
					[](const VertexUniform &p_uniform) { return p_uniform.is_instance; });
	result.uses_color = has("COLOR");
	result.uses_normal = has("NORMAL") || has("TANGENT") || has("BINORMAL");
	result.uses_coordinates = has("UV") || has("UV2");
	if (result.unknown_reason.empty()) {
		result.code = make_code();
	}
	return std::move(result);
}

} // namespace

size_t VertexUniform::count_words() const {
	const auto found = WORDS.find(type);
	return found == WORDS.end() ? 0 : found->second;
}

VertexTranslation translate_vertex(const ShaderText &p_shader) {
	return Translator(p_shader).translate();
}

} // namespace gnomon
