#include "modules/shadow_reference/shadow_reference.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/progress.h"
#include "modules/render_graph/read_back.h"
#include "modules/shadow_reference/reference_input.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/mask_filter.h"

#include <chrono>
#include <cstring>

namespace gnomon {

namespace {

// Increase it when the definition of the reference or the tracer changes, so that older cache
// entries are not found.
constexpr uint64_t REFERENCE_VERSION = 2;

template <typename T> uint64_t add_to_hash(std::span<const T> p_values, uint64_t p_hash) {
	return compute_hash(bytes_of(p_values), p_hash);
}

uint64_t add_to_hash(const Triangles &p_triangles, uint64_t p_hash) {
	return add_to_hash(std::span<const uint32_t>(p_triangles.indices),
			add_to_hash(std::span<const glm::vec3>(p_triangles.positions), p_hash));
}

} // namespace

struct ShadowReference::Job {
	glm::uvec2 size_px;
	shader::FrameConstants frame;
	AreaLight light;
	VisibilityOptions options;
	CasterTriangles triangles;
	std::shared_ptr<const SurfaceSpread> spread;
	std::vector<Triangles> spread_bodies;
	RGBuffer depth;
	RGBuffer normal;
	RGBuffer material;
	RGBuffer receivers;
	RGBuffer mask;
	std::string light_name;
	bool may_reuse = true;

	uint64_t compute_key(std::span<const ReceiverPoint> p_points) const {
		uint64_t key = add_to_hash(triangles.opaque, REFERENCE_VERSION);
		for (const CutOutTriangles &body : triangles.cut_out) {
			key = add_to_hash(body.triangles, key);
			key = add_to_hash(std::span<const glm::vec2>(body.uvs), key);
			key = add_to_hash(std::span<const float>(body.alphas), key);
			key = compute_hash(body.test, key);
		}
		for (const TranslucentTriangles &body : triangles.translucent) {
			key = add_to_hash(body.triangles, key);
			key = compute_value_hash(body.transmittance, key);
		}
		std::vector<glm::vec3> points;
		for (const ReceiverPoint &point : p_points) {
			points.push_back(point.is_receiver ? point.position : glm::vec3(0.0f));
			points.push_back(
					point.is_receiver ? point.offset_m * point.geometric_normal : glm::vec3(0.0f));
		}
		key = add_to_hash(std::span<const glm::vec3>(points), key);
		if (!spread_bodies.empty()) {
			// Range and cone decide which points count around a receiver that spreads light.
			std::vector<float> spread_values = { light.range_m, light.cos_outer };
			for (const ReceiverPoint &point : p_points) {
				spread_values.push_back(point.spread_radius_m);
			}
			for (const Triangles &body : spread_bodies) {
				key = add_to_hash(body, key);
			}
			key = add_to_hash(std::span<const float>(spread_values), key);
		}
		const float numbers[] = { light.is_directional ? 1.0f : 0.0f, light.position.x,
			light.position.y, light.position.z, light.direction.x, light.direction.y,
			light.direction.z, light.disc_radius, static_cast<float>(options.sample_count) };
		return add_to_hash(std::span<const float>(numbers), key);
	}
};

void ShadowReference::get_light_properties(PropertyList &r_list) const {
	r_list.add({ "reference_samples", PropertyType::INT, int64_t(1024), "1,65536,1",
			"Rays per pixel. The error falls faster than 1 / sqrt(rays); published tables use "
			"9216.",
			"", "Reference" });
}

void ShadowReference::compute(const Job &p_job, const std::vector<ReceiverPoint> &p_points,
		ReferenceVisibility &r_reference) {
	const auto start = std::chrono::steady_clock::now();
	const CasterScene tracer(p_job.triangles.opaque.positions, p_job.triangles.opaque.indices,
			p_job.triangles.translucent, p_job.triangles.cut_out);
	Progress progress("Tracing the reference of light \"" + p_job.light_name + "\"");
	VisibilityOptions options = p_job.options;
	std::optional<SpreadVisibility> spread;
	if (!p_job.spread_bodies.empty()) {
		spread.emplace(p_job.spread_bodies, *p_job.spread);
		options.spread = &*spread;
	}
	options.progress = [&](float p_fraction) { progress.update(p_fraction); };
	VisibilityResult result = tracer.compute(p_points, p_job.size_px, p_job.light, options);
	const double seconds =
			std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	log_info("Reference: ", result.ray_count, " rays in ", seconds, " s (",
			result.ray_count / std::max(seconds, 1e-9) * 1e-6, " million a second).");
	r_reference = std::move(result);
}

void ShadowReference::run(const Job &p_job, HostContext &p_context) {
	const size_t pixel_count = size_t(p_job.size_px.x) * p_job.size_px.y;
	const uint8_t *receivers = p_context.get_mapped(p_job.receivers);
	std::vector<SurfacePoint> surfaces = read_surfaces(p_job.frame, p_job.size_px,
			{ p_context.get_mapped(p_job.depth), p_context.get_mapped(p_job.normal),
					p_job.material ? p_context.get_mapped(p_job.material) : nullptr });
	const auto is_receiver = [&](size_t p_pixel) { return receivers[p_pixel] != 0; };
	for (size_t pixel = 0; pixel < surfaces.size(); ++pixel) {
		if (is_receiver(pixel) && shader::is_on_far_side(float(receivers[pixel]) / 255.0f)) {
			surfaces[pixel].geometric_normal *= -1.0f;
		}
	}
	const std::vector<ReceiverPoint> points =
			make_receiver_points(surfaces, p_job.spread.get(), is_receiver);
	const uint64_t key = p_job.compute_key(points);
	if (!p_job.may_reuse || key != last_key || last_reference.visibility.size() != pixel_count) {
		const std::optional<ReferenceVisibility> stored = p_job.may_reuse
				? load_reference(key, pixel_count, !p_job.triangles.translucent.empty())
				: std::nullopt;
		if (stored) {
			last_reference = *stored;
		} else {
			compute(p_job, points, last_reference);
			save_reference(key, last_reference);
		}
		last_key = key;
		log_info("Reference of light \"", p_job.light_name, "\": ", p_job.options.sample_count,
				" samples, standard error ", last_reference.standard_error, " over ",
				last_reference.penumbra_pixel_count, " penumbra pixels",
				stored ? " (from the cache)." : ".");
	}
	if (last_reference.colors.empty()) {
		std::memcpy(p_context.get_mapped(p_job.mask), last_reference.visibility.data(),
				pixel_count * sizeof(float));
		return;
	}
	glm::vec4 *mask = reinterpret_cast<glm::vec4 *>(p_context.get_mapped(p_job.mask));
	for (size_t index = 0; index < pixel_count; ++index) {
		mask[index] = glm::vec4(last_reference.colors[index], 1.0f);
	}
}

RGTexture ShadowReference::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	auto job = std::make_shared<Job>();
	job->size_px = p_inputs.size_px;
	job->frame = compute_frame_constants(p_inputs.scene, p_inputs.size_px);
	job->light_name = p_inputs.light.name;
	job->may_reuse = p_inputs.may_reuse;
	job->light = make_area_light(p_inputs.scene, p_inputs.light);
	job->options.sample_count = read_count(p_inputs.properties, "reference_samples");
	job->triangles = collect_triangles(p_inputs.scene);
	job->spread = find_surface_spread();
	job->spread_bodies = collect_spread_bodies(p_inputs.scene, job->spread.get());

	const uint64_t pixel_count = uint64_t(p_inputs.size_px.x) * p_inputs.size_px.y;
	job->depth = add_copy_for_host(r_graph, p_inputs.depth);
	job->normal = add_copy_for_host(r_graph, p_inputs.geometric_normal);
	job->receivers = add_copy_for_host(r_graph, p_inputs.receivers);
	if (p_inputs.material) {
		job->material = add_copy_for_host(r_graph, p_inputs.material);
	}
	const Format format =
			job->triangles.translucent.empty() ? Format::R32_SFLOAT : Format::RGBA32_SFLOAT;
	job->mask =
			r_graph.create_buffer({ "reference mask", pixel_count * get_texel_size_bytes(format),
					BufferUsage::COPY_SOURCE, MemoryKind::UPLOAD });
	PassBuilder pass = r_graph.add_pass("trace");
	for (const RGBuffer &read : { job->depth, job->normal, job->receivers, job->material }) {
		if (read) {
			pass.reads(read, Access::HOST_READ);
		}
	}
	pass.writes(job->mask, Access::HOST_WRITE).execute_on_host([this, job](HostContext &p_context) {
		run(*job, p_context);
	});
	const RGTexture mask = r_graph.create_texture({ "visibility mask", format, p_inputs.size_px, 1,
			TextureUsage::COPY_TARGET | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	r_graph.add_pass("upload mask")
			.reads(job->mask, Access::COPY_READ)
			.writes(mask, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.copy_buffer_to_texture(
						p_context.get(job->mask), p_context.get(mask));
			});
	return mask;
}

} // namespace gnomon
