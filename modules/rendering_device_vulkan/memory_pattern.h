#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace gnomon {

/// What new buffers contain before anything is written to them, for tests: a pass that reads what
/// no pass wrote then shows. ONE: words of 1, which as the next item of a list is a cycle.
/// NAN_FLOAT: words that are NaN as floats and the largest index as integers. RANDOM: different
/// words, the same in each run.
enum class MemoryPattern { ONE, DEADBEEF, NAN_FLOAT, RANDOM };

/// Parses $GNOMON_MEMORY_PATTERN: "1", "deadbeef", "nan" or "random"; empty: nothing. Another value
/// is an Error that lists these.
std::optional<MemoryPattern> parse_memory_pattern(const std::string &p_written);

/// Fills memory. r_random: state of RANDOM, changed by each call.
void fill_memory(std::span<uint8_t> r_bytes, MemoryPattern p_pattern, uint32_t &r_random);

} // namespace gnomon
