// Soak test: draws frames of randomly changing scenes and checks that masks are valid and nothing
// leaks. Draws 150 frames unless GNOMON_SOAK_FRAMES is set. GNOMON_SOAK_SEED sets the seed. See
// run_soak.py.
//
// Each block of frames is drawn three times. Only growth of the process in the third run counts as
// a leak of Gnomon, because Mesa's software driver compiles and keeps shaders for each new use.

#include "modules/core/error.h"
#include "modules/core/module_registry.h"
#include "modules/core/tests/sanitized.h"
#include "modules/rendering_device/tests/device_fixture.h"

#include "tests/stability/random_scene.h"

#include <doctest/doctest.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iterator>

using namespace gnomon;

namespace {

const uint32_t FRAMES_PER_SCENE = 25;
const uint32_t MAX_BLOCK_FRAMES = 500; // different frames of a block, which is then repeated
const uint32_t IDLE_FRAME_COUNT = 4;   // the transient pool caches three frame layouts
const double FRAME_LIMIT_S = 60;
const uint64_t MIB = 1 << 20;
const uint32_t REPEAT_COUNT = 3;
const uint64_t MAX_GROWTH_BYTES = 12 * MIB; // of the process in the third run

uint32_t get_number(const char *p_variable, uint32_t p_default) {
	const char *value = std::getenv(p_variable);
	if (value == nullptr) {
		return p_default;
	}
	uint32_t number = 0;
	const char *end = value + std::strlen(value);
	const auto result = std::from_chars(value, end, number);
	REQUIRE_MESSAGE((result.ec == std::errc() && result.ptr == end && number > 0), p_variable,
			" is \"", value, "\", must be a whole number from 1");
	return number;
}

uint64_t read_resident_bytes() {
	::malloc_trim(0);
	unsigned long long total = 0;
	unsigned long long resident = 0;
	FILE *file = std::fopen("/proc/self/statm", "r");
	REQUIRE(file != nullptr);
	const int count = std::fscanf(file, "%llu %llu", &total, &resident);
	std::fclose(file);
	REQUIRE(count == 2);
	return resident * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// The resources that are alive after a scene has ended.
struct LiveResources {
	uint64_t used_bytes = 0;
	std::vector<std::string> resources; // sorted
};

/// Describes which resources were added and removed since p_before. Empty if nothing changed.
std::string describe_difference(const LiveResources &p_before, const LiveResources &p_now) {
	std::string difference;
	const auto add = [&](const char *p_what, const LiveResources &p_first,
							 const LiveResources &p_second) {
		std::vector<std::string> names;
		std::set_difference(p_first.resources.begin(), p_first.resources.end(),
				p_second.resources.begin(), p_second.resources.end(), std::back_inserter(names));
		for (const std::string &name : names) {
			difference += text(p_what, " ", name, "; ");
		}
	};
	add("added:", p_now, p_before);
	add("removed:", p_before, p_now);
	if (p_before.used_bytes != p_now.used_bytes) {
		difference +=
				text("device memory: ", p_now.used_bytes, " bytes, before ", p_before.used_bytes);
	}
	return difference;
}

/// Draws random scenes with one device and one renderer, and checks every frame.
class Soak {
public:
	explicit Soak(uint32_t p_seed) : seed(p_seed), random(p_seed) {
		DeviceOptions options;
		options.validation = wants_validation();
		options.wait_limit_s = FRAME_LIMIT_S;
		device = create_rendering_device(options);
		device_resources = measure();
		renderer = std::make_unique<Renderer>(*device);
		idle_resources = measure_idle();
	}
	~Soak() {
		for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
			if (!module.is_enabled) {
				ModuleRegistry::set_enabled(module.name, true);
			}
		}
	}

	void run(uint32_t p_frame_count) {
		const uint32_t different_count = std::max(p_frame_count / REPEAT_COUNT, 1u);
		const uint32_t block_count = (different_count + MAX_BLOCK_FRAMES - 1) / MAX_BLOCK_FRAMES;
		for (uint32_t block = 0; block < block_count; ++block) {
			CAPTURE(block);
			const uint32_t begin = different_count * block / block_count;
			const uint32_t end = different_count * (block + 1) / block_count;
			run_block(seed + block, end - begin);
			run_block(seed + block, end - begin);
			const uint64_t before = read_resident_bytes();
			run_block(seed + block, end - begin);
			const uint64_t after = read_resident_bytes();
			// Sanitizers keep freed memory.
			CHECK((after <= before + MAX_GROWTH_BYTES || IS_SANITIZED));
			if (prints_progress) {
				std::printf("block %u: %llu MiB resident, then %llu; %u pipelines\n", block,
						static_cast<unsigned long long>(before / MIB),
						static_cast<unsigned long long>(after / MIB), get_pipeline_count(*device));
			}
		}
		renderer.reset();
		CHECK(describe_difference(device_resources, measure()) == "");
	}

private:
	void run_block(uint32_t p_seed, uint32_t p_frame_count) {
		random = Random(p_seed);
		for (uint32_t frame = 0; frame < p_frame_count; ++frame) {
			CAPTURE(p_seed);
			CAPTURE(frame);
			if (frame % FRAMES_PER_SCENE == 0) {
				close_scene();
				scene = std::make_unique<RandomScene>(random);
			}
			if (random.chance(0.1)) {
				switch_module();
			}
			scene->change();
			draw();
			CHECK(get_validation_message_count() == message_count);
			if (prints_progress) {
				std::printf("frame %u\n", frame); // run_soak.py waits for this line
				std::fflush(stdout);
			}
		}
		close_scene();
	}

	void close_scene() {
		scene.reset();
		CHECK(describe_difference(idle_resources, measure_idle()) == "");
	}

	LiveResources measure() {
		device->wait_idle();
		return { device->get_memory_use().used_bytes, list_live_resources(*device) };
	}

	/// Enables all modules, then draws empty frames until the previous scene's resources are freed.
	LiveResources measure_idle() {
		for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
			if (!module.is_enabled) {
				ModuleRegistry::set_enabled(module.name, true);
			}
		}
		for (uint32_t index = 0; index < IDLE_FRAME_COUNT; ++index) {
			RenderRequest request;
			request.scene = empty.snap();
			request.size_px = glm::uvec2(16 + index); // another layout each time
			renderer->render(request);
		}
		return measure();
	}

	/// Enables or disables a random module.
	void switch_module() {
		std::vector<std::string> names;
		for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
			if (module.can_disable) {
				names.push_back(module.name);
			}
		}
		if (!names.empty()) {
			const std::string &name = names[random.choose(names.size())];
			ModuleRegistry::set_enabled(name, !ModuleRegistry::is_enabled(name));
		}
	}

	void draw() {
		const RenderRequest request = scene->make_request();
		CAPTURE(request.size_px.x);
		CAPTURE(request.size_px.y);
		CAPTURE(request.mask_light);
		CAPTURE(request.technique_override);
		const bool runs_out_of_memory = random.chance(0.02);
		if (runs_out_of_memory) {
			inject_fault(*device, "out_of_memory");
			CHECK_THROWS_AS(renderer->render(request), std::bad_alloc);
			return;
		}
		const RenderResult result = renderer->render(request);
		if (request.wants_mask) {
			CHECK(is_valid_mask(result));
			for (const glm::vec3 &color : result.colors) {
				if (!(glm::all(glm::greaterThanEqual(color, glm::vec3(0.0f))) &&
							glm::all(glm::lessThanEqual(color, glm::vec3(1.0f))))) {
					FAIL_CHECK("a mask's colour is ", color.x, ", ", color.y, ", ", color.z,
							"; each must be 0..1");
					break;
				}
			}
		}
		if (request.wants_image) {
			// NaN values are written as black, so only the size is checked.
			CHECK(result.image.size() == size_t(4) * request.size_px.x * request.size_px.y);
		}
	}

	const bool prints_progress = std::getenv("GNOMON_SOAK_FRAMES") != nullptr;
	const uint32_t seed;
	Random random;
	CaughtLog log; // catches the messages of fallbacks and of the reference
	TemporaryCache cache;
	EmptyScene empty;
	std::unique_ptr<RenderingDevice> device;
	std::unique_ptr<Renderer> renderer;
	std::unique_ptr<RandomScene> scene;
	LiveResources device_resources; // of the device alone
	LiveResources idle_resources;	// of the device and a renderer that drew only empty scenes
	const unsigned message_count = get_validation_message_count();
};

} // namespace

TEST_CASE("[GPU][Soak] randomly changing scenes leak no resources, and all masks are in 0..1") {
	const uint32_t seed = get_number("GNOMON_SOAK_SEED", 20100901);
	CAPTURE(seed);
	Soak soak(seed);
	soak.run(get_number("GNOMON_SOAK_FRAMES", 150));
}
