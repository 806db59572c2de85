#include "modules/gltf_scene/gltf_json.h"

#include "modules/core/error.h"
#include "modules/core/log.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace gnomon {

namespace {

const size_t MAX_MESSAGE_LENGTH = 300; // bytes
const size_t MAX_VALUE_LENGTH = 60;	   // bytes

/// Returns a whole number of at least 0, which may be written as "3.0"; nothing for other values.
std::optional<uint64_t> to_integer(const Json &p_value) {
	if (p_value.is_number_unsigned()) {
		return p_value.get<uint64_t>();
	}
	if (p_value.is_number_float()) {
		const double number = p_value.get<double>();
		// Up to 2^53, doubles represent every whole number.
		if (!std::signbit(number) && number <= 9007199254740992.0 && std::floor(number) == number) {
			return static_cast<uint64_t>(number);
		}
	}
	return std::nullopt;
}

std::string describe_integers(uint64_t p_minimum, uint64_t p_maximum) {
	return text("a whole number in ", p_minimum, "..", p_maximum);
}

std::string describe_indices(size_t p_count) {
	return p_count == 0 ? "absent, as there is nothing to refer to" : text("0..", p_count - 1);
}

} // namespace

void GltfMessages::report(const std::string &p_line) {
	if (logged.insert(p_line).second) {
		log_error(p_line);
	}
}

void GltfMessages::warn(const char *p_kind, std::string_view p_path, std::string_view p_problem) {
	if (logged.insert(p_kind).second) {
		log_warning(describe(p_path, p_problem));
	}
}

std::string GltfMessages::describe(std::string_view p_path, std::string_view p_problem) const {
	return to_one_line(text("\"", file, "\": ", p_path, " ", p_problem));
}

void GltfMessages::fail(std::string_view p_path, std::string_view p_problem) const {
	throw Error(describe(p_path, p_problem));
}

void GltfMessages::fail_value(
		std::string_view p_path, std::string_view p_value, std::string_view p_range) const {
	fail(p_path, text("is ", p_value, ", must be ", p_range, ". ", CORRECT_OR_EXPORT));
}

std::string to_one_line(std::string_view p_text) {
	std::string line;
	for (const char character : p_text.substr(0, MAX_MESSAGE_LENGTH)) {
		const bool is_control = static_cast<unsigned char>(character) < 0x20 || character == 0x7f;
		line += is_control ? ' ' : character;
	}
	return p_text.size() > MAX_MESSAGE_LENGTH ? line + "..." : line;
}

std::string make_name(std::string_view p_name, const std::string &p_fallback) {
	const std::string name = to_one_line(p_name);
	return name.empty() ? p_fallback : name;
}

std::string describe_json(const Json &p_value) {
	if (p_value.is_array()) {
		return text("an array of ", p_value.size());
	}
	if (p_value.is_object()) {
		return "an object";
	}
	if (p_value.is_string() && p_value.get_ref<const std::string &>().size() > MAX_VALUE_LENGTH) {
		// Truncates before the conversion, which is slow if many nodes share one very long text.
		return describe_json(p_value.get_ref<const std::string &>().substr(0, MAX_VALUE_LENGTH));
	}
	std::string description = p_value.dump(-1, ' ', false, Json::error_handler_t::replace);
	if (description.size() > MAX_VALUE_LENGTH) {
		description.resize(MAX_VALUE_LENGTH);
		description += "...";
	}
	return description;
}

void convert_whole_numbers(Json &r_json) {
	for (auto item = r_json.begin(); item != r_json.end(); ++item) {
		if (r_json.is_object() && (item.key() == "extras" || item.key() == "extensions")) {
			continue;
		}
		if (item->is_structured()) {
			convert_whole_numbers(*item);
		} else if (const std::optional<uint64_t> integer = to_integer(*item)) {
			*item = *integer;
		}
	}
}

GltfObject::GltfObject(Json &r_json, std::string p_path, GltfMessages &p_messages) :
		json(&r_json), path(std::move(p_path)), messages(&p_messages) {
	if (!json->is_object()) {
		throw Error(messages->describe(path,
				text("is ", describe_json(*json), ", must be an object. ", CORRECT_OR_EXPORT)));
	}
}

std::string GltfObject::get_member_path(std::string_view p_key) const {
	const bool needs_dot = !path.empty() && !p_key.starts_with('[');
	return path + (needs_dot ? "." : "") + std::string(p_key);
}

Json *GltfObject::find(std::string_view p_key) const {
	for (auto item = json->begin(); item != json->end(); ++item) {
		if (item.key() == p_key) {
			return item->is_null() ? nullptr : &*item;
		}
	}
	return nullptr;
}

std::optional<GltfObject> GltfObject::find_object(std::string_view p_key) const {
	Json *value = find(p_key);
	if (!value) {
		return std::nullopt;
	}
	return GltfObject(*value, get_member_path(p_key), *messages);
}

GltfObject GltfObject::require_object(std::string_view p_key) const {
	const std::optional<GltfObject> object = find_object(p_key);
	if (!object) {
		fail_at(p_key, text("is missing, must be an object. ", CORRECT_OR_EXPORT));
	}
	return *object;
}

std::optional<GltfObject> GltfObject::find_extension(std::string_view p_name) const {
	const std::optional<GltfObject> extensions = find_object("extensions");
	return extensions ? extensions->find_object(p_name) : std::nullopt;
}

std::optional<GltfObject> GltfObject::find_extras() const {
	const Json *extras = find("extras");
	return extras && extras->is_object() ? find_object("extras") : std::nullopt;
}

size_t GltfObject::get_count(std::string_view p_key) const {
	const Json *value = find(p_key);
	if (value && !value->is_array()) {
		fail_value(p_key, "an array");
	}
	return value ? value->size() : 0;
}

GltfObject GltfObject::get_element(std::string_view p_key, size_t p_index) const {
	return GltfObject((*find(p_key))[p_index],
			get_member_path(p_key) + "[" + std::to_string(p_index) + "]", *messages);
}

std::optional<uint64_t> GltfObject::find_whole_number(std::string_view p_key) const {
	const Json *value = find(p_key);
	return value ? to_integer(*value) : std::nullopt;
}

std::optional<uint64_t> GltfObject::find_integer(
		std::string_view p_key, uint64_t p_minimum, uint64_t p_maximum) const {
	const Json *value = find(p_key);
	if (!value) {
		return std::nullopt;
	}
	const std::optional<uint64_t> integer = to_integer(*value);
	if (!integer || *integer < p_minimum || *integer > p_maximum) {
		fail_value(p_key, describe_integers(p_minimum, p_maximum));
	}
	return integer;
}

uint64_t GltfObject::require_integer(
		std::string_view p_key, uint64_t p_minimum, uint64_t p_maximum) const {
	const std::optional<uint64_t> integer = find_integer(p_key, p_minimum, p_maximum);
	if (!integer) {
		fail_value(p_key, describe_integers(p_minimum, p_maximum));
	}
	return *integer;
}

std::optional<size_t> GltfObject::find_index(std::string_view p_key, size_t p_count) const {
	const Json *value = find(p_key);
	if (!value) {
		return std::nullopt;
	}
	const std::optional<uint64_t> index = to_integer(*value);
	if (!index || *index >= p_count) {
		fail_value(p_key, describe_indices(p_count));
	}
	return *index;
}

size_t GltfObject::require_index(std::string_view p_key, size_t p_count) const {
	const std::optional<size_t> index = find_index(p_key, p_count);
	if (!index) {
		fail_value(p_key, describe_indices(p_count));
	}
	return *index;
}

void GltfObject::check_indices(std::string_view p_key, size_t p_count) const {
	const size_t count = get_count(p_key);
	const Json *list = find(p_key);
	for (size_t position = 0; position < count; ++position) {
		const Json &value = (*list)[position];
		const std::optional<uint64_t> index = to_integer(value);
		if (!index || *index >= p_count) {
			fail_at(text(p_key, "[", position, "]"),
					text("is ", describe_json(value), ", must be ", describe_indices(p_count), ". ",
							CORRECT_OR_EXPORT));
		}
	}
}

bool GltfObject::find_numbers(std::string_view p_key, std::span<double> r_numbers) const {
	const Json *value = find(p_key);
	if (!value) {
		return false;
	}
	bool is_good = value->is_array() && value->size() == r_numbers.size();
	for (size_t index = 0; is_good && index < r_numbers.size(); ++index) {
		is_good = (*value)[index].is_number();
		r_numbers[index] = is_good ? (*value)[index].get<double>() : 0.0;
		is_good = is_good && std::isfinite(r_numbers[index]);
	}
	if (!is_good) {
		fail_value(p_key, text(r_numbers.size(), " finite numbers"));
	}
	return true;
}

std::string GltfObject::get_text(std::string_view p_key) const {
	const Json *value = find(p_key);
	return value && value->is_string() ? value->get<std::string>() : std::string();
}

double GltfObject::read_number(std::string_view p_key, double p_default, double p_minimum,
		double p_maximum, std::string_view p_unit) const {
	const Json *value = find(p_key);
	if (!value) {
		return p_default;
	}
	const double number = value->is_number() ? value->get<double>() : NAN;
	if (!(number >= p_minimum && number <= p_maximum)) {
		const std::string unit = p_unit.empty() ? "" : " " + std::string(p_unit);
		report_value(p_key, text(p_minimum, "..", p_maximum, unit), text(p_default));
		return p_default;
	}
	return number;
}

std::optional<size_t> GltfObject::read_index(
		std::string_view p_key, size_t p_count, std::string_view p_default) const {
	const std::optional<uint64_t> index = find_whole_number(p_key);
	if (index && *index < p_count) {
		return index;
	}
	if (find(p_key)) {
		report_value(p_key, describe_indices(p_count), p_default);
	}
	return std::nullopt;
}

std::optional<uint64_t> GltfObject::read_choice(std::string_view p_key,
		std::initializer_list<uint64_t> p_choices, std::string_view p_default) const {
	const std::optional<uint64_t> number = find_whole_number(p_key);
	if (number && std::find(p_choices.begin(), p_choices.end(), *number) != p_choices.end()) {
		return number;
	}
	if (find(p_key)) {
		std::string choices;
		for (const uint64_t choice : p_choices) {
			choices += (choices.empty() ? "" : ", ") + std::to_string(choice);
		}
		report_value(p_key, "one of " + choices, p_default);
	}
	return std::nullopt;
}

bool GltfObject::read_color(
		std::string_view p_key, double p_maximum, std::span<float, 3> r_color) const {
	const Json *value = find(p_key);
	if (!value) {
		return false;
	}
	// The fourth number of baseColorFactor is alpha, which is ignored here.
	bool is_good = value->is_array() && (value->size() == 3 || value->size() == 4);
	float color[3] = {};
	for (size_t index = 0; is_good && index < 3; ++index) {
		const double number = (*value)[index].is_number() ? (*value)[index].get<double>() : NAN;
		is_good = number >= 0 && number <= p_maximum;
		color[index] = is_good ? static_cast<float>(number) : 0.0f;
	}
	if (!is_good) {
		report_value(p_key, text("three numbers in 0..", p_maximum), "the default");
		return false;
	}
	std::memcpy(r_color.data(), color, sizeof(color));
	return true;
}

bool GltfObject::read_bool(std::string_view p_key, bool p_default) const {
	const Json *value = find(p_key);
	if (!value) {
		return p_default;
	}
	if (value->is_boolean()) {
		return value->get<bool>();
	}
	if (value->is_number() && (*value == 0 || *value == 1)) {
		return *value == 1;
	}
	report_value(p_key, "true or false", p_default ? "true" : "false");
	return p_default;
}

void GltfObject::fail_at(std::string_view p_key, std::string_view p_problem) const {
	messages->fail(get_member_path(p_key), p_problem);
}

void GltfObject::fail_value(std::string_view p_key, std::string_view p_range) const {
	const Json *value = find(p_key);
	fail_at(p_key,
			text(value ? "is " + describe_json(*value) : "is missing", ", must be ", p_range, ". ",
					CORRECT_OR_EXPORT));
}

void GltfObject::report_value(
		std::string_view p_key, std::string_view p_range, std::string_view p_default) const {
	const Json *value = find(p_key);
	messages->report(messages->describe(get_member_path(p_key),
			text("is ", value ? describe_json(*value) : "missing", ", must be ", p_range, "; ",
					p_default, " is used. Correct it in the file.")));
}

double to_shortest_decimal(float p_value) {
	char digits[32];
	const auto written = std::to_chars(digits, digits + sizeof(digits), p_value);
	double number = 0;
	std::from_chars(digits, written.ptr, number);
	return number;
}

} // namespace gnomon
