// Alpha-tested (cut-out) casters with every technique: only their opaque texels cast shadows.

#include "modules/scene/cut_mesh.h"
#include "modules/shadows/tests/each_technique.h"

#include <cmath>

using namespace gnomon;

namespace {

/// A card with round holes above the ground. The camera sees its shadow, but not the card.
struct CardScene : SmallScene {
	std::shared_ptr<const Mesh> card;
	std::shared_ptr<const Material> material;

	explicit CardScene(LightType p_type) : SmallScene(p_type) {
		std::vector<uint8_t> texels;
		for (int y = 0; y < 64; ++y) {
			for (int x = 0; x < 64; ++x) {
				// Signed distance from the rim of the tile's hole, positive outside.
				const double distance_px =
						glm::distance(glm::dvec2(x % 32, y % 32), glm::dvec2(15.5)) - 11;
				const double alpha = std::clamp(0.5 + 0.5 * distance_px, 0.0, 1.0);
				texels.insert(texels.end(), { 255, 255, 255, uint8_t(std::lround(255 * alpha)) });
			}
		}
		Material made;
		made.alpha_mode = AlphaMode::MASK;
		made.base_color_texture.image = make_image("holes", { 64, 64 }, std::move(texels));
		material = std::make_shared<const Material>(made);
		MeshAttributes attributes;
		attributes.uvs[0] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
		card = make_mesh("card",
				{ { -0.8f, 0, -0.8f }, { 0.8f, 0, -0.8f }, { 0.8f, 0.2f, 0.8f },
						{ -0.8f, 0.2f, 0.8f } },
				{}, { 0, 2, 1, 0, 3, 2 }, attributes);
		scene.root->remove_child(*box);
		camera->parent_from_node = look_at({ -1.8, 1.6, 2.6 }, { -0.2, -0.6, -0.2 });
	}

	MeshInstance3D &add_card(const std::shared_ptr<const Mesh> &p_mesh,
			const std::shared_ptr<const Material> &p_material) {
		MeshInstance3D &node = add_mesh(scene, "Card", p_mesh, { 0, 2.2, 0 });
		node.surfaces[0].material = p_material;
		return node;
	}
};

double compute_mean_difference(
		const MaskResult &p_one, const MaskResult &p_other, double &r_max_difference) {
	double sum = 0;
	double count = 0;
	r_max_difference = 0;
	for (size_t i = 0; i < p_one.visibility.size(); ++i) {
		if (p_one.receiver[i] > 0.5f) {
			const double difference = std::abs(double(p_one.visibility[i]) - p_other.visibility[i]);
			sum += difference;
			count += 1;
			r_max_difference = std::max(r_max_difference, difference);
		}
	}
	CHECK(count > 500);
	return sum / std::max(count, 1.0);
}

/// The mesh that casts the card's shadow for the scene's light.
std::shared_ptr<const Mesh> find_caster_mesh(const CardScene &p_scene) {
	const auto snapshot = build_snapshot(p_scene.scene, *p_scene.camera);
	const auto selected = snapshot->select_casters(snapshot->lights[0]);
	for (const InstanceSnapshot &instance : (selected ? *selected : *snapshot).instances) {
		if (instance.node_name == "Card") {
			CHECK(instance.caster_mesh != instance.mesh);
			return instance.caster_mesh;
		}
	}
	return nullptr;
}

} // namespace

TEST_CASE("[GPU][CutOuts] a cut-out caster has exactly the shadow of a mesh with the same holes") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		if (p_info.is_reference) {
			return; // the reference samples the alpha texture itself
		}
		CardScene cut_out(p_type);
		CardScene holes(p_type);
		CardScene whole(p_type);
		for (CardScene *scene : { &cut_out, &holes, &whole }) {
			use_cheap_settings(*scene->light);
			// The light is so small that all receivers get the same level of detail.
			scene->light->properties["light_size"] = 0.02;
			scene->light->properties["light_angular_distance"] = 0.3;
		}
		cut_out.add_card(cut_out.card, cut_out.material);
		holes.add_card(find_caster_mesh(cut_out), nullptr);
		whole.add_card(whole.card, nullptr);
		const MaskResult found = fixture.render_mask(cut_out, p_info.id);
		const MaskResult expected = fixture.render_mask(holes, p_info.id);
		CHECK(is_valid_mask(found));
		CHECK(found.receiver == expected.receiver);
		CHECK(found.visibility == expected.visibility);
		double max_difference = 0;
		compute_mean_difference(found, fixture.render_mask(whole, p_info.id), max_difference);
		CHECK(max_difference > 0.3); // the holes have an effect
	});
}

TEST_CASE("[GPU][CutOuts] the default technique's shadow of a cut-out matches the reference") {
	const ShadowTechniqueInfo *reference = nullptr;
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		reference = info.is_reference ? &info : reference;
	}
	if (reference == nullptr || ShadowRegistry::find_default() == nullptr) {
		MESSAGE("No reference or no default in this build: there is nothing to compare.");
		return;
	}
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(get_light_type_name(type));
		CardScene scene(type);
		scene.add_card(scene.card, scene.material);
		scene.light->properties["reference_samples"] = int64_t(1024);
		double max_difference = 0;
		const double mean = compute_mean_difference(
				fixture.render_mask(scene, ShadowRegistry::find_default()->id),
				fixture.render_mask(scene, reference->id), max_difference);
		CHECK(mean < 0.004);
		CHECK(max_difference < 0.08);
	}
}

TEST_CASE("[GPU][CutOuts] a caster whose alpha is below the cutoff everywhere casts no shadow") {
	MaskFixture fixture;
	CardScene scene(LightType::SPOT);
	Material gone = *scene.material;
	gone.alpha = 0.1f; // the cutoff is 0.5
	scene.add_card(scene.card, std::make_shared<const Material>(gone));
	use_cheap_settings(*scene.light);
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		const MaskResult result = fixture.render_mask(scene, p_info.id);
		for (size_t i = 0; i < result.visibility.size(); ++i) {
			if (result.receiver[i] > 0.5f) {
				REQUIRE(result.visibility[i] == 1.0f);
			}
		}
	});
}
