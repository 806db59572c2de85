// Tests frames of a camera that flies through shadow volumes, walls and casters.

#include "modules/shadow_volume/tests/volume_fixture.h"

#include <array>

using namespace gnomon;

namespace {

const size_t FRAME_COUNT = 300;

/// The camera's position and the point it looks at, for every 25th frame of the flight.
struct Pose {
	glm::dvec3 position, target;
};
const std::array<Pose, 13> FLIGHT = { {
		{ { -2.4, 2.2, 3.0 }, { 0.0, 0.4, 0.0 } }, { { -1.2, 0.9, 1.6 }, { -0.2, 0.2, -0.2 } },
		{ { -0.5, 0.35, 0.4 }, { -0.3, 0.0, -0.9 } }, // into the box's shadow
		{ { -0.2, 0.95, 0.1 }, { -0.6, 0.2, -0.8 } }, // into the box
		{ { 0.1, 1.15, -0.2 }, { 0.7, 0.1, -0.9 } },  // out through its top
		{ { 0.2, 1.8, -0.9 }, { 0.9, 0.3, 0.2 } },	  // through the moebius strip
		{ { 0.9, 0.9, 0.3 }, { 0.2, 0.1, 1.3 } },	  // through the quad
		{ { 1.5, 0.5, 1.0 }, { 0.4, 0.4, 0.9 } },
		{ { 0.4, 0.45, 1.35 }, { -0.9, 0.5, 0.4 } },  // through the wall
		{ { -0.9, 0.8, 0.4 }, { -1.4, 0.4, -0.3 } },  // into the sphere
		{ { -1.4, 0.5, -0.2 }, { -0.5, 0.1, -0.7 } }, // into the box that is inside out
		{ { -0.6, 0.06, -0.8 }, { 0.6, 0.2, -0.2 } }, // along the floor, below the soup
		{ { 1.2, 2.9, 0.7 }, { 0.0, 0.3, -0.1 } },	  // past the light
} };

/// Evaluates a Catmull-Rom spline through four positions; p_fraction: 0 at the second, 1 at the
/// third.
glm::dvec3 blend(const std::array<glm::dvec3, 4> &p_positions, double p_fraction) {
	const double s = p_fraction;
	const auto &[a, b, c, d] = p_positions;
	return 0.5 *
			(2.0 * b + (c - a) * s + (2.0 * a - 5.0 * b + 4.0 * c - d) * (s * s) +
					(3.0 * b - a - 3.0 * c + d) * (s * s * s));
}

glm::dmat4 find_pose(size_t p_frame) {
	const double path_position = double(p_frame) * (FLIGHT.size() - 1) / (FRAME_COUNT - 1);
	const size_t first = std::min(static_cast<size_t>(path_position), FLIGHT.size() - 2);
	std::array<glm::dvec3, 4> positions, targets;
	for (size_t i = 0; i < 4; ++i) {
		const size_t pose = std::clamp(first + i, size_t(1), FLIGHT.size()) - 1;
		positions[i] = FLIGHT[pose].position;
		targets[i] = FLIGHT[pose].target;
	}
	const double fraction = path_position - double(first);
	return look_at(blend(positions, fraction), blend(targets, fraction));
}

struct FlightScene : SmallScene {
	explicit FlightScene(LightType p_type) : SmallScene(p_type) {
		add_meshes(*this);
		add_mirrored_box(*this);
		add_mesh(scene, "Wall", make_box_mesh("wall", glm::vec3(0.04f, 0.5f, 0.6f)),
				{ 0.7, 0.5, 1.3 });
		camera->near_m = 0.02f;
	}
};

} // namespace

TEST_CASE("[GPU][ShadowVolume] 300 frames through volumes, walls and casters, wrong only at "
		  "borders of shadows") {
	MaskFixture fixture;
	struct Leg {
		LightType type;
		size_t step; // renders every step-th frame
	};
	for (const Leg &leg : { Leg{ LightType::SPOT, 1 }, Leg{ LightType::OMNI, 5 },
				 Leg{ LightType::DIRECTIONAL, 5 } }) {
		CAPTURE(std::string(get_light_type_name(leg.type)));
		FlightScene scene(leg.type);
		size_t z_fail_count = 0;
		size_t mixed_count = 0;
		size_t receiver_count = 0;
		size_t wrong_count = 0;
		for (size_t frame = 0; frame < FRAME_COUNT; frame += leg.step) {
			CAPTURE(frame);
			scene.camera->parent_from_node = find_pose(frame);
			const VolumeSettingValues setting_values = {
				{ "extrusion", std::string(frame % 2 == 0 ? "compute" : "auto") },
				{ "culling", std::string("on") }
			};
			const MaskResult result =
					render_volumes(fixture, scene, setting_values, "shadow_volume", glm::uvec2(80));
			const std::string plan = result.plan.to_text();
			const bool has_z_fail = plan.find("by z-fail") != std::string::npos;
			z_fail_count += has_z_fail ? 1 : 0;
			mixed_count += has_z_fail && plan.find("by z-pass") != std::string::npos ? 1 : 0;
			const HardDifference difference = HardReference(scene).compare(result);
			CHECK(difference.unexplained_count == 0);
			CHECK(difference.wrong_count <= 3 + difference.receiver_count / 500);
			receiver_count += difference.receiver_count;
			wrong_count += difference.wrong_count;
		}
		CHECK(z_fail_count > 10);
		CHECK(mixed_count > 10);
		CHECK(wrong_count <= receiver_count / 5000);
		MESSAGE(wrong_count, " of ", receiver_count,
				" receivers differ from rays; frames with z-fail: ", z_fail_count);
	}
}
