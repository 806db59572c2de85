#include "modules/shader_reload/shader_compiler.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <spirv-tools/optimizer.hpp>

#include <algorithm>
#include <cctype>
#include <map>
#include <memory>
#include <regex>
#include <sstream>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

const int GLSL_VERSION = 460;		 // for files without a #version line
const size_t MAX_INCLUDE_DEPTH = 32; // nesting limit, which ends circular includes

EShLanguage find_stage(const std::string &p_name) {
	static const std::map<std::string, EShLanguage> STAGES = { { ".vert", EShLangVertex },
		{ ".geom", EShLangGeometry }, { ".frag", EShLangFragment }, { ".comp", EShLangCompute } };
	const auto found = STAGES.find(fs::path(p_name).extension().string());
	if (found == STAGES.end()) {
		fail("Shader \"", p_name, "\" must end in .vert, .geom, .frag or .comp. Rename it.");
	}
	return found->second;
}

/// Resolves includes relative to the root of the shader sources, not to the including file.
class FolderIncluder : public glslang::TShader::Includer {
public:
	explicit FolderIncluder(fs::path p_folder) : folder(std::move(p_folder)) {}

	IncludeResult *includeLocal(const char *p_name, const char *, size_t p_depth) override {
		if (p_depth > MAX_INCLUDE_DEPTH) {
			return nullptr;
		}
		try {
			auto text = std::make_unique<std::string>(load_text_file(folder / p_name));
			const char *data = text->data();
			const size_t length = text->size();
			return new IncludeResult(p_name, data, length, text.release());
		} catch (const Error &) {
			return nullptr; // the compiler then reports the line of the #include
		}
	}
	IncludeResult *includeSystem(const char *p_name, const char *p_by, size_t p_depth) override {
		return includeLocal(p_name, p_by, p_depth);
	}
	void releaseInclude(IncludeResult *p_result) override {
		if (p_result != nullptr) {
			delete static_cast<std::string *>(p_result->userData);
			delete p_result;
		}
	}

private:
	fs::path folder;
};

/// Removes empty lines and the summary line from the compiler's log.
std::string tidy_log(const std::string &p_log) {
	std::istringstream lines(p_log);
	std::string tidy;
	for (std::string line; std::getline(lines, line);) {
		if (line.find("compilation errors.  No code generated") == std::string::npos &&
				line.find_first_not_of(" \t\r") != std::string::npos) {
			tidy += (tidy.empty() ? "" : "\n") + line;
		}
	}
	return tidy;
}

/// Optimises SPIR-V as the build does: with SHADER_OPTIMIZER_PASSES, the flags of spirv-opt with
/// commas between them, which the build system defines.
std::vector<uint32_t> optimize(
		const std::vector<uint32_t> &p_words, [[maybe_unused]] const std::string &p_name) {
#ifdef SHADER_OPTIMIZER_PASSES
	spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_1);
	std::string messages;
	optimizer.SetMessageConsumer(
			[&](spv_message_level_t, const char *, const spv_position_t &, const char *p_text) {
				messages += std::string("\n") + p_text;
			});
	std::istringstream flags(SHADER_OPTIMIZER_PASSES);
	bool are_flags_known = true;
	for (std::string flag; std::getline(flags, flag, ',');) {
		are_flags_known = are_flags_known && optimizer.RegisterPassFromFlag(flag);
	}
	spvtools::OptimizerOptions options;
	options.set_preserve_bindings(true);
	options.set_preserve_spec_constants(true);
	std::vector<uint32_t> optimized;
	if (!are_flags_known || !optimizer.Run(p_words.data(), p_words.size(), &optimized, options)) {
		fail("Shader \"", p_name, "\" cannot be optimised:", messages);
	}
	return optimized;
#else
	return p_words; // a build with symbols for a debugger
#endif
}

/// Initializes glslang's global tables for the rest of the process.
struct CompilerProcess {
	CompilerProcess() { glslang::InitializeProcess(); }
	~CompilerProcess() { glslang::FinalizeProcess(); }
};

} // namespace

ShaderSource find_shader_source(const std::string &p_name) {
	const fs::path name(p_name);
	const std::string variant = name.stem().extension().string(); // ".storage", or empty
	if (variant.empty()) {
		return { p_name, {} };
	}
	const fs::path base_name = name.stem().stem();
	ShaderSource source = {
		(name.parent_path() / base_name).generic_string() + name.extension().string(), "VARIANT_"
	};
	std::transform(variant.begin() + 1, variant.end(), std::back_inserter(source.macro),
			[](unsigned char p_letter) { return static_cast<char>(std::toupper(p_letter)); });
	return source;
}

std::vector<uint32_t> compile_shader(const fs::path &p_folder, const std::string &p_name) {
	static const CompilerProcess process;
	const EShLanguage stage = find_stage(p_name);
	const ShaderSource found = find_shader_source(p_name);
	const std::string source = load_text_file(p_folder / found.file);
	const char *texts[] = { source.c_str() };
	const int lengths[] = { static_cast<int>(source.size()) };
	const char *names[] = { found.file.c_str() };
	const std::string preamble = found.macro.empty() ? "" : "#define " + found.macro + "\n";
	glslang::TShader shader(stage);
	shader.setPreamble(preamble.c_str());
	shader.setStringsWithLengthsAndNames(texts, lengths, names, 1);
	shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan,
			/*version=*/100); // of GL_KHR_vulkan_glsl
	// The same target as in shaders/shader_builders.py: the lowest with subgroup operations.
	shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
	shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
	const EShMessages messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
	FolderIncluder includer(p_folder);
	if (!shader.parse(GetDefaultResources(), GLSL_VERSION, /*forwardCompatible=*/false, messages,
				includer)) {
		fail("Shader \"", p_name, "\" does not compile:\n", tidy_log(shader.getInfoLog()));
	}
	glslang::TProgram program;
	program.addShader(&shader);
	if (!program.link(messages)) {
		fail("Shader \"", p_name, "\" does not link:\n", tidy_log(program.getInfoLog()));
	}
	std::vector<uint32_t> words;
	glslang::SpvOptions options;
	options.disableOptimizer = true; // glslang's own choice of passes
	options.stripDebugInfo = true;
	glslang::GlslangToSpv(*program.getIntermediate(stage), words, &options);
	return optimize(words, p_name);
}

std::vector<std::string> find_includes(const std::string &p_text) {
	static const std::regex INCLUDE(R"re(^[ \t]*#[ \t]*include[ \t]*"([^"]*)")re");
	std::vector<std::string> names;
	std::istringstream lines(p_text);
	std::smatch found;
	for (std::string line; std::getline(lines, line);) {
		if (std::regex_search(line, found, INCLUDE)) {
			names.push_back(found[1]);
		}
	}
	return names;
}

} // namespace gnomon
