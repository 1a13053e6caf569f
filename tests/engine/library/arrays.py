"""Facts about binosplat.py: FILE.ply as arrays and as a file, invalid arguments, and memory over many frames
(FRAMES)."""

import resource
import sys

import binosplat
import numpy as np


def read_ply(path):
    """The vertices of a binary PLY file of floats."""
    with open(path, "rb") as file:
        names, count = [], 0
        for line in iter(file.readline, b"end_header\n"):
            words = line.split()
            count = int(words[2]) if words[:2] == [b"element", b"vertex"] else count
            names += [words[2].decode()] if words[0] == b"property" else []
        return np.frombuffer(file.read(), np.dtype([(name, "<f4") for name in names]), count)


def stack(rows, prefix, count):
    return np.stack([rows[f"{prefix}{i}"] for i in range(count)], axis=1)


def refused(part, **changed):
    try:
        binosplat.Scene.from_arrays(**{**arrays, **changed})
    except ValueError as error:
        assert part in str(error) and "\n" not in str(error), error
    else:
        raise AssertionError(f"nothing was refused: {part}")


rows = read_ply(sys.argv[1])
count = sum(name.startswith("f_rest_") for name in rows.dtype.names)
rest = stack(rows, "f_rest_", count).reshape(len(rows), 3, count // 3).transpose(0, 2, 1)
arrays = dict(positions=np.stack([rows["x"], rows["y"], rows["z"]], axis=1), rotations=stack(rows, "rot_", 4),
              scales=stack(rows, "scale_", sum(name.startswith("scale_") for name in rows.dtype.names)), opacities=rows["opacity"],
              sh=np.concatenate([stack(rows, "f_dc_", 3)[:, None, :], rest], axis=1))
device = binosplat.Device()
of_file, of_arrays = binosplat.Scene.from_file(sys.argv[1], device), binosplat.Scene.from_arrays(**arrays, device=device)
view = of_file.start_view(64, 48)
seen, depth = of_file.render(view, background=(0.5, 0, 0))
assert seen.shape == (1, 48, 64, 4) and depth.shape == (1, 48, 64) and seen.dtype == depth.dtype == np.float32
assert seen[..., 3].max() > 0.9 and depth.max() > 0
again, depth_again = of_arrays.render(view, background=(0.5, 0, 0))
assert np.array_equal(seen, again) and np.array_equal(depth, depth_again)
assert len(of_arrays) == len(of_file) and np.array_equal(of_arrays.bounds, of_file.bounds)

# A camera given by its matrix and intrinsics is the same; a turned one equals the one given by its
# quaternion.
f = 32 / np.tan(0.6)
same = binosplat.View.from_intrinsics(view.world_from_camera, f, f, 32, 24, 64, 48)
assert np.abs(of_file.render(same, background=(0.5, 0, 0))[0] - seen).max() < 1e-3
turned = view.world_from_camera @ np.diag([-1, -1, 1, 1])
upside_down = of_file.render(binosplat.View(turned, view.angles, 64, 48), background=(0.5, 0, 0))[0]
assert np.abs(upside_down[0, ::-1, ::-1] - seen[0]).max() < 1e-3

# A scene far away from another changes nothing; the same scene in the same place is drawn twice; a camera
# that turns with a scene sees the same.
far, here, back = np.eye(4), np.eye(4), np.diag([-2.0, 2.0, -2.0, 1.0])
far[0, 3] = 1e4
assert np.array_equal(of_file.render(view, background=(0.5, 0, 0), beside=[(of_arrays, far)])[0], seen)
assert of_file.render(view, background=(0.5, 0, 0), beside=[(of_arrays, here)])[0][..., 3].sum() > seen[..., 3].sum()
behind = binosplat.View(np.diag([-1.0, 1.0, -1.0, 1.0]) @ view.world_from_camera, view.angles, 64, 48)
behind.world_from_camera[:3, 3] *= 2
hidden = binosplat.Scene.from_arrays(**{name: array[:1] if name != "opacities" else array[:1] - 1e3 for name, array in arrays.items()}, device=device)
turned_scene = hidden.render(behind, background=(0.5, 0, 0), near=0.2, beside=[(of_file, back)])[0]
assert np.abs(turned_scene - of_file.render(view, background=(0.5, 0, 0), near=0.1)[0]).mean() < 1e-3
for beside in ([(view, far)], [(of_arrays, far[:3])], [(of_arrays, np.diag([1.0, 2.0, 1.0, 1.0]))]):
    try:
        of_file.render(view, beside=beside)
    except ValueError as error:
        assert "\n" not in str(error)
    else:
        raise AssertionError(f"nothing was refused: {beside}")

refused("positions has the shape (4,), must be (any, 3)", positions=np.zeros(4, np.float32))
refused("rotations has the shape (2, 4), must be", rotations=np.zeros((2, 4), np.float32))
refused("must be (%d, 2 or 3)" % len(rows), scales=np.zeros((len(rows), 5), np.float32))
refused("sh has the shape", sh=np.zeros((len(rows), 5, 3), np.float32))
refused("opacities is int64, must be a numpy array of float32 or float64", opacities=np.zeros(len(rows), np.int64))
try:
    binosplat.Scene.from_file("nothing.ply", device)
except binosplat.Error as error:
    assert error.code == -1 and "nothing.ply" in str(error)

pair = [view, binosplat.View(view.world_from_camera, view.angles, 64, 48)]
used = 0
for i in range(int(sys.argv[2])):
    pair[0].world_from_camera[0, 3] += 1e-4
    of_file.render(pair, mode="temporal")
    if i == 20:
        used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - used if used else 0
assert grown < 2048, f"{grown} KiB more after {sys.argv[2]} frames"
print("all right")
