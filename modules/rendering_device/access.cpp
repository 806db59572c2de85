#include "modules/rendering_device/resource_types.h"

namespace gnomon {

bool is_write(Access p_access) {
	switch (p_access) {
		case Access::SHADER_WRITE_FRAGMENT:
		case Access::SHADER_WRITE_COMPUTE:
		case Access::COLOR_WRITE:
		case Access::DEPTH_WRITE:
		case Access::COPY_WRITE:
		case Access::HOST_WRITE:
			return true;
		default:
			return false;
	}
}

} // namespace gnomon
