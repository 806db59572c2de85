// Declares the materials of meshes as properties of their nodes.

#include "modules/scene/node_members.h"

namespace gnomon {

namespace {

const char LENGTH_RANGE[] = "0,10000,0.001"; // minimum, maximum, step: see PropertyInfo::hint
const char GROUP[] = "Material";

/// Returns the first material of the node, whose values the inspector shows for all of them.
const Material &get_material(const Node3D &p_node) {
	static const Material none;
	for (const MeshInstance3D::Surface &surface : to<MeshInstance3D>(p_node).surfaces) {
		if (surface.material) {
			return *surface.material;
		}
	}
	return none;
}

bool has_material(const Node3D &p_node) {
	return !to<MeshInstance3D>(p_node).surfaces.empty();
}

/// Changes all of the node's own materials. Other nodes may share them and keep the originals: the
/// node gets copies, and surfaces that shared a material share its copy.
template <typename Change> void change_materials(Node3D &r_node, const Change &p_change) {
	std::vector<MeshInstance3D::Surface> &surfaces = to<MeshInstance3D>(r_node).surfaces;
	const std::vector<MeshInstance3D::Surface> before = surfaces;
	for (size_t index = 0; index < surfaces.size(); ++index) {
		for (size_t earlier = 0; earlier < index; ++earlier) {
			if (before[earlier].material == before[index].material) {
				surfaces[index].material = surfaces[earlier].material;
			}
		}
		if (surfaces[index].material == before[index].material) {
			auto copy = before[index].material ? std::make_shared<Material>(*before[index].material)
											   : std::make_shared<Material>();
			p_change(*copy);
			if (!before[index].material || !(*copy == *before[index].material)) {
				surfaces[index].material = std::move(copy);
			}
		}
	}
}

template <float Material::*MEMBER> PropertyValue read_value(const Node3D &p_node) {
	return double(get_material(p_node).*MEMBER);
}

template <float Material::*MEMBER> void write_value(Node3D &r_node, const PropertyValue &p_value) {
	change_materials(r_node, [&](Material &r_material) {
		r_material.*MEMBER = static_cast<float>(std::get<double>(p_value));
	});
}

template <glm::vec3 Material::*MEMBER> PropertyValue read_material_color(const Node3D &p_node) {
	return glm::dvec3(get_material(p_node).*MEMBER);
}

template <glm::vec3 Material::*MEMBER>
void write_material_color(Node3D &r_node, const PropertyValue &p_value) {
	change_materials(r_node, [&](Material &r_material) {
		r_material.*MEMBER = glm::vec3(std::get<glm::dvec3>(p_value));
	});
}

PropertyValue read_shading_model(const Node3D &p_node) {
	return std::string(get_shading_model_name(get_material(p_node).shading_model));
}

void write_shading_model(Node3D &r_node, const PropertyValue &p_value) {
	change_materials(r_node, [&](Material &r_material) {
		r_material.shading_model =
				std::get<std::string>(p_value) == get_shading_model_name(ShadingModel::PHONG)
				? ShadingModel::PHONG
				: ShadingModel::METALLIC_ROUGHNESS;
	});
}

template <glm::vec3 Material::*MEMBER>
NodeField make_color_field(const char *p_name, double p_default, const char *p_tooltip) {
	PropertyInfo info = make_info(
			p_name, PropertyType::VECTOR3, glm::dvec3(p_default), "0,1,0.01", p_tooltip, "", GROUP);
	info.is_color = true;
	return { info, &read_material_color<MEMBER>, &write_material_color<MEMBER>, &has_material };
}

template <float Material::*MEMBER>
NodeField make_number_field(const char *p_name, double p_default, const char *p_range,
		const char *p_tooltip, const char *p_unit = "") {
	return { make_info(p_name, PropertyType::FLOAT, p_default, p_range, p_tooltip, p_unit, GROUP),
		&read_value<MEMBER>, &write_value<MEMBER>, &has_material };
}

} // namespace

std::vector<NodeField> make_material_fields() {
	const char FRACTION_RANGE[] = "0,1,0.01";
	return {
		make_color_field<&Material::base_color>(
				"base_color", 0.8, "Colour of the surface, and of light that passes through."),
		make_number_field<&Material::metallic>("metallic", 0.0, FRACTION_RANGE,
				"1 for metals, whose reflections have the base colour."),
		make_number_field<&Material::roughness>(
				"roughness", 1.0, FRACTION_RANGE, "How wide highlights are; 0 is a mirror."),
		{ make_info("shading_model", PropertyType::ENUM, std::string("metallic_roughness"),
				  "metallic_roughness,phong",
				  "How an opaque surface reflects: as glTF defines it, or as Phong did in 1975.",
				  "", GROUP),
				&read_shading_model, &write_shading_model, &has_material },
		make_number_field<&Material::scatter>("scatter", 0.0, FRACTION_RANGE,
				"How much light spreads below the surface, which softens shadows on it; 0 is "
				"opaque."),
		make_number_field<&Material::scatter_distance_m>("scatter_distance", 0.0, LENGTH_RANGE,
				"How far light spreads at scatter 1. 0: 16 pixels of the image.", "m"),
		make_number_field<&Material::transmission>("transmission", 0.0, FRACTION_RANGE,
				"Fraction of the light that passes through, tinted by the base colour."),
		make_number_field<&Material::thickness_m>("thickness", 0.0, LENGTH_RANGE,
				"Distance that light travels inside, in the mesh's own units.", "m"),
		make_color_field<&Material::attenuation_color>(
				"attenuation_color", 1.0, "Colour of white light after the attenuation distance."),
		make_number_field<&Material::attenuation_distance_m>("attenuation_distance", 0.0,
				LENGTH_RANGE,
				"Distance after which white light has attenuation_color. 0: no absorption.", "m"),
	};
}

} // namespace gnomon
