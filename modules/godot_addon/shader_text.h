#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// A function of a shader in Godot's language, as offsets into its code.
struct ShaderFunction {
	std::string name;
	size_t begin = 0;	   // of its return type
	size_t body_begin = 0; // after its opening brace
	size_t body_end = 0;   // its closing brace
};

/// Finds identifiers and functions in the code of a Godot shader. It does not run the preprocessor,
/// so code from an #include is not found.
class ShaderText {
public:
	explicit ShaderText(std::string p_code);

	const std::string &get_code() const { return code; }
	/// Whether the code has the identifier p_word outside of comments.
	bool has_word(std::string_view p_word) const { return words.contains(p_word); }
	/// Returns null if there is no function of that name.
	const ShaderFunction *find_function(std::string_view p_name) const;
	/// Returns all functions, in the order of the code.
	const std::vector<ShaderFunction> &get_functions() const { return functions; }
	/// Whether the body of the function has the identifier p_word.
	bool has_word(const ShaderFunction &p_function, std::string_view p_word) const;
	/// Returns the body of a function, without comments.
	std::string_view get_body(const ShaderFunction &p_function) const;
	/// Returns a function from its return type to its closing brace, without comments.
	std::string_view get_definition(const ShaderFunction &p_function) const;
	/// Returns the statements outside of functions, without comments and final semicolons.
	std::vector<std::string> get_global_statements() const;
	/// Returns the definitions of constants outside of functions.
	std::string get_global_constants() const;
	/// Whether the function of that name, or one that has the identifier too, may change the
	/// variable p_word: by an assignment, or as the argument of a function with out parameters.
	bool may_assign(std::string_view p_function, std::string_view p_word) const;

private:
	std::string code;
	std::string code_without_comments; // the code with spaces instead of comments
	std::vector<ShaderFunction> functions;
	std::set<std::string, std::less<>> words;
};

} // namespace gnomon
