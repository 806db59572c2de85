#include "modules/scene/cut_levels.h"

#include "modules/scene/cut_mesh.h"
#include "modules/scene/triangle_clip.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Measured on trees, fences and single leaves: the error that an outline adds to a penumbra stays
// below 0.002 if the penumbra's half width is at least this many times the tolerance. The half
// width is the largest in a scene; most receivers see a smaller one. Receivers that touch their
// caster have a narrow penumbra under any light, so that the tolerance for all receivers is at most
// a quarter of a texel: with half a texel and more, some of them are lit instead of dark.
const double MIN_HALF_WIDTH_PER_TOLERANCE = 80;
const double MAX_TOLERANCE_PX = 0.25;
// For a receiver whose own penumbra is known to have this half width, in tolerances, a coarse
// outline adds at most 0.0025 to the MAE of trees (the scenes `leaves` and `courtyard`), which is
// then below 0.006.
const double MIN_HALF_WIDTH_PER_RECEIVER_TOLERANCE = 4.5;
// A coarse level that only few receivers could use is not worth its memory: the widest penumbra
// must have this half width, in tolerances.
const double MIN_WIDEST_HALF_WIDTH_PER_TOLERANCE = 5.5;
const uint32_t MIN_LEVEL_STEP = 2; // to the coarse level: at least four times the tolerance
// Where the texture repeats within a triangle, the outline's error repeats too and does not average
// out.
const double REPEATED_TEXTURE_FACTOR = 2;

/// Returns the largest extent of a texel on a triangle: the largest singular value of the
/// derivative of the position with respect to the texel coordinates, times REPEATED_TEXTURE_FACTOR
/// if the triangle covers more texels than the texture has. 0 if the whole triangle shows one line
/// of texels.
double compute_texel_size(const Mesh &p_mesh, const Texture &p_texture, uint32_t p_triangle) {
	const std::vector<glm::vec2> &uvs = p_mesh.attributes.uvs[p_texture.uv_set];
	const glm::dmat3x2 transform(p_texture.transform);
	glm::dvec2 texels[3];
	glm::dvec3 corners[3];
	for (int corner = 0; corner < 3; ++corner) {
		const uint32_t index = p_mesh.indices[3 * size_t(p_triangle) + corner];
		const glm::dvec2 uv = uvs.empty() ? glm::dvec2(0.0) : glm::dvec2(uvs[index]);
		texels[corner] = transform * glm::dvec3(uv, 1.0) * glm::dvec2(p_texture.image->size_px);
		corners[corner] = glm::dvec3(p_mesh.positions_node[index]);
	}
	const glm::dvec2 s = texels[1] - texels[0];
	const glm::dvec2 t = texels[2] - texels[0];
	const double area = s.x * t.y - s.y * t.x; // twice the triangle's, in texels
	if (area == 0 || !std::isfinite(area)) {
		return 0;
	}
	const bool is_repeated =
			std::abs(area) / 2 > double(p_texture.image->size_px.x) * p_texture.image->size_px.y;
	const glm::dvec3 a = corners[1] - corners[0];
	const glm::dvec3 b = corners[2] - corners[0];
	const glm::dvec3 along_x = (a * t.y - b * s.y) / area;
	const glm::dvec3 along_y = (b * s.x - a * t.x) / area;
	const double xx = glm::dot(along_x, along_x);
	const double yy = glm::dot(along_y, along_y);
	const double xy = glm::dot(along_x, along_y);
	return (is_repeated ? REPEATED_TEXTURE_FACTOR : 1.0) *
			std::sqrt((xx + yy + std::sqrt((xx - yy) * (xx - yy) + 4 * xy * xy)) / 2);
}

} // namespace

CutLevels::CutLevels(const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material,
		const std::shared_ptr<const Mesh> &p_cut) :
		source(p_mesh),
		base(p_cut), material(p_material) {
	for (uint32_t triangle = 0; triangle < p_mesh->get_triangle_count(); ++triangle) {
		texel_size = std::max(
				texel_size, compute_texel_size(*p_mesh, material.base_color_texture, triangle));
	}
}

uint32_t CutLevels::choose_level(double p_half_width) const {
	if (p_half_width <= 0) {
		return BASE_LEVEL;
	}
	const auto is_negligible = [&](double p_tolerance_px) {
		return p_tolerance_px <= MAX_TOLERANCE_PX &&
				p_tolerance_px * texel_size * MIN_HALF_WIDTH_PER_TOLERANCE <= p_half_width;
	};
	uint32_t level = static_cast<uint32_t>(TOLERANCES_PX.size()) - 1;
	while (level > 0 && !is_negligible(TOLERANCES_PX[level])) {
		--level;
	}
	return level;
}

uint32_t CutLevels::choose_coarse_level(uint32_t p_level, double p_half_width) const {
	uint32_t level = static_cast<uint32_t>(TOLERANCES_PX.size()) - 1;
	while (level > p_level &&
			TOLERANCES_PX[level] * texel_size * MIN_WIDEST_HALF_WIDTH_PER_TOLERANCE >
					p_half_width) {
		--level;
	}
	return level >= p_level + MIN_LEVEL_STEP ? level : p_level;
}

double CutLevels::get_min_half_width(uint32_t p_level) const {
	return TOLERANCES_PX.at(p_level) * texel_size * MIN_HALF_WIDTH_PER_RECEIVER_TOLERANCE;
}

std::shared_ptr<const Mesh> CutLevels::get_mesh(uint32_t p_level) const {
	if (p_level == BASE_LEVEL) {
		return base.lock();
	}
	const std::lock_guard<std::mutex> lock(mutex);
	Level &level = levels.at(p_level);
	if (!level.is_built) {
		const std::shared_ptr<const Mesh> mesh = source.lock();
		const double tolerance_px = TOLERANCES_PX.at(p_level);
		level = { mesh ? cut_mesh(mesh, material, /*p_budget=*/{}, tolerance_px).mesh : nullptr,
			/*is_built=*/true };
	}
	return level.mesh;
}

std::optional<uint32_t> CutLevels::find_level(const Mesh *p_mesh) const {
	if (p_mesh == base.lock().get()) {
		return BASE_LEVEL;
	}
	const std::lock_guard lock(mutex);
	for (uint32_t level = 0; level < levels.size(); ++level) {
		if (levels[level].mesh.get() == p_mesh) {
			return level;
		}
	}
	return std::nullopt;
}

} // namespace gnomon
