#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/shader_reload/shader_compiler.h"
#include "modules/shader_reload/shader_watcher.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

const std::string_view KERNEL = "#version 460\n"
								"#extension GL_GOOGLE_include_directive : require\n"
								"#include \"common/answer_inc.glsl\"\n"
								"layout(local_size_x = 1) in;\n"
								"layout(set = 0, binding = 0) buffer Output { uint answer; };\n"
								"void main() { answer = get_answer(); }\n";

/// A temporary folder of shader sources with one include file.
struct ShaderFolder : TemporaryFolder {
	int written_count = 0;

	ShaderFolder() { write("common/answer_inc.glsl", "uint get_answer() { return 42u; }\n"); }
	void write(const std::string &p_name, std::string_view p_text) {
		fs::create_directories((path / p_name).parent_path());
		save_file_atomically(path / p_name, p_text);
		// Each write gets a later time, even if the clock of the file system is coarse.
		fs::last_write_time(path / p_name,
				fs::file_time_type::clock::now() + std::chrono::seconds(++written_count));
	}
};

/// Returns the name of any compute shader that this build embeds; empty if there is none.
std::string find_embedded_name() {
	for (const EmbeddedShader &shader : get_embedded_shaders()) {
		if (shader.name.ends_with(".comp")) {
			return std::string(shader.name);
		}
	}
	return {};
}

} // namespace

TEST_CASE("[ShaderCompiler] every shader of this build compiles to what the build embeds") {
	size_t count = 0;
	for (const EmbeddedShader &shader : get_embedded_shaders()) {
		CAPTURE(std::string(shader.name));
		const std::vector<uint32_t> words = compile_shader("shaders", std::string(shader.name));
#ifndef DEV_BUILD // such a build embeds debug symbols
		REQUIRE(words.size() == shader.spirv.size());
		CHECK(std::equal(words.begin(), words.end(), shader.spirv.begin()));
#endif
		++count;
	}
	CHECK(count > 0);
}

TEST_CASE("[ShaderCompiler] includes are resolved, and errors name the file and line") {
	ShaderFolder folder;
	folder.write("tests/answer.comp", KERNEL);
	const std::vector<uint32_t> words = compile_shader(folder.path, "tests/answer.comp");
	CHECK(words.at(0) == 0x07230203); // SPIR-V's first word

	folder.write("common/answer_inc.glsl", "\nuint get_answer() { return 4.5; }\n");
	try {
		compile_shader(folder.path, "tests/answer.comp");
		FAIL("a float was returned as uint");
	} catch (const Error &error) {
		const std::string text = error.what();
		CHECK(text.find("tests/answer.comp") != std::string::npos);
		CHECK(text.find("common/answer_inc.glsl:2") != std::string::npos);
		CHECK(text.find("No code generated") == std::string::npos);
	}
	fs::remove(folder.path / "common/answer_inc.glsl");
	CHECK_THROWS_WITH_AS(compile_shader(folder.path, "tests/answer.comp"),
			doctest::Contains("common/answer_inc.glsl"), Error);
	CHECK_THROWS_AS(compile_shader(folder.path, "tests/none.comp"), Error);
	folder.write("tests/answer.txt", KERNEL);
	CHECK_THROWS_WITH_AS(
			compile_shader(folder.path, "tests/answer.txt"), doctest::Contains(".comp"), Error);
	folder.write("common/endless.comp",
			"#version 460\n#extension GL_GOOGLE_include_directive : "
			"require\n#include \"common/endless.comp\"\n");
	CHECK_THROWS_AS(compile_shader(folder.path, "common/endless.comp"), Error);
	folder.write("common/empty.comp", "");
	CHECK_THROWS_AS(compile_shader(folder.path, "common/empty.comp"), Error);
}

TEST_CASE("[ShaderCompiler] a variant is the same file compiled with the macro VARIANT_<NAME>") {
	CHECK(find_shader_source("a/b.comp").file == "a/b.comp");
	CHECK(find_shader_source("a/b.comp").macro.empty());
	CHECK(find_shader_source("a/b.storage.comp").file == "a/b.comp");
	CHECK(find_shader_source("a/b.storage.comp").macro == "VARIANT_STORAGE");

	ShaderFolder folder;
	folder.write("tests/answer.comp", KERNEL);
	folder.write("common/answer_inc.glsl",
			"#ifdef VARIANT_OTHER\nuint get_answer() { return 43u; }\n"
			"#else\nuint get_answer() { return 42u; }\n#endif\n");
	const std::vector<uint32_t> words = compile_shader(folder.path, "tests/answer.comp");
	CHECK(compile_shader(folder.path, "tests/answer.other.comp") != words);
	CHECK(compile_shader(folder.path, "tests/answer.unused.comp") == words);
}

TEST_CASE("[ShaderCompiler] find_includes returns the quoted includes in order") {
	CHECK(find_includes("").empty());
	CHECK(find_includes("#include \"a/b.h\"\n  #  include \"c.glsl\"\n// #include \"d.h\"\n"
						"#include <e.h>\n") == std::vector<std::string>{ "a/b.h", "c.glsl" });
}

TEST_CASE("[ShaderWatcher] a changed include file recompiles the entry point that includes it") {
	const std::string name = find_embedded_name();
	REQUIRE_FALSE(name.empty());
	ShaderFolder folder;
	folder.write(name, KERNEL);
	ShaderWatcher watcher(folder.path);
	CHECK(watcher.get_watched_count() == 1);
	CHECK(watcher.poll().empty());

	folder.write("common/answer_inc.glsl", "uint get_answer() { return 43u; }\n");
	std::vector<ShaderChange> changes = watcher.poll();
	REQUIRE(changes.size() == 1);
	CHECK(changes[0].name == name);
	CHECK(changes[0].failure.empty());
	CHECK_FALSE(changes[0].spirv.empty());
	CHECK(watcher.poll().empty());

	folder.write("common/answer_inc.glsl", "uint get_answer() { return nothing; }\n");
	changes = watcher.poll();
	REQUIRE(changes.size() == 1);
	CHECK(changes[0].failure.find("common/answer_inc.glsl:1") != std::string::npos);
	CHECK(changes[0].spirv.empty());
	CHECK(watcher.poll().empty()); // reported once

	// Editors may delete a file and write it again with other content.
	fs::remove(folder.path / "common/answer_inc.glsl");
	CHECK(watcher.poll().empty());
	folder.write("common/answer_inc.glsl", "#include \"common/more_inc.glsl\"\n");
	changes = watcher.poll();
	REQUIRE(changes.size() == 1);
	CHECK(changes[0].failure.find("more_inc.glsl") != std::string::npos);
	folder.write("common/more_inc.glsl", "uint get_answer() { return 44u; }\n");
	changes = watcher.poll();
	REQUIRE(changes.size() == 1);
	CHECK(changes[0].failure.empty());
}

TEST_CASE("[ShaderWatcher] nothing is watched in a folder that does not exist") {
	ShaderWatcher watcher("/no/such/folder");
	CHECK(watcher.get_watched_count() == 0);
	CHECK(watcher.poll().empty());
}
