#!/usr/bin/env python3
# Writes the driver's tables of commands, features, properties and extensions from the Vulkan registry.
# SPDX-License-Identifier: Apache-2.0
"""usage: vulkan_entry.py REGISTRY ANNOUNCED SOURCE_DIR OUTPUT_DIR

REGISTRY is vk.xml, ANNOUNCED is vulkan/announced.toml, and SOURCE_DIR is the folder in which commands are written by hand: a
function `VkResult CreateBuffer(Device& device, ...)` at the start of a line there is the command vkCreateBuffer. A file
newer_extensions.xml beside ANNOUNCED describes extensions that the registry may be too old for. Writes
entry_table.cpp and announced.cpp to OUTPUT_DIR. A file whose text would not change is not touched.
"""
import pathlib
import re
import sys
import tomllib
import xml.etree.ElementTree as xml

NEWEST = (1, 3)  # the version of Vulkan whose commands, features and properties the driver has
OBJECTS = {"VkInstance": "Instance", "VkPhysicalDevice": "PhysicalDevice", "VkDevice": "Device", "VkQueue": "Queue",
           "VkCommandBuffer": "CommandBuffer"}
WITHOUT_OBJECT = {"vkGetInstanceProcAddr"}  # The instance may be null.
LEVELS = {"VkInstance": "OfInstance", "VkPhysicalDevice": "OfPhysicalDevice"}  # of the other objects: OfDevice
ALLOCATOR = "const VkAllocationCallbacks*"  # The driver never uses one, so functions do not get it.


class Wrong(Exception):
    """A mistake in announced.toml."""


def is_vulkan(element):
    return "vulkan" in (element.get("api") or element.get("supported") or "vulkan").split(",")


def text_of(element):
    """Returns the C text of a parameter or member without its comment."""
    parts = [element.text or ""]
    for child in element:
        parts += ["" if child.tag == "comment" else "".join(child.itertext()), child.tail or ""]
    return re.sub(r"\s+\*", "*", " ".join("".join(parts).split()))


class Command:
    def __init__(self, element):
        proto = element.find("proto")
        self.name, self.result = proto.find("name").text, proto.find("type").text
        params = [p for p in element.findall("param") if is_vulkan(p)]
        self.params = [(text_of(p), p.find("type").text, p.find("name").text) for p in params]
        self.object = None if self.name in WITHOUT_OBJECT else OBJECTS.get(self.params[0][1])
        self.level = "OfAll"
        if self.object:
            self.level = LEVELS.get(self.params[0][1], "OfDevice")

    def own_params(self):
        """Returns the parameters of the function that is written by hand."""
        rest = self.params[1:] if self.object else self.params
        return [(text, name) for text, _, name in rest if not text.startswith(ALLOCATOR)]

    def own_name(self):
        return self.name.removeprefix("vk")


class Registry:
    def __init__(self, path):
        root = xml.parse(path).getroot()
        self.commands, self.aliases = {}, {}
        for element in root.find("commands"):
            if element.get("alias"):
                self.aliases[element.get("name")] = element.get("alias")
            elif is_vulkan(element):
                command = Command(element)
                self.commands[command.name] = command
        self.structs = {t.get("name"): t for t in root.iterfind("types/type[@category='struct']")
                        if not t.get("alias") and is_vulkan(t)}
        self.type_aliases = {t.get("name"): t.get("alias") for t in root.iterfind("types/type[@category='struct']")
                             if t.get("alias")}
        self.features = [f for f in root.iterfind("feature") if is_vulkan(f)
                         and tuple(map(int, f.get("number").split("."))) <= NEWEST]
        self.formats = [e.get("name") for e in root.iterfind("enums[@name='VkFormat']/enum") if e.get("value")]
        self.extensions = {e.get("name"): e for e in root.iterfind("extensions/extension") if is_vulkan(e)}

    def add_newer(self, path):
        """Takes those extensions of a file that the registry does not have, with their structures."""
        root = xml.parse(path).getroot()
        for element in root.iterfind("extensions/extension"):
            self.extensions.setdefault(element.get("name"), element)
        for struct in root.iterfind("types/type[@category='struct']"):
            self.structs.setdefault(struct.get("name"), struct)

    def command(self, name):
        while name in self.aliases:
            name = self.aliases[name]
        return self.commands[name]


def required(element, tag, extensions):
    """Yields the names of commands or types that a version or an extension brings, given the other extensions."""
    for require in element.iterfind("require"):
        condition = require.get("extension") or require.get("depends") or ""
        if is_vulkan(require) and is_met(condition, extensions):
            for child in require.iterfind(tag):
                yield child.get("name")


def is_met(condition, extensions):
    """Evaluates a `depends` such as "(A,VK_VERSION_1_1)+B"; versions up to NEWEST are there."""
    tokens = re.findall(r"[\w:]+|[(),+]", condition)
    words = {"(": "(", ")": ")", "+": " and ", ",": " or "}

    def value(word):
        version = re.fullmatch(r"VK_VERSION_(\d)_(\d)", word)
        return str(word in extensions or bool(version) and tuple(map(int, version.groups())) <= NEWEST)
    return not tokens or eval("".join(words.get(t) or value(t) for t in tokens))  # only True, False, and, or


def check_extensions(registry, announced):
    names = announced["instance_extensions"] + announced["device_extensions"]
    for kind in ("instance", "device"):
        for name in announced[f"{kind}_extensions"]:
            if name not in registry.extensions:
                continue  # The registry is older than the extension.
            element = registry.extensions[name]
            if element.get("type") != kind:
                raise Wrong(f"{name} is not an extension of a{'n' if kind == 'instance' else ''} {kind}")
            # An extension that a version has taken in counts as there.
            promoted = {n for n, e in registry.extensions.items() if is_met(e.get("promotedto") or "none", ())}
            condition = element.get("depends") or (element.get("requires") or "").replace(",", "+")
            if not is_met(condition, set(names) | promoted):
                raise Wrong(f"{name} needs {condition}, which is not announced")
    return [n for n in names if n in registry.extensions]


def written_commands(registry, folder):
    found = set()
    for path in sorted(folder.rglob("*.cpp")):
        for name in re.findall(r"^\w[\w ]*[ *&]+(\w+)\(", path.read_text(), re.M):
            if "vk" + name in registry.commands:
                found.add("vk" + name)
    return found


def signature(command):
    first = [f"{command.object}& object"] if command.object else []
    return f"{command.result} {command.own_name()}({', '.join(first + [t for t, _ in command.own_params()])})"


def trampoline(command, is_written):
    used = {name for _, name in command.own_params()} | ({command.params[0][2]} if command.object else set())
    params = ", ".join(text if is_written and name in used else re.sub(rf"\b{name}\b", "", text)
                       for text, _, name in command.params)
    handle = command.params[0][2]
    head = f"VKAPI_ATTR {command.result} VKAPI_CALL call_{command.own_name()}({params}) {{\n"
    if not is_written:
        return head + (f"  static Once said;\n"
                       f"  return not_written<{command.result}>(\"{command.name}\", said);\n}}\n")
    arguments = ", ".join(([f"*{handle}"] if command.object else []) + [name for _, name in command.own_params()])
    # An object that is destroyed cannot be locked, because its lock goes with it.
    is_last = command.own_name() == f"Destroy{command.object}"
    guard = f"guarded<{command.result}>(\"{command.name}\", {'nullptr' if is_last or not command.object else handle}"
    out = head
    if is_last:
        out += f"  if (!{handle}) return;\n"
    return out + f"  return {guard}, [&] {{ return {command.own_name()}({arguments}); }});\n}}\n"


HEAD = """// Written by tools/vulkan_entry.py from the Vulkan registry and from vulkan/announced.toml.
// SPDX-License-Identifier: Apache-2.0
"""


def entry_table(registry, extensions, folder):
    """Returns entry_table.cpp: declarations, trampolines, and the sorted table of names."""
    sources = {}  # by name: the extensions that bring it, or nothing for the core
    for feature in registry.features:
        for name in required(feature, "command", extensions):
            sources[name] = []
    for extension in extensions:
        for name in required(registry.extensions[extension], "command", extensions):
            if sources.setdefault(name, [extension]):
                sources[name] = sorted({*sources[name], extension})
    written = written_commands(registry, folder)
    used = {registry.command(name).name: registry.command(name) for name in sources}
    missing = sorted(n for n, e in sources.items() if e and registry.command(n).name not in written)
    if missing:
        raise Wrong("these commands of announced extensions are not written: " + " ".join(missing))
    out = [HEAD + '#include "vulkan/guard.h"\n\nnamespace glint::vulkan {\n']
    out += [signature(c) + ";\n" for c in used.values() if c.name in written]
    out.append("\nnamespace {\n\n")
    out += [trampoline(c, c.name in written) + "\n" for c in used.values()]
    out.append("constexpr EntryPoint kEntryPoints[] = {\n")
    for name in sorted(sources):
        command = registry.command(name)
        function = f"PFN_vkVoidFunction(&call_{command.own_name()})"
        out.append(f'    {{"{name}", {function}, Level::{command.level}, "{" ".join(sources[name])}"}},\n')
    out.append("};\n\n}  // namespace\n\n")
    out.append("std::span<const EntryPoint> entry_points() {\n  return kEntryPoints;\n}\n\n}  // namespace glint::vulkan\n")
    return "".join(out).replace("constexpr EntryPoint", "const EntryPoint")


def structs_that_extend(registry, base, extensions):
    """Returns the structures that may hang on `base`, of the core and of announced extensions, sorted."""
    names = set()
    for source in registry.features + [registry.extensions[e] for e in extensions]:
        names |= {registry.type_aliases.get(n, n) for n in required(source, "type", extensions)}
    return sorted(n for n in names if n in registry.structs
                  and base in (registry.structs[n].get("structextends") or "").split(","))


def members_of(struct):
    """Returns (name, text) of the members after sType and pNext, and the value of sType."""
    members = [m for m in struct.findall("member") if is_vulkan(m)]
    s_type = next((m.get("values") for m in members if m.find("name").text == "sType"), None)
    return [(m.find("name").text, text_of(m)) for m in members
            if m.find("name").text not in ("sType", "pNext")], s_type


def feature_tables(registry, extensions, announced):
    wanted, known, out, rows = set(announced["features"]), set(), [], []
    with_graphics = wanted | set(announced["universal_features"])
    structs = ["VkPhysicalDeviceFeatures"] + structs_that_extend(registry, "VkPhysicalDeviceFeatures2", extensions)
    for name in structs:
        members, s_type = members_of(registry.structs[name])
        known |= {member for member, _ in members}
        out.append(f"const Feature k{name}[] = {{\n")
        out += [f'    {{"{member}", {str(member in wanted).lower()}, {str(member in with_graphics).lower()}}},\n' for member, _ in members]
        out.append("};\n")
        rows.append(f"    {{{s_type or 'VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2'}, k{name}}},\n")
    if with_graphics - known:
        raise Wrong("no announced version or extension has these features: " + " ".join(sorted(with_graphics - known)))
    return "".join(out) + "const FeatureStruct kFeatureStructs[] = {\n" + "".join(rows) + "};\n"


def property_functions(registry, extensions):
    out = ["// Fills one structure of a pNext chain, if it is one of those that the driver knows.\n"
           "void fill_properties(VkBaseOutStructure* base, const DeviceProperties& from) {\n  switch (int(base->sType)) {\n"]
    for name in structs_that_extend(registry, "VkPhysicalDeviceProperties2", extensions):
        members, s_type = members_of(registry.structs[name])
        out.append(f"    case {s_type}: {{\n      auto& to = *reinterpret_cast<{name}*>(base);\n")
        out += [f"      assign(to.{member}, from.{member});\n" for member, _ in members]
        out.append("      break;\n    }\n")
    return "".join(out) + "    default:\n      break;\n  }\n}\n"


def extension_table(registry, extensions, announced, kind):
    names = [n for n in announced[f"{kind}_extensions"] if n in extensions]
    out = [f"const VkExtensionProperties k{kind.title()}Extensions[] = {{\n"]
    for name in sorted(names):
        version = next(e for e in registry.extensions[name].iter("enum")
                       if e.get("name").endswith("_SPEC_VERSION")).get("value")
        out.append(f'    {{"{name}", {version}}},\n')
    return "".join(out) + "};\n"


def format_names(registry):
    rows = "".join(f"    case {name}:\n      return \"{name}\";\n" for name in registry.formats)
    return ("std::string_view name_of(VkFormat format) {\n  switch (int(format)) {\n" + rows
            + "    default:\n      return {};\n  }\n}\n\n")


def announced_tables(registry, extensions, announced):
    return (HEAD + '#include "vulkan/announced.h"\n\nnamespace glint::vulkan {\nnamespace {\n\n'
            + extension_table(registry, extensions, announced, "instance")
            + extension_table(registry, extensions, announced, "device")
            + feature_tables(registry, extensions, announced) + "\n}  // namespace\n\n"
            + "std::span<const VkExtensionProperties> instance_extensions() {\n  return kInstanceExtensions;\n}\n"
            + "std::span<const VkExtensionProperties> device_extensions() {\n  return kDeviceExtensions;\n}\n"
            + "std::span<const FeatureStruct> feature_structs() {\n  return kFeatureStructs;\n}\n\n"
            + format_names(registry) + property_functions(registry, extensions) + "\n}  // namespace glint::vulkan\n")


def write(path, text):
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def main(registry_path, announced_path, source_dir, output_dir):
    registry = Registry(registry_path)
    newer = pathlib.Path(announced_path).with_name("newer_extensions.xml")
    if newer.exists():
        registry.add_newer(newer)
    announced = tomllib.loads(pathlib.Path(announced_path).read_text())
    output = pathlib.Path(output_dir)
    output.mkdir(parents=True, exist_ok=True)
    try:
        extensions = check_extensions(registry, announced)
        write(output / "entry_table.cpp", entry_table(registry, extensions, pathlib.Path(source_dir)))
        write(output / "announced.cpp", announced_tables(registry, extensions, announced))
    except Wrong as wrong:
        sys.exit(f"{announced_path}: error: {wrong}")


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
