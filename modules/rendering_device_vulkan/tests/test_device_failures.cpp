#include "modules/rendering_device/tests/device_fixture.h"

#include <doctest/doctest.h>

#include <fstream>

using namespace gnomon;
using SubmitMode = RenderingDevice::SubmitMode;

namespace {

// Of a Vulkan pipeline cache; some drivers store nothing more.
const size_t PIPELINE_CACHE_HEADER_BYTES = 32;
const double MAX_SPAN_MS = 10000; // a negative difference of timestamps wraps to more

void record_span(CommandList &r_commands, const std::string &p_name, BufferRID p_buffer) {
	r_commands.begin_span(p_name);
	r_commands.clear_buffer(p_buffer);
	r_commands.end_span();
	const Barrier barrier = {
		.buffer = p_buffer, .before = Access::COPY_WRITE, .after = Access::COPY_WRITE
	};
	r_commands.barriers({ &barrier, 1 });
}

OwnedBuffer make_filled(RenderingDevice &r_device) {
	return OwnedBuffer(r_device,
			r_device.create_buffer({ .name = "filled",
					.size_bytes = 1 << 20,
					.usage = BufferUsage::COPY_TARGET }));
}

/// Returns the pipeline cache: the only file that ends with .bin.
std::filesystem::path find_cache_file(const std::filesystem::path &p_folder) {
	for (const auto &entry : std::filesystem::directory_iterator(p_folder)) {
		if (entry.path().extension() == ".bin") {
			return entry.path();
		}
	}
	return {};
}

/// Creates and destroys a device with one pipeline. The parameter shows that a temporary cache
/// folder is set.
void make_one_pipeline(const TemporaryCache &) {
	const auto device = create_rendering_device({ .validation = wants_validation() });
	device->get_compute_pipeline({ .name = "scale", .shader = "tests/scale.comp" });
}

} // namespace

TEST_CASE("[GPU][RenderingDevice] spans of a finished submission have their names and positive "
		  "times") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer buffer = make_filled(device);
	CHECK(device.get_gpu_spans().empty());
	// 64 fill a pool of queries; more need several. Two submissions in flight use pools of their
	// own, and use them again.
	for (const int span_count : { 2, 64, 65, 200, 3, 129, 200 }) {
		CAPTURE(span_count);
		for (const SubmitMode mode : { SubmitMode::QUEUE, SubmitMode::WAIT }) {
			CommandList &commands = device.begin_commands();
			for (int index = 0; index < span_count; ++index) {
				record_span(commands, text("span ", index), buffer.get());
			}
			device.submit_commands(mode);
		}
		REQUIRE(device.get_gpu_spans().size() == static_cast<size_t>(span_count));
		bool are_times_plausible = true;
		for (const GpuSpan &span : device.get_gpu_spans()) {
			are_times_plausible =
					are_times_plausible && span.gpu_ms > 0.0 && span.gpu_ms < MAX_SPAN_MS;
		}
		CHECK(are_times_plausible);
		CHECK(device.get_gpu_spans().back().name == text("span ", span_count - 1));
	}
}

TEST_CASE("[GPU][RenderingDevice] a lost device names the last pass, and so do later calls") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer buffer = make_filled(device);
	CommandList &commands = device.begin_commands();
	record_span(commands, "G-buffer", buffer.get());
	record_span(commands, "Lamp: resolve", buffer.get());
	inject_fault(device, "device_lost");
	const std::string error = catch_error([&] { device.submit_commands(SubmitMode::WAIT); });
	CHECK(contains(error, "pass 'Lamp: resolve'"));
	CHECK(catch_error([&] { device.begin_commands(); }) == error);
	CHECK(catch_error([&] { device.create_texture({ .name = "late" }); }) == error);
	CHECK(catch_error([&] { device.create_sampler({ .name = "late" }); }) == error);
	CHECK(catch_error([&] { device.wait_idle(); }) == error);
	CHECK(catch_error([&] { device.get_compute_pipeline({ .shader = "tests/scale.comp" }); }) ==
			error);
}

TEST_CASE("[GPU][RenderingDevice] the validation layers report a deliberate error") {
	if (!wants_validation()) {
		MESSAGE("the validation layers report elsewhere, see GNOMON_TEST_VALIDATION");
		return;
	}
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const unsigned count_before = get_validation_message_count();
	SUBCASE("a missing barrier, seen by the synchronization layer") {
		const OwnedBuffer buffer = make_filled(device);
		ExpectedValidationMessages expected;
		CommandList &commands = device.begin_commands();
		commands.clear_buffer(buffer.get());
		commands.clear_buffer(buffer.get());
		device.submit_commands(SubmitMode::WAIT);
		REQUIRE_FALSE(expected.get_messages().empty());
		CHECK(contains(expected.get_messages().front(), "SYNC-HAZARD-WRITE-AFTER-WRITE"));
	}
	SUBCASE("a missing usage, seen by the core checks") {
		const OwnedBuffer buffer(device,
				device.create_buffer(
						{ .name = "vertices", .size_bytes = 16, .usage = BufferUsage::VERTEX }));
		ExpectedValidationMessages expected;
		CommandList &commands = device.begin_commands();
		commands.clear_buffer(buffer.get());
		device.submit_commands(SubmitMode::WAIT);
		REQUIRE_FALSE(expected.get_messages().empty());
		CHECK(contains(expected.get_messages().front(), "vertices")); // objects have their names
	}
	CHECK(get_validation_message_count() == count_before);
}

TEST_CASE("[GPU][RenderingDevice] pipelines are cached between runs") {
	TemporaryCache cache;
	make_one_pipeline(cache);
	const std::filesystem::path file = find_cache_file(cache.path);
	REQUIRE_FALSE(file.empty());
	const std::vector<uint8_t> good = load_file(file);
	CHECK(good.size() >= PIPELINE_CACHE_HEADER_BYTES);

	CaughtLog log;
	SUBCASE("an intact file is used without a log message") {
		make_one_pipeline(cache);
		CHECK(log.lines.empty());
	}
	SUBCASE("a file with a changed byte is replaced") {
		std::vector<uint8_t> bytes = good;
		bytes[bytes.size() / 2] ^= 0x10;
		save_file_atomically(file, bytes);
		make_one_pipeline(cache);
		CHECK(log.count("damaged") == 1);
	}
	SUBCASE("a file that was cut short is replaced") {
		std::filesystem::resize_file(file, good.size() / 2);
		make_one_pipeline(cache);
		CHECK(log.count("damaged") == 1);
	}
	SUBCASE("an empty file is replaced") {
		std::filesystem::resize_file(file, 0);
		make_one_pipeline(cache);
		CHECK(log.count("damaged") == 1);
	}
	SUBCASE("a file of another driver is replaced") {
		const std::vector<uint8_t> foreign(64, 7);
		save_cache_entry(file.filename().string(), foreign);
		make_one_pipeline(cache);
		CHECK(log.count("not written by this driver") == 1);
	}
	CHECK(load_cache_entry(file.filename().string()).size() >= PIPELINE_CACHE_HEADER_BYTES);
	log.lines.clear();
	make_one_pipeline(cache);
	CHECK(log.lines.empty());
}
