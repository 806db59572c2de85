#include "modules/core/property.h"

#include "modules/core/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

namespace gnomon {

namespace {

/// Largest magnitude of an INT. Numbers are parsed as double, which cannot represent every larger
/// whole number.
constexpr double MAX_EXACT_INTEGER = 9007199254740991.0; // 2^53 - 1

std::vector<std::string> split(const std::string &p_text) {
	std::vector<std::string> parts;
	std::stringstream stream(p_text);
	for (std::string part; std::getline(stream, part, ',');) {
		parts.push_back(part);
	}
	return parts;
}

std::optional<double> parse_number(std::string_view p_text) {
	double number = 0;
	const char *end = p_text.data() + p_text.size();
	const std::from_chars_result result = std::from_chars(p_text.data(), end, number);
	if (p_text.empty() || result.ec != std::errc() || result.ptr != end) {
		return std::nullopt;
	}
	return number;
}

std::optional<double> get_number(const PropertyValue &p_value) {
	if (const double *number = std::get_if<double>(&p_value)) {
		return *number;
	}
	if (const int64_t *number = std::get_if<int64_t>(&p_value)) {
		return static_cast<double>(*number);
	}
	return std::nullopt;
}

/// Returns whether a number is finite and in the declared range. Ignores the special value.
bool is_in_range(const PropertyInfo &p_info, double p_number) {
	const PropertyRange range = get_range(p_info);
	const bool has_range = !p_info.hint.empty();
	return std::isfinite(p_number) &&
			(!has_range || (p_number >= range.minimum && p_number <= range.maximum));
}

std::optional<glm::dvec3> parse_vector(std::string_view p_text) {
	const std::vector<std::string> parts = split(std::string(p_text));
	glm::dvec3 vector(0.0);
	for (size_t axis = 0; axis < 3; ++axis) {
		const std::optional<double> number =
				parts.size() == 3 ? parse_number(parts[axis]) : std::nullopt;
		if (!number) {
			return std::nullopt;
		}
		vector[int(axis)] = *number;
	}
	return vector;
}

std::string describe_refusal(const PropertyInfo &p_info, const PropertyValue &p_value) {
	return text("is ", format_property(p_value), ", must be ", describe_range(p_info));
}

} // namespace

float read_float(const PropertyValues &p_values, const std::string &p_name) {
	return static_cast<float>(std::get<double>(p_values.at(p_name)));
}

uint32_t read_count(const PropertyValues &p_values, const std::string &p_name) {
	return static_cast<uint32_t>(std::get<int64_t>(p_values.at(p_name)));
}

bool read_switch(const PropertyValues &p_values, const std::string &p_name) {
	return std::get<bool>(p_values.at(p_name));
}

const std::string &read_choice(const PropertyValues &p_values, const std::string &p_name) {
	return std::get<std::string>(p_values.at(p_name));
}

void PropertyList::add(PropertyInfo p_info) {
	GNOMON_ASSERT(!find(p_info.name), "property ", p_info.name, " is declared twice");
	prepare(p_info);
	properties.push_back(std::move(p_info));
}

void PropertyList::replace(PropertyInfo p_info) {
	const auto found = std::find_if(properties.begin(), properties.end(),
			[&](const PropertyInfo &p_one) { return p_one.name == p_info.name; });
	GNOMON_ASSERT(found != properties.end(), "property ", p_info.name, " is not declared");
	prepare(p_info);
	*found = std::move(p_info);
}

void PropertyList::prepare(PropertyInfo &r_info) {
	// An ENUM whose default is no string (index 3 of PropertyValue) defaults to its first choice.
	if (r_info.type == PropertyType::ENUM && r_info.default_value.index() != 3) {
		r_info.default_value = split(r_info.hint).at(0);
	}
	// Converts the default's type, so that a FLOAT may be declared with the literal 3.
	const std::string refusal = check_property(r_info, r_info.default_value);
	GNOMON_ASSERT(refusal.empty(), "default of property ", r_info.name, " ", refusal);
	r_info.default_value = convert_property(r_info, r_info.default_value);
}

const PropertyInfo *PropertyList::find(std::string_view p_name) const {
	for (const PropertyInfo &info : properties) {
		if (info.name == p_name) {
			return &info;
		}
	}
	return nullptr;
}

std::string check_property(const PropertyInfo &p_info, const PropertyValue &p_value) {
	switch (p_info.type) {
		case PropertyType::BOOL:
			return std::holds_alternative<bool>(p_value) ? "" : describe_refusal(p_info, p_value);
		case PropertyType::STRING:
			return std::holds_alternative<std::string>(p_value) ? ""
																: describe_refusal(p_info, p_value);
		case PropertyType::ENUM: {
			const std::string *chosen = std::get_if<std::string>(&p_value);
			for (const std::string &name : split(p_info.hint)) {
				if (chosen && *chosen == name) {
					return "";
				}
			}
			return describe_refusal(p_info, p_value);
		}
		case PropertyType::INT:
		case PropertyType::FLOAT: {
			const std::optional<double> number = get_number(p_value);
			if (!number || !std::isfinite(*number)) {
				return describe_refusal(p_info, p_value);
			}
			if (p_info.type == PropertyType::INT &&
					(std::floor(*number) != *number || std::abs(*number) > MAX_EXACT_INTEGER)) {
				return describe_refusal(p_info, p_value);
			}
			if (!p_info.special.empty() && *number == *parse_number(p_info.special)) {
				return "";
			}
			return is_in_range(p_info, *number) ? "" : describe_refusal(p_info, p_value);
		}
		case PropertyType::VECTOR3: {
			const glm::dvec3 *vector = std::get_if<glm::dvec3>(&p_value);
			const bool is_allowed = vector && is_in_range(p_info, vector->x) &&
					is_in_range(p_info, vector->y) && is_in_range(p_info, vector->z);
			return is_allowed ? "" : describe_refusal(p_info, p_value);
		}
	}
	return "has an unknown type";
}

PropertyValue convert_property(const PropertyInfo &p_info, const PropertyValue &p_value) {
	const std::optional<double> number = get_number(p_value);
	if (number && p_info.type == PropertyType::INT) {
		return static_cast<int64_t>(*number);
	}
	if (number && p_info.type == PropertyType::FLOAT) {
		return *number;
	}
	return p_value;
}

PropertyValue parse_property(
		const PropertyInfo &p_info, std::string_view p_text, const std::string &p_object) {
	PropertyValue value = std::string(p_text);
	if (p_info.type == PropertyType::BOOL && (p_text == "true" || p_text == "false")) {
		value = p_text == "true";
	} else if (p_info.type == PropertyType::INT || p_info.type == PropertyType::FLOAT) {
		if (const std::optional<double> number = parse_number(p_text)) {
			value = *number;
		}
	} else if (p_info.type == PropertyType::VECTOR3) {
		if (const std::optional<glm::dvec3> vector = parse_vector(p_text)) {
			value = *vector;
		}
	}
	const std::string refusal = check_property(p_info, value);
	if (!refusal.empty()) {
		fail(p_object, ": ", p_info.name, " ", refusal, ".");
	}
	return convert_property(p_info, value);
}

std::string format_property(const PropertyValue &p_value) {
	if (const bool *flag = std::get_if<bool>(&p_value)) {
		return *flag ? "true" : "false";
	}
	return std::visit(
			[](const auto &p_held) -> std::string {
				if constexpr (std::is_same_v<std::decay_t<decltype(p_held)>, glm::dvec3>) {
					return text(p_held.x, ",", p_held.y, ",", p_held.z);
				} else {
					return text(p_held);
				}
			},
			p_value);
}

std::vector<std::string> get_choices(const PropertyInfo &p_info) {
	return split(p_info.hint);
}

PropertyRange get_range(const PropertyInfo &p_info) {
	const std::vector<std::string> parts = split(p_info.hint);
	PropertyRange range;
	double *const values[] = { &range.minimum, &range.maximum, &range.step };
	for (size_t index = 0; index < std::size(values) && index < parts.size(); ++index) {
		*values[index] = parse_number(parts[index]).value_or(*values[index]);
	}
	return range;
}

std::string describe_range(const PropertyInfo &p_info) {
	if (p_info.type == PropertyType::BOOL) {
		return "true or false";
	}
	if (p_info.type == PropertyType::STRING) {
		return "text";
	}
	const std::vector<std::string> parts = split(p_info.hint);
	std::string description;
	if (p_info.type == PropertyType::ENUM) {
		for (size_t index = 0; index < parts.size(); ++index) {
			description += (index == 0								   ? ""
										   : index + 1 == parts.size() ? " or "
																	   : ", ") +
					parts[index];
		}
		return description;
	}
	description = p_info.type == PropertyType::INT
			? text("a whole number, in magnitude at most ", static_cast<int64_t>(MAX_EXACT_INTEGER))
			: "a finite number";
	if (parts.size() >= 2) {
		description = parts[0] + ".." + parts[1];
	}
	if (p_info.type == PropertyType::VECTOR3) {
		description =
				"three numbers x,y,z" + (parts.size() >= 2 ? " of " + description : std::string());
	}
	if (!p_info.special.empty()) {
		description = p_info.special + " or " + description;
	}
	return p_info.unit.empty() ? description : description + " " + p_info.unit;
}

const PropertyValue &get_property(
		const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name) {
	const PropertyInfo *info = p_list.find(p_name);
	GNOMON_ASSERT(info, "property ", p_name, " is not declared");
	const auto found = p_values.find(p_name);
	return found != p_values.end() ? found->second : info->default_value;
}

bool get_bool(const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name) {
	return std::get<bool>(get_property(p_list, p_values, p_name));
}

double get_float(
		const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name) {
	return std::get<double>(get_property(p_list, p_values, p_name));
}

} // namespace gnomon
