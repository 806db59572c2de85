// Has an image changed? Each tests/golden/<scene>/<technique id>.png is rendered again and
// compared. Files are written by tests/golden/update.sh only.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/masks/mask_png.h"
#include "modules/renderer/tests/render_fixture.h"

#include "tests/demo_scene.h"
#include "tests/png_pixels.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

const char *const GOLDEN_FOLDER = "tests/golden";
const char *const FAILURE_FOLDER = "build/golden_failures";
constexpr uint32_t CHANNEL_COUNT = 3; // the alpha of an image is always 1
constexpr int AMPLIFICATION = 10;	  // in the image of the difference

struct GoldenImage {
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<uint8_t> pixels; // RGB
};

/// tests/golden/<scene>/golden.json.
struct GoldenSettings {
	std::string camera; // empty = the first
	glm::uvec2 size_px = glm::uvec2(128);
	int max_difference = 5;			// of a channel, in 255ths
	double max_pixel_share = 0.001; // of pixels that differ by more
	nlohmann::json light_settings;	// by technique id, for every light
};

GoldenSettings load_settings(const std::string &p_scene) {
	const fs::path path = fs::path(GOLDEN_FOLDER) / p_scene / "golden.json";
	const nlohmann::json json = nlohmann::json::parse(load_text_file(path));
	GoldenSettings settings;
	settings.camera = json.at("camera").get<std::string>();
	settings.size_px = { json.at("size_px").at(0).get<uint32_t>(),
		json.at("size_px").at(1).get<uint32_t>() };
	settings.max_difference = json.at("tolerance").at("difference").get<int>();
	settings.max_pixel_share = json.at("tolerance").at("pixel_share").get<double>();
	settings.light_settings = json.at("light_settings");
	return settings;
}

GoldenImage load_image(const fs::path &p_path) {
	if (!fs::exists(p_path)) {
		fail("Golden ", p_path, " does not exist. Make it with tests/golden/update.sh.");
	}
	const PngPixels pixels = load_png_pixels(p_path, CHANNEL_COUNT);
	return { pixels.size_px, pixels.values };
}

void save_image(const fs::path &p_path, const GoldenImage &p_image) {
	save_png(p_path, p_image.size_px, CHANNEL_COUNT, p_image.pixels);
}

/// Share of the pixels with a channel that differs by more than the limit; 1 for different sizes.
double compute_differing_share(
		const GoldenImage &p_expected, const GoldenImage &p_actual, int p_max_difference) {
	if (p_expected.size_px != p_actual.size_px) {
		return 1;
	}
	size_t differing_count = 0;
	for (size_t pixel = 0; pixel < p_expected.pixels.size(); pixel += CHANNEL_COUNT) {
		bool differs = false;
		for (size_t index = pixel; index < pixel + CHANNEL_COUNT; ++index) {
			differs = differs ||
					std::abs(int(p_expected.pixels[index]) - p_actual.pixels[index]) >
							p_max_difference;
		}
		differing_count += differs;
	}
	return double(differing_count) / double(p_expected.pixels.size() / CHANNEL_COUNT);
}

bool is_equal_enough(const GoldenImage &p_expected, const GoldenImage &p_actual,
		const GoldenSettings &p_settings) {
	return compute_differing_share(p_expected, p_actual, p_settings.max_difference) <=
			p_settings.max_pixel_share;
}

/// Grey = equal, lighter or darker where the actual image is.
GoldenImage amplify_difference(const GoldenImage &p_expected, const GoldenImage &p_actual) {
	GoldenImage result = p_actual;
	for (size_t index = 0; index < result.pixels.size(); ++index) {
		const int difference = int(p_actual.pixels[index]) - p_expected.pixels[index];
		result.pixels[index] =
				static_cast<uint8_t>(std::clamp(128 + AMPLIFICATION * difference, 0, 255));
	}
	return result;
}

/// Goldens are made by the software driver, so that they do not depend on whose machine it is.
std::string find_software_device() {
	for (const DeviceInfo &info : find_rendering_devices()) {
		if (info.is_usable && info.type == "CPU") {
			return text(info.index);
		}
	}
	fail("Golden images are compared under a software driver, and there is none. Install ",
			"mesa-vulkan-drivers.");
}

GoldenImage render_image(RenderFixture &r_fixture, const Scene &p_scene, const std::string &p_id,
		const GoldenSettings &p_settings) {
	const Camera3D &camera = p_settings.camera.empty()
			? *p_scene.find_nodes<Camera3D>().at(0)
			: p_scene.find_node<Camera3D>(p_settings.camera, "Camera");
	RenderRequest request;
	request.scene = build_snapshot(p_scene, camera);
	request.size_px = p_settings.size_px;
	request.technique_override = p_id;
	request.wants_image = true;
	const std::vector<uint8_t> image = r_fixture.renderer->render(request).image;
	GoldenImage golden = { p_settings.size_px, {} };
	for (size_t index = 0; index < image.size(); index += 4) {
		golden.pixels.insert(golden.pixels.end(), &image[index], &image[index] + CHANNEL_COUNT);
	}
	return golden;
}

GoldenImage render_golden(RenderFixture &r_fixture, const std::string &p_scene,
		const std::string &p_id, const GoldenSettings &p_settings) {
	const std::unique_ptr<Scene> scene = load_demo_scene(p_scene);
	if (p_settings.light_settings.contains(p_id)) {
		apply_light_settings(*scene, p_settings.light_settings.at(p_id));
	}
	return render_image(r_fixture, *scene, p_id, p_settings);
}

struct GoldenFile {
	std::string scene;
	std::string id;
	fs::path get_path() const { return fs::path(GOLDEN_FOLDER) / scene / (id + ".png"); }
	bool operator<(const GoldenFile &p_other) const {
		return std::tie(scene, id) < std::tie(p_other.scene, p_other.id);
	}
};

std::vector<GoldenFile> find_goldens() {
	if (!fs::is_directory(GOLDEN_FOLDER)) {
		fail(GOLDEN_FOLDER, " is not there. Run the tests from the repository's root.");
	}
	std::vector<GoldenFile> found;
	for (const fs::directory_entry &folder : fs::directory_iterator(GOLDEN_FOLDER)) {
		if (!folder.is_directory()) {
			continue;
		}
		for (const fs::directory_entry &file : fs::directory_iterator(folder.path())) {
			if (file.path().extension() == ".png") {
				found.push_back({ folder.path().filename().string(), file.path().stem().string() });
			}
		}
	}
	std::sort(found.begin(), found.end());
	return found;
}

/// $GNOMON_UPDATE_GOLDEN, set by update.sh: "all", a scene, or "scene/id" (which may be new).
std::vector<GoldenFile> choose_updates(std::vector<GoldenFile> p_goldens) {
	const char *variable = std::getenv("GNOMON_UPDATE_GOLDEN");
	const std::string requested = variable == nullptr ? "" : variable;
	const size_t slash = requested.find('/');
	if (slash != std::string::npos) {
		return { { requested.substr(0, slash), requested.substr(slash + 1) } };
	}
	std::erase_if(p_goldens, [&](const GoldenFile &p_golden) {
		return requested != "all" && requested != p_golden.scene;
	});
	return p_goldens;
}

void check_golden(RenderFixture &r_fixture, const GoldenFile &p_golden) {
	const GoldenSettings settings = load_settings(p_golden.scene);
	const GoldenImage expected = load_image(p_golden.get_path());
	const GoldenImage actual = render_golden(r_fixture, p_golden.scene, p_golden.id, settings);
	if (is_equal_enough(expected, actual, settings)) {
		return;
	}
	const std::string stem = p_golden.scene + "." + p_golden.id;
	fs::create_directories(FAILURE_FOLDER);
	save_image(fs::path(FAILURE_FOLDER) / (stem + ".expected.png"), expected);
	save_image(fs::path(FAILURE_FOLDER) / (stem + ".actual.png"), actual);
	if (expected.size_px == actual.size_px) {
		save_image(fs::path(FAILURE_FOLDER) / (stem + ".difference.png"),
				amplify_difference(expected, actual));
	}
	const std::string message = text(p_golden.get_path(), " has changed: ",
			100 * compute_differing_share(expected, actual, settings.max_difference),
			" % of the pixels differ by more than ", settings.max_difference, "/255, allowed are ",
			100 * settings.max_pixel_share, " %. Compare ", FAILURE_FOLDER, "/", stem,
			".*.png; if the change is intended, run tests/golden/update.sh ", p_golden.scene, " ",
			p_golden.id, ".");
	FAIL_CHECK(message);
}

} // namespace

TEST_CASE("[GPU][Golden] every image looks as it did when it was accepted") {
	RenderFixture fixture(find_software_device());
	for (const GoldenFile &golden : choose_updates(find_goldens())) {
		ShadowRegistry::get(golden.id);
		save_image(golden.get_path(),
				render_golden(fixture, golden.scene, golden.id, load_settings(golden.scene)));
		MESSAGE("written: ", golden.get_path().string());
	}
	const std::vector<GoldenFile> goldens = find_goldens();
	CHECK_FALSE(goldens.empty());
	for (const GoldenFile &golden : goldens) {
		if (ShadowRegistry::find(golden.id) == nullptr) {
			FAIL_CHECK(golden.get_path().string(), ": no technique of this build has the id \"",
					golden.id, "\". Delete the file with the technique.");
			continue;
		}
		check_golden(fixture, golden);
	}
}

TEST_CASE("[GPU][Golden] canary: a light that moved by its own radius changes the image") {
	RenderFixture fixture(find_software_device());
	REQUIRE_FALSE(ShadowRegistry::get_all().empty());
	const std::string &id = ShadowRegistry::get_all().front().id;
	GoldenSettings settings;
	settings.size_px = glm::uvec2(64);
	const std::unique_ptr<Scene> scene = load_demo_scene("sphere");
	const GoldenImage before = render_image(fixture, *scene, id, settings);
	CHECK(is_equal_enough(before, render_image(fixture, *scene, id, settings), settings));
	Light3D &light = *scene->find_nodes<Light3D>().at(0);
	light.parent_from_node[3].x += 0.4; // its light_size in the scene file
	CHECK_FALSE(is_equal_enough(before, render_image(fixture, *scene, id, settings), settings));
}

TEST_CASE("[Golden] canary: a changed image is noticed, and only beyond the tolerance") {
	const GoldenSettings settings; // 5/255, 0.1 %
	const GoldenImage expected = { glm::uvec2(100), std::vector<uint8_t>(30000, 100) };
	const auto is_accepted = [&](size_t p_pixel_count, uint8_t p_value) {
		GoldenImage changed = expected;
		for (size_t pixel = 0; pixel < p_pixel_count; ++pixel) {
			changed.pixels[3 * pixel + 1] = p_value; // one channel is enough
		}
		return is_equal_enough(expected, changed, settings);
	};
	CHECK(is_accepted(0, 0));
	CHECK(is_accepted(10000, 105)); // all pixels differ by 5
	CHECK(is_accepted(10000, 95));
	CHECK_FALSE(is_accepted(10000, 106));
	CHECK_FALSE(is_accepted(10000, 94));
	CHECK(is_accepted(10, 255)); // 0.1 % of the pixels
	CHECK_FALSE(is_accepted(11, 255));
	GoldenImage smaller = expected;
	smaller.size_px = { 50, 200 };
	CHECK_FALSE(is_equal_enough(expected, smaller, settings));
	CHECK(amplify_difference(expected, expected).pixels == std::vector<uint8_t>(30000, 128));
}
