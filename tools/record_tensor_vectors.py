#!/usr/bin/env python3
# Records what a GPU answers to products of matrices, in the format of tests/isa/golden/tensor.
# SPDX-License-Identifier: Apache-2.0
"""Runs mma and wmma on inputs of eight kinds and writes forms.txt and words.bin.

The script needs a CUDA GPU, numpy and cupy. The kinds are: numbers of like size, any bits (with NaNs and infinities), wide
exponents, few bits of fraction, powers of two with zeros, numbers far below their summand, fractions of ones, and subnormals.
Integers have any bits, and summands also lie near the limits. forms.txt has a line for each form: op, bits of a register,
registers of A, B, C and D, samples. words.bin has for each sample A, B, C and D, by registers and then by lanes. To compare
Glint with the results, point GLINT_TENSOR_GOLDEN_DIR at the folder; compressed with zstd it may also take the place of
tests/isa/golden/tensor.

    python3 tools/record_tensor_vectors.py --out FOLDER [--seed N] [--samples N]
"""
import argparse
import pathlib

import numpy

# Formats of floats: bits, bits of the exponent, bits of the fraction. Bits of integers.
FLOATS = {"f16": (16, 5, 10), "bf16": (16, 8, 7), "tf32": (32, 8, 23), "f32": (32, 8, 23), "f64": (64, 11, 52),
          "e4m3": (8, 4, 3), "e5m2": (8, 5, 2)}
INTEGERS = {"s8": 8, "u8": 8, "s4": 4, "u4": 4, "b1": 1, "s32": 32}
KINDS = 8


def forms():
    """Yields (op, types of A, B and C, registers of A, B, C and D)."""
    long, short, small = (4, 2, 4, 4), (2, 1, 4, 4), (1, 1, 2, 2)
    product = lambda words: f"mma.sync.aligned.{words}"
    for t in ("f16", "bf16"):
        yield product(f"m16n8k16.row.col.f32.{t}.{t}.f32"), (t, t, "f32"), long
        yield product(f"m16n8k8.row.col.f32.{t}.{t}.f32"), (t, t, "f32"), short
    yield product("m16n8k16.row.col.f16.f16.f16.f16"), ("f16",) * 3, (4, 2, 2, 2)
    yield product("m16n8k8.row.col.f16.f16.f16.f16"), ("f16",) * 3, (2, 1, 2, 2)
    yield product("m16n8k8.row.col.f32.tf32.tf32.f32"), ("tf32", "tf32", "f32"), long
    yield product("m16n8k4.row.col.f32.tf32.tf32.f32"), ("tf32", "tf32", "f32"), short
    for shape, registers in (("m8n8k4", (1, 1, 2, 2)), ("m16n8k4", (2, 1, 4, 4)), ("m16n8k8", (4, 2, 4, 4)),
                             ("m16n8k16", (8, 4, 4, 4))):
        yield product(f"{shape}.row.col.f64.f64.f64.f64"), ("f64",) * 3, registers
    for clamp in ("", ".satfinite"):
        for a, b in (("s8", "s8"), ("u8", "s8"), ("s8", "u8"), ("u8", "u8")):
            yield product(f"m16n8k32.row.col{clamp}.s32.{a}.{b}.s32"), (a, b, "s32"), long
    yield product("m16n8k16.row.col.s32.s8.s8.s32"), ("s8", "s8", "s32"), short
    yield product("m8n8k16.row.col.s32.s8.s8.s32"), ("s8", "s8", "s32"), small
    yield product("m16n8k64.row.col.satfinite.s32.s4.s4.s32"), ("s4", "s4", "s32"), long
    yield product("m16n8k32.row.col.s32.s4.u4.s32"), ("s4", "u4", "s32"), short
    yield product("m8n8k32.row.col.s32.s4.s4.s32"), ("s4", "s4", "s32"), small
    for combine in ("xor", "and"):
        for shape, registers in (("m16n8k256", long), ("m16n8k128", short), ("m8n8k128", small)):
            yield product(f"{shape}.row.col.s32.b1.b1.s32.{combine}.popc"), ("b1", "b1", "s32"), registers
    for a, b in (("e4m3", "e4m3"), ("e5m2", "e5m2"), ("e4m3", "e5m2")):
        yield product(f"m16n8k32.row.col.f32.{a}.{b}.f32"), (a, b, "f32"), long
    yield product("m16n8k16.row.col.f32.e4m3.e4m3.f32"), ("e4m3", "e4m3", "f32"), short
    yield product("m16n8k32.row.col.f16.e4m3.e4m3.f16"), ("e4m3", "e4m3", "f16"), (4, 2, 2, 2)
    yield from fragment_forms()


def fragment_forms():
    product = lambda words: f"wmma.mma.sync.aligned.row.col.{words}"
    for shape, a, b in (("m16n16k16", 4, 4), ("m8n32k16", 2, 8), ("m32n8k16", 8, 2)):
        yield product(f"{shape}.f32.f32"), ("f16", "f16", "f32"), (8, 8, 8, 8)
        yield product(f"{shape}.f16.f16"), ("f16", "f16", "f16"), (8, 8, 4, 4)
        yield product(f"{shape}.f32.bf16.bf16.f32"), ("bf16", "bf16", "f32"), (a, b, 8, 8)
        yield product(f"{shape}.s32.s8.s8.s32"), ("s8", "s8", "s32"), (a // 2, b // 2, 8, 8)
    yield product("m16n16k16.f16.f32"), ("f16", "f16", "f32"), (8, 8, 8, 4)
    yield product("m16n16k16.f32.f16"), ("f16", "f16", "f16"), (8, 8, 4, 8)
    yield product("m16n16k8.f32.tf32.tf32.f32"), ("tf32", "tf32", "f32"), (4, 4, 8, 8)
    yield product("m8n8k4.f64.f64.f64.f64"), ("f64",) * 3, (1, 1, 2, 2)
    yield product("m8n8k32.s32.s4.s4.s32"), ("s4", "s4", "s32"), (1, 1, 2, 2)
    yield ("wmma.mma.xor.popc.sync.aligned.row.col.m8n8k128.s32.b1.b1.s32", ("b1", "b1", "s32"), (1, 1, 2, 2))


def integers(random, kind, count, bits):
    """Returns the bits of integers; those of 32 bits lie near a limit in two kinds, and are small in three."""
    out = random.integers(0, 1 << bits, count, dtype=numpy.uint64)
    if bits == 32 and kind in (1, 2):
        out = numpy.uint64(0x7fffffff if kind == 1 else 0x80000fff) - (out & numpy.uint64(0xfff))
    elif bits == 32 and kind >= 5:
        out &= numpy.uint64(0xfff)
    elif bits == 8 and kind in (1, 3):
        out = numpy.where(out & numpy.uint64(1), numpy.uint64(0x7f), numpy.uint64(0x80))
    return out


def floats(random, kind, count, name, is_sum):
    """Returns the bits of floats of one kind."""
    bits, exponent_bits, fraction_bits = FLOATS[name]
    top, bias = (1 << exponent_bits) - 1, (1 << (exponent_bits - 1)) - 1
    wide = {4: 3, 5: 5}.get(exponent_bits, 20)
    draw = lambda below: random.integers(0, below, count, dtype=numpy.uint64)
    if kind == 1:
        return draw(1 << bits) if bits < 64 else draw(1 << 63) * numpy.uint64(2) + draw(2)
    spread = {0: 3, 2: wide * (2 if is_sum else 1), 3: 1, 4: wide, 5: min(wide, 12), 6: 2, 7: 130 if wide > 5 else 2 * wide}[kind]
    centre = bias + (min(wide, 12) if is_sum and kind == 5 else 0)
    exponent = numpy.clip(draw(2 * spread + 1).astype(numpy.int64) - spread + centre, 0, top - 1).astype(numpy.uint64)
    fraction = draw(1 << fraction_bits)
    if kind == 3:
        fraction &= numpy.uint64(3 << max(fraction_bits - 2, 0))
    elif kind == 4:
        fraction[:] = 0
    elif kind == 6:
        fraction |= numpy.uint64((1 << fraction_bits) - 2)
    elif kind == 7:
        exponent = numpy.where(draw(4) == 0, draw(4), exponent)
    out = draw(2) << numpy.uint64(bits - 1) | exponent << numpy.uint64(fraction_bits) | fraction
    return numpy.where((draw(2) == 0) & (kind in (4, 5)) & (not is_sum), numpy.uint64(0), out)


def words(random, kind, registers, name, is_sum):
    """Returns a matrix as [registers][32], elements from the low bits on."""
    bits = FLOATS[name][0] if name in FLOATS else INTEGERS[name]
    per = max(32 // bits, 1)
    make = floats if name in FLOATS else integers
    last = (name, is_sum) if name in FLOATS else (bits,)
    elements = make(random, kind, registers * 32 * per, *last).reshape(registers, 32, per)
    if bits == 64:
        return elements[..., 0]
    return sum(elements[..., i] << numpy.uint64(i * bits) for i in range(per)).astype(numpy.uint32)


def kernel_text(index, op, wide, registers):
    """Returns a kernel in which each block of one warp runs the op on one sample."""
    kind, size = ("f64", 8) if wide else ("b32", 4)
    text = [f".visible .entry form_{index}(.param .u64 pa, .param .u64 pb, .param .u64 pc, .param .u64 pd) {{",
            " .reg .b64 at, off; .reg .b32 lane, block;", " mov.u32 lane, %tid.x; mov.u32 block, %ctaid.x;"]
    text += [f" .reg .{kind} {name}<{count}>;" for name, count in zip("abcd", registers)]
    group = lambda name, count: "{" + ", ".join(f"{name}{i}" for i in range(count)) + "}"
    for name, count in zip("abcd", registers):
        if name == "d":
            groups = [group(n, c) for n, c in zip("abcd", registers)]
            text.append(f" {op} {groups[3]}, {groups[0]}, {groups[1]}, {groups[2]};")
        text.append(f" ld.param.u64 at, [p{name}]; mul.wide.u32 off, block, {count * 32 * size}; add.u64 at, at, off;"
                    f" mul.wide.u32 off, lane, {size}; add.u64 at, at, off;")
        for i in range(count):
            place = f"[at+{i * 32 * size}]"
            text.append(f" st.global.{kind} {place}, d{i};" if name == "d" else f" ld.global.{kind} {name}{i}, {place};")
    return "\n".join(text) + "\n ret;\n}\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--samples", type=int, default=KINDS, help="of each form of floats; others have a quarter")
    args = parser.parse_args()
    import cupy

    out = pathlib.Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    random = numpy.random.default_rng(args.seed)
    lines = ["// Op, bits of a register, registers of A, B, C and D, samples: of tools/record_tensor_vectors.py"]
    with open(out / "words.bin", "wb") as data:
        for index, (op, types, registers) in enumerate(forms()):
            is_plain = types[0] in FLOATS and not op.startswith("wmma")
            samples = args.samples if is_plain else max(args.samples // 4, 1)
            kinds = [s % KINDS if samples >= KINDS else 1 + s % (KINDS - 1) for s in range(samples)]
            matrices = [numpy.stack([words(random, kind, registers[i], types[i], i == 2) for kind in kinds])
                        for i in range(3)]
            text = ".version 8.8\n.target sm_90a\n.address_size 64\n" + kernel_text(index, op, types[0] == "f64", registers)
            kernel = load(cupy, text, index)
            device = [cupy.asarray(m.reshape(-1)) for m in matrices]
            result = cupy.zeros(samples * registers[3] * 32, dtype=matrices[2].dtype)
            kernel((samples,), (32,), (*device, result))
            matrices.append(cupy.asnumpy(result).reshape(samples, registers[3], 32))
            for s in range(samples):
                for m in matrices:
                    data.write(m[s].tobytes())
            bits = 64 if types[0] == "f64" else 32
            lines.append("\t".join(str(x) for x in (op, bits, *registers, samples)))
    (out / "forms.txt").write_text("\n".join(lines) + "\n")


def load(cupy, text, index):
    """Returns the kernel of a module in PTX, which the driver compiles."""
    module = cupy.cuda.function.Module()
    module.load(text.encode() + b"\0")
    return module.get_function(f"form_{index}")


if __name__ == "__main__":
    main()
