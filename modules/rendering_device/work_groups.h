#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace gnomon {

/// Work groups that every device dispatches along each axis (Vulkan 1.3, maxComputeWorkGroupCount).
inline constexpr uint32_t MAX_WORK_GROUPS = 65535;

/// Arranges a list of more work groups in rows of equal length, the last of which may have groups
/// too many. Shaders find the group's place in the list with find_work_group of
/// common/work_rows_inc.glsl. Other counts remain as they are.
inline glm::uvec3 arrange_work_groups(glm::uvec3 p_count) {
	if (p_count.x <= MAX_WORK_GROUPS || p_count.y != 1 || p_count.z != 1) {
		return p_count;
	}
	const uint32_t rows = (p_count.x + MAX_WORK_GROUPS - 1) / MAX_WORK_GROUPS;
	return glm::uvec3((p_count.x + rows - 1) / rows, rows, 1);
}

} // namespace gnomon
