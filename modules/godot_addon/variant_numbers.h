#pragma once

#include <godot_api.gen.h>

#include <vector>

namespace gnomon {

/// Returns the numbers in a Variant: of a number, vector, colour, matrix (by columns) or packed
/// array of these. Empty: it has none.
std::vector<double> to_numbers(const godot::Variant &p_value);

} // namespace gnomon
