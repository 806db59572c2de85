#include "modules/shadow_volume/volume_area.h"
#include "modules/shadows/camera_view.h"

#include <doctest/doctest.h>

#include <random>

using namespace gnomon;

namespace {

const glm::uvec2 SIZE_PX(160, 120);

struct Situation {
	LightView camera;
	LightSnapshot light;
	Bounds box;
};

/// Draws random situations, the same ones in every run.
class Situations {
public:
	double draw_uniform(double p_min, double p_max) {
		return std::uniform_real_distribution<double>(p_min, p_max)(random);
	}
	glm::dvec3 draw_point(double p_reach) {
		return { draw_uniform(-p_reach, p_reach), draw_uniform(-p_reach, p_reach),
			draw_uniform(-p_reach, p_reach) };
	}

	/// Makes a camera at the origin that looks along -Z, and a light and a box at random around it.
	/// p_index selects the near plane and the light's type and range.
	Situation make(int p_index) {
		Situation situation;
		CameraSnapshot camera;
		camera.near_m = p_index % 3 == 0 ? 0.5f : 0.05f;
		situation.camera = make_camera_view(camera, SIZE_PX);
		LightSnapshot &light = situation.light;
		light.type = p_index % 4 == 0 ? LightType::DIRECTIONAL : LightType::OMNI;
		light.position_world = draw_point(5);
		light.range_m = p_index % 5 == 0 ? float(draw_uniform(1, 8)) : 0.0f;
		light.world_from_light[2] = glm::normalize(draw_point(1) + glm::dvec3(0, 0.01, 0));
		situation.box.add(draw_point(3));
		// Every second box is between the camera and the light.
		if (p_index % 2 == 0 && light.type != LightType::DIRECTIONAL) {
			situation.box = Bounds();
			situation.box.add(draw_uniform(0.1, 0.9) * light.position_world + draw_point(0.3));
		}
		situation.box.add(situation.box.minimum + glm::abs(draw_point(1)) * draw_uniform(0.02, 1));
		return situation;
	}

	glm::dvec3 draw_in(const Bounds &p_box) {
		return { draw_uniform(p_box.minimum.x, p_box.maximum.x),
			draw_uniform(p_box.minimum.y, p_box.maximum.y),
			draw_uniform(p_box.minimum.z, p_box.maximum.z) };
	}

private:
	std::mt19937 random{ 7 };
};

/// Returns a point behind p_point_world on the light's ray. p_length: distance between the two, as
/// a multiple of the first one's distance from the light, or in metres for a directional light.
glm::dvec3 follow_ray(
		const LightSnapshot &p_light, const glm::dvec3 &p_point_world, double p_length) {
	return p_light.type == LightType::DIRECTIONAL
			? p_point_world + p_light.get_direction_world() * p_length
			: p_light.position_world + (p_point_world - p_light.position_world) * (1 + p_length);
}

bool is_in_range(const LightSnapshot &p_light, const glm::dvec3 &p_point_world) {
	return p_light.type == LightType::DIRECTIONAL || p_light.range_m <= 0 ||
			glm::length(p_point_world - p_light.position_world) <= p_light.range_m;
}

/// True when the segment intersects the box (slab test).
bool intersects(const Bounds &p_box, const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
	double begin = 0;
	double end = 1;
	for (int axis = 0; axis < 3; ++axis) {
		const double step = p_to[axis] - p_from[axis];
		const double first = (p_box.minimum[axis] - p_from[axis]) / step;
		const double second = (p_box.maximum[axis] - p_from[axis]) / step;
		begin = std::max(begin, std::min(first, second));
		end = std::min(end, std::max(first, second));
	}
	return begin <= end;
}

} // namespace

TEST_CASE("[ShadowVolume] a volume's area contains every visible point that the box hides") {
	Situations situations;
	size_t visible_count = 0;
	size_t small_count = 0;
	for (int index = 0; index < 400; ++index) {
		const Situation situation = situations.make(index);
		const VolumeArea area =
				compute_volume_area(situation.box, situation.light, situation.camera, SIZE_PX);
		small_count += area.size_px.x * area.size_px.y < SIZE_PX.x * SIZE_PX.y / 2 ? 1 : 0;
		for (int sample = 0; sample < 200; ++sample) {
			const glm::dvec3 point = follow_ray(situation.light, situations.draw_in(situation.box),
					std::pow(10.0, situations.draw_uniform(-3, 3)));
			const glm::dvec3 point_view =
					glm::dvec3(situation.camera.view_from_world * glm::dvec4(point, 1.0));
			const glm::dvec2 position =
					(glm::dvec2(point_view) / point_view.z /
									glm::dvec2(situation.camera.half_extent) * 0.5 +
							0.5) *
					glm::dvec2(SIZE_PX);
			const bool is_visible = point_view.z > situation.camera.near_m &&
					glm::all(glm::greaterThan(position, glm::dvec2(0))) &&
					glm::all(glm::lessThan(position, glm::dvec2(SIZE_PX)));
			if (!is_visible || !is_in_range(situation.light, point)) {
				continue;
			}
			++visible_count;
			const glm::uvec2 pixel(position);
			CAPTURE(index);
			REQUIRE(glm::all(glm::greaterThanEqual(pixel, area.offset_px)));
			REQUIRE(glm::all(glm::lessThan(pixel, area.offset_px + area.size_px)));
			const double depth = situation.camera.near_m / point_view.z;
			REQUIRE(depth >= area.min_depth);
			REQUIRE(depth <= area.max_depth);
		}
	}
	CHECK(visible_count > 2000);
	CHECK(small_count > 100); // areas often exclude half of the image
}

TEST_CASE("[ShadowVolume] z-pass is safe only where the near rectangle is not in the shadow") {
	Situations situations;
	size_t shaded_count = 0;
	size_t safe_count = 0;
	for (int index = 0; index < 1000; ++index) {
		const Situation situation = situations.make(index);
		const bool may_shade =
				may_shade_near_plane(situation.box, situation.light, situation.camera);
		safe_count += may_shade ? 0 : 1;
		bool is_shaded = false;
		for (int sample = 0; sample < 200; ++sample) {
			const glm::dvec2 half =
					glm::dvec2(situation.camera.half_extent) * double(situation.camera.near_m);
			const glm::dvec3 point_view(situations.draw_uniform(-half.x, half.x),
					situations.draw_uniform(-half.y, half.y), situation.camera.near_m);
			const glm::dvec3 point = glm::dvec3(
					glm::inverse(situation.camera.view_from_world) * glm::dvec4(point_view, 1.0));
			const glm::dvec3 light = situation.light.type == LightType::DIRECTIONAL
					? point - situation.light.get_direction_world() * 1e3
					: situation.light.position_world;
			is_shaded = is_shaded || intersects(situation.box, point, light);
		}
		shaded_count += is_shaded ? 1 : 0;
		CAPTURE(index);
		CHECK((may_shade || !is_shaded));
	}
	CHECK(shaded_count > 20);
	CHECK(safe_count > 700);
}

TEST_CASE("[ShadowVolume] a light in the box gives the whole image, a shadow behind the "
		  "camera no area") {
	Situations situations;
	Situation situation = situations.make(1);
	situation.light.position_world = 0.5 * (situation.box.minimum + situation.box.maximum);
	const VolumeArea whole =
			compute_volume_area(situation.box, situation.light, situation.camera, SIZE_PX);
	CHECK(whole.size_px == SIZE_PX);
	CHECK(whole.min_depth == 0.0f);
	CHECK(whole.max_depth == 1.0f);
	situation.light.position_world = { 0, 0, -10 };
	situation.box = Bounds();
	situation.box.add({ -1, -1, 2 });
	situation.box.add({ 1, 1, 3 }); // its shadow goes on behind the camera
	CHECK(compute_volume_area(situation.box, situation.light, situation.camera, SIZE_PX)
					.is_empty());
	CHECK_FALSE(may_shade_near_plane(situation.box, situation.light, situation.camera));
	situation.light.position_world = { 0, 0, 10 };
	CHECK(may_shade_near_plane(situation.box, situation.light, situation.camera));
}
