#include "modules/renderer/lighting.h"
#include "modules/renderer/mask_filter.h"
#include "modules/renderer/tests/render_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Replaces every mask by a quarter of the light; leaves it alone when told to.
class QuarterFilter : public MaskFilter {
public:
	static inline bool is_needed = true;

	bool plan(const ShadowTechnique::Inputs & /*p_inputs*/, TechniquePlan &r_plan) override {
		if (!is_needed) {
			r_plan.leave_out("quarter filter", "not needed");
		}
		return is_needed;
	}
	RGTexture apply(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			RGTexture /*p_mask*/) override {
		return add_constant_mask(r_graph, p_inputs.size_px, 0.25f);
	}
	std::vector<std::string> get_shader_files() const override { return {}; }
};

} // namespace

TEST_CASE("[GPU][MaskFilter] a filter changes every technique's mask, and the plan says when not") {
	RenderFixture fixture;
	SmallScene scene;
	// Any technique will do; which there are depends on the build.
	const std::string any = ShadowRegistry::get_techniques().at(0).id;
	const RenderResult before = fixture.render_mask(scene, any);
	MaskFilterRegistry::add(
			{ "quarter", "Quarter", "test", [] { return std::make_unique<QuarterFilter>(); } });
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_techniques()) {
		CAPTURE(info.id);
		const RenderResult filtered = fixture.render_mask(scene, info.id, glm::uvec2(16));
		for (size_t index = 0; index < filtered.visibility.size(); ++index) {
			CHECK(filtered.visibility[index] == 0.25f * filtered.receiver[index]);
		}
	}
	QuarterFilter::is_needed = false;
	const RenderResult left_out = fixture.render_mask(scene, any);
	CHECK(left_out.visibility == before.visibility);
	CHECK(left_out.plan.is_left_out("Light", "quarter filter"));
	MaskFilterRegistry::remove("quarter");
	CHECK(fixture.render_mask(scene, any).visibility == before.visibility);
}
