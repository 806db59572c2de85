#pragma once

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/rendering_device/command_list.h"
#include "modules/rendering_device/tests/testing.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace gnomon {

/// Catches log lines, so that expected errors do not clutter the output.
struct CaughtLog {
	std::vector<std::string> lines;
	LogSink before;
	CaughtLog() {
		before = set_log_sink(
				[this](LogLevel, const std::string &p_line) { lines.push_back(p_line); });
	}
	~CaughtLog() { set_log_sink(before); }
	CaughtLog(const CaughtLog &) = delete;
	CaughtLog &operator=(const CaughtLog &) = delete;
	size_t count(const std::string &p_part) const {
		size_t found = 0;
		for (const std::string &line : lines) {
			found += line.find(p_part) != std::string::npos;
		}
		return found;
	}
};

/// A device with validation layers, and helpers to create buffers and read results.
struct DeviceFixture {
	TemporaryCache cache;
	std::unique_ptr<RenderingDevice> device;

	explicit DeviceFixture(DeviceOptions p_options = {}, const FeatureList &p_denied = {}) {
		p_options.validation = wants_validation();
		p_options.denied_features = p_denied;
		device = create_rendering_device(p_options);
	}

	template <typename T>
	OwnedBuffer make_buffer(const std::string &p_name, const std::vector<T> &p_values,
			BufferUsage p_usage = BufferUsage::STORAGE, Format p_texel_format = Format::R32_UINT) {
		const auto bytes = bytes_of(std::span<const T>(p_values));
		return OwnedBuffer(*device,
				device->create_buffer_with_data({ .name = p_name,
														.size_bytes = bytes.size(),
														.usage = p_usage,
														.texel_format = p_texel_format },
						bytes));
	}

	OwnedBuffer make_readback(uint64_t p_size_bytes) {
		return OwnedBuffer(*device,
				device->create_buffer({ .name = "readback",
						.size_bytes = p_size_bytes,
						.usage = BufferUsage::COPY_TARGET,
						.memory = MemoryKind::READBACK }));
	}

	template <typename T> std::vector<T> read(const OwnedBuffer &p_readback, size_t p_count) {
		std::vector<T> values(p_count);
		std::memcpy(values.data(), device->get_mapped(p_readback.get()), p_count * sizeof(T));
		return values;
	}

	/// Reads a layer of a texture. p_before: its last access; a texture that was created with data
	/// and not used yet is in SHADER_READ_FRAGMENT.
	template <typename T>
	std::vector<T> read_texture(TextureRID p_texture, Access p_before, uint32_t p_layer = 0) {
		const TextureDesc desc = device->get_desc(p_texture);
		const uint64_t bytes =
				uint64_t(desc.size_px.x) * desc.size_px.y * get_texel_size_bytes(desc.format);
		const OwnedBuffer readback = make_readback(bytes);
		CommandList &commands = device->begin_commands();
		const Barrier barrier = {
			.texture = p_texture, .before = p_before, .after = Access::COPY_READ
		};
		commands.barriers({ &barrier, 1 });
		commands.copy_texture_to_buffer(p_texture, readback.get(), p_layer);
		device->submit_commands(RenderingDevice::SubmitMode::WAIT);
		return read<T>(readback, bytes / sizeof(T));
	}
};

/// Returns the message of the Error that the call throws; empty if it throws none.
template <typename Call> std::string catch_error(const Call &p_call) {
	try {
		p_call();
	} catch (const Error &error) {
		return error.what();
	}
	return "";
}

inline bool contains(const std::string &p_text, const std::string &p_part) {
	return p_text.find(p_part) != std::string::npos;
}

} // namespace gnomon
