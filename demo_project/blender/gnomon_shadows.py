"""Blender add-on: settings of Gnomon's soft shadows on Blender's lights, and glTF export and import. See doc/blender.md.

Without a window:

    blender -b FILE.blend -P demo_project/blender/gnomon_shadows.py -- --export OUT.gltf|OUT.glb [--embedded]

Values that Blender has itself (radius, angle, the checkbox "Shadow") are read from Blender during an export.
Values that it lacks (technique, penumbra widths r and t) are custom properties of the light with the engine's names.
Everything is in one file, because that is what Blender installs.
"""

import argparse
import contextlib
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from typing import NamedTuple

import bpy
from bpy.props import BoolProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

bl_info = {
    "name": "Gnomon Shadow",
    "description": "Size and technique of a light's soft shadow, and glTF files that carry them",
    "author": "Gnomon",
    "version": (1, 0, 0),
    "blender": (3, 3, 0),
    "location": "Properties > Light > Gnomon Shadow, File > Export, File > Import",
    "category": "Import-Export",
}

DEGREE = math.pi / 180.0
TECHNIQUE = "shadow_technique"
OUTER_WIDTH = "penumbra_outer_width"
INNER_WIDTH = "penumbra_inner_width"
MAX_WIDTH_M = 10000.0
SUFFIXES = (".gltf", ".glb")
PROGRAM_TIMEOUT_S = 20


class BlenderValue(NamedTuple):
    """A property of the engine that Blender knows under another name."""

    name: str
    attribute: str  # name in Blender's light
    label: str
    types: tuple
    allowed: tuple  # (minimum, maximum) in the engine's unit
    unit: str
    # Custom properties that the engine reads, in order of precedence: name -> factor that converts
    # it to Blender's unit. Names such as `radius` are written by other programs.
    factors: dict

    def compute(self, light):
        """Return the value in the engine's unit, rounded to the seven digits of Blender's floats."""
        value = getattr(light, self.attribute)
        return value if isinstance(value, bool) else float("%.7g" % (value / self.factors[self.name]))

    def find_names(self, owner):
        """Return the names of custom properties of the light or object that override Blender's value."""
        return [name for name in self.factors if name in owner]


LIGHT_TYPES = ("POINT", "SPOT", "SUN")
# Neither Cycles nor the engine applies the scale of the object to these values (tests/blender measures both).
BLENDER_VALUES = (
    BlenderValue("light_size", "shadow_soft_size", "Radius R", ("POINT", "SPOT"), (0.0, 10000.0), "m",
                 {"light_size": 1.0, "radius": 1.0, "shadow_soft_size": 1.0}),
    BlenderValue("light_angular_distance", "angle", "Angular Diameter", ("SUN",), (0.0, 90.0), "deg",
                 {"light_angular_distance": DEGREE, "angle": 1.0}),
    BlenderValue("shadow_enabled", "use_shadow", "Shadow", LIGHT_TYPES, (0, 1), "", {"shadow_enabled": 1}),
)  # fmt: skip


class ExportError(Exception):
    """The export failed. The text is shown to the user: what is wrong, and what to do."""


def get_values(light):
    return [value for value in BLENDER_VALUES if light.type in value.types]


def read_number(owner, name):
    value = owner.get(name)
    return value if isinstance(value, (bool, int, float)) else None


# Export


def is_exported(item):
    """Whether Blender's exporter writes an object if "Visible Objects" and "Renderable Objects" are ticked.

    Without "Visible Objects" it would also write objects outside of the view layer, and objects that Blender does not
    evaluate, at wrong positions.
    """
    return (
        item.visible_get()
        and not item.hide_viewport
        and not item.hide_render
        and not all(collection.hide_viewport for collection in item.users_collection)
        and not all(collection.hide_render for collection in item.users_collection)
    )


def find_exported_objects(scene):
    """Return the exported objects of the scene, including those in instances of collections."""
    found, waiting = set(), [item for item in scene.objects if is_exported(item)]
    while waiting:
        item = waiting.pop()
        if item in found:
            continue
        found.add(item)
        if item.instance_type == "COLLECTION" and item.instance_collection:
            waiting += item.instance_collection.all_objects
    return found


def find_lights(objects):
    """Map each light to the objects that have it; Blender lets several share one."""
    lights = {}
    for item in objects:
        if item.type == "LIGHT":
            lights.setdefault(item.data, []).append(item)
    return lights


def check_lights(lights, scene):
    if not lights:
        raise ExportError(
            'Scene "%s" has no light that is visible and renders. Add one (Add > Light), or show it in the outliner.'
            % scene.name
        )
    for light, objects in lights.items():
        name = objects[0].name
        if light.type not in LIGHT_TYPES:
            raise ExportError(
                'Light "%s" is of type %s, which glTF does not have. Make it a spot light with half of its size as '
                "radius (Properties > Light), or hide it in the outliner." % (name, light.type)
            )
        for value in get_values(light):
            lowest, highest = value.allowed
            if not value.find_names(light) and not lowest <= value.compute(light) <= highest:
                raise ExportError(
                    'Light "%s": %s is %g %s, must be %g..%g. Change it (Properties > Light).'
                    % (name, value.label, value.compute(light), value.unit, lowest, highest)
                )


def find_owners(value, light, objects):
    """Return what gets Blender's value as a custom property during the export: the light, or objects.

    Properties that the user typed are not overwritten. The engine reads the light before the object,
    so the light gets none if one of its objects has a typed one.
    """
    if value.find_names(light):
        return []
    plain = [item for item in objects if not value.find_names(item)]
    return [light] if len(plain) == len(objects) else plain


@contextlib.contextmanager
def filled_properties(lights):
    """Store Blender's values as custom properties that the engine reads, and remove them afterwards."""
    filled = []
    try:
        for light, objects in lights.items():
            for value in get_values(light):
                for owner in find_owners(value, light, objects):
                    owner[value.name] = value.compute(light)
                    filled.append((owner, value.name))
        yield
    finally:
        for owner, name in filled:
            del owner[name]


def find_cause(error):
    """Return the last line of the traceback in an error of Blender, and where known causes are documented."""
    lines = [line for line in str(error).splitlines() if line.strip() and not line.startswith("Location: ")]
    return "%s. Known causes are in doc/blender.md." % (lines[-1].strip().rstrip(".") if lines else repr(error))


def run_exporter(path, is_embedded):
    """Run Blender's own exporter with those of our options that this version of Blender has."""
    if "gltf" not in dir(bpy.ops.export_scene):
        raise ExportError('The add-on "glTF 2.0 format" is off. Tick it in Edit > Preferences > Add-ons.')
    text_format = "GLTF_EMBEDDED" if is_embedded else "GLTF_SEPARATE"
    options = {
        "export_format": "GLB" if path.lower().endswith(".glb") else text_format,
        "export_extras": True,
        "export_lights": True,
        "export_cameras": True,
        "export_yup": True,
        "use_active_scene": True,
        "use_visible": True,
        "use_renderable": True,
        # The file shows the current frame: modifiers and armatures are applied, no animation is written.
        "export_apply": True,
        "export_animations": False,
        "export_skins": False,
        "export_morph": False,
        "export_current_frame": True,
    }
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
    try:
        bpy.ops.export_scene.gltf(filepath=path, **{name: options[name] for name in options if name in known})
    except (RuntimeError, TypeError) as error:  # TypeError: a format that this version no longer has
        raise ExportError("Blender's exporter failed: %s" % find_cause(error)) from error


def move_files(source, target, main_name):
    """Move side files first and the scene last, so that a program that watches the scene's file never reads old side files."""
    names = sorted(os.listdir(source), key=lambda name: name == main_name)
    if main_name not in names:
        raise ExportError("Blender's exporter wrote no file. Its messages are in the terminal.")
    for name in names:
        os.replace(os.path.join(source, name), os.path.join(target, name))


def export_scene(context, path, is_embedded=False):
    """Write the file and return warnings. Nothing in Blender is changed. Raises ExportError."""
    path = os.path.abspath(bpy.path.abspath(path))
    folder, name = os.path.split(path)
    if not name.lower().endswith(SUFFIXES):
        raise ExportError('"%s" must end with .gltf or .glb. Change the name.' % name)
    if not os.path.isdir(folder):
        raise ExportError('Folder "%s" does not exist. Make it, or choose another one.' % folder)
    objects = find_exported_objects(context.scene)
    lights = find_lights(objects)
    check_lights(lights, context.scene)
    try:
        with tempfile.TemporaryDirectory(prefix=".gnomon_", dir=folder) as temporary:
            with filled_properties(lights):
                run_exporter(os.path.join(temporary, name), is_embedded)
            move_files(temporary, folder, name)
    except OSError as error:
        raise ExportError("%s cannot be written: %s. Choose another folder." % (path, error.strerror)) from error
    if not any(item.type == "CAMERA" and item.data.type == "PERSP" for item in objects):
        return ["No perspective camera is visible, so Gnomon adds one that shows all meshes. Add your own (Add > Camera)."]
    return []


# Import


def adopt_values(light, owners):
    """Set Blender's own values from custom properties of the light and its object, and remove those properties."""
    for value in get_values(light):
        properties = [(owner, name) for owner in owners for name in value.find_names(owner)]
        if not properties or read_number(*properties[0]) is None:
            continue
        owner, name = properties[0]
        number = owner[name] * value.factors[name]
        setattr(light, value.attribute, bool(number) if value.attribute == "use_shadow" else number)
        for owner, name in properties:
            del owner[name]


def repair_numpy():
    """Define numpy.bool, which Blender 3.4's importer needs and Debian 12's numpy 1.24 no longer has.

    See github.com/KhronosGroup/glTF-Blender-IO/issues/1844. Blender 3.5 does not need it.
    """
    import numpy

    if "bool" not in vars(numpy):
        numpy.bool = bool


def import_scene(path):
    repair_numpy()
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=path)
    for item in set(bpy.data.objects) - before:
        if item.type == "LIGHT":
            adopt_values(item.data, (item.data, item))


# List of techniques


class TechniqueList:
    """The techniques of the program `gnomon`, queried when the list opens.

    A list in this file would become outdated with every new technique, so the program is the only source. Without the
    program the user types the id. Files keep any id, and the engine warns of an unknown one.
    """

    def __init__(self):
        self.key, self.items = None, []

    def find_program(self, context):
        addon = context.preferences.addons.get(__name__)
        if addon and addon.preferences and addon.preferences.program:
            return bpy.path.abspath(addon.preferences.program)
        root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
        return shutil.which("gnomon") or os.path.join(root, "bin", "gnomon")

    def load(self, context):
        """Return (id, name) of each technique; an empty list if the program cannot be run."""
        program = self.find_program(context)
        try:
            key = (program, os.path.getmtime(program))
            if key != self.key:
                command = [program, "techniques", "--json"]
                result = subprocess.run(command, capture_output=True, timeout=PROGRAM_TIMEOUT_S, check=True)
                self.items = [(item["id"], item["name"]) for item in json.loads(result.stdout)]
                self.key = key
        except (OSError, ValueError, KeyError, TypeError, subprocess.SubprocessError):
            return []
        return self.items


TECHNIQUES = TechniqueList()


def search_techniques(_light, context, _text):
    items = list(TECHNIQUES.load(context))
    known_ids = {item_id for item_id, _name in items}
    used_ids = sorted(filter(is_text, {light.get(TECHNIQUE) for light in bpy.data.lights}))
    return items + [(used_id, "used in this file") for used_id in used_ids if used_id not in known_ids]


def is_text(value):
    return isinstance(value, str) and value != ""


# The panel. Its fields read and write the custom properties, so nothing is stored twice.


def set_or_drop(light, name, value, default):
    if value != default:
        light[name] = value
    elif name in light:
        del light[name]


def make_technique_property():
    def get(light):
        value = light.get(TECHNIQUE)
        return value if is_text(value) else ""

    return StringProperty(
        name="Technique",
        description="What computes the shadow. Choose or type an id of `gnomon techniques`; empty: the engine's default",
        get=get,
        set=lambda light, value: set_or_drop(light, TECHNIQUE, value.strip(), ""),
        search=search_techniques,
        search_options={"SUGGESTION"},
    )


def make_width_property(name, label, description):
    def get(light):
        value = read_number(light, name)
        return -1.0 if value is None else value

    return FloatProperty(
        name=label,
        description=description + ", in metres. -1: derived from the light's size; 0: none",
        get=get,
        set=lambda light, value: set_or_drop(light, name, -1.0 if value < 0 else value, -1.0),
        min=-1.0,
        max=MAX_WIDTH_M,
        soft_max=10.0,
        step=1,
        precision=3,
    )


class GNOMON_PT_shadow(bpy.types.Panel):  # Blender expects class names PREFIX_TYPE_name
    bl_label = "Gnomon Shadow"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.light is not None

    def draw(self, context):
        light, layout = context.light, self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        if light.type not in LIGHT_TYPES:
            layout.label(text="glTF has no area lights. Use a spot or point light.", icon="ERROR")
            return
        for value in get_values(light):
            layout.prop(light, value.attribute, text=value.label)
        layout.prop(light, "gnomon_technique")
        layout.prop(light, "gnomon_outer_width")
        layout.prop(light, "gnomon_inner_width")
        owners = [owner for owner in (light, context.object) if owner]
        typed = [(owner, name) for value in get_values(light) for owner in owners for name in value.find_names(owner)]
        for owner, name in typed:
            where = "light" if owner == light else "object"
            layout.label(text="%s = %s wins (custom, %s)" % (name, owner[name], where), icon="INFO")
        if typed:
            layout.operator("object.gnomon_adopt")


class GNOMON_OT_adopt(bpy.types.Operator):
    """Sets Blender's radius, angle and shadow from the custom properties, and removes those"""

    bl_idname = "object.gnomon_adopt"
    bl_label = "Make Them Blender's Own"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "LIGHT"

    def execute(self, context):
        adopt_values(context.object.data, (context.object.data, context.object))
        return {"FINISHED"}


class GNOMON_OT_export(bpy.types.Operator, ExportHelper):
    """Writes a glTF file with the size and the technique of each light's shadow"""

    bl_idname = "export_scene.gnomon"
    bl_label = "Export glTF for Gnomon"
    bl_options = {"REGISTER"}

    filename_ext = ".glb"  # of the suggested file name
    check_extension = None  # both .gltf and .glb are allowed
    filter_glob: StringProperty(default="*.gltf;*.glb", options={"HIDDEN"})
    is_embedded: BoolProperty(
        name="Embedded",
        description="For .gltf: one file with everything in it, instead of a .bin next to it",
        default=False,
    )

    def execute(self, context):
        try:
            warnings = export_scene(context, self.filepath, self.is_embedded)
        except ExportError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for warning in warnings:
            self.report({"WARNING"}, warning)
        self.report({"INFO"}, "Wrote %s" % self.filepath)
        return {"FINISHED"}


class GNOMON_OT_import(bpy.types.Operator, ImportHelper):
    """Reads a glTF file; the size of each light becomes Blender's radius or angle"""

    bl_idname = "import_scene.gnomon"
    bl_label = "Import glTF from Gnomon"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.gltf;*.glb", options={"HIDDEN"})

    def execute(self, _context):
        try:
            import_scene(self.filepath)
        except (RuntimeError, ImportError) as error:
            self.report({"ERROR"}, "Blender's importer failed: %s" % find_cause(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class GNOMON_AP_program(bpy.types.AddonPreferences):
    bl_idname = __name__

    program: StringProperty(
        name="Program",
        description="Path of `gnomon`, which names the techniques. Empty: searched in PATH, then bin/gnomon above this file",
        subtype="FILE_PATH",
    )

    def draw(self, _context):
        self.layout.prop(self, "program")


CLASSES = (GNOMON_PT_shadow, GNOMON_OT_adopt, GNOMON_OT_export, GNOMON_OT_import, GNOMON_AP_program)


def draw_export_entry(menu, _context):
    menu.layout.operator(GNOMON_OT_export.bl_idname, text="glTF for Gnomon (.glb/.gltf)")


def draw_import_entry(menu, _context):
    menu.layout.operator(GNOMON_OT_import.bl_idname, text="glTF from Gnomon (.glb/.gltf)")


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Light.gnomon_technique = make_technique_property()
    bpy.types.Light.gnomon_outer_width = make_width_property(
        OUTER_WIDTH, "Outer Width r", "How far the soft edge reaches out of the hard shadow"
    )
    bpy.types.Light.gnomon_inner_width = make_width_property(
        INNER_WIDTH, "Inner Width t", "How far the soft edge reaches into the hard shadow"
    )
    bpy.types.TOPBAR_MT_file_export.append(draw_export_entry)
    bpy.types.TOPBAR_MT_file_import.append(draw_import_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(draw_import_entry)
    bpy.types.TOPBAR_MT_file_export.remove(draw_export_entry)
    del bpy.types.Light.gnomon_inner_width
    del bpy.types.Light.gnomon_outer_width
    del bpy.types.Light.gnomon_technique
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)


def run_command(arguments):
    """Run the export that the command line describes; return the exit code."""
    parser = argparse.ArgumentParser(prog="blender -b FILE.blend -P gnomon_shadows.py --", description="Exports for Gnomon.")
    parser.add_argument("--export", required=True, metavar="OUT", help="the .gltf or .glb file to write")
    parser.add_argument("--embedded", action="store_true", help="a .gltf without a .bin next to it")
    options = parser.parse_args(arguments)
    try:
        for warning in export_scene(bpy.context, options.export, options.embedded):
            print("WARNING: %s" % warning, file=sys.stderr)
    except ExportError as error:
        print("ERROR: %s" % error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    if "--" in sys.argv:
        sys.exit(run_command(sys.argv[sys.argv.index("--") + 1 :]))
    register()  # run from Blender's text editor
