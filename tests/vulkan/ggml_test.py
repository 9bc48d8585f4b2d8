# Tests ggml's Vulkan backend, which nobody wrote for Glint: its numbers are those of ggml's own CPU backend.
# SPDX-License-Identifier: Apache-2.0
"""usage: ggml_test.py MANIFEST SOURCE_DIR
       ggml_test.py MANIFEST SOURCE_DIR graph FOLDER

GLINT_NODE_MODULES names the folder in which npm installed @node-llama-cpp/linux-x64-vulkan, whose libraries have a C
interface. With "graph" the script computes with the libraries of FOLDER in its own process; the test calls it so.
"""
import ctypes
import json
import pathlib
import random
import sys

import vulkan_case
from vulkan_case import MANIFEST, ROOT, VulkanTest

K, ROWS, COLUMNS = 64, 32, 16
F32 = 0  # ggml's number of the type


class GraphSize(ctypes.Structure):
    """What ggml_init takes."""
    _fields_ = [("bytes", ctypes.c_size_t), ("memory", ctypes.c_void_p), ("no_alloc", ctypes.c_bool)]


class Ggml:
    def __init__(self, folder):
        names = ("libggml-base.so", "libggml-vulkan.so", "libggml-cpu-x64.so")
        self.libraries = [ctypes.CDLL(str(folder / name), ctypes.RTLD_GLOBAL) for name in names]

    def call(self, name, result, *arguments):
        """Calls ggml_NAME. Pointers are ints, so every argument that is not a ctypes value is a pointer."""
        function = next(getattr(each, "ggml_" + name) for each in self.libraries if hasattr(each, "ggml_" + name))
        function.restype = result
        return function(*[ctypes.c_void_p(each) if isinstance(each, int) or each is None else each for each in arguments])

    def tensor(self, name, *arguments):
        return self.call(name, ctypes.c_void_p, *arguments)

    def compute(self, backend, build):
        """Returns the numbers of the tensor that build(context, a, b, c) makes on a backend."""
        context = self.tensor("init", GraphSize(16 << 20, None, True))
        shapes = ((K, ROWS), (K, COLUMNS), (ROWS, COLUMNS))
        inputs = [self.tensor("new_tensor_2d", context, ctypes.c_int(F32), ctypes.c_int64(w), ctypes.c_int64(h)) for w, h in shapes]
        out = build(context, *inputs)
        graph = self.tensor("new_graph", context)
        self.call("build_forward_expand", None, graph, out)
        self.tensor("backend_alloc_ctx_tensors", context, backend)
        numbers = random.Random(1)
        for tensor, (width, height) in zip(inputs, shapes):
            values = (ctypes.c_float * (width * height))(*[numbers.uniform(-1, 1) for _ in range(width * height)])
            self.call("backend_tensor_set", None, tensor, values, ctypes.c_size_t(0), ctypes.c_size_t(ctypes.sizeof(values)))
        status = self.call("backend_graph_compute", ctypes.c_int, backend, graph)
        if status:
            sys.exit(f"ggml_backend_graph_compute returned {status}")
        result = (ctypes.c_float * (ROWS * COLUMNS))()
        self.call("backend_tensor_get", None, out, result, ctypes.c_size_t(0), ctypes.c_size_t(ctypes.sizeof(result)))
        return list(result)

    def graphs(self):
        def product(context, a, b, _):
            return self.tensor("mul_mat", context, a, b)

        def soft_max(context, a, b, c):
            return self.tensor("soft_max", context, product(context, a, b, c))

        def block(context, a, b, c):
            norm = self.tensor("rms_norm", context, product(context, a, b, c), ctypes.c_float(1e-5))
            return self.tensor("soft_max", context, self.tensor("gelu", context, self.tensor("add", context, norm, c)))
        return {"product": product, "soft_max": soft_max, "block": block}


def print_differences(folder):
    """Prints for every graph how far the Vulkan backend is from the CPU backend."""
    ggml = Ggml(folder)
    backends = [ggml.tensor("backend_cpu_init"), ggml.tensor("backend_vk_init", ctypes.c_size_t(0))]
    out = {}
    for name, build in ggml.graphs().items():
        cpu, gpu = (ggml.compute(each, build) for each in backends)
        out[name] = {"difference": max(abs(a - b) for a, b in zip(cpu, gpu)), "range": max(cpu) - min(cpu)}
    print(json.dumps(out))


class GgmlTest(VulkanTest):
    def differences(self, **environment):
        result = self.run_on_glint(sys.executable, __file__, MANIFEST, ROOT, "graph", FOLDER, **environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("Glint mobile (simulated)", result.stderr)
        out = json.loads(result.stdout.splitlines()[-1])
        for each in out.values():
            self.assertGreater(each["range"], 0.01, "the numbers are not all the same")
        return {name: each["difference"] for name, each in out.items()}

    def test_graphs_are_those_of_the_cpu_backend(self):
        found = self.differences()
        self.assertLess(found["soft_max"], 1e-3)
        self.assertLess(found["block"], 1e-3)
        # The backend multiplies numbers of 16 bits here: 64 products have errors of up to 2^-11 each.
        self.assertLess(found["product"], 64 * 2.0**-11)

    def test_without_16_bits_the_product_is_the_cpu_backend_s_too(self):
        found = self.differences(GGML_VK_DISABLE_F16="1")
        self.assertEqual([name for name, each in found.items() if each > 1e-3], [])


if sys.argv[3:4] == ["graph"]:
    print_differences(pathlib.Path(sys.argv[4]))
    sys.exit()
FOLDER = vulkan_case.need_module("@node-llama-cpp/linux-x64-vulkan") / "bins/linux-x64-vulkan"
vulkan_case.main()
