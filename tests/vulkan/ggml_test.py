# Tests ggml's Vulkan backend, which nobody wrote for Glint: its numbers are those of ggml's own CPU backend.
# SPDX-License-Identifier: Apache-2.0
"""usage: ggml_test.py MANIFEST SOURCE_DIR
       ggml_test.py MANIFEST SOURCE_DIR graph FOLDER
       ggml_test.py MANIFEST SOURCE_DIR words FOLDER cpu|vulkan

GLINT_NODE_MODULES names the folder in which npm installed @node-llama-cpp/linux-x64-vulkan, whose libraries have a C
interface. With "graph" or "words" the script computes with the libraries of FOLDER in its own process; the test calls it so.
"""
import ctypes
import json
import pathlib
import random
import sys

import vulkan_case
from vulkan_case import MANIFEST, ROOT, VulkanTest

K, ROWS, COLUMNS = 64, 32, 16
F32, I32 = 0, 26  # ggml's numbers of the types


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


class LanguageModel:
    """Is a transformer with random weights and a memory of keys and values, as llama.cpp builds its models of ggml's ops."""
    WORDS, WIDTH, HEADS, LAYERS, MEMORY = 96, 64, 2, 2, 16

    def __init__(self, ggml, backend):
        self.ggml, self.backend = ggml, backend
        self.context = ggml.tensor("init", GraphSize(4 << 20, None, True))
        width, each = self.WIDTH, self.WIDTH // self.HEADS
        self.words, self.choice = self.matrix(width, self.WORDS), self.matrix(width, self.WORDS)
        shapes = {"query": (width, width), "key": (width, width), "value": (width, width), "out": (width, width),
                  "up": (width, 2 * width), "down": (2 * width, width)}
        self.layers = [{name: self.matrix(*shape) for name, shape in shapes.items()} for _ in range(self.LAYERS)]
        # A row of keys for each token, and a row of values for each element of a head.
        self.keys = [self.three(each, self.MEMORY, self.HEADS) for _ in self.layers]
        self.values = [self.three(self.MEMORY, each, self.HEADS) for _ in self.layers]
        ggml.tensor("backend_alloc_ctx_tensors", self.context, backend)
        numbers = random.Random(2)
        for tensor, count in [(self.words, width * self.WORDS), (self.choice, width * self.WORDS)] + [
                (layer[name], shape[0] * shape[1]) for layer in self.layers for name, shape in shapes.items()]:
            self.set(tensor, [numbers.uniform(-0.4, 0.4) for _ in range(count)])
        for tensor in self.keys + self.values:
            self.set(tensor, [0.0] * (width * self.MEMORY))

    def matrix(self, width, height):
        return self.ggml.tensor("new_tensor_2d", self.context, ctypes.c_int(F32), ctypes.c_int64(width), ctypes.c_int64(height))

    def three(self, *sizes):
        return self.ggml.tensor("new_tensor_3d", self.context, ctypes.c_int(F32), *map(ctypes.c_int64, sizes))

    def set(self, tensor, numbers, kind=ctypes.c_float):
        values = (kind * len(numbers))(*numbers)
        self.ggml.call("backend_tensor_set", None, tensor, values, ctypes.c_size_t(0), ctypes.c_size_t(ctypes.sizeof(values)))

    def step(self, token, position):
        """Returns the weights of the next word after a token, and keeps the token's keys and values."""
        ggml, each, count = self.ggml, self.WIDTH // self.HEADS, ctypes.c_int64
        context = ggml.tensor("init", GraphSize(4 << 20, None, True))
        graph = ggml.tensor("new_graph", context)

        def op(name, *arguments):
            return ggml.tensor(name, context, *arguments)

        def heads(x, *sizes):
            return op("reshape_3d", x, *map(count, sizes))

        def part(tensor, width, height, row, plane, first):
            return op("view_3d", tensor, count(width), count(height), count(self.HEADS), ctypes.c_size_t(4 * row), ctypes.c_size_t(4 * plane),
                      ctypes.c_size_t(4 * first))

        chosen = ggml.tensor("new_tensor_1d", context, ctypes.c_int(I32), count(1))
        seen = ggml.tensor("new_tensor_1d", context, ctypes.c_int(F32), count(self.MEMORY))
        x = op("get_rows", self.words, chosen)
        for layer, keys, values in zip(self.layers, self.keys, self.values):
            normal = op("rms_norm", x, ctypes.c_float(1e-5))
            query = heads(op("mul_mat", layer["query"], normal), each, 1, self.HEADS)
            key = heads(op("mul_mat", layer["key"], normal), each, 1, self.HEADS)
            value = heads(op("mul_mat", layer["value"], normal), 1, each, self.HEADS)
            plane = each * self.MEMORY
            for new, place in ((key, part(keys, each, 1, each, plane, each * position)), (value, part(values, 1, each, self.MEMORY, plane, position))):
                ggml.call("build_forward_expand", None, graph, op("cpy", new, place))
            scores = op("scale", op("mul_mat", keys, query), ctypes.c_float(each ** -0.5))
            mixed = op("mul_mat", values, op("soft_max", op("add", scores, seen)))
            x = op("add", x, op("mul_mat", layer["out"], op("reshape_2d", mixed, count(self.WIDTH), count(1))))
            inner = op("silu", op("mul_mat", layer["up"], op("rms_norm", x, ctypes.c_float(1e-5))))
            x = op("add", x, op("mul_mat", layer["down"], inner))
        out = op("mul_mat", self.choice, op("rms_norm", x, ctypes.c_float(1e-5)))
        ggml.call("build_forward_expand", None, graph, out)
        ggml.tensor("backend_alloc_ctx_tensors", context, self.backend)
        self.set(chosen, [token], ctypes.c_int32)
        self.set(seen, [0.0 if i <= position else -1e9 for i in range(self.MEMORY)])
        if ggml.call("backend_graph_compute", ctypes.c_int, self.backend, graph):
            sys.exit("ggml_backend_graph_compute failed")
        result = (ctypes.c_float * self.WORDS)()
        ggml.call("backend_tensor_get", None, out, result, ctypes.c_size_t(0), ctypes.c_size_t(ctypes.sizeof(result)))
        return list(result)

    def speak(self, token=1, length=12):
        """Returns the words that follow a token, and the weights of all words at each step."""
        words, weights = [], []
        for position in range(length):
            weights.append(self.step(token, position))
            token = weights[-1].index(max(weights[-1]))
            words.append(token)
        return words, weights


def print_words(folder, which):
    """Prints what the language model says on the CPU backend or on the Vulkan backend."""
    ggml = Ggml(folder)
    backend = ggml.tensor("backend_cpu_init") if which == "cpu" else ggml.tensor("backend_vk_init", ctypes.c_size_t(0))
    if which == "cpu":
        ggml.call("backend_cpu_set_n_threads", None, backend, ctypes.c_int(1))
    print(json.dumps(LanguageModel(ggml, backend).speak()))


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


    def words(self, which):
        result = self.run_on_glint(sys.executable, __file__, MANIFEST, ROOT, "words", FOLDER, which)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual("Glint mobile (simulated)" in result.stderr, which == "vulkan")
        return json.loads(result.stdout.splitlines()[-1])

    def test_a_language_model_says_the_same_words_token_by_token(self):
        (words, weights), (wanted, exact) = self.words("vulkan"), self.words("cpu")
        self.assertGreater(len(set(wanted)), 3, "the words are not all the same")
        self.assertEqual(words, wanted)
        self.assertLess(max(abs(a - b) for step, other in zip(weights, exact) for a, b in zip(step, other)), 1e-3)


if sys.argv[3:4] == ["words"]:
    print_words(pathlib.Path(sys.argv[4]), sys.argv[5])
    sys.exit()
if sys.argv[3:4] == ["graph"]:
    print_differences(pathlib.Path(sys.argv[4]))
    sys.exit()
FOLDER = vulkan_case.need_module("@node-llama-cpp/linux-x64-vulkan")[0] / "bins/linux-x64-vulkan"
vulkan_case.main()
