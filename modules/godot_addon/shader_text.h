#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// A function of a shader in Godot's language, as offsets into its code.
struct ShaderFunction {
	std::string name;
	size_t begin = 0;	   // of its type
	size_t body_begin = 0; // behind its opening brace
	size_t body_end = 0;   // its closing brace
};

/// A shader's code as Godot's RenderingServer has it: without preprocessor lines.
class ShaderText {
public:
	explicit ShaderText(std::string p_code);

	const std::string &get_code() const { return code; }
	/// Whether it has that identifier, comments aside.
	bool has_word(std::string_view p_word) const { return words.contains(p_word); }
	/// Null: it has none of that name.
	const ShaderFunction *find_function(std::string_view p_name) const;
	/// In the code's order.
	const std::vector<ShaderFunction> &get_functions() const { return functions; }
	/// Whether the function has that identifier.
	bool has_word(const ShaderFunction &p_function, std::string_view p_word) const;

private:
	std::string code;
	std::string bare; // the code with blanks for comments
	std::vector<ShaderFunction> functions;
	std::set<std::string, std::less<>> words;
};

} // namespace gnomon
