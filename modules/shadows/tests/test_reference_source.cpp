#include "modules/shadows/mask_filter.h"
#include "modules/shadows/reference_source.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

// Tests the ReferenceSource of the build's reference technique, if it has one.

using namespace gnomon;

namespace {

const int64_t SAMPLE_COUNT = 64;

struct TracedScene {
	SmallScene scene;
	MaskResult result;
	ReferenceRequest trace_request;

	TracedScene(MaskFixture &r_fixture, const ShadowTechniqueInfo &p_reference, LightType p_type) :
			scene(p_type) {
		scene.light->properties[p_reference.id + "_samples"] = SAMPLE_COUNT;
		MaskRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(96, 64);
		request.technique_override = p_reference.id;
		request.light = scene.light->name;
		request.wants_surfaces = true;
		result = r_fixture.render(request);
		trace_request = { request.scene, request.scene->lights.front(), request.size_px,
			result.surfaces, result.receiver, find_surface_spread() };
	}
};

} // namespace

TEST_CASE("[GPU] ReferenceSource gives the same mask as the reference technique, bit for bit") {
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	if (reference == nullptr) {
		return; // a build without one
	}
	REQUIRE(reference->make_reference_source);
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		CAPTURE(int(type));
		const TracedScene traced(fixture, *reference, type);
		float last_progress = 0;
		const ReferenceResult cpu_result =
				reference->make_reference_source(traced.trace_request)
						->trace(uint32_t(SAMPLE_COUNT), std::atomic<bool>(false),
								[&](float p_fraction) { last_progress = p_fraction; });
		CHECK(cpu_result.is_complete);
		CHECK(cpu_result.visibility == traced.result.visibility);
		CHECK(cpu_result.standard_error == traced.result.standard_error);
		CHECK(cpu_result.penumbra_pixel_count > 20);
		CHECK(last_progress == 1.0f);
	}
}

TEST_CASE("[GPU] A cancelled reference is not complete, and a later run is") {
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	if (reference == nullptr) {
		return;
	}
	MaskFixture fixture;
	const TracedScene traced(fixture, *reference, LightType::SPOT);
	const std::unique_ptr<ReferenceSource> source =
			reference->make_reference_source(traced.trace_request);
	CHECK(!source->trace(16, std::atomic<bool>(true), {}).is_complete);
	CHECK(source->trace(16, std::atomic<bool>(false), {}).is_complete);
}

TEST_CASE("The hash of a reference depends on size, light, casters and camera, not on technique") {
	SmallScene scene;
	const glm::uvec2 SIZE_PX(64);
	const auto hash = [&](glm::uvec2 p_size_px) {
		const auto snapshot = scene.snap();
		return compute_reference_hash(*snapshot, snapshot->lights.front(), p_size_px);
	};
	const uint64_t first = hash(SIZE_PX);
	scene.light->properties["shadow_technique"] = std::string("another");
	scene.light->properties["penumbra_outer_width"] = 0.3;
	scene.light->intensity *= 2.0f;
	CHECK(hash(SIZE_PX) == first);
	CHECK(hash(glm::uvec2(64, 63)) != first);
	scene.light->properties["light_size"] = 0.21;
	const uint64_t larger = hash(SIZE_PX);
	CHECK(larger != first);
	scene.box->parent_from_node[3].x += 0.01;
	const uint64_t moved = hash(SIZE_PX);
	CHECK(moved != larger);
	scene.camera->parent_from_node[3].y += 0.01;
	const uint64_t seen_elsewhere = hash(SIZE_PX);
	CHECK(seen_elsewhere != moved);
	scene.light->range_m = 3.0f;
	CHECK(hash(SIZE_PX) != seen_elsewhere);
}
