// The mask must not depend on the scale, position and rotation of the whole scene, or on the
// borders between an omni light's views.

#include "modules/core/error.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Rotates everything in the scene, including the light and the camera.
void rotate_scene(SmallScene &r_scene, double p_angle_rad, const glm::dvec3 &p_axis) {
	const glm::dmat4 rotation = glm::rotate(glm::dmat4(1.0), p_angle_rad, glm::normalize(p_axis));
	for (const std::unique_ptr<Node3D> &node : r_scene.scene.root->children) {
		node->parent_from_node = rotation * node->parent_from_node;
	}
}

/// The omni light's view that contains each pixel's receiver; 6 for pixels without a receiver.
std::vector<int> find_views(const SmallScene &p_scene, const MaskResult &p_frame) {
	const std::shared_ptr<const SceneSnapshot> scene = p_scene.snap();
	const LightSnapshot &light = scene->lights[0];
	std::vector<int> views;
	for (size_t index = 0; index < p_frame.surfaces.size(); ++index) {
		const glm::dvec3 position_world =
				scene->camera.position_world + glm::dvec3(p_frame.surfaces[index].position);
		const glm::dvec3 r =
				glm::transpose(light.world_from_light) * (position_world - light.position_world);
		const glm::dvec3 size = glm::abs(r);
		const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
		views.push_back(p_frame.receiver[index] > 0 ? 2 * axis + (r[axis] < 0 ? 1 : 0) : 6);
	}
	return views;
}

/// True if a receiver in another view is within three pixels.
bool is_near_seam(const std::vector<int> &p_views, glm::ivec2 p_size_px, glm::ivec2 p_pixel) {
	const auto get_view = [&](const glm::ivec2 &p_neighbour) {
		return p_views[size_t(p_neighbour.y) * size_t(p_size_px.x) + size_t(p_neighbour.x)];
	};
	for (int y = -3; y <= 3; ++y) {
		for (int x = -3; x <= 3; ++x) {
			const glm::ivec2 neighbour =
					glm::clamp(p_pixel + glm::ivec2(x, y), glm::ivec2(0), p_size_px - 1);
			if (get_view(neighbour) != 6 && get_view(neighbour) != get_view(p_pixel)) {
				return true;
			}
		}
	}
	return false;
}

/// Mean absolute difference from the reference over some pixels.
struct MeanError {
	double sum = 0;
	size_t count = 0;
	double compute_mean() const { return sum / double(std::max(count, size_t(1))); }
};

} // namespace

TEST_CASE("[GPU][EdgeCount] very small, very large and distant scenes have the same mask") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		const auto render = [&](double p_scale, const glm::dvec3 &p_origin) {
			SmallScene scene(type, p_scale, p_origin);
			add_globe(scene, p_scale, p_origin);
			return render_frame(fixture, scene);
		};
		const MaskResult expected = render(1.0, glm::dvec3(0.0));
		for (const double scale : { 1e-3, 1e3 }) {
			CAPTURE(scale);
			CHECK(compute_mask_difference(expected, render(scale, glm::dvec3(0.0))) < 1e-5);
		}
		const glm::dvec3 far(1e5, -3e4, 7e4);
		CHECK(compute_mask_difference(expected, render(1.0, far)) < 1e-5);
	}
}

TEST_CASE("[GPU][EdgeCount] a sun over 40 km is as wide as its angle, and set widths are metres") {
	MaskFixture fixture;
	const double S_M = 4e4;
	const auto render = [&](const PropertyValues &p_properties) {
		SmallScene scene(LightType::DIRECTIONAL, S_M / 4.0);
		scene.light->properties = p_properties;
		return render_frame(fixture, scene);
	};
	const MaskResult wide = render({ { "light_angular_distance", 60.0 } }); // widths of 23 km
	SmallScene small(LightType::DIRECTIONAL);
	small.light->properties = { { "light_angular_distance", 60.0 } };
	CHECK(compute_mask_difference(wide, render_frame(fixture, small)) < 1e-4);
	if (has_reference()) {
		CHECK(compare_masks(wide.visibility, render_reference(fixture, small, glm::uvec2(96), 1024))
						.mean < 0.003);
	}
	// R = (r + t) / 2; one width alone may be set.
	const double tangent = std::tan(glm::radians(10.0));
	const MaskResult both = render({ { "light_angular_distance", 60.0 },
			{ "penumbra_outer_width", tangent * S_M }, { "penumbra_inner_width", tangent * S_M } });
	CHECK(compute_mask_difference(both, render({ { "light_angular_distance", 20.0 } })) < 1e-4);
	const MaskResult outer = render(
			{ { "light_angular_distance", 20.0 }, { "penumbra_outer_width", tangent * S_M } });
	CHECK(compute_mask_difference(both, outer) < 1e-4);
	CHECK_THROWS_AS(render({ { "penumbra_outer_width", 2e4 } }), Error); // above the range
}

TEST_CASE("[GPU][EdgeCount] a scene rotated as a whole has the same mask") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		const auto render = [&](double p_angle_rad) {
			SmallScene scene(type);
			add_globe(scene);
			rotate_scene(scene, p_angle_rad, { 0.3, 0.8, -0.5 });
			return render_frame(fixture, scene);
		};
		const MaskResult expected = render(0.0);
		for (const double angle_rad : { 0.7, 2.345 }) {
			CAPTURE(angle_rad);
			CHECK(compute_mask_difference(expected, render(angle_rad)) < 1e-5);
		}
	}
}

TEST_CASE("[GPU][EdgeCount] no seam is visible between an omni light's views") {
	if (!has_reference()) {
		return;
	}
	MaskFixture fixture;
	const glm::uvec2 size_px(128);
	SmallScene scene(LightType::OMNI);
	scene.light->properties["light_size"] = 0.4;
	// Rotated by 45 degrees about its vertical axis, so that a border between views runs through
	// the middle of the shadow.
	scene.light->parent_from_node =
			glm::rotate(scene.light->parent_from_node, glm::radians(45.0), glm::dvec3(0, 1, 0));
	const MaskResult frame =
			render_frame(fixture, scene, { .size_px = size_px, .wants_surfaces = true });
	const MaskResult reference = render_reference(fixture, scene, size_px, 1024);
	const std::vector<int> views = find_views(scene, frame);
	MeanError near_seam;
	MeanError elsewhere;
	for (size_t index = 0; index < views.size(); ++index) {
		const float visibility = reference.visibility[index];
		if (reference.receiver[index] == 0.0f || visibility < 0.002f || visibility > 0.998f) {
			continue;
		}
		const glm::ivec2 pixel(index % size_px.x, index / size_px.x);
		MeanError &error = is_near_seam(views, glm::ivec2(size_px), pixel) ? near_seam : elsewhere;
		error.sum += std::abs(frame.visibility[index] - visibility);
		++error.count;
	}
	CHECK(near_seam.count > 50);
	CHECK(elsewhere.count > 200);
	// 0.002: noise of the reference.
	CHECK(near_seam.compute_mean() < 2 * elsewhere.compute_mean() + 0.002);
}

TEST_CASE("[GPU][EdgeCount] rotating an omni light hardly changes the mask") {
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	add_globe(scene);
	scene.light->properties["light_size"] = 0.4;
	const MaskResult expected = render_frame(fixture, scene);
	const glm::dmat4 world_from_light = scene.light->parent_from_node;
	for (const double angle_rad : { 0.785398, 1.1, 2.9 }) { // the first is 45 degrees
		CAPTURE(angle_rad);
		scene.light->parent_from_node =
				glm::rotate(world_from_light, angle_rad, glm::dvec3(0.2, 1.0, 0.4));
		const MaskDifference difference =
				compare_masks(render_frame(fixture, scene).visibility, expected);
		CHECK(difference.mean < 2e-4);
		// Where two solids overlap, the light's 256 points matter, which are rotated too: 0.05 is
		// 12 of them.
		CHECK(difference.maximum < 0.05);
		CHECK(double(difference.mismatch_count) < 0.01 * double(difference.receiver_count));
	}
}
