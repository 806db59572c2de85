"""Commands that the tests run inside Blender, one per run. Each writes the file OUT: a scene, or results as JSON.

    blender -b --factory-startup --python-exit-code 1 -P inside_blender.py -- COMMAND OUT ARGUMENTS_AS_JSON
"""

import json
import math
import os
import sys

import bpy

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ADDON = os.path.join(ROOT, "demo_project", "blender", "gnomon_shadows.py")
sys.path.insert(0, os.path.dirname(ADDON))
LIGHTS = {
    "Key": {"type": "SPOT", "location": (1.5, -1.5, 3.0), "shadow_soft_size": 0.35, "spot_size": 1.2, "energy": 500.0},
    "Fill": {"type": "POINT", "location": (-2.0, 1.0, 2.5), "shadow_soft_size": 0.2, "energy": 300.0},
    "Sun": {"type": "SUN", "location": (0.0, 0.0, 5.0), "angle": math.radians(6.0), "energy": 2.0},
}


def link(name, data, location, collection=None):
    item = bpy.data.objects.new(name, data)
    (collection or bpy.context.scene.collection).objects.link(item)
    item.location = location
    return item


def look_at(item, target):
    direction = bpy.context.scene.cursor.location.copy()
    direction.xyz = [a - b for a, b in zip(target, item.location)]
    item.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()


def add_light(name, values, collection=None):
    data = bpy.data.lights.new(name + " data", values["type"])
    item = link(name, data, values["location"], collection)
    look_at(item, (0.0, 0.0, 0.5))
    for attribute, value in values.items():
        if attribute not in ("type", "location"):
            setattr(data, attribute, value)
    return item


def build_scene(lights=("Key", "Fill", "Sun"), has_camera=True):
    """A cube above a plane, on which every light casts a penumbra."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_plane_add(size=6.0)
    bpy.ops.mesh.primitive_cube_add(size=0.8, location=(0.0, 0.0, 1.0))
    bpy.context.object.data.materials.append(bpy.data.materials.new("Wax"))
    for name in lights:
        add_light(name, LIGHTS[name])
    if has_camera:
        camera = link("Camera", bpy.data.cameras.new("Camera"), (2.5, -4.0, 4.0))
        look_at(camera, (0.0, 0.0, 0.0))
        bpy.context.scene.camera = camera


def change(changes):
    """Apply changes: [object, attribute or custom property, value].

    A custom property is written as ["name"]. The prefix "data." selects the object's light data.
    """
    for name, path, value in changes:
        owner = bpy.data.objects[name]
        if path.startswith("data."):
            owner, path = owner.data, path[len("data.") :]
        if path.startswith("["):
            owner[json.loads(path)[0]] = value
        else:
            setattr(owner, path, value)


def save_blend(out, lights=("Key", "Fill", "Sun"), has_camera=True, changes=()):
    import gnomon_shadows

    gnomon_shadows.register()
    build_scene(lights, has_camera)
    change(changes)
    bpy.ops.wm.save_as_mainfile(filepath=out)


def save_instances(out, area_is_hidden=True):
    """Save a scene with a light in a collection with two instances, hidden lights, and a light that two objects share."""
    build_scene(("Key",))
    lamps = bpy.data.collections.new("Lamps")
    add_light("Lamp", {**LIGHTS["Fill"], "shadow_soft_size": 0.15}, lamps)
    for number in range(2):
        instance = link("Instance%d" % number, None, (number, 0.0, 0.0))
        instance.instance_type, instance.instance_collection = "COLLECTION", lamps
    excluded = bpy.data.collections.new("Excluded")
    bpy.context.scene.collection.children.link(excluded)
    add_light("Unused", LIGHTS["Fill"], excluded)
    bpy.context.view_layer.layer_collection.children["Excluded"].exclude = True
    area = add_light("Area", {"type": "AREA", "location": (0.0, 0.0, 4.0)})
    area.hide_render = area_is_hidden
    twin = link("Twin", bpy.data.objects["Key"].data, (0.0, 2.0, 3.0))
    twin["light_size"] = 0.6
    bpy.ops.wm.save_as_mainfile(filepath=out)


def export_by_hand(out):
    """Export without the add-on: with Blender's own exporter, and properties as typed by the user."""
    build_scene()
    change((("Key", "data.[\"light_size\"]", 0.5), ("Fill", "[\"light_size\"]", 0.4), ("Sun", "data.[\"angle\"]", 0.1)))
    bpy.ops.export_scene.gltf(
        filepath=out, export_format="GLTF_SEPARATE", export_extras=True, export_lights=True, export_cameras=True
    )


def list_properties():
    found = {}
    for item in bpy.data.objects:
        if item.type == "LIGHT":
            found[item.name] = [dict(item.items()), dict(item.data.items())]
    return found


def compare_properties(out, path, once_folder):
    """Write the custom properties before an export, after it, and after an export that fails, with its error message."""
    import gnomon_shadows

    gnomon_shadows.register()
    build_scene()
    bpy.data.objects["Key"].data["light_size"] = 0.7
    before = list_properties()
    bpy.ops.export_scene.gnomon(filepath=path)
    after = list_properties()
    # Simulate an exporter that writes no file. rmdir fails at a second call: the add-on must call its exporter only once.
    gnomon_shadows.run_exporter = lambda *_: os.rmdir(once_folder)
    message = ""
    try:
        bpy.ops.export_scene.gnomon(filepath=path)
    except RuntimeError as error:  # raised when an operator reports an error
        message = str(error)
    write(out, {"before": before, "after": after, "after_failure": list_properties(), "message": message})


def import_file(out, path):
    """Import a file with the add-on and write the lights and custom properties that Blender has then."""
    import gnomon_shadows

    gnomon_shadows.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gnomon(filepath=path)
    lights = {}
    for item in bpy.data.objects:
        if item.type == "LIGHT":
            data = item.data
            lights[item.name] = {
                "type": data.type,
                "shadow_soft_size": data.shadow_soft_size,
                "angle": getattr(data, "angle", None),
                "use_shadow": data.use_shadow,
                "energy": data.energy,
                "properties": {**dict(item.items()), **dict(data.items())},
                "technique": data.gnomon_technique,
                "widths": [data.gnomon_outer_width, data.gnomon_inner_width],
            }
    others = {
        "Wax": dict(bpy.data.materials["Wax"].items()),
        "Plane": dict(bpy.data.objects["Plane"].items()),
        "scene": dict(bpy.context.scene.items()),
    }
    bpy.ops.wm.save_as_mainfile(filepath=out + ".blend")
    write(out, {"lights": lights, "others": others})


def install(out, program):
    """Install the add-on as Preferences > Install does, use it, and disable it."""
    sys.path.remove(os.path.dirname(ADDON))
    bpy.ops.preferences.addon_install(filepath=ADDON)
    bpy.ops.preferences.addon_enable(module="gnomon_shadows")
    module = sys.modules["gnomon_shadows"]
    preferences = bpy.context.preferences.addons["gnomon_shadows"].preferences
    light = bpy.data.lights.new("Lamp", "POINT")
    light.gnomon_technique = "own_id"
    lists = []  # of ids, with the program and with one that does not exist
    for path in (program, os.path.join(os.path.dirname(out), "gone")):
        preferences.program = path
        lists.append([name for name, _ in module.search_techniques(light, bpy.context, "")])
    was_registered = hasattr(bpy.types, "GNOMON_PT_shadow") and "gnomon" in dir(bpy.ops.export_scene)
    # Both mean the default (any negative width is -1), so nothing may be stored.
    light.gnomon_technique, light.gnomon_outer_width = "", -0.5
    stored_properties = dict(light.items())
    bpy.ops.preferences.addon_disable(module="gnomon_shadows")
    is_still_registered = hasattr(bpy.types, "GNOMON_PT_shadow") or hasattr(bpy.types.Light, "gnomon_technique")
    write(out, {"file": module.__file__, "lists": lists, "was_there": was_registered, "left": stored_properties, "is_there": is_still_registered})


def draw_panel(out):
    """Show the panel for each type of light. Needs a display. Errors while it draws go to stderr."""
    import gnomon_shadows

    gnomon_shadows.register()
    drawn = []
    draw = gnomon_shadows.GNOMON_PT_shadow.draw

    def record_draw(self, context):
        draw(self, context)
        drawn.append(context.light.type)

    gnomon_shadows.GNOMON_PT_shadow.draw = record_draw
    window = bpy.context.window_manager.windows[0]
    light = bpy.data.objects["Light"]
    light["light_size"] = 0.7  # makes the panel draw its hint about custom properties
    window.view_layer.objects.active = light
    states = ["POINT", "SPOT", "SUN", "AREA"]

    def step():
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.spaces[0].context = "DATA"
        if not states:
            write(out, sorted(set(drawn)))
            bpy.ops.wm.quit_blender()
            return None
        light.data.type = states.pop(0)
        return 0.5  # seconds until Blender calls it again

    bpy.app.timers.register(step, first_interval=1.0)


def render_scales(out):
    """Render the shadow of a light with Cycles: unchanged, with its object scaled, and with twice the radius."""
    images = {}
    for kind in ("Key", "Fill"):
        for variant, scale, factor in (("plain", 1.0, 1.0), ("scaled", 3.0, 1.0), ("larger", 1.0, 2.0)):
            build_scene((kind,))
            light, scene = bpy.data.objects[kind], bpy.context.scene
            light.scale = (scale, scale, scale)
            light.data.shadow_soft_size *= factor
            scene.render.engine, scene.cycles.samples, scene.cycles.max_bounces = "CYCLES", 16, 0
            scene.cycles.use_denoising = False
            scene.render.resolution_x = scene.render.resolution_y = 48
            scene.render.image_settings.file_format = "OPEN_EXR"
            scene.render.filepath = out + ".exr"
            bpy.ops.render.render(write_still=True)
            # The red values of the RGBA pixels.
            images[kind + " " + variant] = list(bpy.data.images.load(out + ".exr").pixels)[::4]
    write(out, images)


def write(path, value):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(value, file)


def main():
    command, out, arguments = sys.argv[sys.argv.index("--") + 1 :]
    globals()[command](out, **json.loads(arguments))


main()
