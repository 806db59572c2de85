// fuzz: modules=scene
// Parses arbitrary text as an argument of `--set`. An accepted value must be in range, and its
// formatted text must parse to the same value.
#include "modules/scene/light_setting.h"
#include "modules/scene/nodes.h"

#include "tests/fuzz/fuzz_target.h"

#include <cmath>

using namespace gnomon;

namespace {

/// Properties of every type, with and without a range, a unit and a special value.
const PropertyList &get_own_list() {
	static const PropertyList own = [] {
		PropertyList list;
		list.add({ "flag", PropertyType::BOOL, true, "", "Flag." });
		list.add({ "count", PropertyType::INT, 3, "1,9,1", "Count." });
		list.add({ "whole", PropertyType::INT, 0, "", "Whole number without limits." });
		list.add({ "number", PropertyType::FLOAT, 0, "", "Number without limits." });
		list.add({ "width", PropertyType::FLOAT, -1, "0,10000,0.001", "Width.", "m", "", "-1" });
		list.add({ "angle", PropertyType::FLOAT, 1, "0,1.5707963,0.1", "Angle.", "rad" });
		list.add({ "choice", PropertyType::ENUM, std::string("hard"), "hard,2x2", "Choice." });
		list.add({ "words", PropertyType::STRING, std::string(), "", "Words." });
		list.add({ "place", PropertyType::VECTOR3, glm::dvec3(0), "", "Place.", "m" });
		list.add({ "color", PropertyType::VECTOR3, glm::dvec3(1), "0,1,0.1", "Color." });
		return list;
	}();
	return own;
}

void check_number(double p_first, double p_second, const std::string &p_shown) {
	// Formatted with 9 significant digits: the relative error is at most 5e-9.
	GNOMON_ASSERT(std::abs(p_first - p_second) <= 1e-8 * std::abs(p_first), p_first,
			" is shown as ", p_shown);
}

void check_shown(const PropertyInfo &p_info, const PropertyValue &p_value) {
	GNOMON_ASSERT(check_property(p_info, p_value).empty(), "a value out of range was accepted");
	const std::string shown = format_property(p_value);
	const PropertyValue again = parse_property(p_info, shown, "Light");
	if (const double *number = std::get_if<double>(&p_value)) {
		check_number(*number, std::get<double>(again), shown);
	} else if (const glm::dvec3 *vector = std::get_if<glm::dvec3>(&p_value)) {
		for (int axis = 0; axis < 3; ++axis) {
			check_number((*vector)[axis], std::get<glm::dvec3>(again)[axis], shown);
		}
	} else {
		GNOMON_ASSERT(p_value == again, "shown as ", shown);
	}
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] {
		const LightSetting setting = parse_light_setting(to_text(p_data, p_size));
		const PropertyInfo *info = get_own_list().find(setting.property);
		info = info ? info : Light3D::get_property_list().find(setting.property);
		if (!info) {
			return;
		}
		const PropertyValue value = parse_property(*info, setting.value, "Light");
		try {
			check_shown(*info, value);
		} catch (const Error &error) {
			GNOMON_ASSERT(false, "the formatted value is refused: ", error.what());
		}
	});
}
