#include "modules/core/error.h"
#include "modules/scene/light_setting.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[LightSetting] property=value names no light, light.NAME.property=value does") {
	const LightSetting own = parse_light_setting("light_size=0.4");
	CHECK(own.light_name.empty());
	CHECK(own.property == "light_size");
	CHECK(own.value == "0.4");
	const LightSetting named = parse_light_setting("light.Lamp.001.light_size=a=b");
	CHECK(named.light_name == "Lamp.001");
	CHECK(named.property == "light_size");
	CHECK(named.value == "a=b");
	CHECK(parse_light_setting("words=").value.empty());
}

TEST_CASE("[LightSetting] text without an equals sign or a light's name is a UsageError") {
	for (const char *text : { "", "light_size", "light.size=1", "light..size=1", "light.=1" }) {
		CAPTURE(text);
		CHECK_THROWS_AS(parse_light_setting(text), UsageError);
	}
}
