#!/usr/bin/env python3
"""Makes api/profile_tables.h from OpenXR's registry: which paths each interaction profile has, and with which versions and extensions.

    python3 xr/simulated/make_profile_tables.py xr.xml | clang-format > xr/simulated/api/profile_tables.h

xr.xml stands in specification/registry/ of Debian's source package openxr-sdk-source (apt-get source openxr-sdk-source/sid); take the newest.
What counts are the profiles and the <extend> blocks that <feature> and <extension> require, each with its `depends`. Extensions that
extensions.h does not list are not offered, so what needs them is left out. A new profile of an offered extension wants a line in PLAYED.
unregistered.xml has what runtimes have and the registry does not, yet.
"""
import itertools
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

PREFIX = "/interaction_profiles/"
# In the order in which the simulated controllers like to play them, those that they cannot play last; and
# what a person calls them.
PLAYED = {
    "oculus/touch_controller": "Touch controller",
    "valve/index_controller": "Index controller",
    "microsoft/motion_controller": "Motion controller",
    "htc/vive_controller": "Vive controller",
    "khr/simple_controller": "Simple controller",
    "oculus/go_controller": "Go controller",
    "google/daydream_controller": "Daydream controller",
    "meta/touch_plus_controller": "Touch Plus controller",
    "meta/touch_pro_controller": "Touch Pro controller",
    "meta/touch_controller_quest_2": "Quest 2 controller",
    "meta/touch_controller_quest_1_rift_s": "Quest 1 and Rift S controller",
    "meta/touch_controller_rift_cv1": "Rift CV1 controller",
    "bytedance/pico4_controller": "PICO 4 controller",
    "bytedance/pico_neo3_controller": "PICO Neo3 controller",
    "bytedance/pico_g3_controller": "PICO G3 controller",
    "htc/vive_cosmos_controller": "Vive Cosmos controller",
    "htc/vive_focus3_controller": "Vive Focus 3 controller",
    "hp/mixed_reality_controller": "HP controller",
    "samsung/odyssey_controller": "Odyssey controller",
    "ml/ml2_controller": "Magic Leap 2 controller",
    "bytedance/pico_ultra_controller_bd": "PICO Ultra controller",
    "varjo/xr-4_controller": "XR-4 controller",
    "yvr/touch_controller_yvr": "YVR controller",
    "oppo/mr_controller_oppo": "OPPO controller",
    "huawei/controller": "Huawei controller",
    "valve/frame_controller_valve": "Frame controller",
    "khr/generic_controller": "Generic controller",
    "logitech/mx_ink_stylus_logitech": "MX Ink",
    "facebook/touch_controller_pro": "Touch Pro controller",
    "meta/touch_controller_plus": "Touch Plus controller",
    "ext/hand_interaction_ext": "Hand",
    "microsoft/hand_interaction": "Hand",
    "htc/vive_pro": "Vive Pro headset",
    "microsoft/xbox_controller": "Xbox controller",
    "ext/eye_gaze_interaction": "Eye tracker",
}
KINDS = {
    "XR_ACTION_TYPE_BOOLEAN_INPUT": "kBoolean",
    "XR_ACTION_TYPE_FLOAT_INPUT": "kFloat",
    "XR_ACTION_TYPE_POSE_INPUT": "kPose",
    "XR_ACTION_TYPE_VIBRATION_OUTPUT": "kVibration",
}
VECTOR = "XR_ACTION_TYPE_VECTOR2F_INPUT"
VERSIONS = {"XR_VERSION_1_0": frozenset(), "XR_VERSION_1_1": frozenset({"XR_VERSION_1_1"})}


class Profile:
    def __init__(self, element):
        self.name = element.get("name").removeprefix(PREFIX)
        self.user_paths = [path.get("path") for path in element.findall("user_path")]
        # Each way to have the profile or the component is a set of names that all have to be there.
        self.ways = set()
        self.components = {}
        for component in element.findall("component"):
            self.add(component, None)

    def add(self, component, way):
        """`way` is None for what the profile has wherever it is."""
        key = component.get("user_path", ""), component.get("subpath")
        kind, ways = self.components.setdefault(key, (component.get("type"), set()))
        if kind != component.get("type"):
            sys.exit(f"{self.name}{key[1]}: two types, {kind} and {component.get('type')}")
        ways.add(way)


def ways_of(depends):
    """The registry's `depends`: + is and, a comma is or; brackets are not used for what is read here."""
    if "(" in depends:
        sys.exit(f"depends=\"{depends}\": brackets are not understood")
    return [frozenset(way.split("+")) - {"XR_VERSION_1_0"} for way in depends.split(",")]


def read(root, offered):
    profiles = {one.name: one for one in map(Profile, root.iter("interaction_profile")) if one.user_paths}
    for owner in itertools.chain(root.iter("feature"), root.find("extensions")):
        name = owner.get("name")
        if name not in VERSIONS and name not in offered:
            continue
        for require in owner.findall("require"):
            for way in ways_of(require.get("depends", "XR_VERSION_1_0")):
                way |= VERSIONS.get(name, frozenset({name}))
                if not way <= offered | {"XR_VERSION_1_1"}:
                    continue
                for one in require.findall("interaction_profile"):
                    profiles[one.get("name").removeprefix(PREFIX)].ways.add(way)
                for extend in require.findall("extend[@interaction_profile_path]"):
                    for component in extend.findall("component"):
                        profiles[extend.get("interaction_profile_path").removeprefix(PREFIX)].add(component, way)
    return [one for one in profiles.values() if one.ways]


def holds(ways, names):
    return any(way <= names for way in ways)


def simplest(ways, given):
    """The same condition wherever `given` holds, with as few names as there can be."""
    names = sorted(set().union(*ways, *given))
    worlds = [set(world) for n in range(len(names) + 1) for world in itertools.combinations(names, n)]
    worlds = [world for world in worlds if holds(given, world)]
    wanted = [holds(ways, world) for world in worlds]
    is_same = lambda tried: [holds(tried, world) for world in worlds] == wanted
    ways = set(ways)
    for way in sorted(ways, key=sorted):
        for name in sorted(way):
            shorter = way - {name}
            if is_same(ways - {way} | {shorter}):
                ways = ways - {way} | {shorter}
                way = shorter
    for way in sorted(ways, key=sorted):
        if is_same(ways - {way}):
            ways.remove(way)
    # The core's version first.
    return ",".join("+".join(sorted(way)) for way in sorted(ways, key=lambda way: (min(way, default="") != "XR_VERSION_1_1", sorted(way))))


def constant(path):
    return "k" + "".join(word.capitalize() for word in re.split(r"\W|_", path) if word)


def write_row(items):
    """As many to a line as fit."""
    line = "   "
    for item in items:
        if len(line) + len(item) > 109:
            print(line)
            line = "   "
        line += f" {item},"
    print(line)


def write_components(profile):
    items = []
    for (user_path, path), (kind, ways) in profile.components.items():
        if kind == VECTOR:
            if not {(user_path, path + axis) for axis in ("/x", "/y")} <= profile.components.keys():
                sys.exit(f"{profile.name}{path}: a vector without its parts")
            continue
        depends = simplest([way for way in ways], profile.ways) if None not in ways else ""
        user = f"\"{user_path}\"" if user_path else "{}"
        items.append(f"{{{KINDS[kind]}, \"{path}\"" + (f", {user}" if user_path or depends else "") + (f", \"{depends}\"" if depends else "") + "}")
    print(f"inline constexpr Component {constant(profile.name)}[] = {{")
    write_row(items)
    print("};")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = ElementTree.parse(sys.argv[1]).getroot()
    version = next(re.search(r"\((\d+), *(\d+), *(\d+)\)", "".join(one.itertext())) for one in root.iter("type")
                   if one.findtext("name") == "XR_CURRENT_API_VERSION")
    for added in ElementTree.parse(pathlib.Path(__file__).parent / "unregistered.xml").getroot():
        root.find(added.tag).extend(added)
    listed = (pathlib.Path(__file__).parent / "extensions.h").read_text()
    profiles = read(root, set(re.findall(r"\{\"(XR_\w+)\", \d+\}", listed)))
    new = [one.name for one in profiles if one.name not in PLAYED]
    gone = PLAYED.keys() - {one.name for one in profiles}
    if new or gone:
        sys.exit(f"PLAYED lacks {new}, and has without need {sorted(gone)}")
    profiles.sort(key=lambda one: list(PLAYED).index(one.name))
    print(f"// Which paths each interaction profile has, as the registry of OpenXR {'.'.join(version.groups())} (xr.xml) lists them. Made by")
    print("// make_profile_tables.py, which says how; not to be edited. Vectors such as /input/thumbstick stand here as their parts.")
    print("#pragma once\n\n#include \"xr/simulated/api/profiles.h\"\n\nnamespace simulated {\n\nusing enum ComponentKind;\n")
    groups = {}
    for profile in profiles:
        groups.setdefault(tuple(profile.user_paths), "kHands" if len(profile.user_paths) == 2 else constant(profile.user_paths[0]))
    for paths, name in groups.items():
        print(f"inline constexpr std::string_view {name}[] = {{" + ", ".join(f"\"{path}\"" for path in paths) + "};")
    print("\n// clang-format off")
    for profile in profiles:
        write_components(profile)
    print("// clang-format on\n\ninline constexpr Profile kProfiles[] = {")
    for profile in profiles:
        depends = simplest(profile.ways, [frozenset()])
        print(f"    {{\"{PREFIX}{profile.name}\", \"{PLAYED[profile.name]}\", {groups[tuple(profile.user_paths)]}, {constant(profile.name)}"
              + (f", \"{depends}\"" if depends else "") + "},")
    print("};\n\n}  // namespace simulated")


if __name__ == "__main__":
    main()
