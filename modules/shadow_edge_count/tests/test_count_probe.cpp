// What the technique explains of single receivers: all steps agree where nothing is wrong, and
// what is damaged is named.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

#include <cmath>
#include <optional>

using namespace gnomon;

namespace {

const uint32_t SIZE_PX = 96;

/// edge_count whose lists have edge 0 alone.
class EdgelessEdgeCount : public ShadowEdgeCount {
protected:
	void after_lists(RenderGraph &r_graph, const CountFrameBuffers & /*p_light*/,
			const CountLeaves &p_leaves) override {
		const auto word_count =
				uint32_t(r_graph.get_desc(p_leaves.lists).size_bytes / sizeof(uint32_t));
		const uint32_t push[] = { 0, word_count };
		add_compute_pass(r_graph, "clear lists",
				device->get_compute_pipeline({ "clear lists", "tests/damage_words.comp" }),
				{ PassBinding::write(0, p_leaves.lists, PassBuilder::Content::UPDATE) },
				{ word_count, 1, 1 }, { reinterpret_cast<const uint8_t *>(push), sizeof(push) });
	}

public:
	static inline RenderingDevice *device = nullptr;
};

/// A frame of which receivers are explained.
struct ProbedFrame {
	MaskFixture fixture;
	SmallScene scene;
	MaskResult result;

	explicit ProbedFrame(LightType p_type) : scene(p_type) {
		EdgelessEdgeCount::device = fixture.device.get();
		add_globe(scene);
	}
	void render() {
		result = render_frame(fixture, scene,
				{ .size_px = glm::uvec2(SIZE_PX),
						.wants_surfaces = true,
						.wants_explanation = true });
	}
	ProbeEntry explain(size_t p_texel) const {
		const SurfacePoint &surface = result.surfaces[p_texel];
		const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
		ProbeEntry explanation;
		fixture.shadows->explain(scene.light->name,
				{ .pixel = glm::uvec2(p_texel % SIZE_PX, p_texel / SIZE_PX),
						.position_world = snapshot->camera.position_world +
								glm::dvec3(surface.compute_receiver_position()),
						.offset_share = surface.receiver_offset_m /
								(MAX_RECEIVER_OFFSET * snapshot->scene_size_m),
						.visibility = result.visibility[p_texel] },
				explanation);
		return explanation;
	}
	/// Whether the receiver, off its surface, is in the scene's box.
	bool is_in_box(size_t p_texel) const {
		const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
		const auto found = std::ranges::find_if(snapshot->instances,
				[](const InstanceSnapshot &p_instance) { return p_instance.node_name == "Box"; });
		const glm::dvec3 position_world = snapshot->camera.position_world +
				glm::dvec3(result.surfaces[p_texel].compute_receiver_position());
		const Bounds &box = (*found).bounds_world; // it is not rotated
		return glm::all(glm::greaterThan(position_world, box.minimum)) &&
				glm::all(glm::lessThan(position_world, box.maximum));
	}
	/// Every p_step-th receiver with a visibility between the limits.
	std::vector<size_t> list_receivers(float p_minimum, float p_maximum, size_t p_step) const {
		std::vector<size_t> texels;
		size_t count = 0;
		for (size_t texel = 0; texel < result.visibility.size(); ++texel) {
			const float visibility = result.visibility[texel];
			if (result.receiver[texel] > 0.5f && visibility >= p_minimum &&
					visibility <= p_maximum && count++ % p_step == 0) {
				texels.push_back(texel);
			}
		}
		return texels;
	}
};

double get_step(const ProbeEntry &p_explanation, const char *p_step) {
	const ProbeEntry *entry = p_explanation.find("visibility")->find(p_step);
	REQUIRE(entry != nullptr);
	REQUIRE(std::holds_alternative<double>(entry->value));
	return std::get<double>(entry->value);
}

int64_t get_integer(const ProbeEntry &p_entry, const char *p_name) {
	REQUIRE(p_entry.find(p_name) != nullptr);
	return std::get<int64_t>(p_entry.find(p_name)->value);
}

} // namespace

TEST_CASE("[GPU][EdgeCount] all steps of a receiver's visibility agree, for every type of light") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		CAPTURE(int(type));
		ProbedFrame frame(type);
		frame.render();
		std::vector<size_t> texels = frame.list_receivers(0.01f, 0.99f, 23);
		REQUIRE(texels.size() > 5);
		for (const size_t dark : frame.list_receivers(0.0f, 0.0f, 97)) {
			texels.push_back(dark);
		}
		for (const size_t texel : texels) {
			CAPTURE(texel);
			const ProbeEntry explanation = frame.explain(texel);
			CHECK(get_step(explanation, "mask") == frame.result.visibility[texel]);
			CHECK(get_step(explanation, "gpu") == frame.result.visibility[texel]);
			CHECK(std::abs(get_step(explanation, "mask") - get_step(explanation, "leaf_list")) <
					0.004);
			CHECK(std::abs(get_step(explanation, "leaf_list") -
						  get_step(explanation, "all_found")) < 1e-4);
			CHECK(std::abs(get_step(explanation, "all_found") - get_step(explanation, "meshes")) <
					2e-3);
			CHECK(std::abs(get_step(explanation, "meshes") - get_step(explanation, "rays")) < 0.03);
			CHECK(explanation.find("findings")->entries.empty());
			const ProbeEntry &solids = *explanation.find("solids_before_the_centre");
			CHECK(get_integer(solids, "gpu") == get_integer(solids, "in_double"));
			// The casters are closed. Hosts without normals derive them from the depth, so that a
			// receiver at a corner of the box may be in it: then only one of the box's faces is
			// crossed.
			const size_t inside_count = frame.is_in_box(texel) ? 1 : 0;
			CHECK(explanation.find("faces_crossed")->entries.size() + inside_count ==
					2 * size_t(get_integer(solids, "gpu")));
			for (const ProbeEntry &edge : explanation.find("edges_counted")->entries) {
				CHECK(std::get<bool>(edge.find("is_listed")->value));
			}
			CHECK((frame.result.visibility[texel] == 0.0f ||
					!explanation.find("edges_counted")->entries.empty()));
		}
	}
}

TEST_CASE("[GPU][EdgeCount] a receiver whose leaf's list lacks edges is explained so") {
	const ReplacedTechnique<EdgelessEdgeCount> technique;
	ProbedFrame frame(LightType::SPOT);
	frame.render();
	size_t found_count = 0;
	for (const size_t texel : frame.list_receivers(0.0f, 1.0f, 211)) {
		const ProbeEntry explanation = frame.explain(texel);
		const double difference =
				std::abs(get_step(explanation, "all_found") - frame.result.visibility[texel]);
		if (explanation.find("edges_counted")->entries.empty() || difference < 0.02) {
			continue;
		}
		++found_count;
		const std::vector<ProbeEntry> &findings = explanation.find("findings")->entries;
		REQUIRE(findings.size() == 1);
		CHECK(std::get<std::string>(findings[0].value)
						.starts_with("leaf_list and all_found differ"));
		CHECK(std::ranges::any_of(
				explanation.find("edges_counted")->entries, [](const ProbeEntry &p_edge) {
					return !std::get<bool>(p_edge.find("is_listed")->value);
				}));
	}
	CHECK(found_count > 2);
}

TEST_CASE("[GPU][EdgeCount] a light inside a caster is noted") {
	ProbedFrame frame(LightType::OMNI);
	add_mesh(frame.scene.scene, "Shade", make_count_sphere(0.05, 8),
			glm::dvec3(frame.scene.light->compute_world_from_node()[3]));
	frame.render();
	const std::vector<size_t> texels = frame.list_receivers(0.0f, 1.0f, 501);
	REQUIRE(!texels.empty());
	const ProbeEntry explanation = frame.explain(texels[0]);
	const std::vector<ProbeEntry> &notes = explanation.find("notes")->entries;
	CHECK(std::ranges::any_of(notes, [](const ProbeEntry &p_note) {
		return std::get<std::string>(p_note.value)
				.starts_with("Caster \"Shade\" encloses the light");
	}));
	CHECK(std::abs(get_step(explanation, "mask") - get_step(explanation, "rays")) < 0.03);
}

TEST_CASE(
		"[GPU][EdgeCount] light through a mesh with holes is noted, and is no error of counting") {
	const std::shared_ptr<const Mesh> box = make_box_mesh("box", glm::vec3(0.3f));
	std::vector<uint32_t> half = box->indices;
	half.resize(half.size() / 2);
	ProbedFrame frame(LightType::SPOT);
	add_mesh(frame.scene.scene, "Broken",
			make_mesh("broken", box->positions_node, {}, std::move(half)),
			glm::dvec3(0.7, 1.2, -0.5));
	frame.render();
	size_t noted_count = 0;
	for (const size_t texel : frame.list_receivers(0.0f, 0.9f, 41)) {
		const ProbeEntry explanation = frame.explain(texel);
		CHECK(explanation.find("findings")->entries.empty());
		for (const ProbeEntry &note : explanation.find("notes")->entries) {
			CHECK(std::get<std::string>(note.value).starts_with("Caster \"Broken\" has "));
			++noted_count;
		}
	}
	CHECK(noted_count > 0);
}

TEST_CASE("[GPU][EdgeCount] deformed casters are explained as posed") {
	const std::shared_ptr<const Mesh> sphere = make_count_sphere(0.4, 8);
	MeshRig rig;
	MorphTarget &target = rig.targets.emplace_back();
	for (const glm::vec3 &position : sphere->positions_node) {
		target.positions.emplace_back(0.8f * position.x, 0.0f, -0.5f * position.z);
	}
	MeshAttributes attributes;
	attributes.rig = make_mesh_rig(std::move(rig), sphere->positions_node, "bubble");
	ProbedFrame frame(LightType::SPOT);
	MeshInstance3D &bubble = add_mesh(frame.scene.scene, "Bubble",
			make_mesh("bubble", sphere->positions_node, {}, sphere->indices, attributes),
			glm::dvec3(0.8, 1.2, -0.6));
	bubble.morph_weights = { 1 };
	frame.render();
	size_t involved_count = 0;
	for (const size_t texel : frame.list_receivers(0.01f, 0.99f, 19)) {
		CAPTURE(texel);
		const ProbeEntry explanation = frame.explain(texel);
		CHECK(std::abs(get_step(explanation, "all_found") - get_step(explanation, "meshes")) <
				2e-3);
		CHECK(explanation.find("findings")->entries.empty());
		for (const ProbeEntry &edge : explanation.find("edges_counted")->entries) {
			involved_count += std::get<std::string>(edge.find("caster")->value) == "Bubble" ? 1 : 0;
		}
	}
	CHECK(involved_count > 3);
}
