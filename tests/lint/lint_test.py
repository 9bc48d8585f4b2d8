# The lint rules notice what they are for: each is shown a small tree with one violation.
# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import lint

HEAD = "// Models a thing.\n// SPDX-License-Identifier: Apache-2.0\n"


class LintNotices(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.write("tests/lint/layers.txt", (pathlib.Path(__file__).parent / "layers.txt").read_text())

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def test_an_include_up_the_layers(self):
        self.write("core/a.h", HEAD)
        self.write("isa/b.cpp", HEAD + '#include "core/a.h"\n')
        self.assertEqual(lint.layers(self.root), ["isa/b.cpp:3: isa may not include core/a.h"])

    def test_no_finding_for_an_include_down_the_layers(self):
        self.write("isa/a.h", HEAD)
        self.write("core/b.cpp", HEAD + '#include "isa/a.h"\n')
        self.assertEqual(lint.layers(self.root), [])

    def test_an_include_that_is_not_from_the_root(self):
        self.write("isa/a.h", HEAD)
        self.write("isa/b.cpp", HEAD + '#include "a.h"\n')
        self.assertEqual(len(lint.layers(self.root)), 1)

    def test_a_standard_header_that_only_another_compiler_brings(self):
        self.write("isa/a.h", HEAD + "#pragma once\n#include <vector>\nstd::vector<uint32_t> f();  // std::map\n")
        self.assertEqual(lint.includes(self.root), ["isa/a.h: uses <cstdint> and does not include it"])

    def test_no_finding_for_a_standard_header_that_the_own_header_includes(self):
        self.write("isa/a.h", HEAD + "#pragma once\n#include <vector>\nstd::vector<int> f();\n")
        self.write("isa/a.cpp", HEAD + '#include "isa/a.h"\nstd::vector<int> f() {\n  return {};\n}\n')
        self.assertEqual(lint.includes(self.root), [])

    def test_a_layout_that_is_not_the_formatters(self):
        if lint.clang_format() is None:
            self.skipTest("clang-format of the tree's version is not installed")
        self.write(".clang-format", (pathlib.Path(__file__).parents[2] / ".clang-format").read_text())
        self.write("isa/a.cpp", HEAD + "int  f() { return 1; }\n")
        self.assertEqual(lint.layout(self.root), ["isa/a.cpp:3: clang-format -i would change it"])

    def test_a_long_file(self):
        self.write("isa/a.cpp", HEAD + "\n" * lint.MAX_FILE_LINES)
        self.assertEqual(len(lint.sizes(self.root)), 1)

    def test_a_long_function_and_not_a_short_one(self):
        body = "  x();\n"
        self.write("isa/a.cpp", HEAD + "int f() {\n" + body * 50 + "}\nint g(int a,\n      int b) {\n" + body * 90 + "}\n")
        findings = lint.sizes(self.root)
        self.assertEqual(len(findings), 1)
        self.assertIn("isa/a.cpp:55 g: 93 lines", findings[0])

    def test_a_missing_sentence_licence_and_guard(self):
        self.write("isa/a.h", "int x;\n")
        self.assertEqual(len(lint.headers(self.root)), 3)

    def test_a_folder_of_tests_that_its_readme_does_not_name(self):
        self.write("tests/README.md", "| `lint/` | rules |\n| `old/` | what was there once |\n")
        self.write("tests/other/a_test.cpp", HEAD)
        found = [problem for problem in lint.readmes(self.root) if problem.startswith("tests/")]
        self.assertEqual(found, ["tests/README.md: does not name other/"])

    def test_a_rule_whose_test_does_not_exist_and_one_without_a_test(self):
        self.write("tests/a_test.cpp", HEAD + 'TEST_CASE("one is one") {}\n')
        self.write("tests/b_test.py", "def test_two(self):\n")
        self.write("docs/semantics.md", "# Rules\n- One. *one is one*; *test_two*\n- Two. *two is two*\n- Three.\n")
        self.assertEqual(lint.semantics(self.root), ["docs/semantics.md:3: there is no test 'two is two'", "docs/semantics.md:4: names no test"])

    def test_a_path_in_the_docs_that_does_not_exist(self):
        self.write("docs/a.md", "See `docs/b.md` and `docs/a.md`.\n")
        self.assertEqual(lint.doc_paths(self.root), ["docs/a.md:1: docs/b.md does not exist"])

    def test_loose_ends_and_printing_libraries(self):
        self.write("isa/a.cpp", HEAD + "// TO" + "DO later\nprintf(\"x\");\nauto s = snprintf(b, 1, f);\n")
        self.write("apps/glint/a.cpp", HEAD + "printf(\"x\");\n")
        self.assertEqual(len(lint.wording(self.root)), 2)


if __name__ == "__main__":
    unittest.main()
