#include "modules/rendering_device/tests/triangle_fixture.h"

#include <doctest/doctest.h>

#include <chrono>

using namespace gnomon;
using SubmitMode = RenderingDevice::SubmitMode;

namespace {

const double WAIT_LIMIT_S = 1.0;
const uint64_t TARGET_BYTES = 64 * sizeof(float); // a float per invocation of a group of slow.comp
const uint32_t ITERATION_COUNT = 65535; // of the loop; software drivers end an invocation there
const uint32_t MAX_GROUP_COUNT = 65535; // every device allows this many; takes seconds on 128 cores

OwnedBuffer make_target(RenderingDevice &r_device) {
	return OwnedBuffer(r_device,
			r_device.create_buffer({ .name = "target",
					.size_bytes = TARGET_BYTES,
					.usage = BufferUsage::STORAGE | BufferUsage::COPY_TARGET }));
}

void record_work(RenderingDevice &r_device, CommandList &r_commands, const std::string &p_name,
		BufferRID p_target, uint32_t p_group_count = 1) {
	const Barrier barrier = { .buffer = p_target,
		.before = Access::SHADER_WRITE_COMPUTE,
		.after = Access::SHADER_WRITE_COMPUTE };
	r_commands.begin_span(p_name);
	r_commands.barriers({ &barrier, 1 });
	r_commands.bind_pipeline(
			r_device.get_compute_pipeline({ .name = "slow", .shader = "tests/slow.comp" }));
	r_commands.bind_resources({ { 0, p_target } });
	r_commands.push_constants(ITERATION_COUNT);
	r_commands.dispatch({ p_group_count, 1, 1 });
	r_commands.end_span();
}

/// Only CPU devices are slow enough for these tests; a fast GPU would finish all the work at once.
bool is_slow(const RenderingDevice &p_device) {
	return p_device.get_info().type == "CPU";
}

/// Compiles the pipeline, so that the measured times do not include it.
void warm_up(RenderingDevice &r_device, BufferRID p_target) {
	record_work(r_device, r_device.begin_commands(), "warm up", p_target);
	r_device.submit_commands(SubmitMode::WAIT);
}

double compute_seconds_since(std::chrono::steady_clock::time_point p_start) {
	return std::chrono::duration<double>(std::chrono::steady_clock::now() - p_start).count();
}

/// Sets an environment variable, and unsets it at the end of the scope.
struct EnvironmentVariable {
	const char *name;
	EnvironmentVariable(const char *p_name, const char *p_value) : name(p_name) {
		set_environment_variable(name, p_value);
	}
	~EnvironmentVariable() { set_environment_variable(name, ""); }
	EnvironmentVariable(const EnvironmentVariable &) = delete;
	EnvironmentVariable &operator=(const EnvironmentVariable &) = delete;
};

} // namespace

TEST_CASE("[GPU][RenderingDevice] a pass that exceeds the timeout is named, and the device is "
		  "treated as lost") {
	DeviceFixture fixture({ .wait_limit_s = WAIT_LIMIT_S });
	RenderingDevice &device = *fixture.device;
	if (!is_slow(device)) {
		return;
	}
	const OwnedBuffer target = make_target(device);
	warm_up(device, target.get());
	std::string error;
	for (uint32_t groups = 1; error.empty() && groups <= MAX_GROUP_COUNT; groups *= 3) {
		CommandList &commands = device.begin_commands();
		record_work(device, commands, "G-buffer", target.get());
		record_work(device, commands, "Lamp: resolve", target.get(), groups);
		record_work(device, commands, "tone map", target.get());
		error = catch_error([&] { device.submit_commands(SubmitMode::WAIT); });
	}
	CHECK(contains(error, "no progress for 1 s, in pass 'Lamp: resolve'"));
	CHECK(contains(error, "GNOMON_DEVICE_TIMEOUT_S"));
	CHECK_THROWS_AS(device.begin_commands(), DeviceLost);
	CHECK(catch_error([&] { device.wait_idle(); }) == error);
}

TEST_CASE("[GPU][RenderingDevice] passes that exceed the timeout only together do not time out") {
	DeviceFixture fixture({ .wait_limit_s = WAIT_LIMIT_S });
	RenderingDevice &device = *fixture.device;
	if (!is_slow(device)) {
		return;
	}
	const OwnedBuffer target = make_target(device);
	warm_up(device, target.get());
	// Double the work until the passes together exceed the timeout. Then each takes at most about
	// 2 / PASS_COUNT of it.
	const uint32_t PASS_COUNT = 40;
	double seconds = 0;
	for (uint32_t groups = 1; seconds <= WAIT_LIMIT_S; groups *= 2) {
		REQUIRE(groups <= MAX_GROUP_COUNT);
		CommandList &commands = device.begin_commands();
		for (uint32_t index = 0; index < PASS_COUNT; ++index) {
			record_work(device, commands, text("pass ", index), target.get(), groups);
		}
		const auto start = std::chrono::steady_clock::now();
		device.submit_commands(SubmitMode::WAIT); // throws if it times out
		seconds = compute_seconds_since(start);
	}
}

TEST_CASE("[GPU][RenderingDevice] a submission that never begins is named by its first pass") {
	DeviceFixture fixture({ .wait_limit_s = WAIT_LIMIT_S });
	RenderingDevice &device = *fixture.device;
	OwnedBuffer target = make_target(device);
	record_work(device, device.begin_commands(), "earlier pass", target.get());
	device.submit_commands(SubmitMode::WAIT);
	record_work(device, device.begin_commands(), "G-buffer", target.get());
	inject_fault(device, "hang");
	const auto start = std::chrono::steady_clock::now();
	device.submit_commands(SubmitMode::QUEUE); // the next call that waits notices it
	const std::string error = catch_error([&] { device.wait_idle(); });
	CHECK(contains(error, "before pass 'G-buffer' began"));
	CHECK(compute_seconds_since(start) >= WAIT_LIMIT_S);
	release_injected_hang(device);
	target.reset();
	fixture.device.reset();
	CHECK_FALSE(has_device_hung());
}

TEST_CASE("[GPU][RenderingDevice] a pipeline whose compilation exceeds the timeout is named while "
		  "it compiles") {
	// The injected fault ends when the warning has been logged, however long that takes.
	DeviceFixture fixture({ .wait_limit_s = 0.01 });
	RenderingDevice &device = *fixture.device;
	CaughtLog log;
	inject_fault(device, "slow_compilation@pass:resolve");
	SUBCASE("a compute pipeline") {
		device.get_compute_pipeline({ .name = "Lamp: resolve", .shader = "tests/scale.comp" });
		CHECK(log.count("compiling pipeline 'Lamp: resolve' for 0.01 s") == 1);
	}
	SUBCASE("a raster pipeline") {
		RasterPipelineDesc desc = make_triangle_desc();
		desc.name = "resolve layers";
		device.get_raster_pipeline(desc);
		CHECK(log.count("compiling pipeline 'resolve layers' for 0.01 s") == 1);
	}
	CHECK(log.count("GNOMON_DEVICE_TIMEOUT_S") >= 1);
}

TEST_CASE("[GPU][RenderingDevice] pipelines that compile within the timeout are not named") {
	DeviceFixture fixture({ .wait_limit_s = 3600 });
	CaughtLog log;
	fixture.device->get_compute_pipeline({ .name = "scale", .shader = "tests/scale.comp" });
	CHECK(log.lines.empty());
	DeviceFixture endless({ .wait_limit_s = 0 });
	inject_fault(*endless.device, "slow_compilation"); // without a timeout there is no warning
	endless.device->get_compute_pipeline({ .name = "scale", .shader = "tests/scale.comp" });
	CHECK(log.lines.empty());
}

TEST_CASE("[GPU][RenderingDevice] running out of memory in a submission is reported once, then the "
		  "device keeps working") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer target = make_target(device);
	for (int repeat = 0; repeat < 3; ++repeat) {
		inject_fault(device, "out_of_memory");
		record_work(device, device.begin_commands(), "pass", target.get());
		CHECK_THROWS_AS(device.submit_commands(SubmitMode::WAIT), std::bad_alloc);
		record_work(device, device.begin_commands(), "pass", target.get());
		device.submit_commands(SubmitMode::WAIT);
	}
	CHECK(list_live_resources(device) == std::vector<std::string>{ "buffer 'target'" });
}

TEST_CASE("[GPU][RenderingDevice] environment variables set limits, and bad ones are refused") {
	SUBCASE("the memory budget") {
		const EnvironmentVariable variable("GNOMON_MEMORY_BUDGET_MIB", "3");
		DeviceFixture fixture;
		CHECK(fixture.device->get_memory_use().budget_bytes == 3 << 20);
		const std::string error = catch_error([&] {
			fixture.device->create_buffer(
					{ .name = "large", .size_bytes = 4 << 20, .usage = BufferUsage::STORAGE });
		});
		CHECK(contains(error, "Out of device memory: buffer 'large' needs 4096 KiB"));
	}
	SUBCASE("options of the program take precedence") {
		const EnvironmentVariable variable("GNOMON_MEMORY_BUDGET_MIB", "3");
		DeviceFixture fixture({ .memory_budget_bytes = 5 << 20 });
		CHECK(fixture.device->get_memory_use().budget_bytes == 5 << 20);
	}
	for (const char *name : { "GNOMON_MEMORY_BUDGET_MIB", "GNOMON_DEVICE_TIMEOUT_S" }) {
		for (const char *value : { "-1", "many", "1e99", "nan", "5 s" }) {
			const EnvironmentVariable variable(name, value);
			const std::string error = catch_error([] { create_rendering_device({}); });
			CHECK(contains(error, text(name, " is \"", value, "\", must be 0..")));
		}
	}
	for (const char *value : { "fire", "hang@", "hang@12", "hang@pass", "hang@pass:", "hang@file:",
				 "hang@frame:3", "fire@pass:resolve", "@pass:resolve" }) {
		const EnvironmentVariable variable("GNOMON_INJECT_FAULT", value);
		const std::string error = catch_error([] { create_rendering_device({}); });
		CHECK(contains(error, text("GNOMON_INJECT_FAULT is \"", value, "\"")));
	}
}

TEST_CASE("[GPU][RenderingDevice] a fault set in the environment happens once, in the submission "
		  "that it names") {
	const auto submit = [](DeviceFixture &r_fixture, std::initializer_list<const char *> p_passes) {
		RenderingDevice &device = *r_fixture.device;
		CommandList &commands = device.begin_commands();
		for (const char *pass : p_passes) {
			commands.begin_span(pass);
			commands.end_span();
		}
		device.submit_commands(SubmitMode::WAIT);
	};
	SUBCASE("the first one") {
		const EnvironmentVariable variable("GNOMON_INJECT_FAULT", "device_lost");
		DeviceFixture fixture;
		CHECK_THROWS_AS(submit(fixture, {}), DeviceLost);
	}
	SUBCASE("the first one with that pass, which the message names") {
		const EnvironmentVariable variable("GNOMON_INJECT_FAULT", "device_lost@pass:resolve");
		DeviceFixture fixture;
		submit(fixture, {});
		submit(fixture, { "G-buffer" });
		const std::string error = catch_error([&] {
			submit(fixture, { "G-buffer", "Lamp: resolve", "tone map" });
		});
		CHECK(contains(error, "pass 'Lamp: resolve'"));
	}
	SUBCASE("the first one after that file exists") {
		const TemporaryFolder folder;
		const std::filesystem::path file = folder.path / "a file";
		const EnvironmentVariable variable(
				"GNOMON_INJECT_FAULT", text("out_of_memory@file:", file.string()).c_str());
		DeviceFixture fixture;
		submit(fixture, { "G-buffer" });
		save_file_atomically(file, std::string_view("here"));
		CHECK_THROWS_AS(submit(fixture, { "G-buffer" }), std::bad_alloc);
		submit(fixture, { "G-buffer" });
	}
}
