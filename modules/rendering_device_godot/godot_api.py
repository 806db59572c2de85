"""Writes C++ bindings for what is used of Godot, from the description that a Godot gives of itself.

`godot --headless --dump-extension-api --dump-gdextension-interface` writes extension_api.json and
gdextension_interface.h. USED names classes, their methods and enums; a name that this Godot does not have is an error
that says which. Methods become members of a class of the same name in gnomon::godot, with Godot's names.
"""

import json

USED = {
    "RefCounted": {"methods": "init_ref reference unreference"},
    "RDTextureFormat": {
        "methods": """set_format get_format set_width get_width set_height get_height set_array_layers set_texture_type
            set_usage_bits get_usage_bits get_array_layers"""
    },
    "RDTextureView": {"methods": ""},
    "RDUniform": {"methods": "set_uniform_type set_binding add_id"},
    "RDShaderSPIRV": {"methods": "set_stage_bytecode"},
    "RDSamplerState": {"methods": "set_mag_filter set_min_filter set_repeat_u set_repeat_v set_repeat_w"},
    "RDVertexAttribute": {"methods": "set_binding set_location set_offset set_format set_stride"},
    "RDPipelineRasterizationState": {
        "methods": """set_enable_depth_clamp set_cull_mode set_front_face set_depth_bias_enabled
            set_depth_bias_constant_factor set_depth_bias_slope_factor"""
    },
    "RDPipelineMultisampleState": {"methods": ""},
    "RDPipelineDepthStencilState": {
        "methods": """set_enable_depth_test set_enable_depth_write set_depth_compare_operator set_enable_stencil
            set_front_op_fail set_front_op_pass set_front_op_depth_fail set_front_op_compare set_front_op_compare_mask
            set_front_op_write_mask set_front_op_reference set_back_op_fail set_back_op_pass set_back_op_depth_fail
            set_back_op_compare set_back_op_compare_mask set_back_op_write_mask set_back_op_reference"""
    },
    "RDPipelineColorBlendState": {"methods": "set_attachments"},
    "RDPipelineColorBlendStateAttachment": {
        "methods": """set_enable_blend set_src_color_blend_factor set_dst_color_blend_factor set_color_blend_op
            set_src_alpha_blend_factor set_dst_alpha_blend_factor set_alpha_blend_op"""
    },
    "RDPipelineSpecializationConstant": {"methods": "set_value set_constant_id"},
    "RenderingDevice": {
        "methods": """
            texture_create texture_create_shared_from_slice texture_update texture_get_data texture_get_data_async
            texture_copy texture_clear texture_get_format texture_is_valid
            framebuffer_create framebuffer_create_empty framebuffer_get_format framebuffer_is_valid
            sampler_create vertex_buffer_create vertex_format_create vertex_array_create index_buffer_create
            index_array_create shader_create_from_spirv uniform_buffer_create storage_buffer_create
            texture_buffer_create uniform_set_create uniform_set_is_valid
            buffer_copy buffer_update buffer_clear buffer_get_data buffer_get_data_async
            render_pipeline_create compute_pipeline_create
            draw_list_begin draw_list_bind_render_pipeline draw_list_bind_uniform_set draw_list_bind_vertex_array
            draw_list_bind_index_array draw_list_set_push_constant draw_list_draw draw_list_draw_indirect
            draw_list_enable_scissor draw_list_disable_scissor draw_list_end
            compute_list_begin compute_list_bind_compute_pipeline compute_list_set_push_constant
            compute_list_bind_uniform_set compute_list_dispatch compute_list_dispatch_indirect compute_list_end
            free_rid capture_timestamp get_captured_timestamps_count get_captured_timestamp_gpu_time
            get_captured_timestamp_name limit_get submit sync set_resource_name
            get_device_vendor_name get_device_name get_memory_usage
        """,
        "enums": """
            TextureType TextureUsageBits SamplerFilter SamplerRepeatMode IndexBufferFormat StorageBufferUsage
            BufferCreationBits UniformType RenderPrimitive PolygonCullMode PolygonFrontFace StencilOperation
            CompareOperator BlendFactor BlendOperation InitialAction DrawFlags MemoryType Limit DataFormat
            TextureSliceType ShaderStage
        """,
    },
    "RenderingServer": {"methods": "get_rendering_device create_local_rendering_device"},
}
BUILT_IN_METHODS = {
    "Array": ("size", "resize", "append"),
    "PackedByteArray": ("size", "resize"),
    "PackedInt64Array": ("size", "resize"),
    "PackedColorArray": ("size", "resize"),
}
# Godot's float and int members as they are passed; Vector and Color types have the layout of glm's.
VALUES = {
    "int": "int64_t",
    "float": "double",
    "bool": "bool",
    "RID": "RID",
    "Vector2": "glm::vec2",
    "Vector2i": "glm::ivec2",
    "Vector3": "glm::vec3",
    "Color": "glm::vec4",
    "Rect2": "Rect2",
    "Transform3D": "Transform3D",
    "Projection": "glm::mat4",
    "AABB": "AABB",
}
OPAQUE = ("String", "StringName", "Array", "PackedByteArray", "PackedInt64Array", "PackedColorArray", "Callable", "Variant")
HEADER = """// Generated by modules/rendering_device_godot/godot_api.py from extension_api.json of %s.
#pragma once

#include "modules/rendering_device_godot/godot_object.h"

namespace gnomon::godot {

"""


class Api:
    def __init__(self, path, used):
        with open(path, encoding="utf-8") as file:
            description = json.load(file)
        self.version = description["header"]["version_full_name"]
        self.classes = {item["name"]: item for item in description["classes"]}
        self.built_in = {item["name"]: item for item in description["builtin_classes"]}
        self.used = used

    def find(self, items, name, owner):
        for item in items:
            if item["name"] == name:
                return item
        raise SystemExit("ERROR: %s has no %s.%s, which the add-on uses." % (self.version, owner, name))

    def get_type(self, name, is_argument):
        """C++ type of a parameter or result."""
        if name in VALUES:
            return VALUES[name]
        if name.startswith(("enum::", "bitfield::")):
            return "int64_t"
        if name.startswith("typedarray::"):
            name = "Array"
        if name in OPAQUE:
            return "const %s &" % name if is_argument else name
        if name in self.classes:
            base = name if name in self.used else "Object"
            is_counted = self.is_counted(name)
            if is_argument:
                return "const %s &" % base
            return "Ref<%s>" % base if is_counted else base
        raise SystemExit("ERROR: no binding for values of the type %s." % name)

    def is_counted(self, name):
        while name:
            if name == "RefCounted":
                return True
            name = self.classes[name].get("inherits")
        return False

    def write_class(self, name):
        wanted = self.used[name]
        described = self.find(self.classes.values(), name, "classes")
        lines = ["/// %s; see Godot's documentation." % name, "class %s : public Object {" % name, "public:"]
        lines.append("\tusing Object::Object;")
        lines.append('\tstatic constexpr const char *CLASS_NAME = "%s";' % name)
        for enum in wanted.get("enums", "").split():
            values = self.find(described["enums"], enum, name)["values"]
            lines.append("\tenum %s : int64_t {" % enum)
            lines += ["\t\t%s = %d," % (value["name"], value["value"]) for value in values]
            lines.append("\t};")
        for method_name in wanted["methods"].split():
            method = self.find(described.get("methods", []), method_name, name)
            arguments = [(self.get_type(a["type"], True), a["name"]) for a in method.get("arguments", [])]
            result = method.get("return_value")
            result_type = self.get_type(result["type"], False) if result else "void"
            parameters = ", ".join("%s%sp_%s" % (kind, "" if kind.endswith("&") else " ", arg) for kind, arg in arguments)
            values = "".join(", p_" + arg for _kind, arg in arguments)
            lines.append("\t%s %s(%s) const {" % (result_type, method_name, parameters))
            lines.append('\t\tstatic const MethodBind bind("%s", "%s", %d);' % (name, method_name, method["hash"]))
            lines.append("\t\treturn bind.call<%s>(owner%s);" % (result_type, values))
            lines.append("\t}")
        return lines + ["};", ""]

    def write_built_in(self):
        lines = []
        for name, methods in BUILT_IN_METHODS.items():
            for method_name in methods:
                method = self.find(self.built_in[name]["methods"], method_name, name)
                lines.append(
                    "inline constexpr int64_t HASH_%s_%s = %d;" % (name.upper(), method_name.upper(), method["hash"])
                )
        return lines + [""]


def write_bindings(api_path, target, used):
    """Writes the header `target` with the classes of `used`, in its order."""
    api = Api(api_path, used)
    lines = []
    for name in used:
        lines += api.write_class(name)
    with open(target, "w", encoding="utf-8") as file:
        file.write(HEADER % api.version + "\n".join(lines) + "\n} // namespace gnomon::godot\n")


def write_hashes(api_path, target):
    """Writes the header `target` with the hashes of methods of built-in types."""
    lines = ["// Generated by modules/rendering_device_godot/godot_api.py.", "#pragma once", "", "#include <cstdint>", ""]
    lines += ["namespace gnomon::godot {", ""] + Api(api_path, USED).write_built_in() + ["} // namespace gnomon::godot", ""]
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(lines))
