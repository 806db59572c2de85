#include "modules/error_report/question_hash.h"

#include "modules/core/files.h"

#include <type_traits>

namespace gnomon {

namespace {

class Hasher {
public:
	template <typename T> void add(const T &p_value) {
		static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>); // no padding
		hash = compute_hash({ reinterpret_cast<const uint8_t *>(&p_value), sizeof(T) }, hash);
	}
	template <typename T> void add_values(const T *p_values, size_t p_count) {
		hash = compute_hash(bytes_of(std::span<const T>(p_values, p_count)), hash);
	}
	void add_text(const std::string &p_text) {
		add(p_text.size());
		add_values(p_text.data(), p_text.size());
	}
	void add_matrix(const glm::dmat4 &p_matrix) { add_values(&p_matrix[0][0], 16); }
	void add_matrix(const glm::dmat3 &p_matrix) { add_values(&p_matrix[0][0], 9); }
	uint64_t get_hash() const { return hash; }

private:
	uint64_t hash = 1;
};

void add_camera(const CameraSnapshot &p_camera, Hasher &r_hasher) {
	r_hasher.add_values(&p_camera.position_world[0], 3);
	r_hasher.add_matrix(p_camera.world_from_camera);
	r_hasher.add(p_camera.vertical_fov_rad);
	r_hasher.add(p_camera.near_m);
}

void add_light(const LightSnapshot &p_light, Hasher &r_hasher) {
	r_hasher.add(p_light.type);
	r_hasher.add_values(&p_light.position_world[0], 3);
	r_hasher.add_matrix(p_light.world_from_light);
	for (const float value : { p_light.range_m, p_light.inner_cone_rad, p_light.outer_cone_rad,
				 p_light.light_size_m, p_light.light_angular_distance_deg,
				 p_light.penumbra_outer_width_m, p_light.penumbra_inner_width_m }) {
		r_hasher.add(value);
	}
	r_hasher.add(p_light.casts_shadow);
	for (const auto &[name, value] : p_light.properties) {
		r_hasher.add_text(name);
		r_hasher.add_text(format_property(value));
	}
}

void add_instance(const InstanceSnapshot &p_instance, Hasher &r_hasher) {
	const Mesh &mesh = *p_instance.mesh;
	r_hasher.add_values(mesh.positions_node.data(), mesh.positions_node.size());
	r_hasher.add_values(mesh.normals_node.data(), mesh.normals_node.size());
	r_hasher.add_values(mesh.indices.data(), mesh.indices.size());
	r_hasher.add_matrix(p_instance.world_from_node);
	r_hasher.add(p_instance.casts_shadow);
	r_hasher.add(p_instance.is_planar_receiver);
	r_hasher.add(p_instance.material->scatter);
	r_hasher.add(p_instance.material->scatter_distance_m);
	const glm::vec3 transmittance = p_instance.compute_transmittance();
	r_hasher.add_values(&transmittance[0], 3);
	r_hasher.add(p_instance.material->is_double_sided);
}

} // namespace

uint64_t compute_question_hash(const MaskQuestion &p_question) {
	Hasher hasher;
	const SceneSnapshot &scene = *p_question.scene;
	add_camera(scene.camera, hasher);
	hasher.add(scene.scene_size_m);
	for (const InstanceSnapshot &instance : scene.instances) {
		add_instance(instance, hasher);
	}
	for (const LightSnapshot &light : scene.lights) {
		if (p_question.light.empty() || light.name == p_question.light) {
			add_light(light, hasher);
		}
	}
	hasher.add(p_question.filter_hash);
	hasher.add(p_question.size_px.x);
	hasher.add(p_question.size_px.y);
	return hasher.get_hash();
}

} // namespace gnomon
