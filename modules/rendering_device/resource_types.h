#pragma once

#include <glm/glm.hpp>

#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// Handle of a resource of the RenderingDevice; an id of 0 is null. Each kind of resource has its
/// own handle type.
template <typename Tag> struct RID {
	uint64_t id = 0;
	explicit operator bool() const { return id != 0; }
	bool operator==(const RID &) const = default;
};
using BufferRID = RID<struct BufferTag>;
using TextureRID = RID<struct TextureTag>;
using SamplerRID = RID<struct SamplerTag>;
using PipelineRID = RID<struct PipelineTag>;
using MemoryRID = RID<struct MemoryTag>;

enum class Format {
	R8_UNORM,
	R16_SFLOAT,
	R32_SFLOAT,
	R32_UINT,
	RG16_SFLOAT,
	RG32_UINT,
	RG32_SFLOAT,
	RGBA8_UNORM,
	RGBA8_SRGB,
	BGRA8_UNORM, // for window images
	RGBA16_SFLOAT,
	RGBA32_SFLOAT,
	RGBA32_UINT,
	D32_SFLOAT,
	D32_SFLOAT_S8_UINT, // attachment; shaders can read its depth; not copied
};
uint32_t get_texel_size_bytes(Format p_format);
const char *get_format_name(Format p_format);
bool is_depth_format(Format p_format);
bool has_stencil(Format p_format);
/// Returns whether the format is one of the integer formats that can be render targets (not
/// RGBA32_UINT). Blending has no effect on them.
bool is_uint_format(Format p_format);

/// How a resource may be used; bits are combined with |.
enum class TextureUsage : uint32_t {
	SAMPLED = 1,
	STORAGE = 2,
	COLOR_ATTACHMENT = 4,
	DEPTH_ATTACHMENT = 8,
	COPY_SOURCE = 16,
	COPY_TARGET = 32,
};
enum class BufferUsage : uint32_t {
	VERTEX = 1,
	INDEX = 2,
	UNIFORM = 4,
	STORAGE = 8,
	INDIRECT = 16,
	COPY_SOURCE = 32,
	COPY_TARGET = 64,
	/// Uniform texel buffer of the format BufferDesc::texel_format. May be combined with STORAGE
	/// only if the device has DeviceFeatures::storage_and_texel_buffers.
	TEXEL = 128,
	CONDITIONAL = 256, // read by CommandList::begin_conditional
};
template <typename T>
concept UsageFlags = std::is_same_v<T, TextureUsage> || std::is_same_v<T, BufferUsage>;
template <UsageFlags T> constexpr T operator|(T p_left, T p_right) {
	return static_cast<T>(static_cast<uint32_t>(p_left) | static_cast<uint32_t>(p_right));
}
template <UsageFlags T> constexpr bool has_usage(T p_flags, T p_flag) {
	return (static_cast<uint32_t>(p_flags) & static_cast<uint32_t>(p_flag)) != 0;
}

/// Returns the names of the usage bits, "SAMPLED | STORAGE", for error messages.
std::string describe_usage(TextureUsage p_usage);

/// GPU: fastest for the GPU, not mapped. UPLOAD: mapped, written by the CPU. READBACK: mapped, read
/// by the CPU.
enum class MemoryKind { GPU, UPLOAD, READBACK };

struct TextureDesc {
	std::string name; // shown in errors, leaks and debuggers
	Format format = Format::RGBA8_UNORM;
	glm::uvec2 size_px = glm::uvec2(1);
	uint32_t layer_count = 1; // above 1 only for arrays
	TextureUsage usage = TextureUsage::SAMPLED;
	/// Shaders declare the texture as a 2D array, even if it has one layer. A Binding of a single
	/// layer is a 2D texture.
	bool is_array = false;
	/// Mip levels, each half as large as the one before, at least one texel. Above 1 only for
	/// single-layer textures that are created with data, which contains all levels in order.
	uint32_t mip_count = 1;
	bool operator==(const TextureDesc &) const = default;
};
/// Size of a mip level: half that of the level before, at least 1.
glm::uvec2 compute_mip_size(glm::uvec2 p_size_px, uint32_t p_level);
/// Bytes of one layer with all its mip levels, tightly packed.
uint64_t compute_layer_bytes(const TextureDesc &p_desc);

struct BufferDesc {
	std::string name;
	uint64_t size_bytes = 0;
	BufferUsage usage = BufferUsage::STORAGE;
	MemoryKind memory = MemoryKind::GPU;
	Format texel_format = Format::R32_UINT; // with BufferUsage::TEXEL
	bool operator==(const BufferDesc &) const = default;
};

enum class Filter { NEAREST, LINEAR };
/// Texture addressing outside 0..1: clamp to the edge texels, repeat, or repeat mirrored.
enum class AddressMode { CLAMP, REPEAT, MIRROR };
/// How mip levels are sampled: only the first, the nearest, or two of them blended.
enum class MipMode { NONE, NEAREST, LINEAR };
struct SamplerDesc {
	std::string name;
	Filter mag_filter = Filter::NEAREST;
	Filter min_filter = Filter::NEAREST;
	MipMode mip_mode = MipMode::NONE;
	AddressMode address_u = AddressMode::CLAMP;
	AddressMode address_v = AddressMode::CLAMP;
};

/// The resource for one binding of descriptor set 0. The descriptor type follows from the shader's
/// SPIR-V.
struct Binding {
	uint32_t binding = 0;
	BufferRID buffer;
	TextureRID texture;
	SamplerRID sampler;			 // with a texture: for a combined image sampler
	uint32_t layer = ALL_LAYERS; // layer of the texture

	static constexpr uint32_t ALL_LAYERS = ~0u;
	Binding(uint32_t p_binding, BufferRID p_buffer) : binding(p_binding), buffer(p_buffer) {}
	Binding(uint32_t p_binding, TextureRID p_texture, SamplerRID p_sampler = {}) :
			binding(p_binding), texture(p_texture), sampler(p_sampler) {}
	Binding(uint32_t p_binding, SamplerRID p_sampler) : binding(p_binding), sampler(p_sampler) {}
};

enum class CompareOp { NEVER, LESS, EQUAL, LESS_EQUAL, GREATER, NOT_EQUAL, GREATER_EQUAL, ALWAYS };
/// Stencil operations, in Vulkan's order. WRAP: 255 + 1 is 0.
enum class StencilOp {
	KEEP,
	ZERO,
	REPLACE,
	INCREMENT_CLAMP,
	DECREMENT_CLAMP,
	INVERT,
	INCREMENT_WRAP,
	DECREMENT_WRAP
};
/// Stencil state of front or back faces.
struct StencilFace {
	/// Compares StencilTest::reference with the stored value.
	CompareOp compare = CompareOp::ALWAYS;
	StencilOp fail = StencilOp::KEEP;
	StencilOp depth_fail = StencilOp::KEEP;
	StencilOp pass = StencilOp::KEEP;
	auto operator<=>(const StencilFace &) const = default;
};
struct StencilTest {
	StencilFace front;
	StencilFace back;
	uint32_t reference = 0; // for comparisons and StencilOp::REPLACE, 0..255
	auto operator<=>(const StencilTest &) const = default;
};
/// In Vulkan's order.
enum class CullMode { NONE, FRONT, BACK };
/// NORMAL: the corners of front faces are counter-clockwise in the image that is drawn. MIRRORED:
/// they are clockwise, for instances with a mirrored transform.
enum class Winding { NORMAL, MIRRORED };
enum class Topology { TRIANGLES, TRIANGLES_WITH_ADJACENCY };
enum class BlendMode { OFF, ALPHA, ADD, MINIMUM, MAXIMUM };

/// A specialization constant. Booleans are 0 or 1; floats are stored as their bits.
struct SpecializationConstant {
	uint32_t constant_id = 0;
	uint32_t value = 0;
	auto operator<=>(const SpecializationConstant &) const = default;
};

/// A name for errors and debuggers. All names compare equal, so that descriptions that differ only
/// in their name share one pipeline.
struct PipelineName : std::string {
	using std::string::string;
	PipelineName(std::string p_name) : std::string(std::move(p_name)) {}
	friend bool operator==(const PipelineName &, const PipelineName &) { return true; }
	friend std::strong_ordering operator<=>(const PipelineName &, const PipelineName &) {
		return std::strong_ordering::equal;
	}
};

struct ComputePipelineDesc {
	PipelineName name;
	std::string shader; // path below shaders/, "shadow_map/resolve.comp"
	std::vector<SpecializationConstant> constants;
	auto operator<=>(const ComputePipelineDesc &) const = default;
};

struct VertexAttribute {
	uint32_t location = 0;
	uint32_t buffer_index =
			0; // into RasterPipelineDesc::vertex_strides_bytes and bind_vertex_buffers
	Format format = Format::R32_SFLOAT;
	uint32_t component_count = 3; // 1..4 components of `format`, R32_SFLOAT or R32_UINT
	uint32_t offset_bytes = 0;
	auto operator<=>(const VertexAttribute &) const = default;
};

struct RasterPipelineDesc {
	PipelineName name;
	std::string vertex_shader;
	std::string geometry_shader;				   // empty = none
	std::string fragment_shader;				   // empty = depth only
	std::vector<SpecializationConstant> constants; // for all stages
	std::vector<VertexAttribute> attributes;
	std::vector<uint32_t> vertex_strides_bytes;
	Topology topology = Topology::TRIANGLES;
	CullMode cull_mode = CullMode::NONE;
	Winding winding = Winding::NORMAL;
	/// Formats of the colour targets. Empty, with has_depth false, for
	/// begin_rendering_without_targets.
	std::vector<Format> color_formats;
	BlendMode blend = BlendMode::OFF; // the same for all colour targets
	bool has_depth = true;			  // a D32_SFLOAT attachment is bound
	bool has_stencil = false;		  // with has_depth: a D32_SFLOAT_S8_UINT one
	StencilTest stencil;
	bool writes_depth = true;
	CompareOp depth_compare = CompareOp::LESS;
	bool clamps_depth = false; // depth clamp instead of near and far clipping
	/// Draws only where the stored depth is within CommandList::set_depth_bounds.
	bool has_depth_bounds = false;
	float depth_bias_constant = 0.0f;
	float depth_bias_slope = 0.0f;
	auto operator<=>(const RasterPipelineDesc &) const = default;
};

/// What happens to an attachment's earlier content when a rendering begins. In Vulkan's order.
enum class LoadOp { KEEP, CLEAR, DISCARD };
struct ColorTarget {
	TextureRID texture;
	LoadOp load = LoadOp::CLEAR;
	glm::vec4 clear = glm::vec4(0.0f); // converted for UINT formats
	uint32_t layer = 0;
};
struct DepthTarget {
	TextureRID texture;
	LoadOp load = LoadOp::CLEAR;
	float clear = 1.0f; // clear depth; a stencil is cleared to 0
	uint32_t layer = 0;
};

/// How a pass uses a resource; the render graph derives barriers and layouts from it.
enum class Access {
	NONE,		 // content not needed
	VERTEX_READ, // vertex, index buffer
	INDIRECT_READ,
	CONDITIONAL_READ,
	SHADER_READ_VERTEX, // vertex and geometry stages
	SHADER_READ_FRAGMENT,
	SHADER_READ_COMPUTE,
	UNIFORM_READ,		   // any stage; uniform and storage buffers
	SHADER_WRITE_FRAGMENT, // storage, read and write
	SHADER_WRITE_COMPUTE,
	COLOR_WRITE,
	DEPTH_WRITE, // test and write
	DEPTH_READ,	 // test only
	COPY_READ,
	COPY_WRITE,
	HOST_READ,
	HOST_WRITE,
	PRESENT,
};
/// Returns whether the access may write.
bool is_write(Access p_access);

/// One barrier on a whole resource, a buffer or a texture.
struct Barrier {
	BufferRID buffer;
	TextureRID texture;
	Access before = Access::NONE; // NONE on a texture: its content is discarded
	Access after = Access::NONE;
	/// With before == NONE, for a texture or buffer that reuses the memory of others: the last
	/// accesses to those.
	std::vector<Access> earlier_users;
};

} // namespace gnomon
