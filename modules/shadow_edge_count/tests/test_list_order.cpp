// The order of a leaf's lists depends on scheduling and on the size of subgroups. Masks do not.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// edge_count with reversed lists.
class ReversedEdgeCount : public ShadowEdgeCount {
protected:
	void after_lists(RenderGraph &r_graph, const CountFrameBuffers & /*p_light*/,
			const CountLeaves &p_leaves) override {
		const uint32_t push[] = { p_leaves.leaf_capacity, 0, 0, 0 };
		add_compute_pass(r_graph, "reverse lists",
				device->get_compute_pipeline({ "reverse lists", "tests/reverse_lists.comp" }),
				{ PassBinding::read(0, p_leaves.results),
						PassBinding::write(1, p_leaves.lists, PassBuilder::Content::UPDATE),
						PassBinding::read(2, p_leaves.counts) },
				{ p_leaves.leaf_capacity, 1, 1 },
				{ reinterpret_cast<const uint8_t *>(push), sizeof(push) });
	}

public:
	static inline RenderingDevice *device = nullptr;
};

} // namespace

TEST_CASE("[GPU][EdgeCount] masks do not depend on the order of lists, bit for bit") {
	MaskFixture fixture;
	ReversedEdgeCount::device = fixture.device.get();
	for (const LightType type : { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI }) {
		for (const char *quality : { "64", "256" }) {
			CAPTURE(std::string(get_light_type_name(type)));
			CAPTURE(std::string(quality));
			SmallScene scene(type);
			add_globe(scene);
			add_mesh(scene.scene, "Second globe", make_count_sphere(0.5, 24), { 0.5, 0.9, 0.4 });
			scene.light->properties["light_size"] = 0.5;
			scene.light->properties["light_angular_distance"] = 15.0;
			scene.light->properties["edge_count_quality"] = std::string(quality);
			const MaskResult expected = render_frame(fixture, scene);
			const ReplacedTechnique<ReversedEdgeCount> technique;
			const MaskResult reversed = render_frame(fixture, scene);
			CHECK(reversed.visibility == expected.visibility);
			CHECK(std::any_of(
					reversed.timings.begin(), reversed.timings.end(), [](const PassTiming &p_pass) {
						return p_pass.name.ends_with("reverse lists");
					}));
		}
	}
}
