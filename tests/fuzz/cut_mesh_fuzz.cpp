// fuzz: modules=scene
// Reads arbitrary bytes as a mesh and a material whose image cuts holes into it, and cuts the mesh.
// build_cut of make_seeds.py writes the same format.
#include "modules/scene/cut_mesh.h"

#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <utility>

using namespace gnomon;

namespace {

const uint32_t MAX_TEXELS_PER_SIDE = 24;
const uint32_t MAX_VERTEX_COUNT = 32;
const uint32_t MAX_TRIANGLE_COUNT = 32;
const uint32_t MIN_EDGE_COUNT = 4; // smallest budget of outline edges
// With clamping, a triangle of the mesh overlaps at most 3 x 3 parts of the texture plane (image,
// sides, corners). With repetition, it overlaps at most so many tiles beyond those that it covers.
const uint64_t MAX_OVERLAPPED_PARTS = 9;
// Budgets count the edges of outlines; along a long, thin triangle of the mesh, four count as one
// (LONG_TILES_PER_TILE of outlined_texture.cpp). The three sides of a mesh triangle cut a triangle
// of an outline into up to four, and their points also divide uncut neighbours.
const uint64_t MAX_TRIANGLES_PER_EDGE = 32;

/// Reads values from the front of the input, and zeros after its end.
class InputReader {
public:
	InputReader(const uint8_t *p_data, size_t p_size) : rest(p_data, p_size) {}

	template <typename T> T read() {
		T value{};
		const size_t count = std::min(sizeof(T), rest.size());
		std::memcpy(&value, rest.data(), count);
		rest = rest.subspan(count);
		return value;
	}
	/// An index from 0 to p_count - 1.
	uint32_t read_index(uint32_t p_count) { return read<uint8_t>() % p_count; }
	/// A finite value in the range, as file importers guarantee; 0 if the input's value is outside.
	float read_float(float p_minimum, float p_maximum) {
		const float value = read<float>();
		return value >= p_minimum && value <= p_maximum ? value : 0.0f;
	}

private:
	std::span<const uint8_t> rest;
};

Material read_material(InputReader &r_input) {
	Material material;
	Texture &texture = material.base_color_texture;
	material.alpha_mode = r_input.read_index(2) ? AlphaMode::BLEND : AlphaMode::MASK;
	texture.wrap_u = static_cast<TextureWrap>(r_input.read_index(3));
	texture.wrap_v = static_cast<TextureWrap>(r_input.read_index(3));
	texture.is_magnified_nearest = r_input.read_index(2) != 0;
	texture.uv_set = r_input.read_index(2);
	material.alpha_cutoff = r_input.read_float(0, FLT_MAX);
	material.alpha = r_input.read_float(0, 1);
	for (int i = 0; i < 6; ++i) {
		texture.transform[i / 2][i % 2] = r_input.read<float>();
	}
	return material;
}

std::shared_ptr<const Mesh> read_mesh(InputReader &r_input) {
	const bool has_uvs = r_input.read_index(4) != 0; // three times out of four
	const bool has_colors = r_input.read_index(2) != 0;
	const uint32_t vertex_count = 1 + r_input.read_index(MAX_VERTEX_COUNT);
	const uint32_t triangle_count = 1 + r_input.read_index(MAX_TRIANGLE_COUNT);
	std::vector<glm::vec3> positions;
	MeshAttributes attributes;
	for (uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
		glm::vec3 &position = positions.emplace_back();
		for (int axis = 0; axis < 3; ++axis) {
			position[axis] = r_input.read_float(-FLT_MAX, FLT_MAX);
		}
		if (has_uvs) {
			const glm::vec2 uv(r_input.read<float>(), r_input.read<float>());
			attributes.uvs[0].push_back(uv);
			attributes.uvs[1].push_back(uv * 2.0f);
		}
		if (has_colors) {
			attributes.colors.emplace_back(1, 1, 1, r_input.read<float>());
		}
	}
	std::vector<uint32_t> indices;
	for (uint32_t corner = 0; corner < 3 * triangle_count; ++corner) {
		indices.push_back(r_input.read_index(vertex_count));
	}
	return make_mesh("mesh", std::move(positions), {}, std::move(indices), std::move(attributes));
}

std::shared_ptr<const Image> read_image(InputReader &r_input) {
	const glm::uvec2 size_px(r_input.read_index(MAX_TEXELS_PER_SIDE + 1),
			r_input.read_index(MAX_TEXELS_PER_SIDE + 1));
	std::vector<uint8_t> texels;
	for (uint32_t texel = 0; texel < size_px.x * size_px.y; ++texel) {
		texels.insert(texels.end(), { 0, 0, 0, r_input.read<uint8_t>() });
	}
	return texels.empty() ? nullptr : make_image("image", size_px, std::move(texels));
}

/// The area of a triangle, and the part of it that rounding of its corners may cause.
struct Area {
	double value = 0;
	double rounding = 0;
};

Area compute_area(const Mesh &p_mesh, size_t p_triangle) {
	glm::dvec3 corners[3];
	double max_coordinate = 0;
	for (size_t corner = 0; corner < 3; ++corner) {
		corners[corner] = p_mesh.positions_node[p_mesh.indices[3 * p_triangle + corner]];
		for (int axis = 0; axis < 3; ++axis) {
			max_coordinate = std::max(max_coordinate, std::abs(corners[corner][axis]));
		}
	}
	const glm::dvec3 b = corners[1] - corners[0];
	const glm::dvec3 c = corners[2] - corners[0];
	const double corner_error = max_coordinate * FLT_EPSILON + FLT_MIN;
	return { glm::length(glm::cross(b, c)) / 2,
		(glm::length(b) + glm::length(c) + corner_error) * corner_error };
}

void check_areas(const Mesh &p_mesh, const Mesh &p_cut) {
	std::vector<Area> areas(p_mesh.get_triangle_count());
	for (uint32_t piece = 0; piece < p_cut.get_triangle_count(); ++piece) {
		const Area area = compute_area(p_cut, piece);
		Area &sum = areas[p_cut.source.triangles[piece]];
		sum.value += area.value;
		sum.rounding += area.rounding;
	}
	for (uint32_t triangle = 0; triangle < p_mesh.get_triangle_count(); ++triangle) {
		const Area whole = compute_area(p_mesh, triangle);
		const double most = whole.value * (1 + FLT_EPSILON) + whole.rounding;
		GNOMON_ASSERT(areas[triangle].value <= most + areas[triangle].rounding, "triangle ",
				triangle, " has an area of ", whole.value, ", its pieces of ",
				areas[triangle].value);
	}
}

void check_cut(const std::shared_ptr<const Mesh> &p_mesh, const Mesh &p_cut,
		const OutlineBudget &p_budget) {
	GNOMON_ASSERT(p_cut.indices.size() % 3 == 0 && !p_cut.indices.empty(), p_cut.indices.size(),
			" indices");
	for (const uint32_t index : p_cut.indices) {
		GNOMON_ASSERT(index < p_cut.positions_node.size(), "index ", index, " of ",
				p_cut.positions_node.size());
	}
	for (const glm::vec3 &position : p_cut.positions_node) {
		// A sum could overflow; 0 times infinity or NaN is NaN.
		GNOMON_ASSERT(std::isfinite(position.x + 0.0 * position.y + 0.0 * position.z),
				"a position is not finite");
	}
	GNOMON_ASSERT(p_cut.source.mesh.lock() == p_mesh, "cut out of another mesh");
	GNOMON_ASSERT(p_cut.source.triangles.size() == p_cut.get_triangle_count(),
			p_cut.source.triangles.size(), " sources");
	for (const uint32_t source : p_cut.source.triangles) {
		GNOMON_ASSERT(source < p_mesh->get_triangle_count(), "source ", source, " of ",
				p_mesh->get_triangle_count());
	}
	const uint64_t most = MAX_TRIANGLES_PER_EDGE *
			(p_budget.edges_per_mesh +
					MAX_OVERLAPPED_PARTS * p_mesh->get_triangle_count() * p_budget.edges_per_tile);
	GNOMON_ASSERT(p_cut.get_triangle_count() <= most, p_cut.get_triangle_count(),
			" triangles, must be at most ", most);
	check_areas(*p_mesh, p_cut);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] {
		InputReader input(p_data, p_size);
		Material material = read_material(input);
		OutlineBudget budget;
		budget.edges_per_tile = MIN_EDGE_COUNT << input.read_index(9);	// 4..1024
		budget.edges_per_mesh = MIN_EDGE_COUNT << input.read_index(13); // 4..16384
		const auto mesh = read_mesh(input);
		material.base_color_texture.image = read_image(input);
		std::shared_ptr<const Mesh> cut;
		try {
			cut = cut_mesh(mesh, material, budget).mesh;
		} catch (const Error &error) {
			GNOMON_ASSERT(false, "cutting a valid mesh failed: ", error.what());
		}
		if (cut && cut != mesh) {
			check_cut(mesh, *cut, budget);
		}
	});
}
