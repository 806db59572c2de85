#include "modules/godot_addon/shader_alpha.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>

namespace gnomon {

namespace {

// Values that a linear form is made of: the mesh's UV, then four channels of each texture sample.
const int BASIS_U = 0;
const int BASIS_V = 1;
const int FIRST_CHANNEL = 2;
const int CHANNEL_COUNT = 4;
const size_t MAX_NESTING = 64; // of expressions

/// A number that the shader computes: constant + sum of coefficients times basis values.
struct Linear {
	bool is_known = false;
	double constant = 0;
	std::map<int, double> terms; // by basis

	static Linear of(double p_constant) { return { true, p_constant, {} }; }
	static Linear of_basis(int p_basis) { return { true, 0, { { p_basis, 1.0 } } }; }
	bool is_constant() const { return is_known && terms.empty(); }
};

Linear scale(Linear p_value, double p_factor) {
	p_value.constant *= p_factor;
	if (p_factor == 0) {
		p_value.terms.clear();
	}
	for (auto &[basis, coefficient] : p_value.terms) {
		coefficient *= p_factor;
	}
	return p_value;
}

Linear add(Linear p_left, const Linear &p_right) {
	p_left.is_known = p_left.is_known && p_right.is_known;
	p_left.constant += p_right.constant;
	for (const auto &[basis, coefficient] : p_right.terms) {
		p_left.terms[basis] += coefficient;
	}
	std::erase_if(p_left.terms, [](const auto &p_term) { return p_term.second == 0; });
	return p_left;
}

Linear multiply(const Linear &p_left, const Linear &p_right) {
	if (!p_left.is_known || !p_right.is_known) {
		return {};
	}
	return p_left.terms.empty()		? scale(p_right, p_left.constant)
			: p_right.terms.empty() ? scale(p_left, p_right.constant)
									: Linear();
}

Linear divide(const Linear &p_left, const Linear &p_right) {
	return p_right.is_constant() && p_right.constant != 0 ? scale(p_left, 1.0 / p_right.constant)
														  : Linear();
}

/// 1 to 4 components; empty: not known.
using Value = std::vector<Linear>;

template <typename Function>
Value combine(const Value &p_left, const Value &p_right, Function p_function) {
	if (p_left.empty() || p_right.empty() ||
			(p_left.size() != p_right.size() && p_left.size() != 1 && p_right.size() != 1)) {
		return {};
	}
	Value result(std::max(p_left.size(), p_right.size()));
	for (size_t index = 0; index < result.size(); ++index) {
		result[index] = p_function(
				p_left[p_left.size() == 1 ? 0 : index], p_right[p_right.size() == 1 ? 0 : index]);
	}
	return result;
}

/// Components of a swizzle as indices; empty: it is none.
std::vector<size_t> read_swizzle(std::string_view p_text) {
	std::vector<size_t> components;
	for (const char letter : p_text) {
		size_t found = std::string_view::npos;
		for (const std::string_view names : { "xyzw", "rgba", "stpq" }) {
			found = std::min(found, names.find(letter));
		}
		if (found == std::string_view::npos) {
			return {};
		}
		components.push_back(found);
	}
	return components.size() <= CHANNEL_COUNT ? components : std::vector<size_t>();
}

std::vector<std::string> split_tokens(std::string_view p_text) {
	std::vector<std::string> tokens;
	const auto is_word = [](char p_character) {
		return std::isalnum(static_cast<unsigned char>(p_character)) != 0 || p_character == '_';
	};
	for (size_t begin = 0; begin < p_text.size();) {
		const char first = p_text[begin];
		size_t end = begin + 1;
		const bool is_number = std::isdigit(static_cast<unsigned char>(first)) != 0 ||
				(first == '.' && end < p_text.size() &&
						std::isdigit(static_cast<unsigned char>(p_text[end])) != 0);
		if (std::isspace(static_cast<unsigned char>(first)) != 0) {
			begin = end;
			continue;
		}
		if (is_number) {
			while (end < p_text.size() &&
					(is_word(p_text[end]) || p_text[end] == '.' ||
							((p_text[end] == '-' || p_text[end] == '+') &&
									std::tolower(p_text[end - 1]) == 'e'))) {
				++end;
			}
		} else if (is_word(first)) {
			while (end < p_text.size() && is_word(p_text[end])) {
				++end;
			}
		} else if (end < p_text.size() &&
				((p_text[end] == '=' &&
						 std::string_view("=!<>+-*/").find(first) != std::string_view::npos) ||
						(p_text[end] == first &&
								std::string_view("+-&|").find(first) != std::string_view::npos))) {
			++end;
		}
		tokens.emplace_back(p_text.substr(begin, end - begin));
		begin = end;
	}
	return tokens;
}

bool is_identifier(const std::string &p_token) {
	return !p_token.empty() &&
			(std::isalpha(static_cast<unsigned char>(p_token[0])) != 0 || p_token[0] == '_');
}

const std::set<std::string> TYPES = { "float", "vec2", "vec3", "vec4", "int", "bool", "uint",
	"mat2", "mat3", "mat4", "ivec2", "ivec3", "ivec4" };
const std::set<std::string> QUALIFIERS = { "const", "highp", "mediump", "lowp" };

/// Follows the statements of a function, and keeps the values of variables.
class Tracer {
public:
	Tracer(const ShaderText &p_shader, const UniformLookup &p_uniforms) {
		for (const std::string &statement : p_shader.get_global_statements()) {
			read_uniform(split_tokens(statement), p_uniforms);
		}
		variables["UV"] = { Linear::of_basis(BASIS_U), Linear::of_basis(BASIS_V) };
	}

	void trace(std::string_view p_body) {
		tokens = split_tokens(p_body);
		position = 0;
		while (position < tokens.size()) {
			read_statement();
		}
	}
	const Value &get(const std::string &p_name) { return variables[p_name]; }

	struct Sample {
		std::string sampler;
		Value uv;
	};
	std::vector<Sample> samples;
	std::vector<Linear> discards; // the pixel is discarded where one of them is below 0
	bool has_unknown_discard = false;

private:
	/// Uniforms without a value are 0. Those of instances and of the project have unknown values.
	void read_uniform(const std::vector<std::string> &p_tokens, const UniformLookup &p_uniforms) {
		const auto type = std::find_if(p_tokens.begin(), p_tokens.end(),
				[](const std::string &p_token) { return TYPES.contains(p_token); });
		const auto has = [&](const char *p_word) {
			return std::find(p_tokens.begin(), type, p_word) != type;
		};
		if (type == p_tokens.end() || type + 1 == p_tokens.end() || !has("uniform")) {
			return;
		}
		Value value;
		if (!has("instance") && !has("global")) {
			for (const double number : p_uniforms(type[1])) {
				value.push_back(Linear::of(number));
			}
			if (value.empty() && (type->starts_with("vec") || *type == "float")) {
				value.resize(*type == "float" ? 1 : size_t((*type)[3] - '0'), Linear::of(0));
			}
		}
		uniforms[type[1]] = value;
	}
	const std::string &peek(size_t p_ahead = 0) const {
		static const std::string end;
		return position + p_ahead < tokens.size() ? tokens[position + p_ahead] : end;
	}
	bool accept(std::string_view p_token) {
		if (peek() != p_token) {
			return false;
		}
		++position;
		return true;
	}
	/// Moves past the token that closes the bracket at the position.
	void skip_brackets() {
		size_t depth = 0;
		do {
			const std::string &token = peek();
			depth += size_t(token == "(" || token == "{" || token == "[");
			depth -= size_t(depth > 0 && (token == ")" || token == "}" || token == "]"));
			++position;
		} while (depth > 0 && position < tokens.size());
	}
	/// Moves past a statement, or a block.
	void skip_statement() {
		if (peek() == "{") {
			skip_brackets();
			return;
		}
		while (position < tokens.size() && peek() != ";") {
			if (peek() == "(" || peek() == "{") {
				skip_brackets();
				if (peek() == "{" || tokens[position - 1] == "}") {
					return;
				}
			} else {
				++position;
			}
		}
		++position;
	}
	/// Forgets the values of variables that the tokens from p_begin on may change: all that occur.
	void forget(size_t p_begin) {
		for (size_t index = p_begin; index < std::min(position, tokens.size()); ++index) {
			if (tokens[index] == "discard") {
				has_unknown_discard = true;
			}
			const std::string next = index + 1 < tokens.size() ? tokens[index + 1] : "";
			const bool may_change = next == "=" || next == "." || next == "[" || next == "," ||
					next == ")" || (next.size() == 2 && (next[1] == '=' || next[1] == next[0]));
			if (is_identifier(tokens[index]) && may_change) {
				variables[tokens[index]].clear();
			}
		}
	}

	void read_statement() {
		const size_t begin = position;
		if (accept("{") || accept("}") || accept(";")) {
			return; // blocks do not hide values: names are rarely used twice
		}
		if (peek() == "if") {
			read_if();
			return;
		}
		for (const char *keyword : { "for", "while", "do", "switch", "else" }) {
			if (peek() == keyword) {
				++position;
				if (peek() == "(") {
					skip_brackets();
				}
				skip_statement();
				forget(begin);
				return;
			}
		}
		while (QUALIFIERS.contains(peek())) {
			++position;
		}
		if (TYPES.contains(peek()) && is_identifier(peek(1))) {
			++position;
			do {
				const std::string name = peek();
				++position;
				variables[name] = accept("=") ? read_expression() : Value();
			} while (accept(","));
			finish_statement(begin);
			return;
		}
		read_assignment(begin);
	}

	void finish_statement(size_t p_begin) {
		if (accept(";")) {
			return;
		}
		position = p_begin; // not understood
		skip_statement();
		forget(p_begin);
	}

	void read_assignment(size_t p_begin) {
		const std::string name = peek();
		if (!is_identifier(name)) {
			finish_statement(p_begin);
			return;
		}
		++position;
		std::vector<size_t> swizzle;
		if (accept(".")) {
			swizzle = read_swizzle(peek());
			++position;
		}
		const std::string operation = peek();
		if (operation != "=" && operation != "+=" && operation != "-=" && operation != "*=" &&
				operation != "/=") {
			finish_statement(p_begin);
			return;
		}
		++position;
		Value right = read_expression();
		Value &variable = variables[name];
		Value left = variable;
		if (!swizzle.empty()) {
			left = select(variable, swizzle);
		}
		if (operation != "=") {
			right = combine(left, right, [&](const Linear &p_left, const Linear &p_right) {
				return operation == "+="	? add(p_left, p_right)
						: operation == "-=" ? add(p_left, scale(p_right, -1))
						: operation == "*=" ? multiply(p_left, p_right)
											: divide(p_left, p_right);
			});
		}
		if (swizzle.empty()) {
			variable = right;
		} else {
			const size_t needed = 1 + *std::max_element(swizzle.begin(), swizzle.end());
			variable.resize(std::max(variable.size(), needed));
			for (size_t index = 0; index < swizzle.size(); ++index) {
				variable[swizzle[index]] = right.empty() ? Linear()
						: right.size() == 1				 ? right[0]
						: index < right.size()			 ? right[index]
														 : Linear();
			}
		}
		finish_statement(p_begin);
	}

	/// `if (left < right) discard;`, or any other one.
	void read_if() {
		const size_t begin = position;
		position += 2; // if (
		const Value left = read_expression();
		const std::string comparison = peek();
		++position;
		const Value right = read_expression();
		const bool is_less = comparison == "<" || comparison == "<=";
		const bool is_greater = comparison == ">" || comparison == ">=";
		if ((is_less || is_greater) && left.size() == 1 && right.size() == 1 && accept(")")) {
			const bool has_block = accept("{");
			if (accept("discard") && accept(";") && (!has_block || accept("}")) &&
					peek() != "else") {
				discards.push_back(is_less ? add(left[0], scale(right[0], -1))
										   : add(right[0], scale(left[0], -1)));
				return;
			}
		}
		position = begin + 1;
		skip_brackets(); // the condition
		skip_statement();
		forget(begin);
	}

	static Value select(const Value &p_value, const std::vector<size_t> &p_components) {
		Value selected;
		for (const size_t component : p_components) {
			if (component >= p_value.size()) {
				return {};
			}
			selected.push_back(p_value[component]);
		}
		return selected;
	}

	Value read_expression() { return read_sum(); }

	Value read_sum() {
		Value value = read_product();
		while (peek() == "+" || peek() == "-") {
			const double sign = peek() == "+" ? 1 : -1;
			++position;
			value = combine(
					value, read_product(), [&](const Linear &p_left, const Linear &p_right) {
						return add(p_left, scale(p_right, sign));
					});
		}
		return value;
	}

	Value read_product() {
		Value value = read_unary();
		while (peek() == "*" || peek() == "/") {
			const bool is_product = peek() == "*";
			++position;
			value = combine(value, read_unary(), is_product ? &multiply : &divide);
		}
		return value;
	}

	Value read_unary() {
		double sign = 1;
		while (peek() == "-" || peek() == "+") {
			sign = peek() == "-" ? -sign : sign;
			++position;
		}
		Value value = read_primary();
		while (accept(".")) {
			const std::vector<size_t> swizzle = read_swizzle(peek());
			++position;
			value = swizzle.empty() ? Value() : select(value, swizzle);
		}
		if (peek() == "[") {
			skip_brackets();
			value.clear();
		}
		for (Linear &component : value) {
			component = scale(component, sign);
		}
		return value;
	}

	Value read_primary() {
		const std::string token = peek();
		if (nesting >= MAX_NESTING) {
			++position;
			return {};
		}
		if (accept("(")) {
			++nesting;
			Value value = read_expression();
			--nesting;
			return accept(")") ? value : Value();
		}
		if (token.empty() || token == ";" || token == ")" || token == ",") {
			return {};
		}
		++position;
		if (std::isdigit(static_cast<unsigned char>(token[0])) != 0 || token[0] == '.') {
			return { Linear::of(std::strtod(token.c_str(), nullptr)) };
		}
		if (peek() == "(") {
			return read_call(token);
		}
		if (const auto found = variables.find(token); found != variables.end()) {
			return found->second;
		}
		const auto uniform = uniforms.find(token);
		return uniform == uniforms.end() ? Value() : uniform->second;
	}

	Value read_call(const std::string &p_function) {
		const bool is_texture = p_function == "texture" || p_function == "textureLod";
		++position; // (
		const std::string sampler = is_texture ? peek() : "";
		if (is_texture) {
			++position;
			accept(",");
		}
		std::vector<Value> arguments;
		++nesting;
		while (position < tokens.size() && peek() != ")" && peek() != ";") {
			arguments.push_back(read_expression());
			if (!accept(",") && peek() != ")") {
				break;
			}
		}
		--nesting;
		if (!accept(")") || arguments.empty()) {
			return {};
		}
		if (is_texture) {
			Value channels;
			for (int channel = 0; channel < CHANNEL_COUNT; ++channel) {
				channels.push_back(Linear::of_basis(FIRST_CHANNEL +
						CHANNEL_COUNT * static_cast<int>(samples.size()) + channel));
			}
			samples.push_back({ sampler, arguments[0] });
			return channels;
		}
		if (p_function == "float" || p_function == "vec2" || p_function == "vec3" ||
				p_function == "vec4") {
			const size_t count = p_function == "float" ? 1 : size_t(p_function[3] - '0');
			Value value;
			for (const Value &argument : arguments) {
				value.insert(value.end(), argument.begin(), argument.end());
			}
			if (value.size() == 1) {
				value.resize(count, value[0]);
			}
			value.resize(value.size() < count ? 0 : count);
			return value;
		}
		if ((p_function == "clamp" && arguments.size() == 3) || p_function == "saturate") {
			return arguments[0]; // to 0..1, in which a texture's channels are
		}
		return {};
	}

	std::map<std::string, Value> uniforms;
	std::vector<std::string> tokens;
	size_t position = 0;
	size_t nesting = 0;
	std::map<std::string, Value> variables;
};

/// Reads the condition under which a pixel is drawn: p_visible >= 0.
std::optional<ShaderAlpha> read_condition(
		const Linear &p_visible, const std::vector<Tracer::Sample> &p_samples) {
	ShaderAlpha alpha;
	if (p_visible.is_constant()) {
		alpha.threshold = p_visible.constant >= 0 ? 0.0f : 2.0f;
		return alpha;
	}
	if (!p_visible.is_known || p_visible.terms.size() != 1 ||
			p_visible.terms.begin()->first < FIRST_CHANNEL) {
		return std::nullopt;
	}
	const auto &[basis, factor] = *p_visible.terms.begin();
	const Tracer::Sample &sample = p_samples[size_t(basis - FIRST_CHANNEL) / size_t(CHANNEL_COUNT)];
	if (sample.uv.size() != 2) {
		return std::nullopt;
	}
	alpha.sampler = sample.sampler;
	alpha.channel = (basis - FIRST_CHANNEL) % CHANNEL_COUNT;
	alpha.is_inverted = factor < 0;
	// factor * channel + constant >= 0; inverted: |factor| * (1 - channel) >= |factor| - constant.
	const double threshold =
			factor > 0 ? -p_visible.constant / factor : 1.0 + p_visible.constant / factor;
	alpha.threshold = static_cast<float>(threshold);
	for (int row = 0; row < 2; ++row) {
		const Linear &coordinate = sample.uv[size_t(row)];
		for (const auto &[uv_basis, coefficient] : coordinate.terms) {
			if (uv_basis > BASIS_V) {
				return std::nullopt;
			}
		}
		if (!coordinate.is_known) {
			return std::nullopt;
		}
		const auto get = [&](int p_basis) {
			const auto found = coordinate.terms.find(p_basis);
			return found == coordinate.terms.end() ? 0.0f : static_cast<float>(found->second);
		};
		alpha.uv_from_mesh_uv[0][row] = get(BASIS_U);
		alpha.uv_from_mesh_uv[1][row] = get(BASIS_V);
		alpha.uv_from_mesh_uv[2][row] = static_cast<float>(coordinate.constant);
	}
	return alpha;
}

} // namespace

std::optional<ShaderAlpha> read_shader_alpha(
		const ShaderText &p_shader, const UniformLookup &p_uniforms, float p_default_threshold) {
	Tracer tracer(p_shader, p_uniforms);
	tracer.trace(p_shader.get_global_constants());
	for (const char *name : { "vertex", "fragment" }) {
		if (const ShaderFunction *function = p_shader.find_function(name)) {
			tracer.trace(p_shader.get_body(*function));
		}
	}
	if (tracer.has_unknown_discard) {
		return std::nullopt;
	}
	const bool has_alpha = p_shader.has_word("ALPHA");
	if (!tracer.discards.empty()) {
		return tracer.discards.size() == 1 && !has_alpha
				? read_condition(tracer.discards[0], tracer.samples)
				: std::nullopt;
	}
	const Value threshold = p_shader.has_word("ALPHA_SCISSOR_THRESHOLD")
			? tracer.get("ALPHA_SCISSOR_THRESHOLD")
			: Value{ Linear::of(double(p_default_threshold)) };
	const Value &alpha = tracer.get("ALPHA");
	if (!has_alpha || alpha.size() != 1 || threshold.size() != 1 || !threshold[0].is_constant()) {
		return std::nullopt;
	}
	return read_condition(add(alpha[0], scale(threshold[0], -1)), tracer.samples);
}

} // namespace gnomon
