#include "modules/gltf_scene/tests/gltf_test_files.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace gnomon;

namespace {

Json &get_light_json(Json &r_json) {
	return r_json["extensions"]["KHR_lights_punctual"]["lights"][0];
}

/// Loads a document and returns the value of a property of its light, or -99 if it is not set.
double load_number(const GltfTestFolder &p_folder, const Json &p_json, const char *p_name) {
	const auto scene = p_folder.load(p_json);
	const Light3D &light = *scene->find_nodes<Light3D>().at(0);
	const auto found = light.properties.find(p_name);
	return found == light.properties.end() ? -99.0 : std::get<double>(found->second);
}

/// Adds an area light to the light's node.
Json add_area(Json p_json, const Json &p_area) {
	p_json["extensions"]["EXT_lights_area"]["lights"] = Json::array();
	p_json["extensions"]["EXT_lights_area"]["lights"].push_back(p_area);
	p_json["nodes"][0]["extensions"]["EXT_lights_area"] = { { "light", 0 } };
	return p_json;
}

} // namespace

TEST_CASE("[GltfLights] type, colour, intensity, range and cones are read") {
	GltfTestFolder folder;
	Json json = make_spot_light_document();
	get_light_json(json)["range"] = 7;
	const auto scene = folder.load(json);
	const Light3D &light = *scene->find_nodes<Light3D>().at(0);
	CHECK(light.name == "Lamp");
	CHECK(light.type == LightType::SPOT);
	CHECK(light.color == glm::vec3(1, 0.5f, 0.25f));
	CHECK(light.intensity == 20);
	CHECK(light.range_m == 7);
	CHECK(light.inner_cone_rad == 0.1f);
	CHECK(light.outer_cone_rad == 0.5f);
	CHECK(light.file_path == "lights[0]");
	CHECK(light.properties.empty());
}

TEST_CASE("[GltfLights] a spot light without a spot object has the default cones") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_spot_light_document();
	get_light_json(json).erase("spot");
	const auto scene = folder.load(json);
	CHECK(scene->find_nodes<Light3D>().at(0)->outer_cone_rad ==
			doctest::Approx(std::numbers::pi / 4));
	CHECK(log.errors.empty());
}

TEST_CASE("[GltfLights] a light has the name of its node, else of its definition, else a number") {
	GltfTestFolder folder;
	Json json = make_spot_light_document();
	json["nodes"][0].erase("name");
	CHECK(folder.load(json)->find_nodes<Light3D>().at(0)->name == "Bulb");
	get_light_json(json).erase("name");
	CHECK(folder.load(json)->find_nodes<Light3D>().at(0)->name == "Light 0");
}

TEST_CASE("[GltfLights] size and angle are read under each of their names") {
	GltfTestFolder folder;
	for (const char *name : { "light_size", "radius", "shadow_soft_size" }) {
		Json json = make_spot_light_document();
		get_light_json(json)["extras"][name] = 0.25;
		CHECK(load_number(folder, json, "light_size") == 0.25);
	}
	Json json = make_spot_light_document();
	get_light_json(json)["extras"]["angle"] = 0.5;
	CHECK(load_number(folder, json, "light_angular_distance") ==
			doctest::Approx(0.5 * 180 / std::numbers::pi).epsilon(1e-12));
	json = add_area(make_spot_light_document(), { { "type", "disk" }, { "size", 0.5 } });
	CHECK(load_number(folder, json, "light_size") == 0.25);
	json = add_area(make_spot_light_document(), { { "type", "disk" } });
	CHECK(load_number(folder, json, "light_size") == 0.5);
}

TEST_CASE("[GltfLights] an area light overrides the light's extras, which override the node's") {
	GltfTestFolder folder;
	Json json = make_spot_light_document();
	json["nodes"][0]["extras"] = { { "light_size", 0.3 }, { "penumbra_outer_width", 0.6 } };
	CHECK(load_number(folder, json, "light_size") == 0.3);
	get_light_json(json)["extras"]["shadow_soft_size"] = 0.2;
	CHECK(load_number(folder, json, "light_size") == 0.2);
	get_light_json(json)["extras"]["light_size"] = 0.15;
	CHECK(load_number(folder, json, "light_size") == 0.15);
	json = add_area(json, { { "type", "disk" }, { "size", 0.2 } });
	CHECK(load_number(folder, json, "light_size") == 0.1);
	CHECK(load_number(folder, json, "penumbra_outer_width") == 0.6);
}

TEST_CASE("[GltfLights] an empty area light does not shift the indices of those after it") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = add_area(make_spot_light_document(), { { "type", "disk" }, { "size", 0.5 } });
	Json &lights = json["extensions"]["EXT_lights_area"]["lights"];
	lights.insert(lights.begin(), Json::object());
	json["nodes"][0]["extensions"]["EXT_lights_area"]["light"] = 1;
	const auto scene = folder.load(json);
	Light3D &light = *scene->find_nodes<Light3D>().at(0);
	CHECK(std::get<double>(light.properties.at("light_size")) == 0.25);
	light.properties["light_size"] = 0.75;
	save_gltf(*scene, folder.path / "again.gltf");
	const auto again = load_gltf(folder.path / "again.gltf");
	CHECK(std::get<double>(again->find_nodes<Light3D>().at(0)->properties.at("light_size")) ==
			0.75);
	json["nodes"][0]["extensions"]["EXT_lights_area"]["light"] = 0;
	CHECK(folder.load(json)->find_nodes<Light3D>().at(0)->properties.empty());
}

TEST_CASE("[GltfLights] penumbra widths may be -1; invalid values are reported and ignored") {
	GltfTestFolder folder;
	Json json = make_spot_light_document();
	Json &extras = get_light_json(json)["extras"];
	extras = { { "penumbra_outer_width", -1 }, { "penumbra_inner_width", 0 } };
	CHECK(load_number(folder, json, "penumbra_outer_width") == -1);
	CHECK(load_number(folder, json, "penumbra_inner_width") == 0);
	const std::vector<std::pair<const char *, Json>> bad = { { "penumbra_outer_width", -2 },
		{ "penumbra_inner_width", 10001 }, { "light_size", -1 }, { "light_size", "big" },
		{ "light_size", Json::array({ 1, 2 }) }, { "light_angular_distance", 91 },
		{ "shadow_enabled", 2 }, { "shadow_enabled", "yes" }, { "shadow_technique", 3 } };
	for (const auto &[name, value] : bad) {
		CAPTURE(name);
		GltfTestLog log;
		extras = Json::object();
		extras[name] = value;
		json["nodes"][0]["extras"] = { { "light_size", 0.3 } };
		const auto scene = folder.load(json);
		CHECK_FALSE(scene->find_nodes<Light3D>().at(0)->properties.contains(name));
		REQUIRE(log.errors.size() == 1);
		// The line begins with the path in quotes.
		CHECK(log.errors[0].find((folder.path / "scene.gltf").string()) == 1);
		CHECK(GltfTestLog::contains(log.errors, "lights[0].extras." + std::string(name) + " is "));
		CHECK(GltfTestLog::contains(log.errors, "must be "));
	}
}

TEST_CASE("[GltfLights] an invalid value of an alias is reported under the alias's name") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_spot_light_document();
	// 3 rad are 172 degrees; light_angular_distance is at most 90.
	get_light_json(json)["extras"] = { { "angle", 3 }, { "radius", 20000 } };
	folder.load(json);
	CHECK(GltfTestLog::contains(log.errors, "lights[0].extras.angle is 3"));
	CHECK(GltfTestLog::contains(
			log.errors, "lights[0].extras.radius is 20000, must be 0..10000 m"));
}

TEST_CASE("[GltfLights] a flag can be a boolean or a number") {
	GltfTestFolder folder;
	Json json = make_spot_light_document();
	for (const Json &value : { Json(0), Json(false) }) {
		get_light_json(json)["extras"] = { { "shadow_enabled", value } };
		const auto scene = folder.load(json);
		CHECK(std::get<bool>(scene->find_nodes<Light3D>().at(0)->properties.at("shadow_enabled")) ==
				false);
	}
}

TEST_CASE("[GltfLights] invalid values of punctual lights are reported and replaced by defaults") {
	const std::vector<std::pair<const char *, Json>> bad = { { "range", 0 }, { "range", -1 },
		{ "range", "far" }, { "intensity", -1 }, { "intensity", 1e300 },
		{ "color", Json::array({ 1, 1 }) }, { "color", Json::array({ 1, -1, 1 }) },
		{ "spot", { { "outerConeAngle", 2 } } }, { "spot", { { "outerConeAngle", 0 } } },
		{ "spot", { { "outerConeAngle", 0.5 }, { "innerConeAngle", 0.51 } } }, { "spot", 3 } };
	GltfTestFolder folder;
	for (const auto &[name, value] : bad) {
		CAPTURE(name);
		CAPTURE(value.dump());
		GltfTestLog log;
		Json json = make_spot_light_document();
		get_light_json(json)[name] = value;
		const auto scene = folder.load(json);
		const Light3D &light = *scene->find_nodes<Light3D>().at(0);
		CHECK(log.errors.size() == 1);
		CHECK(GltfTestLog::contains(log.errors, name));
		CHECK(light.range_m == 0);
		CHECK(light.inner_cone_rad < light.outer_cone_rad);
		CHECK(light.intensity == (std::string(name) == "intensity" ? 1.0f : 20.0f));
	}
}

TEST_CASE("[GltfLights] a spot light with equal cone angles keeps its hard edge") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_spot_light_document();
	get_light_json(json)["spot"] = { { "outerConeAngle", 0.5 }, { "innerConeAngle", 0.5 } };
	const auto scene = folder.load(json);
	const Light3D &light = *scene->find_nodes<Light3D>().at(0);
	CHECK(log.errors.empty());
	CHECK(light.outer_cone_rad == 0.5f);
	CHECK(light.inner_cone_rad < 0.5f);
	CHECK(light.inner_cone_rad == doctest::Approx(0.5f));
}

TEST_CASE("[GltfLights] a light of unknown type is skipped; a missing light is an error") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_spot_light_document();
	get_light_json(json)["type"] = "laser";
	CHECK(folder.load(json)->find_nodes<Light3D>().empty());
	CHECK(GltfTestLog::contains(log.errors, "lights[0].type is \"laser\""));
	json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 1;
	CHECK(get_load_error(folder, json)
					.find("nodes[0].extensions.KHR_lights_punctual.light is 1, must be 0..0") !=
			std::string::npos);
}

TEST_CASE("[GltfLights] technique properties are checked if they are registered, else preserved") {
	// A property of an invented technique with the id "later".
	static const PropertyInfo TAPS = { "later_taps", PropertyType::INT, int64_t(16), "1,64,1",
		"Taps." };
	GltfLoadOptions options;
	options.find_technique_property = [](std::string_view p_name) {
		return p_name == TAPS.name ? &TAPS : nullptr;
	};
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_spot_light_document();
	get_light_json(json)["extras"] =
			Json::parse(R"({"later_taps": 8.0, "later_bias": 0.5, "later_on": true,
		"later_mode": "soft", "later_count": 3, "later_list": [1, 2]})");
	const auto scene = folder.load(json, options);
	const PropertyValues &values = scene->find_nodes<Light3D>().at(0)->properties;
	CHECK(values ==
			PropertyValues{ { "later_taps", int64_t(8) }, { "later_bias", 0.5 },
					{ "later_on", true }, { "later_mode", std::string("soft") },
					{ "later_count", int64_t(3) } });
	CHECK(log.errors.empty());
	get_light_json(json)["extras"] = { { "later_taps", 65 } };
	// Not used: the light's own value hides it, even though that is invalid.
	json["nodes"][0]["extras"] = { { "later_taps", 4 } };
	CHECK(folder.load(json, options)->find_nodes<Light3D>().at(0)->properties.empty());
	CHECK(GltfTestLog::contains(
			log.errors, "lights[0].extras.later_taps is 65, must be 1..64; 16 is used"));
}

TEST_CASE("[GltfLights] a Blender light in a child node has the properties of its parent") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_empty_document();
	json["extensions"] = make_spot_light_document()["extensions"];
	json["nodes"] = Json::parse(R"([
		{"name": "Lamp", "translation": [4, 5, 1], "rotation": [0.169, 0.272, 0.756, 0.571],
		 "children": [1], "extras": {"light_size": 0.35, "shadow_enabled": 1}},
		{"name": "Lamp_Orientation", "rotation": [-0.70710678, 0, 0, 0.70710678],
		 "extensions": {"KHR_lights_punctual": {"light": 0}}},
		{"name": "Camera", "translation": [7, 5, 6], "children": [3]},
		{"name": "Camera_Orientation", "rotation": [-0.70710678, 0, 0, 0.70710678], "camera": 0}])");
	json["cameras"] = Json::parse(R"([{"name": "Camera", "type": "perspective",
		"perspective": {"aspectRatio": 1.77, "yfov": 0.4, "zfar": 100, "znear": 0.1}}])");
	json["scenes"] = Json::parse(R"([{"name": "Scene", "nodes": [0, 2]}])");
	const auto scene = folder.load(json);
	const Light3D &light = *scene->find_nodes<Light3D>().at(0);
	CHECK(std::get<double>(light.properties.at("light_size")) == 0.35);
	CHECK(std::get<bool>(light.properties.at("shadow_enabled")));
	CHECK(light.compute_world_from_node()[3].x == 4);
	CHECK(scene->find_nodes<Camera3D>().at(0)->compute_world_from_node()[3].y == 5);
	// Blender has z up and glTF y up. The camera of an object without rotation looks down.
	const glm::dmat4 world_from_camera =
			scene->find_nodes<Camera3D>()[0]->compute_world_from_node();
	CHECK(-world_from_camera[2].y == doctest::Approx(-1.0));
	CHECK(log.errors.empty());
}
