# Says which header of the standard library a file uses and does not include.
# SPDX-License-Identifier: Apache-2.0
"""usage: includes.py SOURCE_DIR [--fix]; prints the missing includes, or adds them. lint.py runs it as the rule `includes`.

A header that arrives only through another one arrives with one compiler and not with the next: g++ 14 brings <cstdint> in
fewer places than g++ 12. A source may rely on what a header of ours that it includes names itself.
"""
import pathlib
import re
import sys

# What makes a header necessary. Each pattern is searched in the code without comments and strings.
USES = {
    "cstdint": r"\b(?:std::)?u?int(?:8|16|32|64)_t\b|\buintptr_t\b",
    "string": r"\bstd::(?:string|to_string)\b(?!_view)",
    "string_view": r"\bstd::string_view\b",
    "vector": r"\bstd::vector\b",
    "array": r"\bstd::array\b",
    "optional": r"\bstd::(?:optional|nullopt)\b",
    "functional": r"\bstd::function\b",
    "memory": r"\bstd::(?:unique_ptr|shared_ptr|make_unique|make_shared|weak_ptr)\b",
    "map": r"\bstd::(?:multi)?map\b",
    "set": r"\bstd::(?:multi)?set\b",
    "span": r"\bstd::span\b",
    "utility": r"\bstd::(?:pair|move|exchange|swap|forward)\b",
    "variant": r"\bstd::variant\b",
    "tuple": r"\bstd::(?:tuple|tie)\b",
    "atomic": r"\bstd::atomic\b",
    "thread": r"\bstd::(?:thread|jthread)\b",
    "mutex": r"\bstd::(?:mutex|lock_guard|unique_lock|scoped_lock)\b",
    "deque": r"\bstd::deque\b",
    "bit": r"\bstd::(?:bit_cast|popcount|countr_zero|countl_zero|bit_width|has_single_bit|countr_one)\b",
    "limits": r"\bstd::numeric_limits\b",
    "cstring": r"\bstd::(?:memcpy|memset|memcmp|memmove|strlen)\b",
    "cmath": r"\bstd::(?:sqrt|abs|floor|ceil|isnan|isinf|isfinite|fma|pow|sin|cos|lround|nextafter|ldexp)\b(?=\()",
    "algorithm": r"\bstd::(?:sort|min|max|clamp|find|find_if|any_of|all_of|none_of|copy|copy_n|fill|fill_n|stable_sort|lower_bound|upper_bound|unique|reverse|transform|count|count_if|min_element|max_element|nth_element|equal|remove_if|replace)\b(?=\()",
    "filesystem": r"\bstd::filesystem\b",
    "fstream": r"\bstd::(?:ifstream|ofstream)\b",
    "sstream": r"\bstd::(?:o|i)?stringstream\b",
    "cstddef": r"\bstd::(?:byte|ptrdiff_t)\b|\boffsetof\b",
    "chrono": r"\bstd::chrono\b",
    "type_traits": r"\bstd::(?:is_same_v|conditional_t|is_integral_v|is_floating_point_v|type_identity_t|decay_t|remove_cvref_t|underlying_type_t)\b",
    "numeric": r"\bstd::(?:accumulate|iota|gcd|lcm|reduce)\b",
    "unordered_map": r"\bstd::unordered_map\b",
    "unordered_set": r"\bstd::unordered_set\b",
    "initializer_list": r"\bstd::initializer_list\b",
    "stdexcept": r"\bstd::(?:runtime_error|logic_error|invalid_argument|out_of_range)\b",
    "exception": r"\bstd::(?:exception|exception_ptr|current_exception|rethrow_exception)\b",
    "bitset": r"\bstd::bitset\b",
    "random": r"\bstd::mt19937",
    "condition_variable": r"\bstd::condition_variable\b",
    "queue": r"\bstd::(?:queue|priority_queue)\b",
    "list": r"\bstd::list\b",
    "iterator": r"\bstd::(?:back_inserter|istreambuf_iterator|istream_iterator)\b",
    "concepts": r"\bstd::(?:same_as|integral|floating_point|convertible_to)\b",
}
PATTERNS = {header: re.compile(pattern) for header, pattern in USES.items()}


def code_of(text):
    """Returns the text without comments, strings and raw strings."""
    text = re.sub(r'R"(\w*)\(.*?\)\1"', '""', text, flags=re.S)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)
    return re.sub(r"//[^\n]*", "", text)


def included(text):
    return set(re.findall(r"#include <([^>]+)>", text))


def missing(root, path):
    """Returns the headers of the standard library that the file uses, in alphabetical order, less those that it has."""
    text = path.read_text()
    present = included(text)
    if path.suffix == ".cpp":
        for name in re.findall(r'#include "([^"]+)"', text):
            if (root / name).exists():
                present |= included((root / name).read_text())
    code = code_of(text)
    return sorted(header for header, pattern in PATTERNS.items() if header not in present and pattern.search(code))


def add(path, headers):
    """Writes the includes in front of the first include of its kind; clang-format sorts them."""
    lines = path.read_text().split("\n")
    places = [i for i, line in enumerate(lines) if line.startswith("#include <")]
    if not places:
        places = [i + 1 for i, line in enumerate(lines) if line == "#pragma once" or line.startswith("// SPDX")][-1:]
    lines[places[0]:places[0]] = [f"#include <{header}>" for header in headers]
    path.write_text("\n".join(lines))


def problems(root, paths, fix=False):
    found = []
    for path in paths:
        headers = missing(root, path)
        if headers and fix:
            add(path, headers)
        found += [f"{path.relative_to(root)}: uses <{header}> and does not include it" for header in headers]
    return found


def main():
    import lint
    root = pathlib.Path(sys.argv[1]).resolve()
    found = problems(root, lint.files(root, lint.SOURCE_FOLDERS + ["tests"]), fix="--fix" in sys.argv)
    print("\n".join(found + [f"{len(found)} findings"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
