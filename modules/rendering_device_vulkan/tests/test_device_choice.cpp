#include "modules/rendering_device/tests/device_fixture.h"
#include "modules/rendering_device_vulkan/vulkan_instance.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

std::vector<PhysicalDevice> make_devices() {
	const char *const types[] = { "CPU", "integrated GPU", "discrete GPU", "virtual GPU" };
	std::vector<PhysicalDevice> devices(4);
	for (uint32_t index = 0; index < 4; ++index) {
		devices[index].info.index = index;
		devices[index].info.name = "Maker " + std::string(types[index]);
		devices[index].info.type = types[index];
		devices[index].info.is_usable = true;
	}
	return devices;
}

} // namespace

TEST_CASE("[GPU][RenderingDevice] the listed devices have names, and a usable one of them, with "
		  "timestamps, is created") {
	const std::vector<DeviceInfo> infos = find_rendering_devices();
	REQUIRE_FALSE(infos.empty());
	for (const DeviceInfo &info : infos) {
		CHECK_FALSE(info.name.empty());
		CHECK_FALSE(info.api_version.empty());
		CHECK(info.is_usable == info.refusal.empty());
	}
	DeviceFixture fixture;
	const DeviceInfo &info = fixture.device->get_info();
	CHECK(info.is_usable);
	CHECK(infos[info.index].name == info.name);
	CHECK(fixture.device->get_features().max_texture_size_px >= 4096); // Vulkan's minimum
	CHECK(fixture.device->get_features().timestamps);
}

TEST_CASE("[GPU][RenderingDevice] by default the best type is chosen: discrete first, CPU last") {
	std::vector<PhysicalDevice> devices = make_devices();
	CHECK(choose_device(devices, "").info.type == "discrete GPU");
	devices[2].info.is_usable = false;
	CHECK(choose_device(devices, "").info.type == "integrated GPU");
	devices[1].info.is_usable = false;
	CHECK(choose_device(devices, "").info.type == "virtual GPU");
	devices[3].info.is_usable = false;
	CHECK(choose_device(devices, "").info.type == "CPU");
}

TEST_CASE("[GPU][RenderingDevice] a device is chosen by index or by part of its name in any case") {
	const std::vector<PhysicalDevice> devices = make_devices();
	CHECK(choose_device(devices, "3").info.index == 3);
	CHECK(choose_device(devices, "INTEGRATED").info.index == 1);
	CHECK(choose_device(devices, "maker").info.index == 0);
}

TEST_CASE(
		"[GPU][RenderingDevice] an unknown or unusable device is an error that lists the devices") {
	std::vector<PhysicalDevice> devices = make_devices();
	const std::string unknown = catch_error([&] { choose_device(devices, "radeon"); });
	CHECK(contains(unknown, "\"radeon\""));
	CHECK(contains(unknown, "2 \"Maker discrete GPU\""));
	devices[2].info.is_usable = false;
	devices[2].info.refusal = "Vulkan 1.1, 1.3 is needed";
	CHECK(contains(catch_error([&] { choose_device(devices, "discrete"); }), "1.3 is needed"));
	CHECK(contains(catch_error([&] { choose_device({}, ""); }), "mesa-vulkan-drivers"));
	const std::string real = catch_error([] { create_rendering_device({ .device = "no such" }); });
	CHECK(contains(real, "\"no such\""));
	CHECK(contains(real, find_rendering_devices().front().name));
}

TEST_CASE(
		"[GPU][RenderingDevice] an instance extension that is missing is an error that names it") {
	const std::string error = catch_error(
			[] { create_rendering_device({ .instance_extensions = { "VK_GNOMON_imaginary" } }); });
	CHECK(contains(error, "VK_GNOMON_imaginary"));
}

TEST_CASE("[GPU][RenderingDevice] denied features are reported as absent") {
	const DeviceFixture fixture({},
			{ &DeviceFeatures::geometry_shader, &DeviceFeatures::aliased_memory,
					&DeviceFeatures::depth_bounds, &DeviceFeatures::storage_and_texel_buffers,
					&DeviceFeatures::conditional_rendering });
	const DeviceFeatures &features = fixture.device->get_features();
	CHECK_FALSE(features.geometry_shader);
	CHECK_FALSE(features.aliased_memory);
	CHECK_FALSE(features.depth_bounds);
	CHECK_FALSE(features.storage_and_texel_buffers);
	CHECK_FALSE(features.conditional_rendering);
}

TEST_CASE("[GPU][RenderingDevice] without geometry shaders, pipelines with one are refused") {
	DeviceFixture fixture({}, { &DeviceFeatures::geometry_shader });
	CHECK_FALSE(fixture.device->get_features().geometry_shader);
	const std::string error = catch_error([&] {
		fixture.device->get_raster_pipeline({ .name = "fins",
				.vertex_shader = "tests/triangle.vert",
				.geometry_shader = "tests/triangle.geom" });
	});
	CHECK(contains(error, "'fins'"));
	CHECK(contains(error, "geometry"));
}

TEST_CASE("[GPU][RenderingDevice] without storage texel buffers, a buffer cannot be STORAGE and "
		  "TEXEL") {
	DeviceFixture fixture({}, { &DeviceFeatures::storage_and_texel_buffers });
	const std::vector<uint32_t> words(4);
	fixture.make_buffer("storage", words, BufferUsage::STORAGE);
	fixture.make_buffer("texels", words, BufferUsage::TEXEL);
	const std::string error = catch_error(
			[&] { fixture.make_buffer("both", words, BufferUsage::STORAGE | BufferUsage::TEXEL); });
	CHECK(contains(error, "'both'"));
	CHECK(contains(error, "storage_and_texel_buffers"));
}
