// There is no library that parses Godot's shading language; Godot's API lacks its own parser.
#include "modules/godot_addon/shader_text.h"

#include <algorithm>
#include <cctype>

namespace gnomon {

namespace {

bool is_identifier_character(char p_character) {
	return std::isalnum(static_cast<unsigned char>(p_character)) != 0 || p_character == '_';
}

/// Also blanks the lines with which Godot's preprocessor marks where an included file begins and
/// ends.
std::string blank_comments(std::string p_code) {
	for (size_t index = 0; index + 1 < p_code.size();) {
		size_t end = index;
		if (p_code.compare(index, 2, "//") == 0 || p_code.compare(index, 2, "@@") == 0) {
			end = std::min(p_code.find('\n', index), p_code.size());
		} else if (p_code.compare(index, 2, "/*") == 0) {
			const size_t found = p_code.find("*/", index + 2);
			end = found == std::string::npos ? p_code.size() : found + 2;
		}
		if (end == index) {
			++index; // no comment begins here
		}
		for (; index < end; ++index) {
			p_code[index] = p_code[index] == '\n' ? '\n' : ' ';
		}
	}
	return p_code;
}

template <typename Function> void for_each_word(std::string_view p_text, Function p_function) {
	for (size_t begin = 0; begin < p_text.size();) {
		if (!is_identifier_character(p_text[begin])) {
			++begin;
			continue;
		}
		size_t end = begin;
		while (end < p_text.size() && is_identifier_character(p_text[end])) {
			++end;
		}
		p_function(p_text.substr(begin, end - begin));
		begin = end;
	}
}

/// Whether the variable whose name ends at p_end is assigned to there, or one of its components.
bool is_assigned(std::string_view p_text, size_t p_end) {
	size_t index = p_end;
	const auto skip = [&](auto p_is_skipped) {
		while (index < p_text.size() && p_is_skipped(p_text[index])) {
			++index;
		}
	};
	const auto is_space = [](char p_character) {
		return std::isspace(static_cast<unsigned char>(p_character)) != 0;
	};
	for (skip(is_space); index < p_text.size() && (p_text[index] == '.' || p_text[index] == '[');
			skip(is_space)) {
		if (p_text[index] == '[') { // an element
			index = std::min(p_text.find(']', index), p_text.size() - 1) + 1;
		} else { // a component
			++index;
			skip(is_identifier_character);
		}
	}
	const std::string_view rest = p_text.substr(std::min(index, p_text.size()));
	if (rest.starts_with("++") || rest.starts_with("--")) {
		return true;
	}
	const size_t equals = rest.find_first_not_of("+-*/%&|^<>");
	return equals != std::string_view::npos && equals <= 2 && rest[equals] == '=' &&
			!rest.substr(equals + 1).starts_with('=') && rest.substr(0, 2) != "<=" &&
			rest.substr(0, 2) != ">=";
}

/// Returns the function whose body opens at p_brace, or one without a name if p_brace opens no
/// function. p_statement: where the statement with the brace begins.
ShaderFunction read_function(std::string_view p_text, size_t p_statement, size_t p_brace) {
	const std::string_view head = p_text.substr(p_statement, p_brace - p_statement);
	const size_t parenthesis = head.find('(');
	const size_t last = head.find_last_not_of(" \t\r\n");
	ShaderFunction function;
	if (parenthesis == std::string_view::npos || head[last] != ')') {
		return function; // a structure or a list of values
	}
	// The last word before the parenthesis is the name.
	for_each_word(
			head.substr(0, parenthesis), [&](std::string_view p_word) { function.name = p_word; });
	function.begin = p_statement + head.find_first_not_of(" \t\r\n");
	function.body_begin = p_brace + 1;
	return function;
}

std::vector<ShaderFunction> find_functions(std::string_view p_text) {
	std::vector<ShaderFunction> functions;
	size_t depth = 0;
	size_t statement = 0;
	ShaderFunction function;
	for (size_t index = 0; index < p_text.size(); ++index) {
		if (p_text[index] == '{' && depth++ == 0) {
			function = read_function(p_text, statement, index);
		} else if (p_text[index] == '}' && depth > 0 && --depth == 0) {
			statement = index + 1;
			function.body_end = index;
			if (!function.name.empty()) {
				functions.push_back(function);
			}
		} else if (p_text[index] == ';' && depth == 0) {
			statement = index + 1;
		}
	}
	return functions;
}

} // namespace

ShaderText::ShaderText(std::string p_code) :
		code(std::move(p_code)), code_without_comments(blank_comments(code)),
		functions(find_functions(code_without_comments)) {
	for_each_word(
			code_without_comments, [this](std::string_view p_word) { words.emplace(p_word); });
}

const ShaderFunction *ShaderText::find_function(std::string_view p_name) const {
	const auto found = std::find_if(functions.begin(), functions.end(),
			[&](const ShaderFunction &p_function) { return p_function.name == p_name; });
	return found == functions.end() ? nullptr : &*found;
}

std::string_view ShaderText::get_body(const ShaderFunction &p_function) const {
	return std::string_view(code_without_comments)
			.substr(p_function.body_begin, p_function.body_end - p_function.body_begin);
}

std::string_view ShaderText::get_definition(const ShaderFunction &p_function) const {
	return std::string_view(code_without_comments)
			.substr(p_function.begin, p_function.body_end + 1 - p_function.begin);
}

std::vector<std::string> ShaderText::get_global_statements() const {
	std::vector<std::string> statements;
	std::string statement;
	size_t depth = 0;
	auto function = functions.begin();
	for (size_t index = 0; index < code_without_comments.size(); ++index) {
		if (function != functions.end() && index == function->begin) {
			index = (function++)->body_end;
			statement.clear();
			continue;
		}
		const char character = code_without_comments[index];
		if (character == ';' && depth == 0) {
			const size_t first = statement.find_first_not_of(" \t\r\n");
			if (first != std::string::npos) {
				statements.push_back(statement.substr(first));
			}
			statement.clear();
			continue;
		}
		depth += size_t(character == '{');
		depth -= size_t(character == '}' && depth > 0);
		statement += character;
	}
	return statements;
}

std::string ShaderText::get_global_constants() const {
	std::string constants;
	for (const std::string &statement : get_global_statements()) {
		if (statement.compare(0, 6, "const ") == 0) {
			constants += statement + ";\n";
		}
	}
	return constants;
}

bool ShaderText::may_assign(std::string_view p_function, std::string_view p_word) const {
	const ShaderFunction *function = find_function(p_function);
	if (!function || !has_word(*function, p_word)) {
		return false;
	}
	// An out parameter may change it, wherever it is passed.
	if (has_word("out") || has_word("inout")) {
		return true;
	}
	const std::string_view body = get_body(*function);
	bool assigns = false;
	for_each_word(body, [&](std::string_view p_found) {
		assigns = assigns ||
				(p_found == p_word &&
						is_assigned(body, size_t(p_found.data() - body.data()) + p_found.size()));
	});
	return assigns;
}

bool ShaderText::has_word(const ShaderFunction &p_function, std::string_view p_word) const {
	bool has = false;
	for_each_word(get_body(p_function),
			[&](std::string_view p_found) { has = has || p_found == p_word; });
	return has;
}

} // namespace gnomon
