// Resources and submissions; see also godot_command_list.cpp and godot_pipelines.cpp.

#include "modules/rendering_device_godot/godot_device.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/core/log.h"
#include "modules/rendering_device_godot/godot_formats.h"
#include "modules/rendering_device_godot/godot_interface.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

using RD = godot::RenderingDevice;
using godot::Array;
using godot::PackedByteArray;
using godot::Ref;
using godot::Variant;

namespace {

constexpr uint64_t MAX_BUFFER_BYTES = 0xffffffffu; // sizes are 32 bits wide in Godot's calls
constexpr int64_t SAMPLED_TEXTURE_PX = 256;		   // side of the texture in measure_two_samples()
constexpr int MAX_MEASUREMENTS = 8;				   // of its size
constexpr size_t MAX_SPARE_UPLOADS = 64;		   // per size and usage

uint64_t compute_size_bytes(const TextureDesc &p_desc) {
	return compute_layer_bytes(p_desc) * p_desc.layer_count;
}

} // namespace

GodotDevice::GodotDevice(
		godot::RenderingDevice p_device, Kind p_kind, const DeviceOptions &p_options) :
		rd(p_device),
		kind(p_kind) {
	info.name = rd.get_device_name().to_utf8();
	info.driver = rd.get_device_vendor_name().to_utf8();
	info.type = "of Godot";
	info.is_usable = true;
	features.depth_clamp = true;
	features.fragment_stores = true;
	features.max_texture_size_px = uint32_t(rd.limit_get(RD::LIMIT_MAX_TEXTURE_SIZE_2D));
	features.max_storage_buffer_bytes = MAX_BUFFER_BYTES;
	features.runs_on_cpu = godot::RenderingServer(godot::find_singleton("RenderingServer"))
								   .get_video_adapter_type() == RD::DEVICE_TYPE_CPU;
	features.subgroup_size = measure_subgroup_size();
	features.subgroup_operations = features.subgroup_size >= MIN_SUBGROUP_SIZE;
	for (const auto &feature : p_options.denied_features) {
		features.*feature = false;
	}
}

uint32_t GodotDevice::measure_subgroup_size() {
	const BufferRID result = create_buffer({ "subgroup size", sizeof(uint32_t) });
	const PipelineRID pipeline = get_compute_pipeline(
			{ "subgroup size", "rendering_device_godot/subgroup_size.comp", {} });
	CommandList &commands = begin_commands();
	commands.bind_pipeline(pipeline);
	commands.bind_resources({ { 0, result } });
	commands.dispatch({ 1, 1, 1 });
	submit_commands(SubmitMode::WAIT);
	const PackedByteArray read = rd.buffer_get_data(buffers.get(result).rid, 0, sizeof(uint32_t));
	uint32_t size = 0;
	if (read.get_values().size() == sizeof(size)) {
		std::memcpy(&size, read.get_values().data(), sizeof(size));
	}
	free(result);
	return size;
}

GodotDevice::~GodotDevice() {
	read_backs.clear(); // the owners of the callbacks may be gone
	wait_idle();
	compile_list.free_resources();
	*is_alive = false;
	for (const std::string &name : list_live_resources()) {
		log_error("Leaked ", name, ". Free it before the device ends.");
	}
	// Godot frees dependent objects together with what they depend on.
	for (const GodotPipeline &pipeline : pipelines) {
		for (const auto &[format, rid] : pipeline.by_framebuffer_format) {
			rd.free_rid(rid);
		}
	}
	for (const auto &[names, shader] : shaders) {
		rd.free_rid(shader);
	}
	for (const auto &[key, spares] : spare_uploads) {
		for (const Cached &spare : spares) {
			rd.free_rid(spare.rid);
		}
	}
	if (kind == Kind::LOCAL) {
		godot::get_interface().object_destroy(rd.get_object());
	}
}

std::vector<std::string> GodotDevice::list_live_resources() {
	std::vector<std::string> names;
	textures.for_each([&](TextureRID, GodotTexture &r_texture) {
		names.push_back(text("texture '", r_texture.desc.name, "'"));
	});
	buffers.for_each([&](BufferRID, GodotBuffer &r_buffer) {
		names.push_back(text("buffer '", r_buffer.desc.name, "'"));
	});
	samplers.for_each([&](SamplerRID, GodotSampler &r_sampler) {
		names.push_back(text("sampler '", r_sampler.desc.name, "'"));
	});
	return names;
}

MemoryUse GodotDevice::get_memory_use() const {
	MemoryUse result = use;
	result.allocated_bytes = uint64_t(rd.get_memory_usage(RD::MEMORY_TOTAL));
	return result;
}

godot::RID GodotDevice::create_godot_buffer(
		const BufferDesc &p_desc, std::span<const uint8_t> p_bytes) {
	const PackedByteArray bytes(p_bytes);
	const int64_t size = static_cast<int64_t>(p_desc.size_bytes);
	const bool is_storage = has_usage(p_desc.usage, BufferUsage::STORAGE);
	const int64_t bits = is_storage ? int64_t(RD::BUFFER_CREATION_AS_STORAGE_BIT) : 0;
	if (has_usage(p_desc.usage, BufferUsage::TEXEL)) {
		const int64_t count = size / get_texel_size_bytes(p_desc.texel_format);
		return rd.texture_buffer_create(count, to_godot_format(p_desc.texel_format),
				p_bytes.empty() ? PackedByteArray(std::vector<uint8_t>(size_t(size))) : bytes);
	}
	if (has_usage(p_desc.usage, BufferUsage::VERTEX)) {
		return rd.vertex_buffer_create(size, bytes, bits);
	}
	if (has_usage(p_desc.usage, BufferUsage::INDEX)) {
		return rd.index_buffer_create(size / int64_t(sizeof(uint32_t)),
				RD::INDEX_BUFFER_FORMAT_UINT32, bytes, /*p_use_restart_indices=*/false, bits);
	}
	// Godot's buffers cannot be both; with both usages it becomes a storage buffer.
	if (has_usage(p_desc.usage, BufferUsage::UNIFORM) && !is_storage) {
		return rd.uniform_buffer_create(size, bytes, /*p_creation_bits=*/0);
	}
	return rd.storage_buffer_create(size, bytes,
			has_usage(p_desc.usage, BufferUsage::INDIRECT)
					? int64_t(RD::STORAGE_BUFFER_USAGE_DISPATCH_INDIRECT)
					: 0,
			/*p_creation_bits=*/0);
}

BufferRID GodotDevice::create_buffer(const BufferDesc &p_desc) {
	return create_buffer_with_data(p_desc, {});
}

BufferRID GodotDevice::create_buffer_with_data(
		BufferDesc p_desc, std::span<const uint8_t> p_bytes) {
	GNOMON_ASSERT(p_desc.size_bytes > 0, "buffer '", p_desc.name, "' has no bytes");
	GodotBuffer buffer;
	buffer.desc = std::move(p_desc);
	const BufferDesc &desc = buffer.desc;
	if (desc.size_bytes > MAX_BUFFER_BYTES) {
		fail_capacity("Buffer '", desc.name, "' needs ", desc.size_bytes, " bytes, at most ",
				MAX_BUFFER_BYTES, " are possible in Godot. Let fewer meshes cast shadows.");
	}
	if (desc.memory != MemoryKind::GPU) {
		buffer.bytes.resize(size_t(desc.size_bytes));
	}
	const auto spare = spare_uploads.find({ desc.size_bytes, desc.usage });
	if (desc.memory == MemoryKind::UPLOAD && spare != spare_uploads.end() &&
			!spare->second.empty()) {
		buffer.rid = spare->second.back().rid;
		spare->second.pop_back();
	} else if (desc.memory != MemoryKind::READBACK) {
		buffer.rid = create_godot_buffer(desc, p_bytes);
		if (!buffer.rid) {
			fail("Buffer '", desc.name, "' of ", desc.size_bytes,
					" bytes could not be made: Godot's log has the reason. Close other programs, "
					"or let fewer meshes cast shadows.");
		}
		if (desc.memory == MemoryKind::GPU) {
			rd.set_resource_name(buffer.rid, desc.name);
		}
	}
	use.used_bytes += desc.size_bytes;
	use.peak_bytes = std::max(use.peak_bytes, use.used_bytes);
	return buffers.add(std::move(buffer));
}

TextureRID GodotDevice::create_texture(const TextureDesc &p_desc) {
	return create_texture_with_data(p_desc, {});
}

TextureRID GodotDevice::create_texture_with_data(
		TextureDesc p_desc, std::span<const uint8_t> p_bytes) {
	if (!p_bytes.empty()) {
		p_desc.usage = p_desc.usage | TextureUsage::COPY_TARGET;
	}
	if (std::max(p_desc.size_px.x, p_desc.size_px.y) > features.max_texture_size_px) {
		fail("Texture '", p_desc.name, "' is ", p_desc.size_px.x, "x", p_desc.size_px.y,
				" pixels, at most ", features.max_texture_size_px,
				" are possible. Take a smaller map or viewport.");
	}
	const auto format = Ref<godot::RDTextureFormat>::create();
	format.set_format(to_godot_format(p_desc.format));
	format.set_width(p_desc.size_px.x);
	format.set_height(p_desc.size_px.y);
	format.set_array_layers(p_desc.layer_count);
	format.set_mipmaps(p_desc.mip_count);
	format.set_texture_type(p_desc.is_array ? RD::TEXTURE_TYPE_2D_ARRAY : RD::TEXTURE_TYPE_2D);
	format.set_usage_bits(to_godot_usage(p_desc));
	GNOMON_ASSERT(p_bytes.empty() || p_bytes.size() == compute_size_bytes(p_desc), "texture '",
			p_desc.name, "': ", p_bytes.size(), " bytes, must be ", compute_size_bytes(p_desc));
	Array data;
	for (uint32_t layer = 0; !p_bytes.empty() && layer < p_desc.layer_count; ++layer) {
		const size_t size = p_bytes.size() / p_desc.layer_count;
		data.append(Variant(PackedByteArray(p_bytes.subspan(layer * size, size))));
	}
	GodotTexture texture;
	texture.rid = rd.texture_create(format, Ref<godot::RDTextureView>::create(), data);
	if (!texture.rid) {
		fail("Texture '", p_desc.name, "' of ", p_desc.size_px.x, "x", p_desc.size_px.y,
				" pixels could not be made: Godot's log has the reason. Take a smaller map, or "
				"close other programs.");
	}
	rd.set_resource_name(texture.rid, p_desc.name);
	use.used_bytes += compute_size_bytes(p_desc);
	use.peak_bytes = std::max(use.peak_bytes, use.used_bytes);
	texture.desc = std::move(p_desc);
	return textures.add(std::move(texture));
}

bool GodotDevice::has_two_samples() {
	if (!two_samples) {
		two_samples = measure_two_samples();
	}
	return *two_samples;
}

/// Godot has no function for it, but a texture with 2 samples needs about twice the memory.
bool GodotDevice::measure_two_samples() {
	const auto measure_bytes = [this](int64_t p_samples) {
		const auto format = Ref<godot::RDTextureFormat>::create();
		format.set_format(to_godot_format(Format::RGBA16_SFLOAT));
		format.set_width(SAMPLED_TEXTURE_PX);
		format.set_height(SAMPLED_TEXTURE_PX);
		format.set_samples(p_samples);
		format.set_usage_bits(RD::TEXTURE_USAGE_COLOR_ATTACHMENT_BIT);
		const int64_t before = rd.get_memory_usage(RD::MEMORY_TEXTURES);
		const godot::RID texture =
				rd.texture_create(format, Ref<godot::RDTextureView>::create(), Array());
		const int64_t bytes = rd.get_memory_usage(RD::MEMORY_TEXTURES) - before;
		rd.free_rid(texture);
		return bytes;
	};
	// Another thread may create or free textures meanwhile, so the results must repeat.
	int64_t single = measure_bytes(RD::TEXTURE_SAMPLES_1);
	int64_t doubled = measure_bytes(RD::TEXTURE_SAMPLES_2);
	for (int attempt = 0; attempt < MAX_MEASUREMENTS; ++attempt) {
		const int64_t single_again = measure_bytes(RD::TEXTURE_SAMPLES_1);
		const int64_t doubled_again = measure_bytes(RD::TEXTURE_SAMPLES_2);
		if (single == single_again && doubled == doubled_again) {
			break;
		}
		single = single_again;
		doubled = doubled_again;
	}
	return 2 * doubled > 3 * single;
}

TextureRID GodotDevice::import_texture(godot::RID p_texture, const TextureDesc &p_desc) {
	GodotTexture texture;
	texture.desc = p_desc;
	texture.rid = p_texture;
	texture.is_imported = true;
	return textures.add(std::move(texture));
}

godot::RID GodotDevice::get_layer(GodotTexture &r_texture, uint32_t p_layer) {
	if (p_layer == Binding::ALL_LAYERS || !r_texture.desc.is_array) {
		return r_texture.rid;
	}
	godot::RID &view = r_texture.layers[p_layer];
	if (!view) {
		view = rd.texture_create_shared_from_slice(Ref<godot::RDTextureView>::create(),
				r_texture.rid, p_layer, /*p_mipmap=*/0, /*p_mipmaps=*/1, RD::TEXTURE_SLICE_2D);
		GNOMON_ASSERT(view, "Godot refuses a view of layer ", p_layer, " of texture '",
				r_texture.desc.name, "'");
	}
	return view;
}

SamplerRID GodotDevice::create_sampler(const SamplerDesc &p_desc) {
	const auto state = Ref<godot::RDSamplerState>::create();
	const auto get_filter = [](bool p_is_linear) {
		return p_is_linear ? RD::SAMPLER_FILTER_LINEAR : RD::SAMPLER_FILTER_NEAREST;
	};
	const auto get_repeat_mode = [](AddressMode p_mode) {
		return p_mode == AddressMode::REPEAT	? RD::SAMPLER_REPEAT_MODE_REPEAT
				: p_mode == AddressMode::MIRROR ? RD::SAMPLER_REPEAT_MODE_MIRRORED_REPEAT
												: RD::SAMPLER_REPEAT_MODE_CLAMP_TO_EDGE;
	};
	state.set_mag_filter(get_filter(p_desc.mag_filter == Filter::LINEAR));
	state.set_min_filter(get_filter(p_desc.min_filter == Filter::LINEAR));
	state.set_mip_filter(get_filter(p_desc.mip_mode == MipMode::LINEAR));
	// With a maximum of 0.25 only the first level is read, with the minification filter.
	state.set_max_lod(p_desc.mip_mode == MipMode::NONE ? 0.25 : 1e20);
	state.set_repeat_u(get_repeat_mode(p_desc.address_u));
	state.set_repeat_v(get_repeat_mode(p_desc.address_v));
	state.set_repeat_w(RD::SAMPLER_REPEAT_MODE_CLAMP_TO_EDGE);
	return samplers.add({ p_desc, rd.sampler_create(state) });
}

void GodotDevice::free(BufferRID p_buffer) {
	const GodotBuffer buffer = buffers.remove(p_buffer);
	use.used_bytes -= buffer.desc.size_bytes;
	std::erase(stale_uploads, p_buffer);
	if (buffer.desc.memory == MemoryKind::UPLOAD) {
		auto &spares = spare_uploads[{ buffer.desc.size_bytes, buffer.desc.usage }];
		if (spares.size() < MAX_SPARE_UPLOADS) {
			spares.push_back({ buffer.rid, submission });
			return;
		}
	}
	if (buffer.rid) {
		remove_dependents(buffer.rid);
		rd.free_rid(buffer.rid);
	}
}

void GodotDevice::free(TextureRID p_texture) {
	const GodotTexture texture = textures.remove(p_texture);
	if (texture.is_imported) {
		for (const auto &[layer, view] : texture.layers) {
			if (rd.texture_is_valid(view)) {
				rd.free_rid(view);
			}
		}
		return;
	}
	use.used_bytes -= compute_size_bytes(texture.desc);
	remove_dependents(texture.rid);
	for (const auto &[layer, view] : texture.layers) {
		remove_dependents(view);
	}
	rd.free_rid(texture.rid); // also frees its views
}

void GodotDevice::free(SamplerRID p_sampler) {
	rd.free_rid(samplers.remove(p_sampler).rid);
}

void GodotDevice::free(MemoryRID) {
	GNOMON_ASSERT(false, "this device has no aliased memory");
}

const BufferDesc &GodotDevice::get_desc(BufferRID p_buffer) const {
	return buffers.get(p_buffer).desc;
}

const TextureDesc &GodotDevice::get_desc(TextureRID p_texture) const {
	return textures.get(p_texture).desc;
}

uint8_t *GodotDevice::get_mapped(BufferRID p_buffer) {
	GodotBuffer &buffer = buffers.get(p_buffer);
	GNOMON_ASSERT(!buffer.bytes.empty(), "buffer '", buffer.desc.name, "' is not mapped");
	if (buffer.desc.memory == MemoryKind::UPLOAD && !buffer.is_stale) {
		buffer.is_stale = true;
		stale_uploads.push_back(p_buffer);
	}
	return buffer.bytes.data();
}

void GodotDevice::flush_uploads() {
	for (const BufferRID handle : stale_uploads) {
		GodotBuffer &buffer = buffers.get(handle);
		rd.buffer_update(buffer.rid, 0, static_cast<int64_t>(buffer.bytes.size()),
				PackedByteArray(buffer.bytes));
		buffer.is_stale = false;
	}
	stale_uploads.clear();
}

godot::Callable GodotDevice::make_callable(ReadBackCallback p_callback) const {
	return godot::Callable(
			[callback = std::move(p_callback), is_alive = is_alive,
					is_not_abandoned = is_not_abandoned](std::span<const Variant> p_arguments) {
				if (!*is_alive || !*is_not_abandoned || p_arguments.empty()) {
					return;
				}
				try {
					callback(PackedByteArray(p_arguments.front()).get_values());
				} catch (const std::exception &failure) { // Godot cannot handle exceptions
					log_error(describe_failure(failure));
				}
			});
}

RenderingDevice::PlacementRequirements GodotDevice::get_placement_requirements(
		const TextureDesc &) {
	GNOMON_ASSERT(false, "this device has no aliased memory");
	return {};
}

MemoryRID GodotDevice::create_texture_memory(const std::string &, uint64_t) {
	GNOMON_ASSERT(false, "this device has no aliased memory");
	return {};
}

TextureRID GodotDevice::create_placed_texture(const TextureDesc &, MemoryRID, uint64_t) {
	GNOMON_ASSERT(false, "this device has no aliased memory");
	return {};
}

void GodotDevice::remove_dependents(godot::RID p_resource) {
	for (Cache *cache : { &uniform_sets, &framebuffers, &vertex_arrays, &index_arrays }) {
		std::erase_if(*cache, [&](const auto &p_entry) {
			return std::find(p_entry.first.begin(), p_entry.first.end(), p_resource.id) !=
					p_entry.first.end();
		});
	}
}

void GodotDevice::prune(Cache &r_cache, bool (*p_is_valid)(const RD &, godot::RID)) {
	std::erase_if(r_cache, [&](const auto &p_entry) {
		const Cached &cached = p_entry.second;
		const bool is_old = submission - cached.last_use > MAX_UNUSED_FRAMES;
		if (is_old && p_is_valid(rd, cached.rid)) {
			rd.free_rid(cached.rid);
		}
		return is_old;
	});
}

void GodotDevice::prune_spare_uploads() {
	for (auto &[key, spares] : spare_uploads) {
		std::erase_if(spares, [&](const Cached &p_spare) {
			const bool is_old = submission - p_spare.last_use > MAX_UNUSED_FRAMES;
			if (is_old) {
				remove_dependents(p_spare.rid);
				rd.free_rid(p_spare.rid);
			}
			return is_old;
		});
	}
	std::erase_if(spare_uploads, [](const auto &p_entry) { return p_entry.second.empty(); });
}

CommandList &GodotDevice::begin_commands() {
	GNOMON_ASSERT(!is_recording, "commands are being recorded already");
	wait_idle();
	is_recording = true;
	++submission;
	if (is_any_timed) {
		read_timestamps();
	}
	spans.clear();
	is_not_abandoned = std::make_shared<bool>(true);
	flush_uploads();
	if (is_compiling_only) {
		return compile_list;
	}
	return *this;
}

void GodotDevice::read_timestamps() {
	std::string name;
	uint64_t start_ns = 0;
	const int64_t count = rd.get_captured_timestamps_count();
	for (int64_t index = 0; index < count; ++index) {
		const auto time_ns = static_cast<uint64_t>(rd.get_captured_timestamp_gpu_time(index));
		if (!name.empty()) {
			timed_ms[name] = double(time_ns - start_ns) * 1e-6;
		}
		name = rd.get_captured_timestamp_name(index).to_utf8();
		name = name.starts_with(TIMED_SPAN_PREFIX) ? name.substr(TIMED_SPAN_PREFIX.size()) : "";
		start_ns = time_ns;
	}
}

void GodotDevice::compile_only(std::optional<uint32_t> p_count) {
	is_compiling_only = p_count.has_value();
	compile_list.set_limit(p_count.value_or(0));
}

void GodotDevice::submit_commands(SubmitMode p_mode) {
	GNOMON_ASSERT(is_recording, "no commands are being recorded");
	end_compute_list();
	if (is_span_timed) {
		rd.capture_timestamp("");
		is_span_timed = false;
	}
	is_recording = false;
	if (kind == Kind::LOCAL) {
		rd.submit();
		is_submitted = true;
	}
	// Godot may have freed some of these objects with the resources that they use.
	prune(uniform_sets,
			[](const RD &p_rd, godot::RID p_rid) { return p_rd.uniform_set_is_valid(p_rid); });
	prune(framebuffers,
			[](const RD &p_rd, godot::RID p_rid) { return p_rd.framebuffer_is_valid(p_rid); });
	prune(vertex_arrays, [](const RD &, godot::RID) { return true; });
	prune(index_arrays, [](const RD &, godot::RID) { return true; });
	prune_spare_uploads();
	if (p_mode == SubmitMode::WAIT) {
		wait_idle();
	}
	if (is_compiling_only) {
		throw NothingExecuted();
	}
}

void GodotDevice::abandon_commands() {
	if (!is_recording) {
		return;
	}
	if (draw_list >= 0) {
		end_rendering();
	}
	*is_not_abandoned = false;
	read_backs.clear();
	is_compiling_only = false;
	submit_commands(SubmitMode::QUEUE);
}

void GodotDevice::wait_idle() {
	if (is_submitted) {
		is_submitted = false;
		rd.sync();
	}
	if (!is_recording) { // what is being recorded has not ended
		call_read_backs();
	}
}

} // namespace gnomon
