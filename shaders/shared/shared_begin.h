// Opens a header that C++ and GLSL both compile: the same struct, written once. Only float, int,
// uint, vec2, uvec2, vec4, uvec4 and mat4 members; sizes are multiples of 16 (std430 and std140
// agree). Functions of these types begin with SHARED_FUNCTION. Without an include guard, because
// each such header includes it.
#ifdef __cplusplus
#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
namespace gnomon {
namespace shader {
using glm::ivec2;
using glm::mat4;
using glm::min;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec4;
using uint = uint32_t;
#define SHARED_ALIGN alignas(16)
#define SHARED_FUNCTION inline
#define SHARED_SIZE(m_type, m_size) static_assert(sizeof(m_type) == (m_size), #m_type " size")
#define SHARED_OFFSET(m_type, m_member, m_offset)                                                  \
	static_assert(offsetof(m_type, m_member) == (m_offset), #m_type "." #m_member " offset")
#else
#define SHARED_ALIGN
#define SHARED_FUNCTION
#define SHARED_SIZE(m_type, m_size)
#define SHARED_OFFSET(m_type, m_member, m_offset)
#endif
