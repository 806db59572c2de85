// Compares each technique's masks of the demo scenes with the reference. The limits of the errors
// are in tests/golden/accuracy.json. A technique without a limit must give a valid mask.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/masks/mask_metrics.h"
#include "modules/renderer/tests/render_fixture.h"
#include "modules/shadows/mask_filter.h"

#include "tests/demo_scene.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

using namespace gnomon;

namespace {

nlohmann::json load_limits() {
	return nlohmann::json::parse(load_text_file("tests/golden/accuracy.json"));
}

LightType parse_light_type(const std::string &p_name) {
	if (p_name == "spot") {
		return LightType::SPOT;
	}
	if (p_name == "omni") {
		return LightType::OMNI;
	}
	if (p_name == "directional") {
		return LightType::DIRECTIONAL;
	}
	fail("accuracy.json: light \"", p_name, "\", must be spot, omni or directional.");
}

/// A demo scene whose first light has the type of the case, at the same position and direction.
struct AccuracyScene {
	std::unique_ptr<Scene> scene;
	Light3D *light = nullptr;

	AccuracyScene(const nlohmann::json &p_case, const nlohmann::json &p_settings) :
			scene(load_demo_scene(p_case.at("scene").get<std::string>())) {
		light = scene->find_nodes<Light3D>().at(0);
		light->type = parse_light_type(p_case.at("light").get<std::string>());
		// In degrees: about the angle under which a light of radius 0.4 m appears from the origin.
		light->properties["light_angular_distance"] = 7.1;
		apply_light_settings(*scene, p_settings);
	}

	MaskImage render(RenderFixture &r_fixture, const std::string &p_id, uint32_t p_size_px) {
		RenderRequest request;
		request.scene = build_snapshot(*scene, *scene->find_nodes<Camera3D>().at(0));
		request.size_px = glm::uvec2(p_size_px);
		request.technique_override = p_id;
		request.mask_light = light->name;
		request.wants_mask = true;
		const RenderResult result = r_fixture.renderer->render(request);
		CHECK(is_valid_mask(result));
		return { request.size_px, result.visibility, result.receiver };
	}
};

/// Width and height of the masks in pixels. A case may override the common size with a larger one
/// if too few pixels would show an error.
uint32_t read_size_px(const nlohmann::json &p_limits, const nlohmann::json &p_case) {
	return (p_case.contains("size_px") ? p_case : p_limits).at("size_px").get<uint32_t>();
}

MaskImage render_reference(RenderFixture &r_fixture, const nlohmann::json &p_limits,
		const nlohmann::json &p_case, nlohmann::json p_extra_settings = nlohmann::json::object()) {
	p_extra_settings.update(p_limits.at("reference_settings"));
	AccuracyScene scene(p_case, p_extra_settings);
	return scene.render(
			r_fixture, ShadowRegistry::find_reference()->id, read_size_px(p_limits, p_case));
}

/// The largest absolute error of all receivers: even a single wrong pixel is visible in an image.
double find_max_error(const MaskImage &p_reference, const MaskImage &p_mask) {
	double greatest = 0;
	for (size_t pixel = 0; pixel < p_reference.get_pixel_count(); ++pixel) {
		if (p_reference.is_receiver(pixel)) {
			greatest = std::max(greatest,
					double(std::abs(p_mask.visibility[pixel] - p_reference.visibility[pixel])));
		}
	}
	return greatest;
}

/// False, with a message, in a build without the reference technique.
bool has_reference() {
	if (ShadowRegistry::find_reference() == nullptr) {
		MESSAGE("No reference technique in this build: accuracy is not measured.");
		return false;
	}
	return true;
}

} // namespace

TEST_CASE("[GPU][Accuracy] no technique is further from the reference than when it was accepted") {
	if (!has_reference()) {
		return;
	}
	RenderFixture fixture;
	const nlohmann::json limits = load_limits();
	for (const nlohmann::json &accuracy_case : limits.at("cases")) {
		const std::string filter = accuracy_case.value("mask_filter", "");
		if (!filter.empty() && MaskFilterRegistry::find(filter) == nullptr) {
			continue;
		}
		const uint32_t size_px = read_size_px(limits, accuracy_case);
		CAPTURE(accuracy_case.at("scene").get<std::string>());
		CAPTURE(accuracy_case.at("light").get<std::string>());
		const MaskImage reference = render_reference(fixture, limits, accuracy_case);
		double previous_mae = 0; // a case lists its results from the smallest to the largest MAE
		for (const nlohmann::json &entry : accuracy_case.at("results")) {
			const std::string id = entry.at("id").get<std::string>();
			CAPTURE(id);
			CAPTURE(entry.at("settings").dump());
			if (ShadowRegistry::find(id) == nullptr) {
				FAIL_CHECK("No technique of this build has the id \"", id, "\".");
				continue;
			}
			AccuracyScene scene(accuracy_case, entry.at("settings"));
			const MaskImage mask = scene.render(fixture, id, size_px);
			const MaskMetrics metrics = compute_mask_metrics(reference, mask);
			CHECK(metrics.penumbra.pixel_count > 200); // the means need many pixels
			CHECK(metrics.receiver.mae <= entry.at("receiver_mae").get<double>());
			CHECK(metrics.penumbra.mae <= entry.at("penumbra_mae").get<double>());
			CHECK(metrics.umbra_over <= entry.value("umbra_over", 1.0));
			CHECK(find_max_error(reference, mask) <= entry.value("greatest", 1.0));
			CHECK(metrics.penumbra.mae > previous_mae);
			previous_mae = metrics.penumbra.mae;
		}
	}
}

TEST_CASE("[GPU][Accuracy] hard shadows differ from rays to the light's centre in few receivers") {
	if (!has_reference()) {
		return;
	}
	RenderFixture fixture;
	const nlohmann::json limits = load_limits();
	for (const nlohmann::json &hard_case : limits.at("hard_cases")) {
		const uint32_t size_px = read_size_px(limits, hard_case);
		CAPTURE(hard_case.at("scene").get<std::string>());
		CAPTURE(hard_case.at("light").get<std::string>());
		AccuracyScene exact(hard_case, limits.at("hard_settings"));
		const MaskImage reference =
				exact.render(fixture, ShadowRegistry::find_reference()->id, size_px);
		for (const nlohmann::json &entry : hard_case.at("results")) {
			const std::string id = entry.at("id").get<std::string>();
			CAPTURE(id);
			if (ShadowRegistry::find(id) == nullptr) {
				FAIL_CHECK("No technique of this build has the id \"", id, "\".");
				continue;
			}
			AccuracyScene scene(hard_case, limits.at("hard_settings"));
			const MaskMetrics metrics =
					compute_mask_metrics(reference, scene.render(fixture, id, size_px));
			CHECK(metrics.receiver.pixel_count > 10000); // the mean needs many receivers
			// Hard shadows are 0 or 1, so their MAE is the fraction of wrong receivers.
			CHECK(metrics.receiver.mae <= entry.at("wrong_share").get<double>());
		}
	}
}

TEST_CASE("[GPU][Accuracy] every technique gives valid masks of every scene that has limits") {
	RenderFixture fixture;
	const nlohmann::json limits = load_limits();
	for (const nlohmann::json &accuracy_case : limits.at("cases")) {
		for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
			CAPTURE(info.id);
			if (!info.is_reference) { // render() checks the mask
				AccuracyScene scene(accuracy_case, nlohmann::json::object());
				scene.render(fixture, info.id, /*p_size_px=*/48);
			}
		}
	}
}

TEST_CASE("[GPU][Accuracy] canary: a light of twice the size gives a large error") {
	if (!has_reference()) {
		return;
	}
	RenderFixture fixture;
	const nlohmann::json limits = load_limits();
	const nlohmann::json &accuracy_case = limits.at("cases").at(0);
	const MaskImage reference = render_reference(fixture, limits, accuracy_case);
	const MaskMetrics metrics = compute_mask_metrics(
			reference, render_reference(fixture, limits, accuracy_case, { { "light_size", 0.8 } }));
	// Far above the limits of edge_count (0.0061) and of 64 views (0.020) in this case.
	CHECK(metrics.penumbra.mae > 0.05);
}
