#include "modules/scene/node_properties.h"
#include "modules/shadows/light_properties.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/mask_filter.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

namespace {

/// Replaces every mask by a constant, 0.25 by default. Changes nothing while is_needed is false.
class QuarterFilter : public MaskFilter {
public:
	static inline bool is_needed = true;

	void get_light_properties(PropertyList &r_list) const override {
		r_list.add({ "quarter_share", PropertyType::FLOAT, 0.25, "0,1,0.25",
				"The visibility of every receiver." });
	}
	bool plan(const ShadowTechnique::Inputs & /*p_inputs*/, const PropertyValues & /*p_values*/,
			TechniquePlan &r_plan) override {
		if (!is_needed) {
			r_plan.skip("quarter filter", "not needed");
		}
		return is_needed;
	}
	RGTexture apply(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			const PropertyValues &p_values, RGTexture /*p_mask*/) override {
		return add_constant_mask(r_graph, p_inputs.size_px,
				static_cast<float>(std::get<double>(p_values.at("quarter_share"))));
	}
	std::vector<std::string> get_shader_files() const override { return {}; }
};

} // namespace

TEST_CASE("[GPU][MaskFilter] a filter adds light properties and changes every technique's mask, "
		  "unless it is skipped or removed") {
	MaskFixture fixture;
	SmallScene scene;
	// Any technique will do; which ones exist depends on the build.
	const std::string any = ShadowRegistry::get_all().at(0).id;
	const MaskResult before = fixture.render_mask(scene, any);
	MaskFilterRegistry::add({ "quarter", "Quarter", "test", "#000000",
			[] { return std::make_unique<QuarterFilter>(); } });
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		CAPTURE(info.id);
		const MaskResult filtered = fixture.render_mask(scene, info.id, glm::uvec2(16));
		for (size_t index = 0; index < filtered.visibility.size(); ++index) {
			CHECK(filtered.visibility[index] == 0.25f * filtered.receiver[index]);
		}
	}
	scene.light->properties["quarter_share"] = 0.5;
	const MaskResult half = fixture.render_mask(scene, any);
	CHECK(*std::max_element(half.visibility.begin(), half.visibility.end()) == 0.5f);
	CHECK(find_added_light_property("quarter_share") != nullptr);
	CHECK(list_node_properties(*scene.light).find("quarter_share") != nullptr);
	QuarterFilter::is_needed = false;
	const MaskResult skipped = fixture.render_mask(scene, any);
	CHECK(skipped.visibility == before.visibility);
	CHECK(skipped.plan.is_skipped("Light", "quarter filter"));
	MaskFilterRegistry::remove("quarter");
	CHECK(find_added_light_property("quarter_share") == nullptr);
	CHECK(fixture.render_mask(scene, any).visibility == before.visibility);
}
