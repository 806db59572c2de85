"""Generates C++ bindings for the part of Godot's API that the add-on uses, from Godot's description of its API.

`godot --headless --dump-extension-api --dump-gdextension-interface` writes extension_api.json and
gdextension_interface.h. USED lists classes with their methods and enums; a name that this Godot lacks is an error that
names it. Methods become members of a class of the same name in gnomon::godot, with Godot's names. Debian has no package of godot-cpp, Godot's own bindings.
"""

import json

USED = {
    "Object": {"methods": "connect disconnect get_class notification notify_property_list_changed"},
    "RefCounted": {"methods": "init_ref reference unreference get_reference_count"},
    "RDTextureFormat": {
        "methods": "set_format set_width set_height set_array_layers set_mipmaps set_texture_type set_usage_bits set_samples"
    },
    "RDTextureView": {"methods": ""},
    "RDUniform": {"methods": "set_uniform_type set_binding add_id"},
    "RDShaderSPIRV": {"methods": "set_stage_bytecode get_stage_bytecode get_stage_compile_error"},
    "RDShaderSource": {"methods": "set_stage_source set_language", "enums": ""},
    "RDSamplerState": {"methods": "set_mag_filter set_min_filter set_mip_filter set_max_lod set_repeat_u set_repeat_v set_repeat_w"},
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
            texture_copy texture_clear texture_is_valid
            framebuffer_create framebuffer_create_empty framebuffer_get_format framebuffer_is_valid
            sampler_create vertex_buffer_create vertex_format_create vertex_array_create index_buffer_create
            index_array_create shader_compile_spirv_from_source shader_create_from_spirv uniform_buffer_create storage_buffer_create
            texture_buffer_create uniform_set_create uniform_set_is_valid
            buffer_copy buffer_update buffer_clear buffer_get_data buffer_get_data_async
            render_pipeline_create compute_pipeline_create
            draw_list_begin draw_list_bind_render_pipeline draw_list_bind_uniform_set draw_list_bind_vertex_array
            draw_list_bind_index_array draw_list_set_push_constant draw_list_draw draw_list_draw_indirect
            draw_list_enable_scissor draw_list_end
            compute_list_begin compute_list_bind_compute_pipeline compute_list_set_push_constant
            compute_list_bind_uniform_set compute_list_dispatch compute_list_dispatch_indirect compute_list_end
            free_rid limit_get submit sync set_resource_name
            get_device_vendor_name get_device_name get_memory_usage
            capture_timestamp get_captured_timestamps_count get_captured_timestamp_gpu_time get_captured_timestamp_name
        """,
        "enums": """
            TextureType TextureUsageBits TextureSamples SamplerFilter SamplerRepeatMode IndexBufferFormat StorageBufferUsage
            BufferCreationBits UniformType RenderPrimitive PolygonCullMode PolygonFrontFace StencilOperation
            CompareOperator BlendFactor BlendOperation DrawFlags MemoryType Limit DataFormat DeviceType
            TextureSliceType ShaderStage ShaderLanguage
        """,
    },
    "RenderingServer": {
        "methods": """
            get_rendering_device create_local_rendering_device get_current_rendering_method call_on_render_thread
            get_current_rendering_driver_name get_video_adapter_type
            compositor_effect_create compositor_effect_set_callback compositor_effect_set_flag
            compositor_effect_set_enabled compositor_create compositor_set_compositor_effects scenario_set_compositor
            shader_create shader_get_code shader_set_code get_shader_parameter_list shader_get_parameter_default
            shader_get_default_texture_parameter shader_set_default_texture_parameter material_create material_set_shader
            mesh_surface_get_material mesh_surface_set_material mesh_surface_get_arrays mesh_get_surface_count
            material_get_param texture_2d_get texture_get_rd_texture
            canvas_create canvas_item_create canvas_item_set_parent canvas_item_set_material canvas_item_add_rect
            viewport_create viewport_set_size viewport_set_disable_3d viewport_attach_canvas viewport_set_update_mode
            viewport_set_active viewport_get_texture
            global_shader_parameter_add global_shader_parameter_remove global_shader_parameter_set
            texture_2d_create texture_rd_create
            directional_light_create omni_light_create spot_light_create light_set_color light_set_param
            light_set_shadow light_set_projector light_set_negative light_set_cull_mask light_set_distance_fade
            light_set_reverse_cull_face_mode light_set_shadow_caster_mask light_set_bake_mode
            light_omni_set_shadow_mode light_directional_set_shadow_mode light_directional_set_blend_splits
            light_directional_set_sky_mode instance_create2 instance_set_layer_mask instance_set_transform
            instance_set_visible
            instances_cull_aabb multimesh_get_aabb multimesh_instance_get_transform multimesh_get_buffer mesh_get_surface
            skeleton_get_bone_count skeleton_bone_get_transform free_rid
        """,
        "enums": """CompositorEffectFlags CompositorEffectCallbackType GlobalShaderParameterType
            TextureLayeredType ViewportUpdateMode""",
    },
    "RenderData": {"methods": "get_render_scene_buffers get_render_scene_data"},
    "RenderSceneBuffers": {"methods": ""},
    "RenderSceneBuffersRD": {"methods": "get_depth_texture get_color_texture get_internal_size get_texture_samples get_view_count"},
    "RenderSceneData": {"methods": "get_cam_transform get_cam_projection get_view_count"},
    "Engine": {
        "methods": """is_editor_hint get_frames_drawn get_physics_frames get_physics_ticks_per_second get_max_physics_steps_per_frame
            get_time_scale get_main_loop register_singleton unregister_singleton"""
    },
    "Time": {"methods": "get_ticks_usec"},
    "MainLoop": {"methods": ""},
    "Node": {
        "methods": """get_parent get_path is_inside_tree get_tree update_configuration_warnings find_children
            get_node_or_null get_name get_process_delta_time add_to_group remove_from_group is_physics_interpolated_and_enabled"""
    },
    "SceneTree": {"methods": "get_root get_nodes_in_group"},
    "Node3D": {
        "methods": """get_global_transform get_global_transform_interpolated is_visible_in_tree get_world_3d
            get_visibility_parent"""
    },
    "VisualInstance3D": {"methods": "get_layer_mask get_aabb get_instance get_base"},
    "ReflectionProbe": {"methods": ""},
    "VoxelGI": {"methods": ""},
    "GeometryInstance3D": {
        "methods": """get_cast_shadows_setting get_material_override get_material_overlay get_lod_bias get_custom_aabb get_extra_cull_margin
            get_transparency get_instance_shader_parameter get_visibility_range_begin get_visibility_range_end get_visibility_range_begin_margin
            get_visibility_range_end_margin get_visibility_range_fade_mode""",
        "enums": "ShadowCastingSetting VisibilityRangeFadeMode",
    },
    "MeshInstance3D": {
        "methods": "get_mesh get_active_material get_skin_reference get_blend_shape_count get_blend_shape_value"
    },
    "SoftBody3D": {"methods": ""},
    "MultiMeshInstance3D": {"methods": "get_multimesh"},
    "CSGShape3D": {"methods": "get_meshes is_root_shape"},
    "GridMap": {"methods": "get_meshes get_used_cells get_cell_item get_mesh_library"},
    "MeshLibrary": {"methods": "get_item_mesh get_item_mesh_cast_shadow"},
    "SpriteBase3D": {"methods": "get_draw_flag get_alpha_cut_mode", "enums": "DrawFlags AlphaCutMode"},
    "Label3D": {"methods": "get_draw_flag get_alpha_cut_mode", "enums": "DrawFlags AlphaCutMode"},
    "GPUParticles3D": {"methods": "get_draw_passes get_draw_pass_mesh get_visibility_aabb"},
    "CPUParticles3D": {"methods": "get_mesh get_visibility_aabb"},
    "Light3D": {
        "methods": """get_param get_shadow_caster_mask is_editor_only has_shadow get_color get_correlated_color is_negative
            get_shadow_reverse_cull_face is_distance_fade_enabled get_distance_fade_begin get_distance_fade_shadow
            get_distance_fade_length get_cull_mask get_bake_mode get_projector""",
        "enums": "Param",
    },
    "OmniLight3D": {"methods": "get_shadow_mode"},
    "SpotLight3D": {"methods": ""},
    "DirectionalLight3D": {"methods": "get_shadow_mode get_sky_mode is_blend_splits_enabled"},
    "Viewport": {
        "methods": "get_camera_3d get_mesh_lod_threshold get_msaa_3d get_scaling_3d_scale get_texture get_render_info find_world_3d",
        "enums": "RenderInfo RenderInfoType",
    },
    "Window": {"methods": "get_size get_content_scale_mode", "enums": "ContentScaleMode"},
    "Texture2D": {"methods": "get_width get_height get_image"},
    "ViewportTexture": {"methods": ""},
    "Texture": {"methods": ""},
    "Environment": {"methods": "is_volumetric_fog_enabled is_sdfgi_enabled"},
    "ProjectSettings": {"methods": "has_setting get_setting_with_override"},
    "Camera3D": {
        "methods": "get_compositor get_environment get_projection get_camera_transform get_camera_projection get_fov get_keep_aspect_mode",
        "enums": "ProjectionType KeepAspect",
    },
    "WorldEnvironment": {"methods": "get_compositor"},
    "Resource": {"methods": "get_rid get_path get_name duplicate"},
    "Compositor": {"methods": "get_compositor_effects"},
    "World3D": {"methods": "get_scenario get_environment"},
    "SkinReference": {"methods": "get_skeleton"},
    "Mesh": {
        "methods": "get_surface_count surface_get_arrays surface_get_blend_shape_arrays surface_get_material",
        "enums": "ArrayType PrimitiveType BlendShapeMode",
    },
    "ArrayMesh": {"methods": "surface_get_primitive_type get_blend_shape_mode"},
    "PrimitiveMesh": {"methods": ""},
    "MultiMesh": {
        "methods": """get_mesh get_instance_count get_visible_instance_count get_transform_format is_using_colors
            is_using_custom_data""",
        "enums": "TransformFormat",
    },
    "Material": {"methods": "get_next_pass inspect_native_shader_code"},
    "BaseMaterial3D": {
        "methods": """get_transparency get_depth_draw_mode get_flag get_blend_mode get_texture get_albedo
            get_alpha_scissor_threshold get_uv1_scale get_uv1_offset get_texture_filter get_billboard_mode
            is_grow_enabled get_grow get_cull_mode""",
        "enums": "CullMode BillboardMode Transparency DepthDrawMode Flags BlendMode TextureParam TextureFilter",
    },
    "ShaderMaterial": {"methods": "get_shader get_shader_parameter"},
    "Shader": {"methods": "get_default_texture_parameter"},
    "Image": {
        "methods": "create_from_data get_width get_height is_empty is_compressed decompress convert get_data",
        "enums": "Format",
    },
}
# Methods of built-in types, which godot_interface.cpp looks up by name and hash.
BUILT_IN_METHODS = {
    "Array": ("append", "size"),
    "PackedByteArray": ("size", "resize"),
    "PackedInt32Array": ("size", "resize"),
    "PackedInt64Array": ("size", "resize"),
    "PackedFloat32Array": ("size", "resize"),
    "PackedVector2Array": ("size", "resize"),
    "PackedVector3Array": ("size", "resize"),
    "PackedColorArray": ("size", "resize"),
    "PackedStringArray": ("append",),
}
# C++ types of the values that Godot passes; vectors and colours have the layout of glm types.
VALUES = {
    "int": "int64_t",
    "float": "double",
    "bool": "bool",
    "RID": "RID",
    "Vector2i": "glm::ivec2",
    "Vector3i": "glm::ivec3",
    "Vector3": "glm::vec3",
    "Color": "glm::vec4",
    "Rect2": "Rect2",
    "AABB": "AABB",
    "Transform3D": "Transform3D",
    "Projection": "glm::mat4",
}
# Built-in types whose contents Godot allocates. godot_values.h wraps them, and they are passed by reference.
OPAQUE = (
    *("String", "StringName", "NodePath", "Variant", "Callable", "Array", "Dictionary"),
    *("PackedByteArray", "PackedInt64Array", "PackedFloat32Array", "PackedColorArray"),
)
HEADER = """// Generated by modules/rendering_device_godot/godot_api.py from extension_api.json of %s.
#pragma once

#include "modules/rendering_device_godot/godot_object.h"

namespace gnomon::godot {

"""


class Api:
    """Godot's API. `used` maps the classes to bind to their methods and enums, as USED does."""

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
        raise SystemExit(
            "ERROR: %s has no %s.%s, which the add-on uses. Set $GODOT to another version."
            % (self.version, owner, name)
        )

    def get_type(self, name, is_argument):
        """Returns the C++ type of a parameter or result."""
        if name in VALUES:
            return VALUES[name]
        if name.startswith(("enum::", "bitfield::")):
            return "int64_t"
        if name.startswith("typedarray::"):
            name = "Array"
        if name in OPAQUE:
            return "const %s &" % name if is_argument else name
        if name in self.classes:
            base = name if name in self.used else "ObjectHandle"
            is_counted = self.is_counted(name)
            if is_argument:
                return "const %s &" % base
            return "Ref<%s>" % base if is_counted else base
        raise SystemExit(
            "ERROR: no binding for values of the type %s. Add it to VALUES or OPAQUE in this script."
            % name
        )

    def is_counted(self, name):
        """Returns whether the class derives from RefCounted."""
        while name:
            if name == "RefCounted":
                return True
            name = self.classes[name].get("inherits")
        return False

    def find_base(self, name):
        """Returns the nearest base class that is in `used`, or ObjectHandle, the base of all bound classes."""
        base = self.classes[name].get("inherits")
        while base and base not in self.used:
            base = self.classes[base].get("inherits")
        return base or "ObjectHandle"

    def sort_classes(self):
        """Returns the names in `used`, with each class after its base class."""
        found = []
        while len(found) < len(self.used):
            found += [name for name in self.used if name not in found and self.find_base(name) in ["ObjectHandle"] + found]
        return found

    def build_class(self, name):
        """Returns the lines of the class and the lines of its method definitions."""
        members = self.used[name]
        definitions = []
        described = self.find(self.classes.values(), name, "classes")
        base = self.find_base(name)
        lines = ["/// %s; see Godot's documentation." % name, "class %s : public %s {" % (name, base), "public:"]
        lines.append("\tusing %s::%s;" % (base, base))
        lines.append('\tstatic constexpr const char *CLASS_NAME = "%s";' % name)
        for enum in members.get("enums", "").split():
            values = self.find(described["enums"], enum, name)["values"]
            lines.append("\tenum %s : int64_t {" % enum)
            lines += ["\t\t%s = %d," % (value["name"], value["value"]) for value in values]
            lines.append("\t};")
        for method_name in members["methods"].split():
            method = self.find(described.get("methods", []), method_name, name)
            arguments = [(self.get_type(a["type"], True), a["name"]) for a in method.get("arguments", [])]
            result = method.get("return_value")
            result_type = self.get_type(result["type"], False) if result else "void"
            parameters = ", ".join("%s%sp_%s" % (kind, "" if kind.endswith("&") else " ", arg) for kind, arg in arguments)
            values = "".join(", p_" + arg for _kind, arg in arguments)
            is_static = method["is_static"]
            form = "\tstatic %s %s(%s);" if is_static else "\t%s %s(%s) const;"
            lines.append(form % (result_type, method_name, parameters))
            form = "inline %s %s::%s(%s)" + ("" if is_static else " const") + " {"
            definitions.append(form % (result_type, name, method_name, parameters))
            definitions.append('\tstatic const MethodBind bind("%s", "%s", %d);' % (name, method_name, method["hash"]))
            object_name = "nullptr" if is_static else "object"
            definitions += ["\treturn bind.call<%s>(%s%s);" % (result_type, object_name, values), "}"]
        return lines + ["};", ""], definitions + [""]

    def build_hashes(self):
        """Returns the lines of the constants with the hashes of BUILT_IN_METHODS."""
        lines = []
        for name, methods in BUILT_IN_METHODS.items():
            for method_name in methods:
                method = self.find(self.built_in[name]["methods"], method_name, name)
                lines.append(
                    "inline constexpr int64_t HASH_%s_%s = %d;" % (name.upper(), method_name.upper(), method["hash"])
                )
        return lines + [""]


def write_bindings(api_path, target, used):
    """Writes the header `target` with the classes of `used`, a dictionary like USED."""
    api = Api(api_path, used)
    lines = ["class %s;" % name for name in used] + [""]
    definitions = []  # written after all classes, because methods return some of them
    for name in api.sort_classes():
        declared, defined = api.build_class(name)
        lines += declared
        definitions += defined
    lines += definitions
    with open(target, "w", encoding="utf-8") as file:
        file.write(HEADER % api.version + "\n".join(lines) + "\n} // namespace gnomon::godot\n")


def write_hashes(api_path, target):
    """Writes the header `target` with the hashes of methods of built-in types."""
    lines = ["// Generated by modules/rendering_device_godot/godot_api.py.", "#pragma once", "", "#include <cstdint>", ""]
    lines += ["namespace gnomon::godot {", ""] + Api(api_path, USED).build_hashes() + ["} // namespace gnomon::godot", ""]
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(lines))
