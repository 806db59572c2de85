// The device that draws Godot's frames gives the same masks as a local one.

#include "modules/rendering_device_godot/godot_device.h"
#include "modules/shadows/tests/each_technique.h"

#include <algorithm>

using namespace gnomon;

namespace {

void use_main_device(MaskFixture &r_fixture) {
	r_fixture.shadows.reset();
	r_fixture.transients.reset();
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	r_fixture.device =
			TestDevice(new GodotDevice(server.get_rendering_device(), GodotDevice::Kind::MAIN),
					TestDeviceDeleter());
	r_fixture.transients = std::make_unique<TransientPool>(*r_fixture.device);
	r_fixture.shadows = std::make_unique<ShadowSystem>(*r_fixture.device);
}

} // namespace

TEST_CASE("[GPU][Godot] masks from the device of Godot's frames equal those from a local device") {
	MaskFixture local;
	MaskFixture main;
	use_main_device(main);
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		const MaskResult expected = local.render_mask(scene, p_info.id);
		for (int frame = 0; frame < 2; ++frame) { // the second reuses cached maps
			const MaskResult found = main.render_mask(scene, p_info.id);
			CHECK(count_receivers(found) > 0);
			CHECK(found.receiver == expected.receiver);
			CHECK(found.visibility == expected.visibility);
		}
	});
}

TEST_CASE("[GPU][Godot] a texture of Godot is drawn into, and stays Godot's") {
	MaskFixture fixture;
	auto &device = static_cast<GodotDevice &>(*fixture.device);
	const TextureDesc desc = { "of Godot", Format::R16_SFLOAT, glm::uvec2(8), 1,
		TextureUsage::COPY_TARGET | TextureUsage::COPY_SOURCE };
	const TextureRID owned = device.create_texture(desc);
	const TextureRID imported = device.import_texture(device.get_rid(owned), desc);
	RenderGraph graph(device, *fixture.transients);
	const RGTexture target = graph.import_texture(imported, RenderGraph::ImportedContent::NONE);
	graph.add_pass("clear").writes(target, Access::COPY_WRITE).execute([=](PassContext &p_context) {
		p_context.commands.clear_color(p_context.get(target), glm::vec4(0.25f));
	});
	std::vector<uint8_t> bytes;
	add_readback(graph, target, bytes);
	graph.execute(RenderGraph::Mode::WAIT);
	REQUIRE(bytes.size() == 2 * 64); // 8 x 8 half floats
	CHECK(glm::unpackHalf1x16(uint16_t(bytes[0] | bytes[1] << 8)) == 0.25f);
	device.free(imported);
	const std::vector<std::string> alive = list_live_resources(device);
	CHECK(std::count(alive.begin(), alive.end(), "texture 'of Godot'") == 1);
	device.free(owned);
}
