"""Skins and animations of a gltf_writer.Document. Standard library only."""

from gltf_writer import to_float32


class Channel:
    """Animation of one property of one node. path: translation, rotation, scale or weights. values: one tuple per time, or for
    CUBICSPLINE three: the in-tangent (per second), the value and the out-tangent (per second)."""

    def __init__(self, node, path, times_s, values, interpolation="LINEAR"):
        self.node = node
        self.path = path
        self.times_s = tuple(to_float32(time) for time in times_s)
        self.values = values
        self.interpolation = interpolation

    def check(self, name):
        per_key = 3 if self.interpolation == "CUBICSPLINE" else 1
        if len(self.values) != per_key * len(self.times_s):
            raise ValueError("animation %s: %d values at %d times of node %d" % (name, len(self.values), len(self.times_s), self.node))
        if any(after <= before for before, after in zip(self.times_s, self.times_s[1:])):
            raise ValueError("animation %s: times of node %d do not rise" % (name, self.node))


def make_signs_continuous(quaternions):
    """Return the quaternions with such signs that LINEAR takes the shorter arc in every reader."""
    result = []
    for quaternion in quaternions:
        if result and sum(a * b for a, b in zip(quaternion, result[-1])) < 0.0:
            quaternion = tuple(-value for value in quaternion)
        result.append(quaternion)
    return result


def add_skin(document, name, joints, skeleton, inverse_binds):
    """Add a skin, return its index. joints: nodes. skeleton: their root. inverse_binds: 16 numbers per joint, column-major."""
    matrices = document.add_accessor(inverse_binds, "MAT4")
    skin = {"name": name, "inverseBindMatrices": matrices, "skeleton": skeleton, "joints": list(joints)}
    document.root.setdefault("skins", []).append(skin)
    return len(document.root["skins"]) - 1


def add_animation(document, name, channels):
    """Add an animation, return its index. Channels with the same times share an accessor."""
    times, written = {}, {"name": name, "channels": [], "samplers": []}
    for channel in channels:
        channel.check(name)
        if channel.times_s not in times:
            times[channel.times_s] = document.add_accessor([(time,) for time in channel.times_s], "SCALAR", has_bounds=True)
        if channel.path == "weights":
            rows, kind = [(weight,) for weights in channel.values for weight in weights], "SCALAR"
        else:
            rows, kind = channel.values, "VEC%d" % len(channel.values[0])
        sampler = {"input": times[channel.times_s], "interpolation": channel.interpolation, "output": document.add_accessor(rows, kind)}
        written["samplers"].append(sampler)
        target = {"node": channel.node, "path": channel.path}
        written["channels"].append({"sampler": len(written["samplers"]) - 1, "target": target})
    document.root.setdefault("animations", []).append(written)
    return len(document.root["animations"]) - 1
