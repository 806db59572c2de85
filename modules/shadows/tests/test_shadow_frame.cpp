// The interface of ShadowFrame for hosts: surfaces, masks of all lights, layers, shared meshes.

#include "modules/shadows/tests/each_technique.h"

#include <algorithm>

using namespace gnomon;

namespace {

constexpr glm::uvec2 SIZE_PX(128);

MaskRequest make_request(const SmallScene &p_scene) {
	MaskRequest request;
	request.scene = p_scene.snap();
	request.size_px = SIZE_PX;
	request.technique_override = ShadowRegistry::find_default()->id;
	return request;
}

/// A texture array that outlives a frame, with p_count layers.
struct HeldMasks {
	OwnedTexture texture;
	HeldMasks(RenderingDevice &p_device, Format p_format, uint32_t p_count) :
			texture(p_device,
					p_device.create_texture({ "held masks", p_format, SIZE_PX, p_count,
							TextureUsage::STORAGE | TextureUsage::SAMPLED |
									TextureUsage::COPY_SOURCE | TextureUsage::COPY_TARGET,
							/*is_array=*/true })) {}
};

/// Copies the masks of all lights into layers of an array, and returns each layer's values: 4 per
/// texel for RGBA16_SFLOAT, 1 for R16_SFLOAT.
std::vector<std::vector<float>> hold_masks(
		MaskFixture &r_fixture, const SmallScene &p_scene, Format p_format) {
	const std::shared_ptr<const SceneSnapshot> scene = p_scene.snap();
	const uint32_t count = static_cast<uint32_t>(scene->lights.size());
	HeldMasks held(*r_fixture.device, p_format, count);
	std::vector<std::vector<uint8_t>> texels(count);
	RenderGraph graph(*r_fixture.device, *r_fixture.transients);
	FramePlan plan;
	ShadowFrame frame(*r_fixture.shadows, graph, plan, scene, SIZE_PX,
			{ ShadowRegistry::find_default()->id });
	frame.set_surfaces(
			add_surface_pass(graph, *r_fixture.shadows, *scene, SIZE_PX, frame.get_constants()));
	const RGTexture array =
			graph.import_texture(held.texture.get(), RenderGraph::ImportedContent::NONE);
	const std::vector<LightShadow> shadows = frame.add_all_lights();
	for (uint32_t index = 0; index < count; ++index) {
		frame.hold(shadows[index], array, index);
	}
	for (uint32_t index = 0; index < count; ++index) {
		add_readback(graph, array, texels[index], index);
	}
	graph.execute(RenderGraph::Mode::WAIT);
	frame.end();
	std::vector<std::vector<float>> values(count);
	for (uint32_t index = 0; index < count; ++index) {
		for (size_t byte = 0; byte < texels[index].size(); byte += 2) {
			uint16_t half = 0;
			std::memcpy(&half, &texels[index][byte], sizeof(half));
			values[index].push_back(glm::unpackHalf1x16(half));
		}
	}
	return values;
}

} // namespace

TEST_CASE("[GPU][Shadows] normals from depth equal the face normals at 99.5 % of the pixels") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(get_light_type_name(type));
		MaskRequest request = make_request(SmallScene(type));
		request.wants_surfaces = true;
		const MaskResult drawn = fixture.render(request);
		request.has_normals = false;
		const MaskResult reconstructed = fixture.render(request);
		CHECK_FALSE(reconstructed.plan.is_skipped("", "normals from depth"));
		CHECK(is_valid_mask(reconstructed));
		size_t count = 0;
		size_t wrong_normal_count = 0;
		size_t wrong_mask_count = 0;
		for (size_t index = 0; index < drawn.surfaces.size(); ++index) {
			const SurfacePoint &before = drawn.surfaces[index];
			if (!before.is_valid) {
				continue;
			}
			++count;
			wrong_normal_count += glm::distance(before.geometric_normal,
										  reconstructed.surfaces[index].geometric_normal) > 2e-3f;
			wrong_mask_count += drawn.receiver[index] != reconstructed.receiver[index] ||
					std::abs(drawn.visibility[index] - reconstructed.visibility[index]) >
							1.0f / 255; // one step of an 8-bit image
		}
		CHECK(count > 5000);
		CHECK(wrong_normal_count <= count / 200);
		CHECK(wrong_mask_count <= count / 200);
	}
}

TEST_CASE("[GPU][Shadows] normals from depth are finite and face the viewer at any image size") {
	MaskFixture fixture;
	SmallScene scene;
	for (const glm::uvec2 size_px :
			{ glm::uvec2(1, 1), glm::uvec2(1, 40), glm::uvec2(40, 1), glm::uvec2(2, 3) }) {
		CAPTURE(size_px.x);
		MaskRequest request = make_request(scene);
		request.size_px = size_px;
		request.has_normals = false;
		request.wants_surfaces = true;
		const MaskResult reconstructed = fixture.render(request);
		for (const SurfacePoint &surface : reconstructed.surfaces) {
			CHECK((!surface.is_valid ||
					(glm::length(surface.geometric_normal) > 0.99f &&
							glm::dot(surface.geometric_normal, surface.position) <= 0.0f)));
		}
		CHECK(std::all_of(reconstructed.visibility.begin(), reconstructed.visibility.end(),
				[](float p_value) { return p_value >= 0.0f && p_value <= 1.0f; }));
	}
}

TEST_CASE("[GPU][Shadows] hold() copies the masks of all lights into the layers of an array") {
	MaskFixture fixture;
	SmallScene scene;
	scene.add_light("Second", LightType::OMNI, { -2, 3, 1 }, { 0, 0, 0 });
	scene.add_light("Third", LightType::DIRECTIONAL, { 1, 3, 1 }, { 0, 0, 0 });
	const MaskResult masks = fixture.render(make_request(scene));
	const std::vector<std::vector<float>> gray = hold_masks(fixture, scene, Format::R16_SFLOAT);
	const std::vector<std::vector<float>> color = hold_masks(fixture, scene, Format::RGBA16_SFLOAT);
	REQUIRE(gray.size() == 3);
	const char *const names[] = { "Light", "Second", "Third" };
	for (size_t light = 0; light < 3; ++light) {
		CAPTURE(names[light]);
		const std::vector<float> &expected = masks.masks.at(names[light]).visibility;
		CHECK(gray[light] == expected);
		REQUIRE(color[light].size() == 4 * expected.size());
		bool is_same = true;
		for (size_t index = 0; index < expected.size(); ++index) {
			for (size_t channel = 0; channel < 3; ++channel) {
				is_same = is_same && color[light][4 * index + channel] == expected[index];
			}
		}
		CHECK(is_same);
	}
}

TEST_CASE("[GPU][Shadows] hold() copies a coloured mask as colours, or as its luminance") {
	MaskFixture fixture;
	SmallScene scene;
	auto glass = std::make_shared<Material>();
	glass->base_color = glm::vec3(0.9f, 0.25f, 0.125f);
	glass->transmission = 1.0f;
	scene.box->surfaces[0].material = glass;
	const MaskResult mask = fixture.render(make_request(scene));
	REQUIRE_FALSE(mask.colors.empty());
	const std::vector<float> gray = hold_masks(fixture, scene, Format::R16_SFLOAT)[0];
	const std::vector<float> color = hold_masks(fixture, scene, Format::RGBA16_SFLOAT)[0];
	for (size_t index = 0; index < mask.colors.size(); ++index) {
		const glm::vec3 held(color[4 * index], color[4 * index + 1], color[4 * index + 2]);
		CHECK(held == mask.colors[index]);
		// Below 1, half floats are at most 1 / 2048 apart.
		CHECK(std::abs(gray[index] - mask.visibility[index]) <= 1.0f / 2048);
	}
}

TEST_CASE("[GPU][Shadows] a host without materials gets masks in which nothing scatters") {
	MaskFixture fixture;
	SmallScene scene;
	const std::vector<float> plain = fixture.render(make_request(scene)).visibility; // no wax
	auto wax = std::make_shared<Material>();
	wax->scatter = 1.0f;
	wax->scatter_distance_m = 0.5f;
	scene.ground->surfaces[0].material = wax;
	for (const ShadowTechniqueInfo *technique :
			{ ShadowRegistry::find_default(), ShadowRegistry::find_reference() }) {
		if (technique == nullptr) {
			continue;
		}
		CAPTURE(technique->id);
		MaskRequest request = make_request(scene);
		request.technique_override = technique->id;
		request.has_materials = false;
		CHECK(is_valid_mask(fixture.render(request)));
		if (technique == ShadowRegistry::find_default()) {
			CHECK(fixture.render(request).visibility == plain);
		}
	}
}

TEST_CASE("[GPU][Shadows] a frame that was not ended does not change later masks") {
	MaskFixture fixture;
	SmallScene scene;
	const std::vector<float> expected = fixture.render(make_request(scene)).visibility;
	{ // A frame whose graph is never executed.
		RenderGraph graph(*fixture.device, *fixture.transients);
		FramePlan plan;
		const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
		ShadowFrame frame(*fixture.shadows, graph, plan, snapshot, SIZE_PX);
		frame.set_surfaces(add_surface_pass(
				graph, *fixture.shadows, *snapshot, SIZE_PX, frame.get_constants()));
		frame.add_all_lights();
	}
	CHECK(fixture.render(make_request(scene)).visibility == expected);
}

TEST_CASE("[GPU][Shadows] a mesh on none of a light's caster layers casts no shadow from it") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		// With the pose of "Light".
		Light3D &other = scene.add_light("Other", p_type, { 1.2, 4.0, 0.8 }, { 0, 0.3, 0 });
		other.properties = scene.light->properties;
		auto snapshot = std::make_shared<SceneSnapshot>(*scene.snap());
		snapshot->instances.edit(1).layers = 0b10; // the box
		snapshot->lights.edit(0).caster_layers = 0b01;
		snapshot->lights.edit(1).caster_layers = 0b11;
		MaskRequest request;
		request.scene = snapshot;
		request.technique_override = p_info.id;
		const MaskResult masks = fixture.render(request);
		const MaskValues shadowed = fixture.render_mask(scene, p_info.id);
		scene.box->casts_shadow = false;
		const MaskValues unshadowed = fixture.render_mask(scene, p_info.id);
		CHECK(shadowed.visibility != unshadowed.visibility);
		CHECK(masks.masks.at("Light").visibility == unshadowed.visibility);
		CHECK(masks.masks.at("Other").visibility == shadowed.visibility);
	});
}

TEST_CASE("[GPU][Shadows] masks of frames that share instances are those of separate snapshots") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		auto glass = std::make_shared<Material>();
		glass->transmission = 0.5f;
		add_mesh(scene.scene, "Glass", make_box_mesh("glass", glm::vec3(0.3f)), { 0.9, 1.6, 0.2 })
				.surfaces[0]
				.material = glass;
		// Of another light, so that the light has a selection of casters.
		auto other_layer = std::make_shared<SceneSnapshot>(*scene.snap());
		other_layer->instances.edit(1).layers = 0b10;
		other_layer->lights.edit(0).caster_layers = 0b01;
		for (const bool has_selection : { false, true }) {
			CAPTURE(has_selection);
			std::shared_ptr<SceneSnapshot> shared =
					has_selection ? other_layer : std::make_shared<SceneSnapshot>(*scene.snap());
			for (const glm::dvec3 from : { glm::dvec3(-2.4, 3.6, 3.4), glm::dvec3(2.4, 3.0, -3.4),
						 glm::dvec3(2.4, 3.0, -3.4) }) {
				const glm::dmat4 pose = look_at(from, { 0, 0.3, 0 });
				shared = std::make_shared<SceneSnapshot>(*shared);
				shared->camera.position_world = from;
				shared->camera.world_from_camera = glm::dmat3(pose);
				auto separate = std::make_shared<SceneSnapshot>(*shared);
				separate->instances.edit_all([](const InstanceSnapshot &) {});
				separate->lights.edit_all([](const LightSnapshot &) {});
				CHECK_FALSE(separate->instances.shares_items_with(shared->instances));
				MaskRequest request;
				request.technique_override = p_info.id;
				request.scene = shared;
				const MaskResult mask = fixture.render(request);
				MaskFixture fresh;
				request.scene = separate;
				CHECK(fresh.render(request).visibility == mask.visibility);
			}
		}
	});
}

TEST_CASE("[GPU][Shadows] masks of frames in which a few instances move are those of new scenes") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		const auto pebble = make_box_mesh("pebble", glm::vec3(0.1f));
		for (int index = 0; index < 40; ++index) {
			const double x = 0.37 * (index % 7) - 1.1;
			add_mesh(scene.scene, "Pebble", pebble,
					{ x, 0.2 + 0.01 * index, 0.3 * (index / 7) - 0.9 });
		}
		auto glass = std::make_shared<Material>();
		glass->transmission = 0.5f;
		scene.scene.root->children.back()->name = "Glass";
		static_cast<MeshInstance3D &>(*scene.scene.root->children.back()).surfaces[0].material =
				glass;
		auto moved = std::make_shared<SceneSnapshot>(*scene.snap());
		const auto move = [&](size_t p_index, const glm::dvec3 &p_by) {
			InstanceSnapshot &instance = moved->instances.edit(p_index);
			instance.set_transform(
					glm::rotate(glm::translate(instance.world_from_node, p_by), 0.2, p_by));
		};
		std::vector<float> before;
		for (int frame = 0; frame < 5; ++frame) {
			CAPTURE(frame);
			moved = std::make_shared<SceneSnapshot>(*moved);
			if (frame == 1) {
				move(5, { 0.1, 0.3, 0.0 });
				move(38, { -0.2, 0.1, 0.1 });
			} else if (frame == 2) {		// one is on another layer
				move(1, { 0.1, 0.1, 0.2 }); // the box
				moved->instances.edit(20).layers = 0b10;
				moved->lights.edit(0).caster_layers = 0b01;
			} else if (frame == 3) { // the translucent one, and one out of sight
				move(41, { -0.3, 0.4, 0.1 });
				move(12, { 0.0, 90.0, 0.0 });
			} else if (frame == 4) {
				moved->instances.edit(20).layers = 0b01;
				moved->instances.edit(30).casts_shadow = false;
				moved->camera.position_world.x += 0.2;
			}
			auto separate = std::make_shared<SceneSnapshot>(*moved);
			separate->instances.edit_all([](const InstanceSnapshot &) {});
			MaskRequest request;
			request.technique_override = p_info.id;
			request.scene = moved;
			const MaskResult mask = fixture.render(request);
			MaskFixture fresh;
			request.scene = separate;
			CHECK(fresh.render(request).visibility == mask.visibility);
			CHECK(mask.visibility != before);
			before = mask.visibility;
		}
	});
}

TEST_CASE("[GPU][Shadows] a snapshot that a host edits after a frame gets the masks of a new one") {
	MaskFixture fixture;
	SmallScene scene(LightType::DIRECTIONAL);
	auto snapshot = std::make_shared<SceneSnapshot>(*scene.snap());
	MaskRequest request;
	request.scene = snapshot;
	const std::vector<float> before = fixture.render(request).visibility;
	snapshot->instances.edit(1).casts_shadow = false; // the box
	const std::vector<float> without_box = fixture.render(request).visibility;
	CHECK(without_box != before);
	snapshot->instances.edit(1).casts_shadow = true;
	CHECK(fixture.render(request).visibility == before);
	snapshot->lights.edit(0).world_from_light = glm::dmat3(look_at({ 3, 4, -2 }, { 0, 0, 0 }));
	const std::vector<float> turned = fixture.render(request).visibility;
	CHECK(turned != before);
	snapshot->camera.position_world.x += 0.4;
	const MaskResult moved = fixture.render(request);
	MaskFixture fresh;
	CHECK(fresh.render(request).visibility == moved.visibility);
	CHECK(moved.visibility != turned);
}

TEST_CASE("[GPU][Shadows] two shadow systems that draw alternately share meshes, not masks") {
	MaskFixture fixture;
	SmallScene scene;
	const std::vector<float> first = fixture.render(make_request(scene)).visibility;
	const glm::dmat4 first_pose = scene.camera->parent_from_node;
	const glm::dmat4 second_pose = look_at({ 2.4, 3.0, -3.4 }, { 0, 0.3, 0 });
	scene.camera->parent_from_node = second_pose;
	const std::vector<float> second = fixture.render(make_request(scene)).visibility;
	const size_t mesh_count = fixture.shadows->get_meshes().get_mesh_count();
	auto meshes = std::make_shared<MeshStore>(*fixture.device);
	// One per camera. The fixture renders with the system that is swapped in.
	std::unique_ptr<ShadowSystem> systems[2] = {
		std::make_unique<ShadowSystem>(*fixture.device, meshes),
		std::make_unique<ShadowSystem>(*fixture.device, meshes),
	};
	for (int frame = 0; frame < 4; ++frame) {
		if (frame % 2 == 0) {
			std::swap(fixture.shadows, systems[0]);
			scene.camera->parent_from_node = first_pose;
			CHECK(fixture.render(make_request(scene)).visibility == first);
			std::swap(fixture.shadows, systems[0]);
		} else {
			std::swap(fixture.shadows, systems[1]);
			scene.camera->parent_from_node = second_pose;
			CHECK(fixture.render(make_request(scene)).visibility == second);
			std::swap(fixture.shadows, systems[1]);
		}
	}
	CHECK(meshes->get_mesh_count() == mesh_count);
}
