#pragma once

#include "modules/renderer/tests/render_fixture.h"
#include "modules/shadows/shadow_registry.h"

#include <glm/gtc/matrix_transform.hpp>

#include <random>
#include <set>
#include <string>
#include <vector>

// Scenes that change randomly, for the soak test.

namespace gnomon {

/// A seeded generator, so that a failed soak test can be repeated.
struct Random {
	std::mt19937 engine;
	explicit Random(uint32_t p_seed) : engine(p_seed) {}
	/// A random index from 0 to p_count - 1.
	size_t choose(size_t p_count) {
		return std::uniform_int_distribution<size_t>(0, p_count - 1)(engine);
	}
	/// A random number in p_min..p_max.
	double uniform(double p_min, double p_max) {
		return std::uniform_real_distribution<double>(p_min, p_max)(engine);
	}
	/// True with the given probability.
	bool chance(double p_probability) { return uniform(0, 1) < p_probability; }
	/// A random point in a box whose base is centred on the Y axis.
	glm::dvec3 make_position(double p_half_width_m, double p_min_height_m, double p_max_height_m) {
		const double x = uniform(-p_half_width_m, p_half_width_m);
		const double y = uniform(p_min_height_m, p_max_height_m);
		return { x, y, uniform(-p_half_width_m, p_half_width_m) };
	}
};

/// A scene with a camera and nothing else.
struct EmptyScene {
	Scene scene;
	Camera3D camera;
	std::shared_ptr<const SceneSnapshot> snap() const { return build_snapshot(scene, camera); }
};

/// Starts as a box above the ground. Each call of change() makes one to three changes, which add,
/// move, alter or remove something.
class RandomScene {
public:
	explicit RandomScene(Random &r_random) :
			random(r_random), scene(random_type(), random_scale()) {
		use_cheap_settings(*scene.light);
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
		request.size_px = { 8 + random.choose(41), 8 + random.choose(41) }; // 8..48 each
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
			request.needs_debug_view = false; // without shadow-casting lights there is none
		}
		return request;
	}

private:
	std::vector<Light3D *> lights() const { return scene.scene.find_nodes<Light3D>(); }
	std::vector<MeshInstance3D *> casters() const {
		return scene.scene.find_nodes<MeshInstance3D>();
	}
	LightType random_type() { return static_cast<LightType>(random.choose(3)); }
	/// Chooses and stores the factor of all lengths.
	double random_scale() {
		scale = random.chance(0.7) ? 1.0 : random.chance(0.5) ? 1e-2 : 1e3;
		return scale;
	}

	/// Sorted, so that the order does not depend on when modules were disabled and enabled.
	static std::vector<std::string> list_techniques() {
		std::set<std::string> ids;
		for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
			ids.insert(info.id);
		}
		return { ids.begin(), ids.end() };
	}

	/// Gives the light a random technique, and all techniques few rays, views and texels: the test
	/// checks invariants, not precision.
	void use_cheap_settings(Light3D &r_light) {
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
		r_light.properties["shadow_technique"] = random_technique();
	}

	/// The id of a random technique, an empty id, or an id that this build lacks.
	std::string random_technique() {
		const std::vector<std::string> all = list_techniques();
		const size_t index = random.choose(all.size() + 2);
		return index < all.size() ? all[index] : index == all.size() ? "" : "of_another_build";
	}

	void add_light() {
		if (lights().size() < 4) {
			Light3D &light = scene.add_light(text("Light ", ++made_count), random_type(),
					scale * random.make_position(2, 1, 5), scale * random.make_position(1, 0, 0.5),
					scale);
			use_cheap_settings(light);
		}
	}

	void add_caster() {
		if (casters().size() < 8) {
			const glm::vec3 half_m(static_cast<float>(scale) *
					glm::vec3(0.05 + random.uniform(0, 0.4), 0.05 + random.uniform(0, 0.4), 0.3f));
			add_mesh(scene.scene, text("Box ", ++made_count), make_box_mesh("box", half_m),
					scale * random.make_position(1.5, 0, 2));
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
		node.parent_from_node[3] += glm::dvec4(scale * random.make_position(0.3, -0.2, 0.2), 0.0);
	}

	void change_caster() {
		const std::vector<MeshInstance3D *> all = casters();
		if (all.empty()) {
			return;
		}
		MeshInstance3D &caster = *all[random.choose(all.size())];
		Material material;
		material.scatter = random.chance(0.3) ? static_cast<float>(random.uniform(0, 1)) : 0.0f;
		material.scatter_distance_m = static_cast<float>(scale * random.uniform(0, 0.3));
		material.transmission =
				random.chance(0.2) ? static_cast<float>(random.uniform(0, 1)) : 0.0f;
		material.is_double_sided = random.chance(0.3);
		material.roughness = static_cast<float>(random.uniform(0, 1));
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
				light.type = random_type();
				break;
			case 1:
				light.properties["light_size"] =
						random.chance(0.2) ? 0.0 : scale * random.uniform(0, 1);
				light.properties["light_angular_distance"] = random.uniform(0, 30);
				break;
			case 2:
				light.properties["shadow_enabled"] = random.chance(0.8);
				break;
			case 3:
				light.outer_cone_rad = static_cast<float>(random.uniform(0.1, 1.5));
				light.range_m = random.chance(0.3) ? static_cast<float>(scale * 3) : 0.0f;
				light.intensity = random.chance(0.1) ? 0.0f : 100.0f;
				break;
			default:
				light.properties["shadow_technique"] = random_technique();
		}
	}

	Random &random;
	double scale = 1.0;
	SmallScene scene;
	int made_count = 0;
};

} // namespace gnomon
