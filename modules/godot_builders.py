"""Finds Godot, generates bindings from the description of its API that Godot writes, and packs the
add-on."""

import os
import shutil
import subprocess
import sys
import zipfile

from SCons.Script import Action

NO_GODOT_ERROR = (
    "ERROR: no Godot was found. Set $GODOT to a Godot 4.5 or later, or have `godot` in PATH.\n"
    "demo_project/install_godot.sh sets one up on Debian 12, below build/godot_program/, which is then found."
)
LIBRARY_FOLDER = "#demo_project/godot/addons/gnomon/bin"


def find_godot():
    """Return the path of Godot: $GODOT, `godot` in PATH, or that of demo_project/install_godot.sh; None if there is none."""
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    installed = os.path.join(root, "build", "godot_program", "godot")
    return os.environ.get("GODOT") or shutil.which("godot") or (installed if os.path.exists(installed) else None)


def get_library_name(platform):
    """Return the file name of the add-on's library, which gnomon.gdextension lists."""
    return "libgnomon.%s%s" % (platform.name, platform.ending)


def _dump(target, source, env):
    """Let Godot write extension_api.json and gdextension_interface.h. Its exit code is ignored: only a missing file fails."""
    folder = os.path.dirname(target[0].abspath)
    command = [env["GODOT"], "--headless", "--dump-extension-api", "--dump-gdextension-interface"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if not all(os.path.exists(node.abspath) for node in target):
        print("ERROR: %s\n%s%s" % (" ".join(command), done.stdout, done.stderr))
        return 1
    return 0


def add_bindings(env):
    """Generate headers in get_api_folder(). Objects that include them depend on env["GODOT_HEADERS"]. Exits if there is no Godot."""
    sys.path.insert(0, env.Dir("#modules/rendering_device_godot").abspath)
    import godot_api

    env["GODOT"] = find_godot()
    if not env["GODOT"]:
        print(NO_GODOT_ERROR)
        env.Exit(2)
    folder = "#" + env["BUILD_FOLDER"].lstrip("#") + "/api/"
    described = env.Command(
        [folder + "extension_api.json", folder + "gdextension_interface.h"],
        env.Value(env["GODOT"]),
        Action(_dump, "Dumping the API of $GODOT"),
    )
    env.Precious(described)

    def write(target, source, env):
        godot_api.write_bindings(str(source[0]), str(target[0]), godot_api.USED)
        godot_api.write_hashes(str(source[0]), str(target[1]))

    generated = env.Command(
        [folder + "godot_api.gen.h", folder + "godot_hashes.gen.h"],
        described[0],
        Action(write, "Generating $TARGET"),
    )
    env.Depends(generated, "#modules/rendering_device_godot/godot_api.py")
    env["GODOT_HEADERS"] = described[1:] + generated


def get_api_folder(env):
    """Return the folder of the generated headers, relative to the repository's root."""
    return env.Dir("#" + env["BUILD_FOLDER"].lstrip("#") + "/api").path


ZIP_FOLDER = "addons/gnomon"
ZIP_DATE = (2026, 1, 1, 0, 0, 0)  # of every entry, so that the same files give the same archive
SKIPPED = (".import",)  # files that Godot generates for each project


def add_zip(env, libraries):
    """Add bin/gnomon_godot_addon.zip: the add-on's folder with these libraries, and the licence. Return its node."""
    folder = env.Dir("#demo_project/godot/" + ZIP_FOLDER).abspath
    files = []
    for root, _folders, names in os.walk(folder):
        if root != os.path.join(folder, "bin"):
            files += [os.path.join(root, name) for name in names if not name.endswith(SKIPPED)]

    def pack(target, source, env):
        with zipfile.ZipFile(str(target[0]), "w", zipfile.ZIP_DEFLATED) as archive:
            for node in source:
                path = node.abspath
                inside = os.path.relpath(path, folder) if path.startswith(folder) else os.path.basename(path)
                with open(path, "rb") as file:
                    entry = zipfile.ZipInfo(ZIP_FOLDER + "/" + inside, ZIP_DATE)
                    entry.compress_type = zipfile.ZIP_DEFLATED
                    entry.external_attr = 0o644 << 16
                    archive.writestr(entry, file.read())

    return env.Command("#bin/gnomon_godot_addon.zip", libraries + ["#LICENSE"] + sorted(files), Action(pack, "Packing $TARGET"))
