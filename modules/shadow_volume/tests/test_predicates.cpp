// Tests that predicates decide which volumes are drawn. Images of culled scenes cannot show it,
// because the shadows of culled casters are within those of others anyway.

#include "modules/shadow_volume/tests/volume_fixture.h"
#include "modules/shadow_volume/volume_passes.h"

using namespace gnomon;

namespace {

/// Draws the volumes of all casters with all predicates 0.
class NothingDrawn : public ShadowTechnique {
public:
	static inline VolumeExtruder extruder = VolumeExtruder::COMPUTE;

	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues & /*p_properties*/,
			std::vector<LightView> &r_views) const override {
		r_views = build_listing_views(p_light, p_scene);
	}
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override {
		instances = list_casters(p_inputs, r_plan);
	}
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override {
		VolumeSettings settings;
		settings.extruder = extruder;
		casters = build_volume_casters(p_inputs, settings, instances);
		CHECK(casters.casters.size() == 2);
		DrawPredicates predicates;
		predicates.instances = std::make_shared<const std::vector<uint32_t>>(instances);
		predicates.words = r_graph.create_buffer({ "no casters", /*size_bytes=*/64,
				BufferUsage::COPY_TARGET | BufferUsage::CONDITIONAL | BufferUsage::STORAGE });
		r_graph.add_pass("none is seen")
				.writes(predicates.words, Access::COPY_WRITE)
				.execute([words = predicates.words](PassContext &p_context) {
					p_context.commands.clear_buffer(p_context.get(words));
				});
		const VolumeTargets targets = add_volume_receivers_pass(r_graph, p_inputs);
		add_volume_passes(r_graph, p_inputs, settings, casters, predicates, targets, edges);
		return targets.mask;
	}
	std::vector<std::string> get_shader_files() const override { return {}; }

private:
	std::vector<uint32_t> instances;
	VolumeCasters casters;
	CachedEdges edges;
};

} // namespace

TEST_CASE("[GPU][ShadowVolume] casters whose predicate is 0 are not drawn, with compute or "
		  "geometry shaders") {
	MaskFixture fixture;
	if (!fixture.device->get_features().conditional_rendering) {
		MESSAGE("this device has no conditional rendering");
		return;
	}
	ShadowTechniqueInfo info = *ShadowRegistry::find("shadow_volume");
	info.id = "nothing_seen";
	info.color = "#010101";
	info.make = [] { return std::make_unique<NothingDrawn>(); };
	ShadowRegistry::add(info);
	SmallScene scene;
	for (const VolumeExtruder extruder :
			{ VolumeExtruder::COMPUTE, VolumeExtruder::GEOMETRY_SHADER }) {
		NothingDrawn::extruder = extruder;
		const MaskResult frame = fixture.render_mask(scene, "nothing_seen");
		CHECK(frame.visibility == frame.receiver); // lit wherever there is a receiver
	}
	ShadowRegistry::remove("nothing_seen");
}
