#pragma once

#include <span>

namespace gnomon {

/// Returns the embedded TrueType file of the font DejaVu Sans (in typeface/, with its licence). The
/// build generates the definition.
std::span<const unsigned char> get_typeface();

} // namespace gnomon
