#include "modules/shadows/mask_filter.h"
#include "modules/shadows/reference_source.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

// Tests the ReferenceSource of the build's reference technique, if it has one.

using namespace gnomon;

namespace {

const int64_t SAMPLE_COUNT = 64; // rays per pixel; int64_t is the type of the light's property

/// A scene with its mask by the reference technique on the GPU, and the request for the same mask
/// on the CPU.
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
		CHECK(cpu_result.penumbra_pixel_count > 20); // else only trivial pixels are compared
		CHECK(last_progress == 1.0f);
	}
}

TEST_CASE("[GPU] A cancelled reference is not complete, and a later trace is") {
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	if (reference == nullptr) {
		return;
	}
	MaskFixture fixture;
	const TracedScene traced(fixture, *reference, LightType::SPOT);
	const std::unique_ptr<ReferenceSource> source =
			reference->make_reference_source(traced.trace_request);
	const auto trace = [&](bool p_is_cancelled) {
		return source->trace(
				/*p_sample_count=*/16, std::atomic<bool>(p_is_cancelled), /*p_progress=*/{});
	};
	CHECK_FALSE(trace(/*p_is_cancelled=*/true).is_complete);
	CHECK(trace(/*p_is_cancelled=*/false).is_complete);
}

TEST_CASE("The hash of a reference depends on size, light, casters and camera, not on technique, "
		  "penumbra widths and intensity") {
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
