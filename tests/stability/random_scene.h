#pragma once

#include "modules/renderer/tests/render_fixture.h"
#include "modules/shadows/shadow_registry.h"

#include <glm/gtc/matrix_transform.hpp>

#include <random>
#include <set>
#include <string>
#include <vector>

// Scenes that change at random, for the soak test.

namespace gnomon {

struct Random {
	std::mt19937 engine;
	explicit Random(uint32_t p_seed) : engine(p_seed) {}
	/// 0 to p_count - 1.
	size_t choose(size_t p_count) {
		return std::uniform_int_distribution<size_t>(0, p_count - 1)(engine);
	}
	double draw(double p_least, double p_greatest) {
		return std::uniform_real_distribution<double>(p_least, p_greatest)(engine);
	}
	bool chance(double p_share) { return draw(0, 1) < p_share; }
	glm::dvec3 draw_position(double p_reach_m, double p_lowest_m, double p_highest_m) {
		const double x = draw(-p_reach_m, p_reach_m);
		const double y = draw(p_lowest_m, p_highest_m);
		return { x, y, draw(-p_reach_m, p_reach_m) };
	}
};

/// A camera and nothing to see.
struct EmptyScene {
	Scene scene;
	Camera3D camera;
	std::shared_ptr<const SceneSnapshot> snap() const { return build_snapshot(scene, camera); }
};

/// Starts as a box above the ground. Each change adds, moves, alters or removes something.
class RandomScene {
public:
	explicit RandomScene(Random &r_random) : random(r_random), scene(draw_type(), draw_scale()) {
		make_cheap(*scene.light);
	}

	void change() {
		for (size_t count = 1 + random.choose(3); count > 0; --count) {
			switch (random.choose(6)) {
				case 0:
					random.chance(0.5) ? add_light() : remove(lights());
					break;
				case 1:
					random.chance(0.5) ? add_caster() : remove(casters());
					break;
				case 2:
					move_something();
					break;
				case 3:
					change_caster();
					break;
				default:
					change_light();
			}
		}
	}

	RenderRequest make_request() {
		static const RenderGraph::Mode MODES[] = { RenderGraph::Mode::WAIT,
			RenderGraph::Mode::QUEUE, RenderGraph::Mode::ONE_BY_ONE };
		RenderRequest request;
		request.scene = scene.snap();
		request.size_px = { 8 + random.choose(41), 8 + random.choose(41) };
		request.may_reuse = random.chance(0.8);
		request.may_skip = random.chance(0.8);
		const std::vector<Light3D *> all = lights();
		if (!all.empty() && random.chance(0.6)) {
			request.mask_light = all[random.choose(all.size())]->name;
			request.wants_mask = true;
			request.wants_surfaces = random.chance(0.2);
		} else {
			request.wants_image = random.chance(0.5);
			request.mode = request.wants_image ? RenderGraph::Mode::WAIT : MODES[random.choose(3)];
			request.debug_view = random.chance(0.3) ? "mask" : "";
			request.needs_debug_view = false;
		}
		return request;
	}

private:
	std::vector<Light3D *> lights() const { return scene.scene.find_nodes<Light3D>(); }
	std::vector<MeshInstance3D *> casters() const {
		return scene.scene.find_nodes<MeshInstance3D>();
	}
	LightType draw_type() { return static_cast<LightType>(random.choose(3)); }
	double draw_scale() {
		scale = random.chance(0.7) ? 1.0 : random.chance(0.5) ? 1e-2 : 1e3;
		return scale;
	}

	/// In the same order, however their modules were switched.
	static std::vector<std::string> list_techniques() {
		std::set<std::string> ids;
		for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
			ids.insert(info.id);
		}
		return { ids.begin(), ids.end() };
	}

	/// Few rays, taps and texels: the test checks rules, not precision.
	void make_cheap(Light3D &r_light) {
		for (const std::string &id : list_techniques()) {
			for (const PropertyInfo &property :
					ShadowRegistry::get_light_properties(id).get_properties()) {
				const bool is_count =
						property.name.ends_with("_samples") || property.name.ends_with("_count");
				const bool is_map = property.name.ends_with("_map_size");
				if (is_count) {
					r_light.properties[property.name] = int64_t(4 + random.choose(12));
				} else if (is_map) {
					r_light.properties[property.name] = int64_t(64) << random.choose(3);
				}
			}
		}
		r_light.properties["shadow_technique"] = draw_technique();
	}

	/// Also none, and one that this build lacks.
	std::string draw_technique() {
		const std::vector<std::string> all = list_techniques();
		const size_t index = random.choose(all.size() + 2);
		return index < all.size() ? all[index] : index == all.size() ? "" : "of_another_build";
	}

	void add_light() {
		if (lights().size() < 4) {
			Light3D &light = scene.add_light(text("Light ", ++made_count), draw_type(),
					scale * random.draw_position(2, 1, 5), scale * random.draw_position(1, 0, 0.5),
					scale);
			make_cheap(light);
		}
	}

	void add_caster() {
		if (casters().size() < 8) {
			const glm::vec3 half_m(static_cast<float>(scale) *
					glm::vec3(0.05 + random.draw(0, 0.4), 0.05 + random.draw(0, 0.4), 0.3f));
			add_mesh(scene.scene, text("Box ", ++made_count), make_box_mesh("box", half_m),
					scale * random.draw_position(1.5, 0, 2));
		}
	}

	template <typename T> void remove(const std::vector<T *> &p_nodes) {
		if (!p_nodes.empty()) {
			T *node = p_nodes[random.choose(p_nodes.size())];
			node->parent->remove_child(*node);
		}
	}

	void move_something() {
		std::vector<Node3D *> nodes;
		for (Node3D *node : casters()) {
			nodes.push_back(node);
		}
		for (Node3D *node : lights()) {
			nodes.push_back(node);
		}
		nodes.push_back(scene.camera);
		Node3D &node = *nodes[random.choose(nodes.size())];
		node.parent_from_node[3] += glm::dvec4(scale * random.draw_position(0.3, -0.2, 0.2), 0.0);
	}

	void change_caster() {
		const std::vector<MeshInstance3D *> all = casters();
		if (all.empty()) {
			return;
		}
		MeshInstance3D &caster = *all[random.choose(all.size())];
		Material material;
		material.scatter = random.chance(0.3) ? static_cast<float>(random.draw(0, 1)) : 0.0f;
		material.scatter_distance_m = static_cast<float>(scale * random.draw(0, 0.3));
		material.transmission = random.chance(0.2) ? static_cast<float>(random.draw(0, 1)) : 0.0f;
		material.is_double_sided = random.chance(0.3);
		material.roughness = static_cast<float>(random.draw(0, 1));
		caster.surfaces[0].material = std::make_shared<const Material>(material);
		caster.casts_shadow = random.chance(0.9);
		caster.is_planar_receiver = &caster == scene.ground && random.chance(0.7);
	}

	void change_light() {
		const std::vector<Light3D *> all = lights();
		if (all.empty()) {
			return;
		}
		Light3D &light = *all[random.choose(all.size())];
		switch (random.choose(5)) {
			case 0:
				light.type = draw_type();
				break;
			case 1:
				light.properties["light_size"] =
						random.chance(0.2) ? 0.0 : scale * random.draw(0, 1);
				light.properties["light_angular_distance"] = random.draw(0, 30);
				break;
			case 2:
				light.properties["shadow_enabled"] = random.chance(0.8);
				break;
			case 3:
				light.outer_cone_rad = static_cast<float>(random.draw(0.1, 1.5));
				light.range_m = random.chance(0.3) ? static_cast<float>(scale * 3) : 0.0f;
				light.intensity = random.chance(0.1) ? 0.0f : 100.0f;
				break;
			default:
				light.properties["shadow_technique"] = draw_technique();
		}
	}

	Random &random;
	double scale = 1.0;
	SmallScene scene;
	int made_count = 0;
};

} // namespace gnomon
