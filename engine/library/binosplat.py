"""Scenes of Gaussian splats, drawn from Python by libbinosplat: numpy arrays in, numpy arrays out.

    import binosplat
    scene = binosplat.Scene.from_file("garden.ply")
    colour, depth = scene.render([scene.start_view(1024, 768)])

Lengths are in the scene's units, angles in radians. Camera axes are OpenCV's: x right, y down, z forward. Quaternions are w, x, y, z.
What the library refuses raises binosplat.Error, an argument of a wrong shape or dtype ValueError; both messages are one line. A scene is used
by one thread at a time. It needs numpy and the library (libbinosplat0), or the file that the variable BINOSPLAT_LIBRARY names.
"""

import collections.abc
import ctypes
import math
import os
import weakref

import numpy as np

__all__ = ["Device", "Error", "Scene", "View"]


class Error(RuntimeError):
    """What the library says is wrong. `code` is a bsp_result: -1 a file or a value, -2 memory, -3 no device, -4 the device was lost."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


# The structures of binosplat.h, which explains their fields.
_HEADER = [("type", ctypes.c_uint32), ("size", ctypes.c_uint32), ("next", ctypes.c_void_p)]
_DOUBLES3, _U32, _U64, _PTR = ctypes.c_double * 3, ctypes.c_uint32, ctypes.c_uint64, ctypes.c_void_p
_LOG = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_char_p)


class _Structure(ctypes.Structure):
    def __init__(self, **fields):
        super().__init__(type=self.TYPE, size=ctypes.sizeof(self), **fields)


class _Array(ctypes.Structure):
    _fields_ = [("values", _PTR), ("stride", _U64)]


class _DeviceInfo(_Structure):
    TYPE = 1
    _fields_ = _HEADER + [("name", ctypes.c_char_p), ("log", _LOG), ("log_user", _PTR), ("memory_limit_bytes", _U64), ("validation", _U32)]


class _Splats(_Structure):
    TYPE = 2
    _fields_ = _HEADER + [("count", _U64), ("positions", _Array), ("rotations", _Array), ("scales", _Array), ("opacities", _Array), ("sh", _Array),
                          ("scale_count", _U32), ("sh_degree", _U32), ("activated", _U32), ("antialiased", _U32), ("origin", _DOUBLES3)]


class _SceneInfo(_Structure):
    TYPE = 3
    _fields_ = _HEADER + [("source", ctypes.c_char_p), ("splats", ctypes.POINTER(_Splats)), ("live", _U32), ("unused", _U32),
                          ("splat_budget", _U64), ("rate_hz", ctypes.c_double)]


class _SceneProperties(_Structure):
    TYPE = 4
    _fields_ = _HEADER + [("splats", _U64), ("skipped", _U64), ("device_bytes", _U64), ("scale_count", _U32), ("sh_degree", _U32),
                          ("low", _DOUBLES3), ("high", _DOUBLES3), ("core_size", ctypes.c_double), ("near", ctypes.c_double),
                          ("eye", _DOUBLES3), ("look", _DOUBLES3), ("up", _DOUBLES3)]


class _View(_Structure):
    TYPE = 5
    _fields_ = _HEADER + [("orientation", ctypes.c_double * 4), ("position", _DOUBLES3), ("angles", ctypes.c_double * 4), ("width", _U32), ("height", _U32)]


class _Instance(_Structure):
    TYPE = 11
    _fields_ = _HEADER + [("scene", _PTR), ("orientation", ctypes.c_double * 4), ("position", _DOUBLES3), ("scale", ctypes.c_double), ("hidden", _U32)]


class _FrameInfo(_Structure):
    TYPE = 6
    _fields_ = _HEADER + [("scene", _PTR), ("views", ctypes.POINTER(_View)), ("view_count", _U32), ("mode", ctypes.c_int), ("flags", _U32),
                          ("budget", ctypes.c_double), ("near_depth", ctypes.c_double), ("background", _DOUBLES3),
                          ("instances", ctypes.POINTER(_Instance)), ("instance_count", _U32), ("unused", _U32), ("foveation_rad", ctypes.c_double),
                          ("time_s", ctypes.c_double), ("error_bound_db", ctypes.c_double)]


_MODES = {"predicted": 4, "two-pass": 1, "shared": 2, "paper": 3, "temporal": 5}
_FLAG_DEPTH, _FLAG_CUT, _FLAG_SETTLED = 2, 4, 8
_NOT_READY = 1


def _open_library():
    # That of the same installation, if there is one: the loader may not search its folder.
    name = "libbinosplat.so.0"
    installed = os.path.normpath(os.path.join(os.path.abspath(__file__), "../../..", name))
    file = os.environ.get("BINOSPLAT_LIBRARY") or (installed if os.path.exists(installed) else name)
    try:
        library = ctypes.CDLL(file)
    except OSError as error:
        raise ImportError(f"{error}; BINOSPLAT_LIBRARY may name the file {name}") from None
    library.bsp_error_text.restype = ctypes.c_char_p
    library.bsp_device_name.restype = ctypes.c_char_p
    for name, arguments in {
            "device_name": [_PTR], "device_create": [_PTR, _PTR], "device_destroy": [_PTR], "scene_create": [_PTR, _PTR, _PTR], "scene_state": [_PTR, _PTR],
            "scene_wait": [_PTR], "scene_cancel": [_PTR], "scene_destroy": [_PTR], "scene_get_properties": [_PTR, _PTR],
            "look_at": [_PTR, _PTR, _PTR, ctypes.c_double, ctypes.c_double, _U32, _U32, _U32, _PTR], "renderer_create": [_PTR, _PTR],
            "renderer_destroy": [_PTR], "render": [_PTR, _PTR, _PTR], "read_colour": [_PTR, _U32, _PTR, _U64], "read_depth": [_PTR, _U32, _PTR, _U64]}.items():
        getattr(library, "bsp_" + name).argtypes = arguments
    return library


_library = _open_library()


def _check(code):
    if code < 0:
        raise Error(code, _library.bsp_error_text().decode())
    return code


def _own(owner, destroy, handle, *keeps):
    """Destroys the handle with its owner, or as the program ends; `keeps` stay until then."""
    weakref.finalize(owner, lambda *_: destroy(handle), *keeps)
    return handle


def _vector(name, values, count=3):
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (count,):
        raise ValueError(f"{name} has the shape {array.shape}, must be ({count},)")
    return array


class Device:
    """A Vulkan device. `name`: its number or a part of its name; None: the first discrete GPU, or else the first that will do.
    `log`: a function of one str, called with notes for the user, from any thread. `memory_limit_bytes`: 0 is what the device has."""

    def __init__(self, name=None, log=None, memory_limit_bytes=0):
        self._log = _LOG(lambda user, line: log(line.decode())) if log else _LOG()
        info = _DeviceInfo(name=name.encode() if name else None, log=self._log, memory_limit_bytes=memory_limit_bytes)
        handle = _PTR()
        _check(_library.bsp_device_create(ctypes.byref(info), ctypes.byref(handle)))
        self._handle = _own(self, _library.bsp_device_destroy, handle, self._log)

    @property
    def name(self):
        return _library.bsp_device_name(self._handle).decode()


def _quaternion(m):
    """Of a rotation matrix: w, x, y, z."""
    # The greatest of the four components first, so that nothing is divided by a small number.
    squares = np.array([m[0, 0] + m[1, 1] + m[2, 2], m[0, 0] - m[1, 1] - m[2, 2], m[1, 1] - m[0, 0] - m[2, 2], m[2, 2] - m[0, 0] - m[1, 1]])
    products = np.array([[0, m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]], [0, 0, m[1, 0] + m[0, 1], m[0, 2] + m[2, 0]],
                         [0, 0, 0, m[2, 1] + m[1, 2]], [0, 0, 0, 0]])
    products = products + products.T + np.diag(squares + 1.0)
    row = products[int(np.argmax(squares))]
    return (ctypes.c_double * 4)(*(row / np.linalg.norm(row)))


def _placed(scene, matrix):
    """A scene where a matrix of a rotation, a scale and a place has it."""
    if not isinstance(scene, Scene):
        raise ValueError("beside has something that is no Scene")
    matrix = np.asarray(matrix, dtype=np.float64)
    if matrix.shape != (4, 4):
        raise ValueError(f"a matrix of beside has the shape {matrix.shape}, must be (4, 4)")
    scale = np.cbrt(np.linalg.det(matrix[:3, :3]))
    rotation = matrix[:3, :3] / scale if scale > 0 else np.zeros((3, 3))
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-4):
        raise ValueError("a matrix of beside is no rotation times a scale")
    return _Instance(scene=scene._scene, orientation=_quaternion(rotation), position=_DOUBLES3(*matrix[:3, 3]), scale=scale)


class View:
    """A camera.

    world_from_camera: (4, 4) matrix of a rotation and a place; angles: (4,) signed angles left, right, up, down from the axis, of a usual
    camera (-, +, +, -); width, height: pixels.
    """

    def __init__(self, world_from_camera, angles, width, height):
        matrix = np.asarray(world_from_camera, dtype=np.float64)
        if matrix.shape != (4, 4):
            raise ValueError(f"world_from_camera has the shape {matrix.shape}, must be (4, 4)")
        rotation = matrix[:3, :3]
        if not (np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-4) and np.linalg.det(rotation) > 0):
            raise ValueError("world_from_camera[:3, :3] is no rotation, must be orthonormal and right-handed")
        self.world_from_camera, self.angles = matrix, _vector("angles", angles, 4)
        self.width, self.height = int(width), int(height)

    @classmethod
    def from_intrinsics(cls, world_from_camera, fx, fy, cx, cy, width, height):
        """By focal lengths and the principal point in pixels; the middle of the first pixel is (0.5, 0.5)."""
        angles = (-math.atan(cx / fx), math.atan((width - cx) / fx), math.atan(cy / fy), -math.atan((height - cy) / fy))
        return cls(world_from_camera, angles, width, height)

    @classmethod
    def look_at(cls, eye, look, up, fov_x, width, height):
        """From `eye` to `look`, with square pixels; `up` points up. Each (3,)."""
        points = [_DOUBLES3(*_vector(name, value)) for name, value in (("eye", eye), ("look", look), ("up", up))]
        view = _View()
        _check(_library.bsp_look_at(*points, 0.0, fov_x, width, height, 1, ctypes.byref(view)))
        w, x, y, z = view.orientation
        matrix = np.eye(4)
        matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                          [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                          [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
        matrix[:3, 3] = view.position
        return cls(matrix, view.angles, width, height)

    def _structure(self):
        return _View(orientation=_quaternion(self.world_from_camera[:3, :3]), position=_DOUBLES3(*self.world_from_camera[:3, 3]),
                     angles=(ctypes.c_double * 4)(*self.angles), width=self.width, height=self.height)


def _rows(name, array, shape):
    """The array as rows of floats that lie together, and how the library finds them. None in `shape`: any length."""
    if not isinstance(array, np.ndarray) or array.dtype not in (np.float32, np.float64):
        raise ValueError(f"{name} is {getattr(array, 'dtype', type(array).__name__)}, must be a numpy array of float32 or float64")
    if array.ndim != len(shape) or any(want is not None and have != want for have, want in zip(array.shape, shape)):
        raise ValueError(f"{name} has the shape {array.shape}, must be ({', '.join('any' if n is None else str(n) for n in shape)})")
    array = array.astype(np.float32, copy=False)
    row_bytes = 4 * math.prod(array.shape[1:])
    if array.size and (array.strides[0] < row_bytes or (array.ndim > 1 and not array[0].flags.c_contiguous)):
        array = np.ascontiguousarray(array)
    return array, _Array(array.ctypes.data, array.strides[0] if len(array) > 1 else 0)


class Scene:
    """Splats on a device: Scene.from_file or Scene.from_arrays."""

    def __init__(self, device, info):
        self.device = device if device is not None else Device()
        scene, renderer = _PTR(), _PTR()
        _check(_library.bsp_scene_create(self.device._handle, ctypes.byref(info), ctypes.byref(scene)))
        self._scene = _own(self, _library.bsp_scene_destroy, scene, self.device)
        _check(_library.bsp_scene_wait(scene))
        _check(_library.bsp_renderer_create(self.device._handle, ctypes.byref(renderer)))
        self._renderer = _own(self, _library.bsp_renderer_destroy, renderer, self.device)
        self._properties = _SceneProperties()
        _check(_library.bsp_scene_get_properties(self._scene, ctypes.byref(self._properties)))

    @classmethod
    def from_file(cls, source, device=None, live=False):
        """A file of any format that binosplat reads, a folder, builtin:NAME, or an address on the web. device: None opens one.

        live: True: of a streamed scene, levels of detail come as views ask for them; a folder of numbered files moves, 30 files a second.
        """
        return cls(device, _SceneInfo(source=os.fspath(source).encode(), live=1 if live else 0))

    @classmethod
    def from_arrays(cls, positions, rotations, scales, opacities, sh, activated=False, antialiased=False, origin=(0, 0, 0), device=None):
        """Arrays of float32, or of float64 that are rounded to it; their first axis may have any stride.

        positions: (N, 3); rotations: (N, 4), w, x, y, z of any length but 0; scales: (N, 2) of discs (2DGS), (N, 3) of Gaussians (3DGS);
        opacities: (N,); sh: (N, K, 3) with K = 1, 4, 9 or 16, the constant coefficient first.
        activated: False: scales are logarithms and opacities logits, as trainings hold them; True: lengths, and 0 to 1.
        antialiased: Gaussians trained with opacities that the low-pass dims. origin: (3,), positions count from here, if they are far from 0.
        Splats with a NaN or an infinity are left out (`skipped`).
        """
        positions, at_positions = _rows("positions", positions, (None, 3))
        count = len(positions)
        rotations, at_rotations = _rows("rotations", rotations, (count, 4))
        scale_count = scales.shape[1] if isinstance(scales, np.ndarray) and scales.ndim == 2 and scales.shape[1] in (2, 3) else "2 or 3"
        scales, at_scales = _rows("scales", scales, (count, scale_count))
        opacities, at_opacities = _rows("opacities", opacities, (count,))
        degree = {1: 0, 4: 1, 9: 2, 16: 3}.get(sh.shape[1] if isinstance(sh, np.ndarray) and sh.ndim == 3 else None)
        sh, at_sh = _rows("sh", sh, (count, "1, 4, 9 or 16" if degree is None else (degree + 1) ** 2, 3))
        splats = _Splats(count=count, positions=at_positions, rotations=at_rotations, scales=at_scales, opacities=at_opacities, sh=at_sh,
                         scale_count=scale_count, sh_degree=degree, activated=int(activated), antialiased=int(antialiased),
                         origin=_DOUBLES3(*_vector("origin", origin)))
        return cls(device, _SceneInfo(splats=ctypes.pointer(splats)))

    def __len__(self):
        return self._properties.splats

    @property
    def skipped(self):
        """Splats that were left out."""
        return self._properties.skipped

    @property
    def bounds(self):
        """(2, 3): the box of all centres."""
        return np.array([self._properties.low, self._properties.high])

    @property
    def up(self):
        """(3,): a vector that points up."""
        return np.array(self._properties.up)

    def start_view(self, width, height, fov_x=1.2):
        """Where to begin, judged from the scene."""
        start = self._properties
        return View.look_at(start.eye, start.look, start.up, fov_x, width, height)

    def render(self, views, mode=None, background=(0, 0, 0), near=None, budget=0.2, cut=False, beside=(), time=0.0, error_bound=0.0):
        """Draws views, all of one size.

        views: a View or a sequence of them. mode: None draws each by itself, in full. Otherwise views are one or two pairs of eyes, left and
        right: "two-pass", "shared" (in full), "paper", "predicted" (the right one from the left one), or "temporal" (both from the frame before:
        call it along a path; cut=True forgets that frame). budget: 0 to 1, the share of the work that mends what was warped.
        background: (3,) red, green, blue, as displayed. near: the nearest depth that is drawn; None: the scene's.
        beside: pairs of a Scene on the same device and a (4, 4) matrix of a rotation, a scale and a place, where it is drawn with this one.
        time: in seconds, of a live scene that moves.
        error_bound: in dB, such as 28, for "temporal": tiles expected to be off by more are rendered first, within the budget. 0: no bound.

        Returns colour, (V, H, W, 4) float32: red, green, blue as displayed (not clamped) over the background, and alpha; and depth,
        (V, H, W) float32: along the camera's axis, the mean by what each splat adds to the pixel, 0 where there is nothing.
        """
        views = [views] if isinstance(views, View) else list(views) if isinstance(views, collections.abc.Iterable) else [None]
        if not views or not all(isinstance(view, View) for view in views):
            raise ValueError("views is no View and no sequence of them")
        if len({(view.width, view.height) for view in views}) != 1:
            raise ValueError("views have different sizes, must have one")
        if mode is not None and mode not in _MODES:
            raise ValueError(f"mode is {mode!r}, must be None or one of {', '.join(_MODES)}")
        if mode is not None and len(views) not in (2, 4):
            raise ValueError(f"there are {len(views)} views, must be 2 or 4 for the mode {mode}")
        instances = [_Instance(scene=self._scene)] + [_placed(scene, matrix) for scene, matrix in beside]
        placed = (_Instance * len(instances))(*instances) if beside else None
        colour = np.empty((len(views), views[0].height, views[0].width, 4), np.float32)
        depth = np.empty(colour.shape[:3], np.float32)
        background = _DOUBLES3(*_vector("background", background))
        step = len(views) if mode is not None else 1
        for first in range(0, len(views), step):
            array = (_View * step)(*[view._structure() for view in views[first:first + step]])
            frame = _FrameInfo(scene=None if placed else self._scene, views=array, view_count=step, mode=_MODES.get(mode, 0),
                               flags=_FLAG_DEPTH | _FLAG_SETTLED | (_FLAG_CUT if cut else 0), budget=budget if budget > 0 else -1.0,
                               near_depth=near or 0.0, background=background, instances=placed, instance_count=len(placed) if placed else 0,
                               time_s=time, error_bound_db=error_bound)
            _check(_library.bsp_render(self._renderer, ctypes.byref(frame), None))
            for index in range(step):
                _check(_library.bsp_read_colour(self._renderer, index, colour[first + index].ctypes.data, colour[0].size))
                _check(_library.bsp_read_depth(self._renderer, index, depth[first + index].ctypes.data, depth[0].size))
        return colour, depth
