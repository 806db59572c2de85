// Reads the environment variables of a device.

#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

#include <charconv>
#include <cstdlib>
#include <optional>

namespace gnomon {

namespace {

constexpr double MAX_WAIT_S = 86400; // a day
constexpr double GPU_WAIT_S = 60;	 // drivers reset a device that hangs after 2 to 10 s
// Software is a hundred times slower than a GPU, but ten times the limit is enough, because a pass
// takes far less than GPU_WAIT_S on a GPU.
constexpr double CPU_WAIT_S = 600;
constexpr double MAX_BUDGET_MIB = 1 << 24; // 16 TiB

/// Reads a number in 0..p_max from an environment variable. Returns nothing if the variable is
/// absent or empty; any other value is an Error, in which p_zero states the meaning of 0.
std::optional<double> read_number(
		const char *p_name, double p_max, const char *p_unit, const char *p_zero) {
	const char *value = std::getenv(p_name);
	if (value == nullptr || *value == 0) {
		return std::nullopt;
	}
	const std::string_view written(value);
	double number = 0;
	const auto result = std::from_chars(written.begin(), written.end(), number);
	if (result.ec != std::errc() || result.ptr != written.end() || !(number >= 0) ||
			number > p_max) {
		fail(p_name, " is \"", written, "\", must be 0..", p_max, " ", p_unit, " (0 = ", p_zero,
				"). Change it, or unset it.");
	}
	return number;
}

} // namespace

void VulkanDevice::read_environment() {
	const auto budget_mib = read_number(
			"GNOMON_MEMORY_BUDGET_MIB", MAX_BUDGET_MIB, "MiB", "what the device reports");
	if (options.memory_budget_bytes == 0 && budget_mib) {
		options.memory_budget_bytes = static_cast<uint64_t>(*budget_mib * (1 << 20));
	}
	const auto wait_s =
			read_number("GNOMON_DEVICE_TIMEOUT_S", MAX_WAIT_S, "seconds", "wait for ever");
	wait_limit_s = options.wait_limit_s.value_or(
			wait_s.value_or(physical.info.type == "CPU" ? CPU_WAIT_S : GPU_WAIT_S));
	const char *pattern = std::getenv("GNOMON_MEMORY_PATTERN");
	memory_pattern = parse_memory_pattern(pattern ? pattern : "");
	const char *fault = std::getenv("GNOMON_INJECT_FAULT");
	injected_fault = parse_injected_fault(fault ? fault : "");
}

} // namespace gnomon
