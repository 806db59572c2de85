#pragma once

#include "modules/godot_addon/shader_text.h"

#include <glm/glm.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// Which pixels a shader keeps: those in which one channel of a texture is at least a threshold.
struct ShaderAlpha {
	std::string sampler;	  // name of the uniform; empty: all pixels have the value 1
	int channel = 3;		  // 0 to 3: red, green, blue, alpha
	bool is_inverted = false; // the channel is subtracted from 1
	float threshold = 0.5f;	  // of the channel, or of the inverted channel; may be outside of 0..1
	glm::mat3x2 uv_from_mesh_uv = glm::mat3x2(1.0f);
};

/// Returns the value of a uniform: 1 to 4 numbers; empty: it is not known, or is no number.
using UniformLookup = std::function<std::vector<double>(const std::string &p_name)>;

/// Reads the alpha test of a shader by following how fragment() computes ALPHA and
/// ALPHA_SCISSOR_THRESHOLD, or the condition of a discard: sums and products with constants and
/// uniforms of texture samples, at coordinates that are UV, scaled and offset (also in vertex()).
/// Empty: it is none of these forms. p_default_threshold: if the shader sets none (alpha hash,
/// depth prepass).
std::optional<ShaderAlpha> read_shader_alpha(
		const ShaderText &p_shader, const UniformLookup &p_uniforms, float p_default_threshold);

} // namespace gnomon
