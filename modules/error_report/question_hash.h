#pragma once

#include "modules/error_report/mask_source.h"

#include <cstdint>

namespace gnomon {

/// 64 bits that change when anything changes that the mask could depend on: the casters and their
/// places, what scatters, the camera, the light (all lights where the question names none) with all
/// its properties, and the size of the picture.
uint64_t compute_question_hash(const MaskQuestion &p_question);

} // namespace gnomon
