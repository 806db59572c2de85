#include "modules/core/error.h"
#include "modules/core/property.h"

#include <doctest/doctest.h>

#include <limits>

using namespace gnomon;

namespace {

PropertyInfo make_width() {
	return { "penumbra_outer_width", PropertyType::FLOAT, -1, "0,10000,0.001", "Width.", "m",
		"Shadow", /*special=*/"-1", "derived" };
}

} // namespace

TEST_CASE("[Property] a value in the range is allowed; the refusal of another names the range") {
	const PropertyInfo width = make_width();
	CHECK(check_property(width, 0.0).empty());
	CHECK(check_property(width, int64_t(3)).empty());
	CHECK(check_property(width, 10000.0).empty());
	CHECK(check_property(width, -1.0).empty());
	CHECK(check_property(width, -0.5) == "is -0.5, must be -1 or 0..10000 m");
	CHECK_FALSE(check_property(width, 10001.0).empty());
}

TEST_CASE("[Property] NaN, infinity and other types are refused") {
	const PropertyInfo width = make_width();
	CHECK_FALSE(check_property(width, std::numeric_limits<double>::quiet_NaN()).empty());
	CHECK_FALSE(check_property(width, std::numeric_limits<double>::infinity()).empty());
	CHECK_FALSE(check_property(width, true).empty());
	CHECK_FALSE(check_property(width, std::string("wide")).empty());
}

TEST_CASE("[Property] text is parsed by type, and an error names object, value and range") {
	const PropertyInfo width = make_width();
	CHECK(std::get<double>(parse_property(width, "0.25", "Light \"Lamp\"")) == 0.25);
	const PropertyInfo filter = { "filter", PropertyType::ENUM, std::string("hard"), "hard,2x2,3x3",
		"Filter." };
	CHECK(std::get<std::string>(parse_property(filter, "2x2", "")) == "2x2");
	CHECK_THROWS_WITH_AS(parse_property(filter, "soft", "Light \"Lamp\""),
			"Light \"Lamp\": filter is soft, must be hard, 2x2 or 3x3.", Error);
	CHECK_THROWS_AS(parse_property(width, "0.25m", "x"), Error);
	CHECK_THROWS_AS(parse_property(width, "", "x"), Error);
	CHECK_THROWS_AS(parse_property(width, "nan", "x"), Error);
}

TEST_CASE("[Property] an INT accepts a FLOAT without fraction, and no other FLOAT") {
	const PropertyInfo count = { "layers", PropertyType::INT, 3, "1,3,1", "Layers." };
	CHECK(std::get<int64_t>(convert_property(count, 2.0)) == 2);
	CHECK_FALSE(check_property(count, 2.5).empty());
	CHECK_FALSE(check_property(count, 4.0).empty());
}

TEST_CASE("[Property] a property that was not set has its default") {
	PropertyList list;
	list.add(make_width());
	list.add({ "layers", PropertyType::INT, 3, "1,3,1", "Layers." });
	PropertyValues values;
	CHECK(get_float(list, values, "penumbra_outer_width") == -1.0);
	values["layers"] = int64_t(1);
	CHECK(std::get<int64_t>(get_property(list, values, "layers")) == 1);
}

TEST_CASE("[Property] a vector is three numbers that are all in the range") {
	const PropertyInfo info = { "position", PropertyType::VECTOR3, glm::dvec3(0.0), "-2,2,0.5",
		"Where it is.", "m" };
	CHECK(check_property(info, glm::dvec3(1, -2, 2)).empty());
	CHECK(check_property(info, glm::dvec3(0, 0, 2.5)) ==
			"is 0,0,2.5, must be three numbers x,y,z of -2..2 m");
	CHECK_FALSE(check_property(info, glm::dvec3(NAN, 0, 0)).empty());
	CHECK_FALSE(check_property(info, 1.0).empty());
	CHECK(std::get<glm::dvec3>(parse_property(info, "1,-2,0.25", "Node")) ==
			glm::dvec3(1, -2, 0.25));
	for (const char *text : { "1,2", "1,2,x", "1,2,3", "1,2,0,0", "" }) {
		CHECK_THROWS_AS(parse_property(info, text, "Node"), Error);
	}
	CHECK(format_property(glm::dvec3(1, -2, 0.25)) == "1,-2,0.25");
	CHECK(get_range(info).step == 0.5);
	CHECK(get_range(info).minimum == -2);
}

TEST_CASE("[Property] replacing a declaration keeps its position in the list") {
	PropertyList list;
	list.add({ "first", PropertyType::STRING, "", "", "One of several." });
	list.add({ "second", PropertyType::BOOL, true, "", "Another one." });
	list.replace({ "first", PropertyType::ENUM, /*default_value=*/{}, ",a,b", "A choice now." });
	CHECK(list.get_properties().at(0).type == PropertyType::ENUM);
	CHECK(get_choices(*list.find("first")) == std::vector<std::string>{ "", "a", "b" });
	CHECK(std::get<std::string>(list.find("first")->default_value).empty());
}

TEST_CASE(
		"[Property] an INT of magnitude above 2^53 - 1, where a double skips numbers, is refused") {
	const PropertyInfo count = { "count", PropertyType::INT, 0, "", "Count." };
	CHECK(std::get<int64_t>(parse_property(count, "9007199254740991", "x")) == 9007199254740991);
	CHECK(std::get<int64_t>(parse_property(count, "-12e3", "x")) == -12000);
	for (const char *text : { "9007199254740992", "-7e300", "9223372036854775807" }) {
		CAPTURE(text);
		CHECK_THROWS_WITH_AS(parse_property(count, text, "x"),
				doctest::Contains("at most 9007199254740991"), Error);
	}
	CHECK_FALSE(check_property(count, std::numeric_limits<int64_t>::max()).empty());
}
