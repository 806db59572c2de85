// Runs the shader code that counts faces and edges (count_receiver.comp), and compares it with the
// same computation in double precision (count_in_double.h).

#include "modules/shadow_edge_count/tests/count_records.h"
#include "modules/shadow_edge_count/tests/count_scene.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Difference of the shader's visibility from that of the double version.
struct Agreement {
	double mean = 0; // over receivers
	double maximum = 0;
	size_t mismatch_count = 0; // receivers that differ by more than 1e-3
};

/// The shader's results for receivers in light space: visibility, number of solids, area.
std::vector<glm::vec4> run_receivers(const CountScene &p_scene, KernelFixture &r_fixture,
		const std::vector<glm::dvec3> &p_receivers) {
	const CountArrays arrays(p_scene);
	std::vector<glm::vec4> input;
	for (const glm::dvec3 &receiver : p_receivers) {
		input.emplace_back(glm::vec3(receiver), 0.0f);
	}
	const OwnedBuffer light = r_fixture.make_buffer("light",
			std::vector<shader::CountLightConstants>{ arrays.light }, BufferUsage::STORAGE);
	const OwnedBuffer edges = r_fixture.make_buffer("edges", arrays.edges);
	const OwnedBuffer faces = r_fixture.make_buffer("faces", arrays.faces);
	const OwnedBuffer planes = r_fixture.make_buffer("planes", arrays.planes);
	const OwnedBuffer masks = r_fixture.make_buffer("masks", p_scene.get_masks()[0].get_table());
	return r_fixture.run("count_receiver.comp", input, input.size(), 1,
			{ { 2, light.get() }, { 3, edges.get() }, { 4, faces.get() }, { 5, planes.get() },
					{ 6, masks.get() } },
			arrays.pipeline_constants);
}

/// Compares the shader with the double version, for receivers on the ground.
Agreement compare_kernels(const CountScene &p_scene, KernelFixture &r_fixture) {
	std::vector<glm::dvec3> receivers;
	TestRandom random;
	const size_t count = 2000;
	for (size_t index = 0; index < count; ++index) {
		const glm::dvec3 position(random.next(-1.6, 1.4), 0.0, random.next(-1.5, 1.3));
		// Rounded to float32, so that both get the same position.
		receivers.push_back(
				glm::dvec3(glm::vec3(p_scene.make_receiver(position, glm::dvec3(0.0, 1.0, 0.0)))));
	}
	const std::vector<glm::vec4> results = run_receivers(p_scene, r_fixture, receivers);
	Agreement agreement;
	for (size_t index = 0; index < count; ++index) {
		const double expected = p_scene.count(receivers[index]);
		const double difference = std::abs(results[index].x - expected);
		REQUIRE(results[index].x >= 0.0f);
		REQUIRE(results[index].x <= 1.0f);
		agreement.mean += difference / count;
		agreement.maximum = std::max(agreement.maximum, difference);
		agreement.mismatch_count += difference > 1e-3 ? 1 : 0;
	}
	return agreement;
}

} // namespace

TEST_CASE("[GPU][EdgeCount] the shader matches the double version in the shadow of one solid") {
	KernelFixture fixture;
	for (const bool is_directional : { false, true }) {
		for (const double radius : { 0.0, 0.02, 0.1, 0.3 }) { // of S, or a tangent
			CAPTURE(is_directional);
			CAPTURE(radius);
			CountScene scene;
			scene.radius = is_directional ? radius : radius * scene.scene_size;
			scene.is_directional = is_directional;
			scene.half_extent = is_directional ? 6.0 : 0.95;
			scene.add(make_box_mesh("box", glm::vec3(4.2, 0.2, 4.2)),
					glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.2, 0.0)));
			scene.add(make_count_sphere(0.8, 8),
					glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 1.3, 0.0)));
			scene.build();
			const Agreement agreement = compare_kernels(scene, fixture);
			CHECK(agreement.mean < 5e-5);
			CHECK(agreement.mismatch_count <= 2); // receivers on an outline, where rounding decides
		}
	}
}

TEST_CASE("[GPU][EdgeCount] the shader matches the double version where solids overlap") {
	KernelFixture fixture;
	CountScene scene;
	scene.add(make_box_mesh("box", glm::vec3(4.2, 0.2, 4.2)),
			glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.2, 0.0)));
	for (int index = 0; index < 6; ++index) {
		const glm::dvec3 position(
				0.4 * std::cos(2.1 * index), 0.4 + 0.35 * index, 0.4 * std::sin(2.1 * index));
		scene.add(make_box_mesh("box", glm::vec3(0.4, 0.04, 0.35)),
				glm::rotate(glm::translate(glm::dmat4(1.0), position), 0.7 * index,
						glm::dvec3(0.2, 1.0, 0.1)));
	}
	scene.build();
	const Agreement agreement = compare_kernels(scene, fixture);
	CHECK(agreement.mean < 5e-4);
	// If an edge passes through one of the 64 points, rounding decides on which side the point is.
	CHECK(agreement.maximum < 0.05);	  // about three points
	CHECK(agreement.mismatch_count < 60); // of 2000 receivers
}

// A ray through a vertex meets all faces of the vertex in one point, a ray through an edge two.
TEST_CASE("[GPU][EdgeCount] rays through shared edges and vertices count each solid once") {
	KernelFixture fixture;
	for (const bool is_directional : { false, true }) {
		CAPTURE(is_directional);
		CountScene scene;
		scene.is_directional = is_directional;
		scene.radius = 0;
		scene.light = { 0.0, 8.0, 0.0 };
		scene.target = { 0.0, 0.0, 1e-3 }; // not straight down, where build() finds no right axis
		scene.add(make_count_sphere(0.75, 8), glm::translate(glm::dmat4(1.0), { 0.5, 4.0, 0.25 }));
		scene.build();
		std::vector<glm::dvec3> receivers;
		std::vector<bool> is_inside; // not close to the outline, where rounding may decide
		const auto add = [&](const glm::dvec3 &p_point, const glm::dvec4 &p_plane) {
			// A receiver behind the sphere, whose ray passes exactly through the point in float32.
			const glm::dvec3 point = glm::dvec3(glm::vec3(p_point));
			receivers.push_back(is_directional ? point + glm::dvec3(0.0, 0.0, 8.0) : 2.0 * point);
			// 0.5: the ray is within 60 degrees of the face's normal.
			is_inside.push_back(std::abs(scene.get_space().get_light_side(p_plane)) >
					0.5 * (is_directional ? 1.0 : glm::length(point)));
		};
		for (const CountFace &face : scene.get_faces()) {
			for (int corner = 0; corner < 3; ++corner) {
				add(face.corners[corner], face.plane);
				const glm::dvec3 a(glm::vec3(face.corners[corner]));
				const glm::dvec3 b(glm::vec3(face.corners[(corner + 1) % 3]));
				add(0.5 * (a + b), face.plane);
			}
		}
		const std::vector<glm::vec4> results = run_receivers(scene, fixture, receivers);
		size_t inside_count = 0;
		size_t wrong_count = 0;
		for (size_t index = 0; index < results.size(); ++index) {
			CHECK(results[index].y <= 1.0f); // the number of solids
			inside_count += is_inside[index] ? 1 : 0;
			wrong_count += is_inside[index] && results[index].y != 1.0f ? 1 : 0;
		}
		CHECK(inside_count > 200);
		CHECK(wrong_count == 0);
	}
}

TEST_CASE("[GPU][EdgeCount] numbers of solids match the double version behind, inside and next to "
		  "solids") {
	KernelFixture fixture;
	TestRandom random;
	for (const bool is_directional : { false, true }) {
		CAPTURE(is_directional);
		CountScene scene;
		scene.is_directional = is_directional;
		scene.radius = 0;
		for (int index = 0; index < 12; ++index) {
			const glm::dvec3 position(
					random.next(-0.8, 0.8), random.next(0.2, 5.8), random.next(-0.8, 0.8));
			const glm::dmat4 matrix = glm::rotate(glm::translate(glm::dmat4(1.0), position),
					random.next(0.0, 6.0), random.next_unit());
			if (index % 3 == 0) {
				scene.add(make_mesh("card",
								  { { -0.6f, 0, -0.5f }, { 0.6f, 0, -0.5f }, { 0.6f, 0.1f, 0.5f },
										  { -0.6f, 0, 0.5f } },
								  {}, { 0, 1, 2, 0, 2, 3 }),
						matrix);
			} else {
				scene.add(make_box_mesh("box", glm::vec3(0.7f, 0.4f, 0.6f)), matrix);
			}
		}
		scene.add(make_count_sphere(0.4, 8), // around the light's centre
				glm::translate(glm::dmat4(1.0), scene.light));
		scene.build();
		std::vector<glm::dvec3> receivers;
		for (int index = 0; index < 4000; ++index) {
			const glm::dvec3 position(
					random.next(-1, 1), random.next(-0.5, 6.5), random.next(-1, 1));
			receivers.push_back(glm::dvec3(
					glm::vec3(scene.make_receiver(position, glm::dvec3(0.0, 1.0, 0.0)))));
		}
		const std::vector<glm::vec4> results = run_receivers(scene, fixture, receivers);
		size_t mismatch_count = 0;
		size_t hidden_count = 0;
		for (size_t index = 0; index < receivers.size(); ++index) {
			const int expected =
					count_solids_in_double(scene.get_space(), receivers[index], scene.get_faces());
			mismatch_count += int(results[index].y) != expected ? 1 : 0;
			hidden_count += expected > 0 ? 1 : 0;
		}
		CHECK(mismatch_count <= 1); // rounding at an outline
		CHECK(hidden_count > 500);
	}
}
