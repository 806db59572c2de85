#include "modules/rendering_device/tests/device_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;
using SubmitMode = RenderingDevice::SubmitMode;

namespace {

/// A buffer of one word, and the words that were read back from it.
struct ReadBackFixture : DeviceFixture {
	OwnedBuffer source;
	std::vector<uint32_t> words;

	explicit ReadBackFixture(uint32_t p_word) {
		source = make_buffer("source", std::vector<uint32_t>{ p_word },
				BufferUsage::STORAGE | BufferUsage::COPY_SOURCE);
	}

	void record() {
		device->begin_commands();
		device->read_back(source.get(), [this](std::span<const uint8_t> p_bytes) {
			REQUIRE(p_bytes.size() == sizeof(uint32_t));
			words.push_back(0);
			std::memcpy(&words.back(), p_bytes.data(), sizeof(uint32_t));
		});
	}
};

} // namespace

TEST_CASE("[GPU][RenderingDevice] a read-back arrives once, after its submission has finished") {
	ReadBackFixture fixture(7);
	fixture.record();
	CHECK(fixture.words.empty());
	fixture.device->submit_commands(SubmitMode::WAIT);
	CHECK(fixture.words == std::vector<uint32_t>{ 7 });
	fixture.record();
	fixture.device->submit_commands(SubmitMode::QUEUE);
	fixture.device->wait_idle();
	CHECK(fixture.words == std::vector<uint32_t>{ 7, 7 });
	for (int frame = 0; frame < 3; ++frame) { // two are in flight, so that the third waits
		fixture.record();
		fixture.device->submit_commands(SubmitMode::QUEUE);
	}
	CHECK(fixture.words.size() >= 3);
	fixture.device->wait_idle();
	CHECK(fixture.words.size() == 5);
}

TEST_CASE("[GPU][RenderingDevice] abandoned commands read nothing back") {
	ReadBackFixture fixture(7);
	fixture.record();
	fixture.device->abandon_commands();
	fixture.device->begin_commands();
	fixture.device->submit_commands(SubmitMode::WAIT);
	CHECK(fixture.words.empty());
}

TEST_CASE("[GPU][RenderingDevice] a refused submission reads nothing back") {
	ReadBackFixture fixture(7);
	fixture.record();
	inject_fault(*fixture.device, "out_of_memory");
	CHECK_THROWS_AS(fixture.device->submit_commands(SubmitMode::WAIT), std::bad_alloc);
	fixture.device->begin_commands();
	fixture.device->submit_commands(SubmitMode::WAIT);
	CHECK(fixture.words.empty());
}

TEST_CASE("[GPU][RenderingDevice] a layer of a texture is read back in tightly packed rows") {
	DeviceFixture fixture;
	const std::vector<uint8_t> texels = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 }; // two layers
	const OwnedTexture texture(*fixture.device,
			fixture.device->create_texture_with_data({ .name = "texture",
															 .format = Format::R8_UNORM,
															 .size_px = { 3, 2 },
															 .layer_count = 2,
															 .usage = TextureUsage::COPY_SOURCE,
															 .is_array = true },
					texels));
	std::vector<uint8_t> found;
	CommandList &commands = fixture.device->begin_commands();
	const Barrier barrier = {
		.texture = texture.get(), .before = Access::SHADER_READ_FRAGMENT, .after = Access::COPY_READ
	};
	commands.barriers({ &barrier, 1 });
	fixture.device->read_back(texture.get(), /*p_layer=*/1, [&](std::span<const uint8_t> p_bytes) {
		found.assign(p_bytes.begin(), p_bytes.end());
	});
	fixture.device->submit_commands(SubmitMode::WAIT);
	CHECK(found == std::vector<uint8_t>{ 7, 8, 9, 10, 11, 12 });
}
