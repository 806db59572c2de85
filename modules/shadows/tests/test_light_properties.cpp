#include "modules/scene/node_properties.h"
#include "modules/shadows/light_properties.h"
#include "modules/shadows/shadow_registry.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

using namespace gnomon;

TEST_CASE("[LightProperties] a light has the properties of its technique") {
	REQUIRE_FALSE(ShadowRegistry::get_all().empty());
	Light3D light;
	for (const ShadowTechniqueInfo &technique : ShadowRegistry::get_all()) {
		CAPTURE(technique.id);
		light.properties["shadow_technique"] = technique.id;
		const PropertyList list = list_node_properties(light);
		const PropertyList &own = ShadowRegistry::get_light_properties(technique.id);
		for (const PropertyInfo &info : own.get_properties()) {
			CHECK(list.find(info.name) != nullptr);
			CHECK(get_node_property(light, info.name) == info.default_value);
		}
		const PropertyInfo &choice = *list.find("shadow_technique");
		const std::vector<std::string> ids = get_choices(choice);
		const size_t listed_count = std::count_if(ShadowRegistry::get_all().begin(),
				ShadowRegistry::get_all().end(), [&](const ShadowTechniqueInfo &p_info) {
					return !p_info.is_example || p_info.id == technique.id;
				});
		CHECK(ids.size() == listed_count + 1); // and the default
		CHECK(ids.size() == choice.choice_tooltips.size());
	}
	set_node_property(light, "shadow_technique", std::nullopt);
	if (const ShadowTechniqueInfo *chosen = ShadowRegistry::find_default()) {
		for (const PropertyInfo &info :
				ShadowRegistry::get_light_properties(chosen->id).get_properties()) {
			CHECK_NOTHROW(get_node_property(light, info.name));
		}
	}
}

TEST_CASE("[LightProperties] properties are listed even of a light with a singular transform or an "
		  "unknown technique") {
	Light3D light;
	light.parent_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(0.0));
	light.properties["shadow_technique"] = std::string("of_another_build");
	CHECK_NOTHROW(list_node_properties(light));
	light.properties["shadow_technique"] = 3.0; // files may have values of any type
	CHECK_NOTHROW(list_node_properties(light));
	CHECK_NOTHROW(list_node_properties(MeshInstance3D()));
}

TEST_CASE("[LightProperties] without techniques shadow_technique is a plain string") {
	const std::vector<ShadowTechniqueInfo> all = ShadowRegistry::get_all();
	for (const ShadowTechniqueInfo &technique : all) {
		ShadowRegistry::remove(technique.id);
	}
	const PropertyList list = list_node_properties(Light3D());
	for (const ShadowTechniqueInfo &technique : all) {
		ShadowRegistry::add(technique);
	}
	CHECK(list.find("shadow_technique")->type == PropertyType::STRING);
}
