#include "modules/shadow_edge_count/count_probe.h"

#include "modules/core/error.h"
#include "modules/core/text.h"
#include "modules/mesh_tools/topology.h"
#include "modules/scene/cut_levels.h"
#include "modules/scene/mesh_pose.h"
#include "modules/shadow_edge_count/count_in_double.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace gnomon {

namespace {

const uint32_t RAY_COUNT = 4096;
const double ENCLOSING_SHARE = 0.5; // of all directions that a mesh hides from a point inside
// Differences between steps up to which they agree.
const double FILTER_TOLERANCE = 1e-3; // both are half floats
const double MASK_TOLERANCE = 0.004;  // rounding on the GPU, and of the mask to half floats
const double LIST_TOLERANCE = 1e-3;	  // edges beyond the list's bounds, with next to no effect
const double FOUND_TOLERANCE = 0.004; // vertices rounded to float in light space
const double POINTS_TOLERANCE = 0.03; // 64 points instead of the whole disc, where solids overlap
const double SMOOTH_TOLERANCE = 0.02; // interpolation between counted pixels

const char *const KIND_NAMES[] = { "dark", "plain", "listed", "unlisted", "filtered", "smooth" };

/// Item p_index of a copied buffer of items. Zero beyond its end.
template <typename Item> Item read_item(const std::vector<uint8_t> &p_bytes, size_t p_index) {
	Item item = {};
	if ((p_index + 1) * sizeof(Item) <= p_bytes.size()) {
		std::memcpy(&item, p_bytes.data() + p_index * sizeof(Item), sizeof(Item));
	}
	return item;
}

glm::dvec3 read_point(const glm::uvec4 &p_words) {
	return { std::bit_cast<float>(p_words.x), std::bit_cast<float>(p_words.y),
		std::bit_cast<float>(p_words.z) };
}

/// See find_pixel_index in count_pixels_inc.glsl.
uint32_t find_morton_index(glm::uvec2 p_pixel) {
	uint32_t index = 0;
	for (uint32_t bit = 0; bit < 3; ++bit) {
		index |= (p_pixel.x >> bit & 1u) << (2 * bit) | (p_pixel.y >> bit & 1u) << (2 * bit + 1);
	}
	return index;
}

/// The share of all directions, 0..1, in which the faces surround the origin: 1 inside a closed
/// mesh, 0 outside (Van Oosterom and Strackee 1983, the solid angle of a triangle).
double compute_enclosed_share(std::span<const CountFace> p_faces) {
	double solid_angle = 0;
	for (const CountFace &face : p_faces) {
		const glm::dvec3 &a = face.corners[0];
		const glm::dvec3 &b = face.corners[1];
		const glm::dvec3 &c = face.corners[2];
		const double la = glm::length(a);
		const double lb = glm::length(b);
		const double lc = glm::length(c);
		solid_angle += 2.0 *
				std::atan2(glm::dot(a, glm::cross(b, c)),
						la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la +
								glm::dot(c, a) * lb);
	}
	return std::abs(solid_angle) / (4.0 * std::numbers::pi);
}

/// Whether the line from p_origin to p_origin + p_way passes through the box.
bool passes_box(const Bounds &p_box, const glm::dvec3 &p_origin, const glm::dvec3 &p_way) {
	double begin = 0;
	double end = 1;
	for (int axis = 0; axis < 3; ++axis) {
		const double low = p_box.minimum[axis] - p_origin[axis];
		const double high = p_box.maximum[axis] - p_origin[axis];
		if (p_way[axis] == 0) {
			end = low > 0 || high < 0 ? -1 : end;
			continue;
		}
		begin = std::max(begin, std::min(low / p_way[axis], high / p_way[axis]));
		end = std::min(end, std::max(low / p_way[axis], high / p_way[axis]));
	}
	return begin <= end;
}

/// The topology of a caster's mesh with its vertices as posed. p_pose: null if it is at rest.
MeshTopology pose_topology(const std::shared_ptr<const Mesh> &p_mesh, const MeshPose *p_pose) {
	MeshTopology topology = *get_topology(p_mesh); // that at rest
	if (p_pose == nullptr || !p_mesh->rest) {
		return topology;
	}
	const std::shared_ptr<const Mesh> posed = p_pose->get_mesh(p_mesh->rest);
	for (size_t index = 0; index < topology.welded_from_position.size(); ++index) {
		const uint32_t vertex = topology.welded_from_position[index];
		if (vertex != NO_VERTEX) {
			topology.welded_positions_node[vertex] = posed->positions_node[index];
		}
	}
	return topology;
}

/// The leaf that a receiver belongs to.
struct ProbedLeaf {
	shader::CountLeaf leaf;
	shader::CountLeafResult result;
};

/// Faces and edges, with the caster of each face.
struct CountItems {
	std::vector<CountFace> faces;
	std::vector<uint32_t> face_casters; // indices in CountCasters
	std::vector<CountEdge> edges;
};

/// A step of the computation, compared with the more exact one after it.
struct Step {
	const char *name;
	std::optional<double> visibility;
	double tolerance;	 // of its difference from the next
	std::string meaning; // of a larger difference from the next
};

} // namespace

CountProbe::CountProbe(const ShadowTechnique::Inputs &p_inputs, const CountSettings &p_settings,
		const CountCapacities &p_capacities) :
		view(p_inputs.views.front()),
		settings(p_settings),
		constants(make_leaf_constants(p_inputs, p_settings, p_capacities, /*p_empty_views=*/0)),
		size_px(p_inputs.size_px), scene_size_m(p_inputs.scene.scene_size_m) {}

void CountProbe::add_read_back(RenderGraph &r_graph, const CountFrameBuffers &p_light,
		const CountLeaves &p_leaves, RGTexture p_debug_image, RGTexture p_mask) {
	const std::vector<std::pair<RGBuffer, std::vector<uint8_t> *>> buffers = {
		{ p_light.planes, &copies->planes }, { p_light.faces, &copies->faces },
		{ p_light.edges, &copies->edges }, { p_light.totals, &copies->totals },
		{ p_leaves.leaves, &copies->leaves }, { p_leaves.results, &copies->results },
		{ p_leaves.lists, &copies->lists }, { p_leaves.counts, &copies->counts }
	};
	PassBuilder pass = r_graph.add_pass("read back for the probe");
	for (const auto &[buffer, bytes] : buffers) {
		pass.reads(buffer, Access::COPY_READ);
	}
	pass.reads(p_debug_image, Access::COPY_READ).reads(p_mask, Access::COPY_READ);
	pass.keep().execute([buffers, p_debug_image, p_mask, copies = copies](PassContext &p_context) {
		const auto receive_into = [&copies](std::vector<uint8_t> *r_bytes) {
			return [copies, r_bytes](std::span<const uint8_t> p_bytes) {
				r_bytes->assign(p_bytes.begin(), p_bytes.end());
			};
		};
		RenderingDevice &device = p_context.get_device();
		for (const auto &[buffer, bytes] : buffers) {
			device.read_back(p_context.get(buffer), receive_into(bytes));
		}
		device.read_back(p_context.get(p_mask), /*p_layer=*/0, receive_into(&copies->mask));
		for (uint32_t layer = 0; layer < EDGE_COUNT_DEBUG_LAYERS; ++layer) {
			device.read_back(p_context.get(p_debug_image), layer,
					receive_into(&copies->debug_layers[layer]));
		}
	});
}

/// What one explanation computes.
struct CountProbe::Work {
	const CountProbe &probe;
	const ProbedReceiver &receiver;
	const CountCasters &casters;
	CountSpace space;
	glm::dvec3 position; // in light space
	std::vector<DiscLookup> masks;

	/// The receiver's texel of a copied R16_SFLOAT texture.
	double read_texel(const std::vector<uint8_t> &p_texels) const {
		const size_t index = size_t(receiver.pixel.y) * probe.size_px.x + receiver.pixel.x;
		return glm::unpackHalf1x16(read_item<uint16_t>(p_texels, index));
	}
	double read_debug(uint32_t p_layer) const {
		return read_texel(probe.copies->debug_layers[p_layer]);
	}
	/// The kind of the receiver's leaf (EDGE_COUNT_LEAVES_*).
	uint32_t find_kind() const { return uint32_t(read_debug(EDGE_COUNT_DEBUG_LEAVES)); }
	std::optional<ProbedLeaf> find_leaf() const;
	/// Whether a receiver at that distance (CountLeaf::axis_distance) sees the face's LOD.
	bool is_seen(uint32_t p_face, double p_distance) const;
	CountItems read_found(double p_distance) const;
	/// Nothing if receivers see two LODs of one caster, or if a program on the GPU moves vertices.
	std::optional<CountItems> read_meshes(double p_distance) const;
	/// The edges in the leaf's list. Nothing if the leaf has none.
	std::optional<std::vector<CountEdge>> read_listed(const ProbedLeaf &p_leaf) const;
	CountEdge read_edge(uint32_t p_index) const;
	double count(std::span<const CountEdge> p_edges, std::span<const CountFace> p_faces,
			CountDetails *r_details = nullptr) const {
		return compute_count_visibility(space, position, p_edges, p_faces, masks, r_details);
	}
	glm::dvec3 find_world_position(const glm::dvec3 &p_position) const {
		return glm::inverse(probe.view.view_from_world) * glm::dvec4(p_position, 1.0);
	}
	/// From the receiver towards the light's centre to the face's plane, in metres.
	double find_distance(const CountFace &p_face) const {
		const glm::dvec3 to_light =
				space.is_directional ? glm::dvec3(0.0, 0.0, -1.0) : -glm::normalize(position);
		const glm::dvec3 normal = p_face.plane;
		return -(glm::dot(normal, position) + p_face.plane.w) / glm::dot(normal, to_light);
	}
	void describe_leaf(const std::optional<ProbedLeaf> &p_leaf, ProbeEntry &r_explanation) const;
	void describe_items(const CountItems &p_items, const CountDetails &p_details,
			const std::optional<CountDetails> &p_listed, std::span<const CountEdge> p_listed_edges,
			ProbeEntry &r_explanation) const;
	/// The casters whose bounds the way to the light's centre passes, though perhaps no face.
	std::vector<uint32_t> list_passed() const {
		const glm::dmat4 world_from_light = glm::inverse(probe.view.view_from_world);
		const glm::dvec3 way = space.is_directional
				? glm::dvec3(world_from_light[2]) * -position.z
				: glm::dvec3(world_from_light[3]) - receiver.position_world;
		std::vector<uint32_t> passed;
		for (uint32_t index = 0; index < casters.casters.size(); ++index) {
			const InstanceSnapshot &instance = casters.instances[casters.casters[index].instance];
			if (passes_box(instance.bounds_world, receiver.position_world, way)) {
				passed.push_back(index);
			}
		}
		return passed;
	}
	/// Describes the casters of the faces and edges, and those whose bounds are passed, and what of
	/// them often surprises.
	void describe_casters(const CountItems &p_items, const CountDetails &p_details,
			ProbeEntry &r_casters, ProbeEntry &r_notes) const;
	std::string describe_caster(uint32_t p_caster) const {
		const CountCaster &caster = casters.casters[p_caster];
		return text(casters.instances[caster.instance].node_name,
				caster.is_coarse ? " (coarse level)" : "");
	}
};

std::optional<ProbedLeaf> CountProbe::Work::find_leaf() const {
	const uint32_t count = std::min(read_item<uint32_t>(probe.copies->counts, EDGE_COUNT_COUNT_ALL),
			probe.constants.leaf_capacity);
	const glm::uvec2 block = receiver.pixel / uint32_t(EDGE_COUNT_BLOCK_PX);
	const uint32_t block_index = block.y * probe.constants.block_count.x + block.x;
	const uint32_t pixel = find_morton_index(receiver.pixel % uint32_t(EDGE_COUNT_BLOCK_PX));
	for (uint32_t index = 0; index < count; ++index) {
		const auto leaf = read_item<shader::CountLeaf>(probe.copies->leaves, index);
		const uint32_t pixels = pixel < 32 ? leaf.pixels_flags.x : leaf.pixels_flags.y;
		if (std::bit_cast<uint32_t>(leaf.anchor_block.w) == block_index &&
				(pixels >> (pixel % 32) & 1u) != 0) {
			return ProbedLeaf{ leaf,
				read_item<shader::CountLeafResult>(probe.copies->results, index) };
		}
	}
	return std::nullopt;
}

bool CountProbe::Work::is_seen(uint32_t p_face, double p_distance) const {
	const auto record = read_item<shader::CountFaceRecord>(probe.copies->faces, p_face);
	return p_distance >= std::bit_cast<float>(record.b_first_distance.w) &&
			p_distance < std::bit_cast<float>(record.c_end_distance.w);
}

CountEdge CountProbe::Work::read_edge(uint32_t p_index) const {
	const auto record = read_item<shader::CountEdgeRecord>(probe.copies->edges, p_index);
	const auto read_plane = [&](uint32_t p_face) {
		return glm::dvec4(
				read_item<glm::vec4>(probe.copies->planes, p_face & EDGE_COUNT_FACE_MASK));
	};
	CountEdge edge;
	edge.a = read_point(record.a_face0);
	edge.b = read_point(record.b_face1);
	edge.face0 = record.a_face0.w & EDGE_COUNT_FACE_MASK;
	edge.plane0 = read_plane(record.a_face0.w);
	edge.has_face1 = record.b_face1.w != EDGE_COUNT_NO_FACE;
	edge.is_double_sided = (record.a_face0.w & EDGE_COUNT_DOUBLE_SIDED) != 0;
	if (edge.has_face1) {
		const bool is_inconsistent = (record.a_face0.w & EDGE_COUNT_INCONSISTENT) != 0;
		edge.plane1 = read_plane(record.b_face1.w) * (is_inconsistent ? -1.0 : 1.0);
	}
	return edge;
}

CountItems CountProbe::Work::read_found(double p_distance) const {
	CountItems items;
	for (uint32_t caster = 0; caster < casters.casters.size(); ++caster) {
		const uint32_t first = casters.records[caster].first_face;
		for (uint32_t face = first; face < first + casters.casters[caster].face_count; ++face) {
			const auto record = read_item<shader::CountFaceRecord>(probe.copies->faces, face);
			items.face_casters.push_back(caster);
			CountFace &added = items.faces.emplace_back();
			if (is_seen(face, p_distance)) { // else it has no area, and is in front of nothing
				added.corners[0] = read_point(record.a_kind);
				added.corners[1] = read_point(record.b_first_distance);
				added.corners[2] = read_point(record.c_end_distance);
				added.plane = read_item<glm::vec4>(probe.copies->planes, face);
				added.is_double_sided = (record.a_kind.w & EDGE_COUNT_DOUBLE_SIDED) != 0;
			}
		}
	}
	const uint32_t edge_count =
			std::min(read_item<uint32_t>(probe.copies->totals, EDGE_COUNT_TOTAL_EDGES),
					probe.constants.max_edge_count);
	for (uint32_t index = 0; index < edge_count; ++index) {
		const CountEdge edge = read_edge(index);
		if (is_seen(edge.face0, p_distance)) {
			items.edges.push_back(edge);
		}
	}
	return items;
}

std::optional<CountItems> CountProbe::Work::read_meshes(double p_distance) const {
	CountItems items;
	CountedCasters meshes;
	for (uint32_t index = 0; index < casters.casters.size(); ++index) {
		const CountCaster &caster = casters.casters[index];
		const shader::CountCasterRecord &record = casters.records[index];
		const InstanceSnapshot &instance = casters.instances[caster.instance];
		if (instance.pose && instance.pose->get_move().program) {
			return std::nullopt;
		}
		if ((record.flags & EDGE_COUNT_CASTER_LOD) != 0) {
			uint32_t seen_count = 0;
			for (uint32_t face = 0; face < caster.face_count; ++face) {
				seen_count += is_seen(record.first_face + face, p_distance) ? 1 : 0;
			}
			if (seen_count == 0) {
				continue;
			}
			if (seen_count < caster.face_count) {
				return std::nullopt;
			}
		}
		meshes.add_mesh(pose_topology(caster.mesh, instance.pose.get()),
				probe.view.view_from_world * instance.world_from_node, space);
		items.face_casters.resize(meshes.faces.size(), index);
	}
	items.faces = std::move(meshes.faces);
	items.edges = std::move(meshes.edges);
	return items;
}

std::optional<std::vector<CountEdge>> CountProbe::Work::read_listed(
		const ProbedLeaf &p_leaf) const {
	const bool is_filtered_without_list =
			find_kind() == EDGE_COUNT_LEAVES_FILTERED && p_leaf.result.edge_count == 0;
	if (find_kind() == EDGE_COUNT_LEAVES_UNLISTED || is_filtered_without_list) {
		return std::nullopt;
	}
	const uint32_t edge_mask = (1u << EDGE_COUNT_EDGE_BITS) - 1u;
	const shader::CountLeafResult &result = p_leaf.result;
	const uint32_t first = result.first_word + result.silhouette_count + result.face_count;
	std::vector<CountEdge> edges;
	const uint32_t edge_count = std::min(result.edge_count, probe.constants.list_capacity);
	for (uint32_t index = 0; index < edge_count; ++index) {
		edges.push_back(
				read_edge(read_item<uint32_t>(probe.copies->lists, first + index) & edge_mask));
	}
	return edges;
}

void CountProbe::Work::describe_leaf(
		const std::optional<ProbedLeaf> &p_leaf, ProbeEntry &r_explanation) const {
	ProbeEntry &entry = r_explanation.add("leaf");
	const glm::uvec2 block = receiver.pixel / uint32_t(EDGE_COUNT_BLOCK_PX);
	entry.add("tile", block);
	if (!p_leaf) {
		entry.add("kind", "lit: nothing may be between its receivers and the light");
		return;
	}
	const shader::CountLeafResult &result = p_leaf->result;
	const bool is_lit = find_kind() == EDGE_COUNT_LEAVES_DARK && result.back_facing == 0 &&
			result.light_facing == 0 && result.double_sided == 0; // it is in no list of leaves
	entry.add("kind",
			is_lit ? "lit: nothing is between its receivers and the light"
				   : KIND_NAMES[std::min<size_t>(find_kind(), std::size(KIND_NAMES) - 1)]);
	const glm::uvec4 &flags = p_leaf->leaf.pixels_flags;
	entry.add("receivers", int64_t(std::popcount(flags.x) + std::popcount(flags.y)));
	entry.add("receivers_minimum_light_m", glm::dvec3(p_leaf->leaf.minimum_w));
	entry.add("receivers_maximum_light_m", glm::dvec3(p_leaf->leaf.maximum_w));
	entry.add("distance_for_levels_m", double(p_leaf->leaf.axis_distance.w));
	entry.add("listed_edges", int64_t(p_leaf->result.edge_count));
	entry.add("listed_silhouettes", int64_t(p_leaf->result.silhouette_count));
	entry.add("listed_faces", int64_t(p_leaf->result.face_count));
	entry.add("solids_from_own_ray", p_leaf->result.needs_rays != 0);
}

void CountProbe::Work::describe_items(const CountItems &p_items, const CountDetails &p_details,
		const std::optional<CountDetails> &p_listed, std::span<const CountEdge> p_listed_edges,
		ProbeEntry &r_explanation) const {
	ProbeEntry &faces = r_explanation.add_list("faces_crossed");
	for (const size_t index : p_details.crossed_faces) {
		const CountFace &face = p_items.faces[index];
		ProbeEntry &entry = faces.add("");
		entry.add("caster", describe_caster(p_items.face_casters[index]));
		entry.add("a_world_m", find_world_position(face.corners[0]));
		entry.add("b_world_m", find_world_position(face.corners[1]));
		entry.add("c_world_m", find_world_position(face.corners[2]));
		entry.add("distance_m", find_distance(face));
		const bool is_in_front = glm::dot(glm::dvec3(face.plane), position) + face.plane.w > 0.0;
		entry.add("is_towards_receiver", is_in_front);
		entry.add("is_in_closed_part", !face.is_double_sided);
	}
	ProbeEntry &edges = r_explanation.add_list("edges_counted");
	for (const CountedEdge &counted : p_details.edges) {
		const CountEdge &edge = p_items.edges[counted.index];
		ProbeEntry &entry = edges.add("");
		entry.add("caster", describe_caster(p_items.face_casters[edge.face0]));
		entry.add("a_world_m", find_world_position(edge.a));
		entry.add("b_world_m", find_world_position(edge.b));
		entry.add("weight", int64_t(counted.weight));
		entry.add("area", counted.area);
		entry.add("is_boundary", !edge.has_face1);
		if (p_listed) {
			// Equal bits: both are read from the same record.
			const bool is_listed =
					std::ranges::any_of(p_listed->edges, [&](const CountedEdge &p_other) {
						const CountEdge &other = p_listed_edges[p_other.index];
						return other.a == edge.a && other.b == edge.b && other.face0 == edge.face0;
					});
			entry.add("is_listed", is_listed);
		}
	}
	r_explanation.add("faces_that_cut_the_disc", int64_t(p_details.cut_faces.size()));
}

void CountProbe::Work::describe_casters(const CountItems &p_items, const CountDetails &p_details,
		ProbeEntry &r_casters, ProbeEntry &r_notes) const {
	std::vector<uint32_t> involved = list_passed();
	for (const size_t face : p_details.crossed_faces) {
		involved.push_back(p_items.face_casters[face]);
	}
	for (const CountedEdge &counted : p_details.edges) {
		involved.push_back(p_items.face_casters[p_items.edges[counted.index].face0]);
	}
	std::ranges::sort(involved);
	involved.erase(std::unique(involved.begin(), involved.end()), involved.end());
	const auto add_note = [&](uint32_t p_caster, const auto &...p_parts) {
		r_notes.add("",
				ProbeEntry::Value(text("Caster \"", describe_caster(p_caster), "\" ", p_parts...)));
	};
	for (const uint32_t index : involved) {
		const CountCaster &caster = casters.casters[index];
		const std::shared_ptr<const MeshTopology> topology = get_topology(caster.mesh);
		const TopologyCounts &counts = topology->counts;
		const auto [begin, end] = std::ranges::equal_range(p_items.face_casters, index);
		const std::span<const CountFace> faces =
				std::span(p_items.faces)
						.subspan(size_t(begin - p_items.face_casters.begin()), size_t(end - begin));
		if (std::ranges::all_of(faces,
					[](const CountFace &p_face) { return p_face.plane == glm::dvec4(0.0); })) {
			continue; // the receiver sees another LOD of it
		}
		const bool encloses_light =
				!space.is_directional && compute_enclosed_share(faces) > ENCLOSING_SHARE;
		ProbeEntry &entry = r_casters.add("");
		entry.add("name", ProbeEntry::Value(describe_caster(index)));
		entry.add("triangles", int64_t(caster.face_count));
		entry.add("parts", int64_t(counts.part_count));
		entry.add("closed_parts", int64_t(counts.closed_part_count));
		entry.add("boundary_edges", int64_t(counts.boundary_edge_count));
		entry.add("edges_of_more_than_two_faces", int64_t(counts.non_manifold_edge_count));
		entry.add("edges_of_inconsistent_winding", int64_t(counts.inconsistent_edge_count));
		entry.add("encloses_the_light", encloses_light);
		if (encloses_light) {
			add_note(index,
					"encloses the light's centre, so that it hides most of the light. Move "
					"the light out of it, or let it cast no shadow.");
		}
		const std::shared_ptr<const CutLevels> &levels =
				casters.instances[caster.instance].caster_levels;
		const std::optional<uint32_t> level =
				levels ? levels->find_level(caster.mesh.get()) : std::nullopt;
		if (level) {
			entry.add("level_of_detail", int64_t(*level));
			add_note(index, "is cut out by its texture. Here its outline is that of level ", *level,
					", simplified within ", CutLevels::TOLERANCES_PX[*level],
					" texels: other texels are lit or hidden than those that are drawn.");
		}
		if (counts.boundary_edge_count > 0) {
			add_note(index, "has ", counts.boundary_edge_count,
					" boundary edges, with a face on one side only: light passes where the mesh is "
					"open or its parts do not meet.");
		}
		if (counts.non_manifold_edge_count > 0 || counts.inconsistent_edge_count > 0) {
			add_note(index, "has ", counts.non_manifold_edge_count,
					" edges of more than two faces and ", counts.inconsistent_edge_count,
					" between faces of opposite winding: what it encloses is not defined there, so "
					"each of its faces counts as a thin solid.");
		}
	}
}

void CountProbe::explain(const ProbedReceiver &p_receiver, const CountCasters &p_casters,
		ProbeEntry &r_explanation) const {
	if (copies->counts.empty()) {
		fail("The frame has not finished: nothing was read back for the probe.");
	}
	Work work = { .probe = *this,
		.receiver = p_receiver,
		.casters = p_casters,
		.space = { view.is_orthographic, settings.disc_radius,
				constants.nearer_tolerance * p_receiver.offset_share, scene_size_m },
		.position = glm::dvec3(view.view_from_world * glm::dvec4(p_receiver.position_world, 1.0)),
		.masks = {} };
	for (uint32_t index = 0; index < settings.get_sample_set_count(); ++index) {
		work.masks.emplace_back(index, settings.get_sample_set_count());
	}
	const std::optional<ProbedLeaf> leaf = work.find_leaf();
	work.describe_leaf(leaf, r_explanation);
	const double distance = leaf   ? double(leaf->leaf.axis_distance.w)
			: view.is_orthographic ? work.position.z
								   : glm::length(work.position);
	const CountItems found = work.read_found(distance);
	const std::optional<CountItems> meshes = work.read_meshes(distance);
	CountDetails found_details;
	const double found_visibility = work.count(found.edges, found.faces, &found_details);
	std::vector<CountEdge> listed_edges;
	std::optional<CountDetails> listed;
	std::optional<double> listed_visibility;
	if (leaf) {
		if (std::optional<std::vector<CountEdge>> edges = work.read_listed(*leaf)) {
			listed_edges = std::move(*edges);
			listed_visibility = work.count(listed_edges, found.faces, &listed.emplace());
		}
	}
	const CountItems &exact = meshes ? *meshes : found;
	CountDetails exact_details;
	const double exact_visibility = work.count(exact.edges, exact.faces, &exact_details);

	ProbeEntry &solids = r_explanation.add("solids_before_the_centre");
	solids.add("gpu", int64_t(work.read_debug(EDGE_COUNT_DEBUG_SOLIDS)));
	solids.add("in_double", int64_t(exact_details.solid_count));
	work.describe_items(found, found_details, listed, listed_edges, r_explanation);
	ProbeEntry notes;
	work.describe_casters(exact, exact_details, r_explanation.add_list("casters"), notes);

	const bool is_smooth = leaf && work.find_kind() == EDGE_COUNT_LEAVES_SMOOTH;
	const std::vector<Step> steps = {
		{ "mask", p_receiver.visibility, FILTER_TOLERANCE,
				"Translucent casters or a mask filter changed the mask after counting; only opaque "
				"casters are explained here." },
		{ "gpu", work.read_texel(copies->mask), is_smooth ? SMOOTH_TOLERANCE : MASK_TOLERANCE,
				is_smooth ? "The leaf is smooth: 16 of its 64 receivers are counted, and this one "
							"is interpolated. Set edge_count_interpolation to 0."
						  : "The leaf exceeds edge_count_budget or edge_count_time_budget; else "
							"there is a fault, which the log names." },
		{ "leaf_list", listed_visibility, LIST_TOLERANCE,
				"The leaf's list lacks edges, see is_listed." },
		{ "all_found", found_visibility, FOUND_TOLERANCE,
				"The faces and edges on the GPU differ from the meshes: vertices are rounded "
				"to floats in light space, so parts thinner than the rounding change." },
		{ "meshes", meshes ? std::optional(exact_visibility) : std::nullopt, POINTS_TOLERANCE,
				"Counting is wrong for these meshes: see the casters with edges of more than two "
				"faces or inconsistent winding, or the light's centre is inside a caster." },
		{ "rays", trace_count_visibility(work.space, work.position, exact.faces, RAY_COUNT), 0,
				"" },
	};
	ProbeEntry &values = r_explanation.add("visibility");
	for (const Step &step : steps) {
		values.add(step.name,
				step.visibility ? ProbeEntry::Value(*step.visibility) : ProbeEntry::Value());
	}
	if (leaf && work.find_kind() == EDGE_COUNT_LEAVES_FILTERED) {
		notes.add("",
				"The leaf has more edges than edge_count_budget, so its mask is filtered from a "
				"depth map, not counted.");
	}
	r_explanation.add_list("notes").entries = std::move(notes.entries);
	ProbeEntry &findings = r_explanation.add_list("findings");
	for (size_t index = 0; index + 1 < steps.size(); ++index) {
		const Step &step = steps[index];
		const auto next = std::find_if(steps.begin() + long(index) + 1, steps.end(),
				[](const Step &p_step) { return p_step.visibility.has_value(); });
		if (!step.visibility || next == steps.end()) {
			continue;
		}
		const double difference = std::abs(*step.visibility - *next->visibility);
		double tolerance = 0; // of this step and of those that were not computed
		for (auto skipped = steps.begin() + long(index); skipped != next; ++skipped) {
			tolerance += skipped->tolerance;
		}
		if (difference > tolerance) {
			findings.add("",
					ProbeEntry::Value(text(step.name, " and ", next->name, " differ by ",
							difference, ". ", step.meaning)));
		}
	}
}

} // namespace gnomon
