#include "modules/godot_addon/receiver_textures.h"

#include "modules/godot_addon/directional_albedo.h"

#include <cstring>
#include <limits>

namespace gnomon {

namespace {

using godot::RenderingServer;

const char MASKS_GLOBAL[] = "gnomon_masks";
const char DEPTH_GLOBAL[] = "gnomon_depth";
const char LIGHTS_GLOBAL[] = "gnomon_lights";
const char ALBEDO_GLOBAL[] = "gnomon_albedo";
const float NO_FADE_M = 1e30f;	  // depth from which the shadow of a light that does not fade fades
const uint32_t SIZE_STEP_PX = 64; // no new array for each pixel of a window resize

/// Returns the row that gnomon_is_masked_view() compares with the view that is drawn.
ReceiverRow make_view_row(const GodotView &p_view, bool p_has_faded) {
	const glm::mat4 world_from_camera(p_view.camera_transform.to_matrix());
	return { glm::vec4(glm::vec3(world_from_camera[3]), p_view.horizontal_scale),
		glm::vec4(glm::vec3(world_from_camera[0]), float(p_view.size_px.x)),
		glm::vec4(glm::vec3(world_from_camera[2]), float(p_view.size_px.y)),
		glm::vec4(p_view.has_depth_samples() ? float(p_view.sample_count) : 0.0f,
				p_view.depth_offset, p_has_faded ? 1.0f : 0.0f, 0.0f) };
}

ReceiverRow make_light_row(const ReceiverLight &p_light, const glm::dmat4 &p_view_from_world,
		const glm::dvec3 &p_camera_world) {
	const glm::vec3 position(p_view_from_world * glm::dvec4(p_light.position_world, 1.0));
	const glm::vec3 direction(p_view_from_world * glm::dvec4(p_light.direction_world, 0.0));
	const float godot_shadow = p_light.has_godot_shadow ? 2.0f : 0.0f;
	const bool fades_by_depth = p_light.is_directional && p_light.fade_end_m > 0;
	const float opacity = p_light.is_directional
			? p_light.mask_opacity
			: p_light.mask_opacity * compute_shadow_fade(p_light, p_camera_world);
	return { glm::vec4(p_light.specular, float(p_light.mask), p_light.size, opacity + godot_shadow),
		glm::vec4(position, 1.0f / p_light.range_m), glm::vec4(direction, p_light.cone_cosine),
		glm::vec4(p_light.distance_exponent, p_light.cone_exponent,
				fades_by_depth ? p_light.fade_begin_m : NO_FADE_M,
				fades_by_depth ? p_light.fade_end_m : 2.0f * NO_FADE_M) };
}

} // namespace

ReceiverGlobals::ReceiverGlobals() : server(godot::find_singleton("RenderingServer")) {
	const std::span<const float> values = get_directional_albedo();
	const godot::PackedByteArray bytes(
			std::span(reinterpret_cast<const uint8_t *>(values.data()), values.size_bytes()));
	const auto image = godot::Image::create_from_data(
			ALBEDO_SIZE, ALBEDO_SIZE, /*use_mipmaps=*/false, godot::Image::FORMAT_RF, bytes);
	albedo = server.texture_2d_create(image);
	server.global_shader_parameter_add(
			MASKS_GLOBAL, RenderingServer::GLOBAL_VAR_TYPE_SAMPLER2DARRAY, {});
	server.global_shader_parameter_add(
			DEPTH_GLOBAL, RenderingServer::GLOBAL_VAR_TYPE_SAMPLER2D, {});
	server.global_shader_parameter_add(
			LIGHTS_GLOBAL, RenderingServer::GLOBAL_VAR_TYPE_SAMPLER2D, {});
	server.global_shader_parameter_add(
			ALBEDO_GLOBAL, RenderingServer::GLOBAL_VAR_TYPE_SAMPLER2D, albedo);
}

ReceiverGlobals::~ReceiverGlobals() {
	for (const char *global : { MASKS_GLOBAL, DEPTH_GLOBAL, LIGHTS_GLOBAL, ALBEDO_GLOBAL }) {
		server.global_shader_parameter_remove(global);
	}
	server.free_rid(albedo);
}

void ReceiverTextures::Published::publish(
		const RenderingServer &p_server, const char *p_global, godot::RID p_texture) {
	// The kind of layers matters for arrays only.
	const godot::RID made =
			p_server.texture_rd_create(p_texture, RenderingServer::TEXTURE_LAYERED_2D_ARRAY);
	p_server.global_shader_parameter_set(p_global, made);
	free(p_server);
	texture = made;
}

void ReceiverTextures::Published::free(const RenderingServer &p_server) {
	if (texture.id) {
		p_server.free_rid(std::exchange(texture, {}));
	}
}

ReceiverTextures::ReceiverTextures(GodotDevice &p_device) :
		device(p_device), server(godot::find_singleton("RenderingServer")) {
	rows = OwnedBuffer(device,
			device.create_buffer({ "rows of lights", RECEIVER_ROW_COUNT * sizeof(ReceiverRow),
					BufferUsage::COPY_SOURCE, MemoryKind::UPLOAD }));
	lights = OwnedTexture(device,
			device.create_texture({ "Gnomon's lights", Format::RGBA32_SFLOAT,
					{ RECEIVER_COLUMN_COUNT, RECEIVER_ROW_COUNT }, 1,
					TextureUsage::SAMPLED | TextureUsage::COPY_TARGET }));
	published_lights.publish(server, LIGHTS_GLOBAL, device.get_rid(lights.get()));
}

ReceiverTextures::~ReceiverTextures() {
	for (const char *global : { MASKS_GLOBAL, DEPTH_GLOBAL, LIGHTS_GLOBAL }) {
		server.global_shader_parameter_set(global, {});
	}
	published_masks.free(server);
	published_depth.free(server);
	published_lights.free(server);
}

void ReceiverTextures::reserve(const ReceiverSpace &p_space) {
	if (space.holds(p_space)) {
		return;
	}
	const glm::uvec2 old_size_px = space.size_px;
	space.add({ (p_space.size_px + SIZE_STEP_PX - 1u) / SIZE_STEP_PX * SIZE_STEP_PX,
			glm::max(p_space.mask_count, MIN_ARRAY_LAYER_COUNT), p_space.has_depth });
	OwnedTexture new_masks(device,
			device.create_texture(
					{ "Gnomon's masks", Format::R16_SFLOAT, space.size_px, space.mask_count,
							TextureUsage::STORAGE | TextureUsage::SAMPLED |
									TextureUsage::COPY_SOURCE | TextureUsage::COPY_TARGET,
							/*is_array=*/true }));
	published_masks.publish(server, MASKS_GLOBAL, device.get_rid(new_masks.get()));
	masks = std::move(new_masks);
	if (space.has_depth && (!depth.get() || space.size_px != old_size_px)) {
		OwnedTexture new_depth(device,
				device.create_texture({ "Gnomon's depth", Format::R32_SFLOAT, space.size_px, 1,
						TextureUsage::STORAGE | TextureUsage::SAMPLED }));
		published_depth.publish(server, DEPTH_GLOBAL, device.get_rid(new_depth.get()));
		depth = std::move(new_depth);
	}
}

void ReceiverTextures::write_lights(
		const GodotView &p_view, const ScenarioFrame &p_frame, bool p_has_masks) {
	Table table = {};
	table[0] = make_view_row(p_view, p_frame.has_faded);
	const glm::dmat4 view_from_world = glm::inverse(p_view.camera_transform.to_matrix());
	for (ReceiverLight light : p_frame.receiver_lights) {
		light.mask = p_has_masks ? light.mask : -1;
		table[light.row] = make_light_row(light, view_from_world, p_view.camera.position_world);
	}
	write(table);
}

void ReceiverTextures::forget_view() {
	Table table = {};
	table[0][0] = glm::vec4(std::numeric_limits<float>::quiet_NaN()); // NaN equals no view
	write(table);
}

void ReceiverTextures::write(const Table &p_table) {
	std::memcpy(device.get_mapped(rows.get()), p_table.data(), sizeof(p_table));
	device.begin_commands().copy_buffer_to_texture(rows.get(), lights.get());
	device.submit_commands(RenderingDevice::SubmitMode::QUEUE);
}

} // namespace gnomon
