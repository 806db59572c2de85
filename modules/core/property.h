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
/// Name to value. Holds only what was set; what is absent has its PropertyInfo's default.
using PropertyValues = std::map<std::string, PropertyValue, std::less<>>;

/// One declaration drives the editor's inspector, the scene file's extras, `--set` on the command
/// line, the generated docs and the test that every property has a tooltip.
struct PropertyInfo {
	std::string name; // snake_case; a technique's properties begin with its id
	PropertyType type = PropertyType::FLOAT;
	PropertyValue default_value;
	/// INT, FLOAT and each component of VECTOR3: "minimum,maximum,step". ENUM: "first,second,...".
	/// Otherwise empty.
	std::string hint;
	std::string tooltip; // one sentence or two: meaning, and what happens at the edges
	std::string unit;	 // "m", "px", "deg", or empty
	std::string group;	 // heading in the inspector
	/// A value outside the range that is also allowed and has its own meaning: "-1" for "derived".
	std::string special;
	/// ENUM: the tooltip of each choice, in the order of the hint; may be empty.
	std::vector<std::string> choice_tooltips;
	bool is_color = false; // VECTOR3: linear red, green, blue
};

/// One step of a technique's ladder from cheap to good, which the error report measures.
struct QualitySetting {
	std::string name; // "32 taps"; unique within the technique
	/// Properties of the technique or of every light (penumbra_outer_width); they override the
	/// light's own.
	PropertyValues properties;
	/// The setting is so slow that the report measures it at one light size only.
	bool is_expensive = false;
};

/// A property of earlier versions: files may still contain it, nothing reads it, and saving
/// preserves it.
struct RemovedProperty {
	std::string name;
	std::string advice; // a sentence: what replaced it
};

/// The properties of one kind of object, in the order in which they are shown.
class PropertyList {
public:
	/// A name that is present already, or a default that its own range refuses, is a programming
	/// error.
	void add(PropertyInfo p_info);
	/// Declares a property again, at its position. A name that the list lacks is a programming
	/// error.
	void replace(PropertyInfo p_info);
	void add_removed(RemovedProperty p_removed) { removed.push_back(std::move(p_removed)); }
	const PropertyInfo *find(std::string_view p_name) const;
	const std::vector<PropertyInfo> &get_properties() const { return properties; }
	const std::vector<RemovedProperty> &get_removed() const { return removed; }

private:
	/// Checks a declaration and converts its default.
	static void prepare(PropertyInfo &r_info);

	std::vector<PropertyInfo> properties;
	std::vector<RemovedProperty> removed;
};

/// Why the value is refused, or empty when it is allowed: "is 7, must be 1..3". NaN and infinity
/// are refused, and so is a value of another type (an INT is allowed where a FLOAT is expected,
/// and a FLOAT without fraction where an INT is).
std::string check_property(const PropertyInfo &p_info, const PropertyValue &p_value);
/// The value converted to the property's type. Only for values that check_property allows.
PropertyValue convert_property(const PropertyInfo &p_info, const PropertyValue &p_value);
/// Reads "0.4", "true", "hard", "1,2,3". Text that does not parse, or that check_property refuses,
/// is an Error that begins with p_object and names the value and the range.
PropertyValue parse_property(
		const PropertyInfo &p_info, std::string_view p_text, const std::string &p_object);
/// Formats a value so that parse_property reads it back.
std::string format_property(const PropertyValue &p_value);
/// A property's value as JSON: a vector is a list of three numbers.
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
/// The allowed values in words: "1..3", "-1 or 0..10000 m", "hard, 2x2 or 3x3", "true or false".
std::string describe_range(const PropertyInfo &p_info);

/// The names of an ENUM, in order.
std::vector<std::string> get_choices(const PropertyInfo &p_info);
/// The allowed range of a number, apart from its special value. Without a hint there are no limits.
struct PropertyRange {
	double minimum = -1e30;
	double maximum = 1e30;
	double step = 0.01; // step of the slider
};
PropertyRange get_range(const PropertyInfo &p_info);

/// The value that is set, else the declared default. A name that the list lacks is a programming
/// error.
const PropertyValue &get_property(
		const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name);
bool get_bool(const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name);
double get_float(
		const PropertyList &p_list, const PropertyValues &p_values, std::string_view p_name);

} // namespace gnomon
