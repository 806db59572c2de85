#include "modules/main/probe.h"

#include "modules/core/error.h"
#include "modules/core/text.h"
#include "modules/main/commands.h"
#include "modules/masks/mask_metrics.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/shadow_registry.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

const double REFERENCE_TOLERANCE = 0.01; // besides its noise: other points of the light

/// Returns the reference's mask, or nothing if no reference technique is enabled.
std::optional<RenderResult> render_reference(Renderer &r_renderer, RenderRequest p_request) {
	const ShadowTechniqueInfo *info = ShadowRegistry::find_reference();
	if (info == nullptr) {
		return std::nullopt;
	}
	p_request.technique_override = info->id;
	// Its own, since a light's technique loses its caches when another draws the light.
	return Renderer(r_renderer.get_device()).render(p_request);
}

/// Returns the receiver with the largest error. Throws an Error if there is no receiver.
size_t find_worst_texel(const RenderResult &p_result, const RenderResult &p_reference) {
	size_t worst = 0;
	float largest = -1;
	for (size_t texel = 0; texel < p_result.visibility.size(); ++texel) {
		const float error = std::abs(p_result.visibility[texel] - p_reference.visibility[texel]);
		if (p_result.receiver[texel] >= 0.5f && error > largest) {
			worst = texel;
			largest = error;
		}
	}
	if (largest < 0) {
		fail("--probe ", WORST_PIXEL,
				": the light has no receiver in the image. Check its range and cone, or name a "
				"pixel.");
	}
	return worst;
}

void add_reference(const std::optional<RenderResult> &p_reference, size_t p_texel,
		double p_visibility, ProbeEntry &r_explanation) {
	if (!p_reference) {
		r_explanation.add("reference_mask", "no reference technique is enabled");
		return;
	}
	const double visibility = p_reference->visibility[p_texel];
	const bool is_sampled = is_penumbra(p_reference->visibility[p_texel]);
	ProbeEntry &reference = r_explanation.add("reference_mask");
	reference.add("visibility", visibility);
	reference.add("standard_error", is_sampled ? double(p_reference->standard_error) : 0.0);
	reference.add("error_of_the_mask", p_visibility - visibility);
}

/// Returns the number of an entry, or nothing.
std::optional<double> read_number(const ProbeEntry *p_entry) {
	const double *value = p_entry != nullptr ? std::get_if<double>(&p_entry->value) : nullptr;
	return value != nullptr ? std::optional(*value) : std::nullopt;
}

/// Adds to the findings whether the technique's most exact value is that of the reference.
void compare_with_reference(ProbeEntry &r_explanation) {
	const ProbeEntry *values = r_explanation.find("visibility");
	const ProbeEntry *reference = r_explanation.find("reference_mask");
	if (values == nullptr || values->entries.empty() || reference == nullptr) {
		return;
	}
	const ProbeEntry &last = values->entries.back();
	const std::optional<double> exact = read_number(&last);
	const std::optional<double> visibility = read_number(reference->find("visibility"));
	const double standard_error = read_number(reference->find("standard_error")).value_or(0.0);
	if (!exact || !visibility ||
			std::abs(*exact - *visibility) <= REFERENCE_TOLERANCE + 3.0 * standard_error) {
		return;
	}
	for (ProbeEntry &entry : r_explanation.entries) {
		if (entry.name == "findings") {
			entry.add("",
					ProbeEntry::Value(text(last.name, " and reference differ by ",
							std::abs(*exact - *visibility),
							". What casts the shadow is not what is drawn: a coarse level of a "
							"cut-out, or a caster that is translucent or in another layer; or the "
							"surface scatters light.")));
		}
	}
}

void append_text(const ProbeEntry &p_entry, size_t p_depth, std::string &r_text) {
	const auto format = [](const auto &p_value) -> std::string {
		using Value = std::decay_t<decltype(p_value)>;
		if constexpr (std::is_same_v<Value, std::monostate>) {
			return "";
		} else if constexpr (std::is_same_v<Value, bool>) {
			return p_value ? "yes" : "no";
		} else if constexpr (std::is_same_v<Value, std::vector<double>>) {
			std::string joined;
			for (const double number : p_value) {
				joined += text(joined.empty() ? "" : ", ", number);
			}
			return joined;
		} else {
			return text(p_value);
		}
	};
	// What has no entries of its own is one line, so that lists of faces and edges are tables.
	const auto is_plain = [](const ProbeEntry &p_one) { return p_one.entries.empty(); };
	const bool is_row = p_entry.name.empty() && !p_entry.entries.empty() &&
			std::ranges::all_of(p_entry.entries, is_plain);
	r_text.append(4 * p_depth, ' ');
	if (is_row) {
		std::string row;
		for (const ProbeEntry &entry : p_entry.entries) {
			row += text(row.empty() ? "" : "; ", entry.name, " ", std::visit(format, entry.value));
		}
		r_text += "- " + row + "\n";
		return;
	}
	std::string value = std::visit(format, p_entry.value);
	if (value.empty() && p_entry.entries.empty()) {
		value = p_entry.is_list ? "none" : "not computed";
	}
	r_text += p_entry.name.empty() ? "- " : p_entry.name + (value.empty() ? ":" : ": ");
	r_text += value + "\n";
	for (const ProbeEntry &entry : p_entry.entries) {
		append_text(entry, p_depth + 1, r_text);
	}
}

} // namespace

std::optional<glm::uvec2> parse_pixel(const std::string &p_text, glm::uvec2 p_size_px) {
	if (p_text == WORST_PIXEL) {
		return std::nullopt;
	}
	const size_t comma = p_text.find(',');
	const std::string_view whole = p_text;
	glm::uvec2 pixel(0);
	if (comma == std::string::npos || !parse_uint32(whole.substr(0, comma), pixel.x) ||
			!parse_uint32(whole.substr(comma + 1), pixel.y) || pixel.x >= p_size_px.x ||
			pixel.y >= p_size_px.y) {
		throw UsageError(text("--probe is \"", p_text,
				"\", must be X,Y: a pixel from 0,0 (top left) to ", p_size_px.x - 1, ",",
				p_size_px.y - 1, " of the image (see --size), or ", WORST_PIXEL, "."));
	}
	return pixel;
}

ProbeEntry explain_pixel(
		Renderer &r_renderer, RenderRequest p_request, std::optional<glm::uvec2> p_pixel) {
	p_request.wants_mask = true;
	const std::optional<RenderResult> reference = render_reference(r_renderer, p_request);
	if (!p_pixel && !reference) {
		fail("--probe ", WORST_PIXEL,
				" needs a reference technique, and none is enabled. Name a "
				"pixel: --probe X,Y.");
	}
	p_request.wants_surfaces = true;
	p_request.wants_explanation = true;
	const RenderResult result = r_renderer.render(p_request);
	const SceneSnapshot &scene = *p_request.scene;
	const size_t texel = p_pixel ? size_t(p_pixel->y) * p_request.size_px.x + p_pixel->x
								 : find_worst_texel(result, *reference);
	const glm::uvec2 pixel(texel % p_request.size_px.x, texel / p_request.size_px.x);
	const SurfacePoint &surface = result.surfaces[texel];
	ProbeEntry explanation;
	explanation.add("pixel", pixel);
	explanation.add("light", ProbeEntry::Value(p_request.mask_light));
	explanation.add("technique", ProbeEntry::Value(p_request.technique_override));
	if (!surface.is_valid) {
		explanation.add("surface", "none: the camera sees the background");
		return explanation;
	}
	const glm::dvec3 camera = scene.camera.position_world;
	const glm::dvec3 position = camera + glm::dvec3(surface.position);
	const glm::dvec3 normal = surface.geometric_normal;
	ProbeEntry &receiver = explanation.add("surface");
	receiver.add("position_world_m", position);
	receiver.add("normal_world", normal);
	receiver.add("plane_offset_m", -glm::dot(normal, position));
	receiver.add("distance_from_camera_m", double(glm::length(surface.position)));
	receiver.add("pixel_size_m", double(surface.pixel_size_m));
	receiver.add("receiver_offset_m", double(surface.receiver_offset_m));
	if (result.receiver[texel] < 0.5f) {
		explanation.add("mask", "none: the light does not reach the surface, or is behind it");
		return explanation;
	}
	const double visibility = result.visibility[texel];
	explanation.add("mask", visibility);
	const double max_offset_m =
			compute_frame_constants(scene, p_request.size_px).max_receiver_offset_m;
	const ProbedReceiver probed = { .pixel = pixel,
		.position_world = camera + glm::dvec3(surface.compute_receiver_position()),
		.offset_share = surface.receiver_offset_m / max_offset_m,
		.visibility = visibility };
	add_reference(reference, texel, visibility, explanation);
	r_renderer.explain(p_request.mask_light, probed, explanation);
	compare_with_reference(explanation);
	return explanation;
}

Json probe_to_json(const ProbeEntry &p_entry) {
	if (p_entry.is_list) {
		Json list = Json::array();
		for (const ProbeEntry &entry : p_entry.entries) {
			list.push_back(probe_to_json(entry));
		}
		return list;
	}
	if (p_entry.entries.empty() && !std::holds_alternative<std::monostate>(p_entry.value)) {
		return std::visit(
				[](const auto &p_value) -> Json {
					if constexpr (std::is_same_v<std::decay_t<decltype(p_value)>, std::monostate>) {
						return nullptr;
					} else {
						return p_value;
					}
				},
				p_entry.value);
	}
	if (p_entry.entries.empty()) {
		return nullptr;
	}
	Json object = Json::object();
	for (const ProbeEntry &entry : p_entry.entries) {
		object[entry.name] = probe_to_json(entry);
	}
	return object;
}

std::string probe_to_text(const ProbeEntry &p_entry) {
	std::string lines;
	for (const ProbeEntry &entry : p_entry.entries) {
		append_text(entry, 0, lines);
	}
	return lines;
}

} // namespace gnomon
