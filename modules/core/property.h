#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace gnomon {

enum class PropertyType { BOOL, INT, FLOAT, ENUM, STRING, VECTOR3 };

/// BOOL: bool. INT: int64_t. FLOAT: double. ENUM and STRING: std::string. VECTOR3: glm::dvec3.
using PropertyValue = std::variant<bool, int64_t, double, std::string, glm::dvec3>;
/// Values by property name. Contains only the properties that were set; the others have the default
/// of their PropertyInfo.
using PropertyValues = std::map<std::string, PropertyValue, std::less<>>;

/// Read values of a light or a filter whose properties are all set. A name that is missing or has a
/// value of another type is a programming error.
float read_float(const PropertyValues &p_values, const std::string &p_name);
/// Reads an INT whose minimum is at least 0.
uint32_t read_count(const PropertyValues &p_values, const std::string &p_name);
bool read_switch(const PropertyValues &p_values, const std::string &p_name);
/// Reads an ENUM.
const std::string &read_choice(const PropertyValues &p_values, const std::string &p_name);

/// Declares a property. The editor's inspector, the scene file's extras, `--set` on the command
/// line and the generated docs all use this declaration.
struct PropertyInfo {
	std::string name; // snake_case; those that a technique adds to lights begin with its id
	PropertyType type = PropertyType::FLOAT;
	PropertyValue default_value;
	/// INT, FLOAT and each component of VECTOR3: "minimum,maximum,step". ENUM: "first,second,...".
	/// Otherwise empty.
	std::string hint;
	std::string tooltip; // one or two sentences: the meaning, and the effect of extreme values
	std::string unit;	 // "m", "px", "deg", or empty
	std::string group;	 // heading in the inspector
	/// A value outside the range that is also allowed and has its own meaning, such as "-1".
	std::string special;
	std::string special_meaning; // a word or two, "derived", which the inspector shows beside it
	/// ENUM: the tooltip of each choice, in the order of the hint; may be empty.
	std::vector<std::string> choice_tooltips;
	bool is_color = false; // VECTOR3: linear red, green, blue
};

/// A quality level of a technique or mask filter, for example a number of taps. The error report
/// measures each of them.
struct QualitySetting {
	std::string name; // "32 taps"; unique within the technique
	/// Values that replace those of the light: properties that the technique declares, or that
	/// every light has (penumbra_outer_width).
	PropertyValues properties;
	/// True: so slow that the report measures it only at the middle light size of each light.
	bool is_expensive = false;
};

/// A property of earlier versions. Files may still contain it; it has no effect, and saving
/// preserves it.
struct RemovedProperty {
	std::string name;
	std::string advice; // a sentence that names the replacement
};

/// The properties of one kind of object, in the order in which they are shown.
class PropertyList {
public:
	/// Appends a declaration. A name that is already declared, or a default outside the declared
	/// range, is a programming error.
	void add(PropertyInfo p_info);
	/// Replaces the declaration of the same name, at the same position. An undeclared name is a
	/// programming error.
	void replace(PropertyInfo p_info);
	void add_removed(RemovedProperty p_removed) { removed.push_back(std::move(p_removed)); }
	/// Returns null if the name is not declared.
	const PropertyInfo *find(std::string_view p_name) const;
	const std::vector<PropertyInfo> &get_properties() const { return properties; }
	const std::vector<RemovedProperty> &get_removed() const { return removed; }

private:
	/// Checks a declaration and converts its default.
	static void prepare(PropertyInfo &r_info);

	std::vector<PropertyInfo> properties;
	std::vector<RemovedProperty> removed;
};

/// Returns why the value is not allowed, for example "is 7, must be 1..3"; empty if it is allowed.
/// NaN and infinity are not allowed, nor is a value of another type, except a whole number for a
/// FLOAT and a FLOAT without fraction for an INT.
std::string check_property(const PropertyInfo &p_info, const PropertyValue &p_value);
/// Converts the value to the property's type. Only for values that check_property allows.
PropertyValue convert_property(const PropertyInfo &p_info, const PropertyValue &p_value);
/// Parses text such as "0.4", "true", "hard" or "1,2,3". Text that does not parse, or a value that
/// check_property does not allow, is an Error that begins with p_object and names the value and the
/// range.
PropertyValue parse_property(
		const PropertyInfo &p_info, std::string_view p_text, const std::string &p_object);
/// Formats a value as text that parse_property parses.
std::string format_property(const PropertyValue &p_value);
/// Converts a property's value to JSON. A vector becomes an array of three numbers.
template <typename Json> Json property_to_json(const PropertyValue &p_value) {
	return std::visit(
			[](const auto &p_held) {
				if constexpr (std::is_same_v<std::decay_t<decltype(p_held)>, glm::dvec3>) {
					return Json::array({ p_held.x, p_held.y, p_held.z });
				} else {
					return Json(p_held);
				}
			},
			p_value);
}
/// Describes the allowed values: "1..3", "-1 or 0..10000 m", "hard, 2x2 or 3x3", "true or false".
std::string describe_range(const PropertyInfo &p_info);

/// Returns the choices of an ENUM, in the order of the hint.
std::vector<std::string> get_choices(const PropertyInfo &p_info);
/// The allowed range of a number, apart from its special value. The defaults, for a property
/// without a hint, mean no limits.
struct PropertyRange {
	double minimum = -1e30;
	double maximum = 1e30;
	double step = 0.01; // step of the slider
};
/// Parses the hint of an INT, FLOAT or VECTOR3.
PropertyRange get_range(const PropertyInfo &p_info);

/// Returns the value in p_values, else the declared default. An undeclared name is a programming
/// error.
const PropertyValue &get_property(
		const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name);
/// Like get_property, for a BOOL or a FLOAT property.
bool get_bool(const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name);
double get_float(
		const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name);

} // namespace gnomon
