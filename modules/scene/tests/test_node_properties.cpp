#include "modules/core/error.h"
#include "modules/scene/box_mesh.h"
#include "modules/scene/node_properties.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

using namespace gnomon;

namespace {

bool has(const Node3D &p_node, const char *p_name) {
	return list_node_properties(p_node).find(p_name) != nullptr;
}

void add_test_property(const Node3D &p_node, PropertyList &r_list) {
	if (dynamic_cast<const Light3D *>(&p_node) != nullptr) {
		r_list.add({ "note_size", PropertyType::FLOAT, 2.0, "0,4,1", "Only of this test." });
	}
}

} // namespace

TEST_CASE("[NodeProperties] every property of every class can be read, set and reset") {
	const std::unique_ptr<Node3D> nodes[] = { std::make_unique<Node3D>(),
		std::make_unique<MeshInstance3D>(), std::make_unique<Light3D>(),
		std::make_unique<Camera3D>() };
	for (const std::unique_ptr<Node3D> &node : nodes) {
		CAPTURE(node->get_class_name());
		const PropertyList list = list_node_properties(*node);
		CHECK(list.get_properties().size() >= 3); // position, rotation and scale
		for (const PropertyInfo &info : list.get_properties()) {
			CAPTURE(info.name);
			CHECK(info.tooltip.size() > 10);
			CHECK_FALSE(info.group.empty());
			CHECK_FALSE(is_node_property_set(*node, info.name));
			const PropertyValue value = get_node_property(*node, info.name);
			CHECK(check_property(info, value).empty());
			set_node_property(*node, info.name, value);
			set_node_property(*node, info.name, std::nullopt);
			CHECK_FALSE(is_node_property_set(*node, info.name));
		}
	}
}

TEST_CASE("[NodeProperties] position, rotation and scale are set separately, mirrored ones too") {
	for (const double mirror : { 1.0, -1.0 }) {
		Node3D node;
		set_node_property(node, "position", glm::dvec3(1, 2, 3));
		set_node_property(node, "rotation", glm::dvec3(20, -130, 45));
		set_node_property(node, "scale", glm::dvec3(mirror * 2, 3, 4));
		const auto check = [&](const char *p_name, const glm::dvec3 &p_expected) {
			const auto value = std::get<glm::dvec3>(get_node_property(node, p_name));
			CAPTURE(p_name);
			CHECK(glm::length(value - p_expected) < 1e-9);
		};
		check("position", { 1, 2, 3 });
		check("rotation", { 20, -130, 45 });
		check("scale", { mirror * 2, 3, 4 });
		CHECK((glm::determinant(glm::dmat3(node.parent_from_node)) > 0) == (mirror > 0));
	}
}

TEST_CASE("[NodeProperties] a flat transform keeps its rotation, and a moved one its shear") {
	Node3D node;
	set_node_property(node, "rotation", glm::dvec3(20, -130, 45));
	for (const glm::dvec3 &flat :
			{ glm::dvec3(0, 3, 4), glm::dvec3(2, 0, 4), glm::dvec3(2, 3, 0) }) {
		set_node_property(node, "scale", flat);
		set_node_property(node, "scale", glm::dvec3(2, 3, 4));
		const auto rotation = std::get<glm::dvec3>(get_node_property(node, "rotation"));
		CHECK(glm::length(rotation - glm::dvec3(20, -130, 45)) < 1e-8);
	}
	set_node_property(node, "scale", glm::dvec3(0.0));
	CHECK(std::isfinite(std::get<glm::dvec3>(get_node_property(node, "rotation")).x));
	glm::dmat4 sheared(1.0);
	sheared[1] = glm::dvec4(0.5, 1, 0, 0);
	node.parent_from_node = sheared;
	set_node_property(node, "position", glm::dvec3(1, 2, 3));
	CHECK(node.parent_from_node[1] == sheared[1]);
}

TEST_CASE("[NodeProperties] a stored value of another type is converted, or reads as the default") {
	Light3D light;
	light.properties["light_size"] = int64_t(2);
	CHECK(std::get<double>(get_node_property(light, "light_size")) == 2.0);
	light.properties["light_size"] = std::string("large");
	CHECK(std::get<double>(get_node_property(light, "light_size")) == 0.1);
}

TEST_CASE("[NodeProperties] a light's type decides what is listed; the inner cone stays inside") {
	Light3D light;
	set_node_property(light, "type", std::string("directional"));
	CHECK(light.type == LightType::DIRECTIONAL);
	CHECK(has(light, "light_angular_distance"));
	CHECK_FALSE(has(light, "light_size"));
	CHECK_FALSE(has(light, "range"));
	set_node_property(light, "type", std::string("spot"));
	CHECK(has(light, "light_size"));
	CHECK(has(light, "outer_cone"));
	CHECK_FALSE(has(light, "light_angular_distance"));
	set_node_property(light, "inner_cone", 40.0);
	set_node_property(light, "outer_cone", 30.0);
	CHECK(light.inner_cone_rad < light.outer_cone_rad);
	set_node_property(light, "inner_cone", 50.0);
	CHECK(light.inner_cone_rad < light.outer_cone_rad);
}

TEST_CASE("[NodeProperties] a refused value and an unknown name are errors that state what is "
		  "allowed") {
	Light3D light;
	light.name = "Lamp";
	CHECK_THROWS_WITH_AS(set_node_property(light, "intensity", -1.0),
			doctest::Contains("Light3D \"Lamp\": intensity is -1, must be 0..1000000"), Error);
	CHECK(light.intensity == 1.0f);
	CHECK_THROWS_WITH_AS(
			set_node_property(light, "colour", 1.0), doctest::Contains("intensity"), Error);
	CHECK_THROWS_AS(set_node_property(light, "position", glm::dvec3(NAN, 0, 0)), Error);
}

TEST_CASE("[NodeProperties] other modules add properties, which the node stores by name") {
	Light3D light;
	CHECK_FALSE(has(light, "note_size"));
	add_node_property_source(&add_test_property);
	CHECK(has(light, "note_size"));
	CHECK_FALSE(has(Camera3D(), "note_size"));
	CHECK(std::get<double>(get_node_property(light, "note_size")) == 2.0);
	set_node_property(light, "note_size", 3.0);
	CHECK(is_node_property_set(light, "note_size"));
	remove_node_property_source(&add_test_property);
	CHECK(light.properties.contains("note_size"));
}

TEST_CASE("[NodeProperties] a mesh has world bounds, and a light has gizmos of its size") {
	MeshInstance3D instance;
	CHECK(instance.compute_bounds().is_empty());
	instance.surfaces.push_back({ make_box_mesh("box", glm::vec3(1, 2, 3)), nullptr });
	instance.parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(10, 0, 0));
	CHECK(instance.compute_bounds().minimum == glm::dvec3(9, -2, -3));
	CHECK(instance.compute_bounds().maximum == glm::dvec3(11, 2, 3));
	Light3D light;
	for (const LightType type : { LightType::OMNI, LightType::SPOT, LightType::DIRECTIONAL }) {
		light.type = type;
		light.properties = { { "light_size", 0.25 }, { "light_angular_distance", 60.0 } };
		std::vector<NodeGizmo> gizmos;
		light.add_gizmos(gizmos);
		REQUIRE_FALSE(gizmos.empty());
		// A directional light's gizmo is a disc of the light's apparent size, 1 m away.
		const double radius_m =
				type == LightType::DIRECTIONAL ? std::tan(glm::radians(30.0)) : 0.25;
		CHECK(gizmos[0].radius_m == doctest::Approx(radius_m));
		CHECK(gizmos[0].value == std::get<double>(get_node_property(light, gizmos[0].property)));
		// value_per_m is the change of the property per metre of the gizmo's radius.
		const double more = gizmos[0].value + 1e-6 * gizmos[0].value_per_m;
		set_node_property(light, gizmos[0].property, more);
		gizmos.clear();
		light.add_gizmos(gizmos);
		CHECK(gizmos[0].radius_m == doctest::Approx(radius_m + 1e-6).epsilon(1e-9));
	}
}

TEST_CASE("[NodeProperties] a copy has the whole state, and no children") {
	Light3D light;
	light.name = "Lamp";
	light.type = LightType::SPOT;
	light.color = { 0.5f, 0.25f, 1.0f };
	light.properties["unknown_to_all"] = std::string("preserved");
	light.parent_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(1, 2, 0));
	light.add_child(std::make_unique<Node3D>());
	const std::unique_ptr<Node3D> copy = light.copy();
	const Light3D &same = dynamic_cast<const Light3D &>(*copy);
	CHECK(same.name == "Lamp");
	CHECK(same.type == LightType::SPOT);
	CHECK(same.color == light.color);
	CHECK(same.properties == light.properties);
	CHECK(same.parent_from_node == light.parent_from_node);
	CHECK(same.children.empty());
}

TEST_CASE("[NodeProperties] a mesh's material is changed for its node alone, and can be undone") {
	auto wax = std::make_shared<Material>();
	wax->name = "Wax";
	wax->scatter = 0.25f;
	wax->file_index = 3;
	MeshInstance3D left;
	left.name = "Left";
	MeshInstance3D right;
	for (MeshInstance3D *node : { &left, &right }) {
		node->surfaces = { { nullptr, wax }, { nullptr, wax }, { nullptr, nullptr } };
	}
	const std::unique_ptr<Node3D> before = left.copy();
	CHECK(get_node_property(left, "scatter") == PropertyValue(0.25));
	CHECK(is_node_property_set(left, "scatter"));
	set_node_property(left, "scatter", 0.75);
	set_node_property(left, "shading_model", std::string("phong"));
	set_node_property(left, "attenuation_color", glm::dvec3(0.5, 0.25, 1));
	CHECK(right.surfaces[0].material == wax);
	CHECK(wax->scatter == 0.25f);
	CHECK(left.surfaces[0].material->scatter == 0.75f);
	CHECK(left.surfaces[0].material->shading_model == ShadingModel::PHONG);
	CHECK(left.surfaces[0].material->attenuation_color == glm::vec3(0.5f, 0.25f, 1));
	CHECK(left.surfaces[0].material->name == "Wax");
	CHECK(left.surfaces[0].material->file_index == 3);
	CHECK(left.surfaces[1].material == left.surfaces[0].material); // still one material
	CHECK(left.surfaces[2].material->scatter == 0.75f);
	// Setting the same value again makes no new material.
	const auto same = left.surfaces[0].material;
	set_node_property(left, "scatter", 0.75);
	CHECK(left.surfaces[0].material == same);
	set_node_property(left, "scatter", std::nullopt);
	CHECK(get_node_property(left, "scatter") == PropertyValue(0.0));
	CHECK_THROWS_AS(set_node_property(left, "scatter", 1.5), Error);
	CHECK_THROWS_AS(set_node_property(left, "thickness", -1.0), Error);
	left.assign(*before);
	CHECK(left.surfaces[0].material == wax);
	// Without a surface there is no material.
	CHECK(list_node_properties(MeshInstance3D()).find("scatter") == nullptr);
	CHECK(list_node_properties(left).find("scatter") != nullptr);
}
