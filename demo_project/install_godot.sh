#!/usr/bin/env bash
# Finds or installs a Godot 4 for the add-on's build, demo and tests; see doc/godot.md. Run it by itself, or source it after
# install_packages.sh and call install_godot.

GODOT_SUITE=sid # Debian 12 has no Godot 4
GODOT_PACKAGES=(
    godot godot-template-release mesa-vulkan-drivers xvfb xauth libx11-6 libxcursor1 libxi6 libxinerama1 libxrandr2 libxrender1 libxkbcommon0
    libxkbcommon-x11-0 libdbus-1-3 libfontconfig1 libasound2t64 libpulse0 libegl1 libgl1 libgl1-mesa-dri
)

# install_godot ROOT: sets and exports GODOT, a program that runs Godot 4.5 or later. It is the first of: the program that GODOT
# already names, `godot` in PATH, and Debian's, which is installed into ROOT/build/godot_program (1.2 GB, 3 minutes; needs root).
# For Debian's it also sets GODOT_TEMPLATE, the release template for exported games, and GODOT_RUN, which runs such games:
# GODOT_RUN PROGRAM ARGUMENT... Returns 1, with the reason on stderr, if there is no working Godot.
install_godot() {
    local root=$1 folder=$1/build/godot_program version
    if [ -z "${GODOT:-}" ]; then
        GODOT=$(command -v godot || true)
    fi
    if [ -z "$GODOT" ]; then
        if [ ! -x "$folder/run" ]; then
            _make_godot_root "$root" "$folder" || return 1
        fi
        GODOT=$folder/godot
    fi
    if [ "$GODOT" = "$folder/godot" ]; then
        export GODOT_RUN=$folder/run GODOT_TEMPLATE=/usr/bin/godot-template-release
    fi
    export GODOT
    version=$("$GODOT" --version 2>/dev/null | tail -n 1)
    case $version in
        4.[5-9].* | 4.[1-9][0-9].* | [5-9].*) return 0 ;;
    esac
    echo "ERROR: \`$GODOT --version\` prints \"$version\", Gnomon needs Godot 4.5 or later. Set \$GODOT to one." >&2
    return 1
}

# _make_godot_root ROOT FOLDER: installs Godot of a later Debian, which therefore gets its own root directory, FOLDER/root.
# Mounts are made in a namespace that ends with the program, so that there is nothing to undo, or to delete by accident.
_make_godot_root() {
    local root=$1 folder=$2 mirror
    if [ "$(id -u)" -ne 0 ]; then
        echo "ERROR: no Godot was found, and only root can set one up. Set \$GODOT to a Godot 4.5 or later." >&2
        return 1
    fi
    install_packages debootstrap || return 1
    mirror=$(find_debian_mirror)
    if [ -z "$mirror" ]; then
        echo "ERROR: apt names no mirror to get Godot from. Run apt-get update, or set \$GODOT to a Godot 4.5 or later." >&2
        return 1
    fi
    echo "Setting up Godot in $folder (1.2 GB, 3 minutes on a fast connection)"
    rm -rf "$folder/root.part"
    mkdir -p "$folder/root.part"
    echo "1/3 base system of Debian $GODOT_SUITE"
    # Check-Valid-Until=false accepts a mirror whose index has expired, such as a snapshot.
    if ! unshare --mount debootstrap --variant=minbase --include=ca-certificates "$GODOT_SUITE" "$folder/root.part" \
        "$mirror" >"$folder/log" 2>&1 ||
        ! cp /etc/resolv.conf "$folder/root.part/etc/" ||
        ! echo "2/3 package lists" ||
        ! _run_in "$folder/root.part" apt-get -o Acquire::Check-Valid-Until=false update >>"$folder/log" 2>&1 ||
        ! echo "3/3 Godot, its graphics driver and a virtual display" ||
        ! _run_in "$folder/root.part" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
            "${GODOT_PACKAGES[@]}" >>"$folder/log" 2>&1; then
        tail -n 5 "$folder/log" >&2
        echo "ERROR: Godot could not be set up, see $folder/log. Is there a network connection? Or set \$GODOT." >&2
        return 1
    fi
    rm -rf "$folder/root.part/var/cache/apt/archives"
    mv "$folder/root.part" "$folder/root"
    cat >"$folder/run" <<TEXT
#!/bin/bash
# Runs a program in a root directory of its own, in which this project and the user's home have the paths that they have here.
# GODOT_DISPLAY=virtual gives it a display, which a RenderingDevice needs, and a home of its own, which tests need.
exec unshare --mount bash -c 'set -e
    S=$folder/root
    home=/root
    if [ "\${GODOT_DISPLAY:-}" != virtual ] && [ -d "\${HOME:-}" ] && [ "\$HOME" != / ]; then
        home=\$HOME
        mkdir -p "\$S\$home"
        mount --bind "\$home" "\$S\$home"
        if [ -d /tmp/.X11-unix ]; then
            mkdir -p "\$S/tmp/.X11-unix"
            mount --bind /tmp/.X11-unix "\$S/tmp/.X11-unix"
        fi
    fi
    mkdir -p "\$S$root"
    mount --bind "$root" "\$S$root"
    mount --bind /proc "\$S/proc"
    mount --bind /dev "\$S/dev"
    here=\$PWD
    exec chroot "\$S" env HOME="\$home" XDG_RUNTIME_DIR=/run bash -c "cd \"\$here\" 2>/dev/null || cd /
        if [ \"\${GODOT_DISPLAY:-}\" = virtual ]; then
            exec xvfb-run -a -s \"-screen 0 1280x1024x24\" \"\\\$@\"
        fi
        exec \"\\\$@\"" run "\$@"' run "\$@"
TEXT
    printf '#!/bin/bash\nexec "%s" godot "$@"\n' "$folder/run" >"$folder/godot"
    chmod +x "$folder/run" "$folder/godot"
}

# _run_in ROOT COMMAND...: runs a command in the root directory ROOT.
_run_in() {
    local folder=$1
    shift
    # shellcheck disable=SC2016
    unshare --mount bash -c 'mount --bind /proc "$0/proc" && mount --bind /dev "$0/dev" && exec chroot "$0" "$@"' "$folder" "$@"
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    root=$(cd "$(dirname "$0")/.." && pwd)
    # shellcheck source=demo_project/install_packages.sh
    . "$root/demo_project/install_packages.sh"
    install_godot "$root" || exit 1
    echo "Godot $("$GODOT" --version 2>/dev/null | tail -n 1): $GODOT"
    echo "To build the add-on with it: scons addon_zip=yes"
fi
