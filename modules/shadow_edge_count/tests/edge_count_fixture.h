#pragma once

#include "modules/core/text.h"
#include "modules/shadow_edge_count/shadow_edge_count.h"
#include "modules/shadow_edge_count/tests/count_scene.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/light_properties.h"
#include "modules/shadows/shadow_registry.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

// Whole frames of the technique, and their two references: the same light counted in double
// precision, and the traced reference.

namespace gnomon {

/// Replaces the technique edge_count by a derived class while it exists.
template <typename Technique> class ReplacedTechnique {
public:
	ReplacedTechnique() {
		ShadowTechniqueInfo info = original;
		info.make = [] { return std::make_unique<Technique>(); };
		replace(info);
	}
	~ReplacedTechnique() { replace(original); }
	ReplacedTechnique(const ReplacedTechnique &) = delete;
	ReplacedTechnique &operator=(const ReplacedTechnique &) = delete;

private:
	static void replace(const ShadowTechniqueInfo &p_info) {
		ShadowRegistry::remove("edge_count");
		ShadowRegistry::add(p_info);
	}
	ShadowTechniqueInfo original = ShadowRegistry::get("edge_count");
};

/// Options of a frame, apart from its scene.
struct FrameOptions {
	glm::uvec2 size_px = glm::uvec2(96);
	std::string technique = "edge_count";
	bool may_reuse = true;
	bool wants_surfaces = false;
	bool wants_explanation = false;
};

inline MaskResult render_frame(
		MaskFixture &r_fixture, const SmallScene &p_scene, const FrameOptions &p_options = {}) {
	MaskRequest request;
	request.scene = p_scene.snap();
	request.size_px = p_options.size_px;
	request.technique_override = p_options.technique;
	request.light = p_scene.light->name;
	request.wants_surfaces = p_options.wants_surfaces;
	request.may_reuse = p_options.may_reuse;
	request.wants_explanation = p_options.wants_explanation;
	MaskResult result = r_fixture.render(request);
	CHECK(is_valid_mask(result));
	return result;
}

/// Adds a finely tessellated sphere next to the scene's box. Their shadows overlap partly.
inline MeshInstance3D &add_globe(
		SmallScene &r_scene, double p_scale = 1.0, const glm::dvec3 &p_origin = glm::dvec3(0.0)) {
	return add_mesh(r_scene.scene, "Globe", make_count_sphere(0.4 * p_scale, 16),
			p_origin + p_scale * glm::dvec3(-0.7, 0.9, 0.5));
}

/// One light of a scene, with visibility counted in double precision.
class CountedLight {
public:
	CountedLight(const SceneSnapshot &p_scene, const LightSnapshot &p_light) :
			camera_position_world(p_scene.camera.position_world) {
		const PropertyValues properties = resolve_light_properties(
				p_light, ShadowRegistry::get_light_properties("edge_count"));
		const CountSettings settings = read_count_settings(p_light, p_scene, properties);
		std::vector<LightView> views;
		ShadowEdgeCount().get_light_views(p_light, p_scene, properties, views);
		light_from_world = views[0].view_from_world;
		const shader::CountLightConstants constants =
				make_count_light_constants(views[0], settings.disc_radius, p_scene.scene_size_m);
		space = { views[0].is_orthographic, settings.disc_radius, constants.nearer_tolerance,
			p_scene.scene_size_m };
		// All casters, also those that the renderer culls.
		for (const InstanceSnapshot &instance : p_scene.instances) {
			if (instance.casts_shadow) {
				casters.add_mesh(*get_topology(instance.caster_mesh),
						light_from_world * instance.world_from_node, space);
			}
		}
		for (uint32_t sample_set = 0; sample_set < settings.get_sample_set_count(); ++sample_set) {
			masks.emplace_back(sample_set, settings.get_sample_set_count());
		}
	}

	/// Visibility of the light at a surface point, 0..1.
	double compute(const SurfacePoint &p_surface) const {
		const glm::dvec3 normal = glm::normalize(glm::dvec3(p_surface.geometric_normal));
		const glm::dvec3 position_world = camera_position_world + glm::dvec3(p_surface.position) +
				normal * double(p_surface.receiver_offset_m);
		CountSpace own_space = space;
		own_space.nearer_tolerance *=
				p_surface.receiver_offset_m / (MAX_RECEIVER_OFFSET * space.scene_size_m);
		return compute_count_visibility(own_space,
				glm::dvec3(light_from_world * glm::dvec4(position_world, 1.0)), casters.edges,
				casters.faces, masks);
	}

private:
	glm::dvec3 camera_position_world;
	glm::dmat4 light_from_world = glm::dmat4(1.0);
	CountSpace space;
	CountedCasters casters;
	std::vector<DiscLookup> masks;
};

/// Difference of a mask from its reference.
struct MaskDifference {
	double mean = 0; // over receivers
	double maximum = 0;
	double penumbra_mean = 0; // where the reference is above 0.002 and below 0.998
	size_t receiver_count = 0;
	size_t penumbra_count = 0;
	size_t mismatch_count = 0; // receivers that differ by more than 0.01
};

/// Compares a mask with a reference. Pixels without a receiver are skipped.
inline MaskDifference compare_masks(
		const std::vector<float> &p_mask, const MaskResult &p_reference) {
	MaskDifference difference;
	for (size_t index = 0; index < p_mask.size(); ++index) {
		if (p_reference.receiver[index] == 0.0f) {
			continue;
		}
		const double reference = p_reference.visibility[index];
		const double error = std::abs(p_mask[index] - reference);
		const bool is_penumbra = reference > 0.002 && reference < 0.998;
		difference.mean += error;
		difference.maximum = std::max(difference.maximum, error);
		difference.mismatch_count += error > 0.01 ? 1 : 0;
		difference.penumbra_mean += is_penumbra ? error : 0.0;
		++difference.receiver_count;
		difference.penumbra_count += is_penumbra ? 1 : 0;
	}
	difference.mean /= double(std::max(difference.receiver_count, size_t(1)));
	difference.penumbra_mean /= double(std::max(difference.penumbra_count, size_t(1)));
	return difference;
}

/// The mask computed in double precision. p_frame must have surfaces.
inline MaskResult count_in_double(const SmallScene &p_scene, const MaskResult &p_frame) {
	const std::shared_ptr<const SceneSnapshot> scene = p_scene.snap();
	const CountedLight light(*scene, scene->lights[0]);
	MaskResult result;
	result.receiver = p_frame.receiver;
	result.visibility.resize(p_frame.visibility.size());
	for (size_t index = 0; index < result.visibility.size(); ++index) {
		if (result.receiver[index] > 0) {
			result.visibility[index] = float(light.compute(p_frame.surfaces[index]));
		}
	}
	return result;
}

/// True if the build has the traced reference. Otherwise it logs a message.
inline bool has_reference() {
	if (ShadowRegistry::find_reference() == nullptr) {
		MESSAGE("No reference technique in this build: there is nothing to compare with.");
		return false;
	}
	return true;
}

/// Renders the traced reference's mask. has_reference() must be true. p_sample_count: rays per
/// pixel.
inline MaskResult render_reference(MaskFixture &r_fixture, SmallScene &r_scene,
		glm::uvec2 p_size_px = glm::uvec2(96), int64_t p_sample_count = 256) {
	const std::string id = ShadowRegistry::find_reference()->id;
	for (const PropertyInfo &property : ShadowRegistry::get_light_properties(id).get_properties()) {
		if (property.name.ends_with("_samples")) {
			r_scene.light->properties[property.name] = p_sample_count;
		}
	}
	return render_frame(r_fixture, r_scene, { .size_px = p_size_px, .technique = id });
}

} // namespace gnomon
