#!/usr/bin/env python3
# Records what a GPU answers to PTX instruction forms, in the format of the golden vectors.
# SPDX-License-Identifier: Apache-2.0
"""Runs each form of a manifest on fresh inputs and writes manifest.json, inputs.bin and outputs.bin.

The script needs a CUDA GPU, numpy and cupy. A form is PTX text with the operands A, B, C, E
(inputs), D0, D1 (outputs), TMP and SHM (8 bytes of global and shared memory per lane) and PP (a predicate). The inputs of
a form are drawn from the inputs of the given manifest, permuted, and from random bits; masks of lanes stay as they are.
To compare Glint with the results, compress them with zstd and point GLINT_PTX_GOLDEN_DIR at the folder.

    python3 tools/record_vectors.py --golden FOLDER --out FOLDER [--forms extra.json] [--seed N] [--lanes N]
"""
import argparse
import json
import pathlib
import sys

import numpy

BLOCK = 256
NAMES = "ABCE"
REGISTER = {1: "pred", 2: "b16", 4: "b32", 8: "b64"}


def entry_text(index, form):
    """Returns a kernel that loads the inputs of its lane, runs the form and stores the outputs."""
    operands = [("in", NAMES[i], o) for i, o in enumerate(form["inputs"])]
    operands += [("out", f"D{i}", o) for i, o in enumerate(form["outputs"])]
    text = [f".visible .entry form_{index}(.param .u64 p_tmp"]
    text += [f", .param .u64 p_{name}" for _, name, _ in operands]
    text += [") {", " .reg .pred PP; .reg .b32 g, tid, cta, byte; .reg .b64 TMP, off, at; .reg .b32 SHM;"]
    text += [f" .reg .{REGISTER[o['bytes']]} {name};" for _, name, o in operands]
    text += [f" .shared .align 8 .b8 cells_{index}[{8 * BLOCK}];",
             " mov.u32 tid, %tid.x; mov.u32 cta, %ctaid.x;", f" mad.lo.u32 g, cta, {BLOCK}, tid;",
             " ld.param.u64 TMP, [p_tmp]; mul.wide.u32 off, g, 8; add.u64 TMP, TMP, off;",
             f" mov.u32 SHM, cells_{index}; mad.lo.u32 SHM, tid, 8, SHM;"]
    for kind, name, o in operands:
        if kind == "in":
            text.append(f" ld.param.u64 at, [p_{name}]; mul.wide.u32 off, g, {o['bytes']}; add.u64 at, at, off;"
                        f" ld.global.b{8 * o['bytes']} {name}, [at];")
    text.append(" " + form["ptx"])
    for kind, name, o in operands:
        if kind == "out":
            text.append(f" ld.param.u64 at, [p_{name}]; mul.wide.u32 off, g, {o['bytes']}; add.u64 at, at, off;")
            if o["bytes"] == 1:
                text.append(f" selp.u32 byte, 1, 0, {name}; st.global.u8 [at], byte;")
            else:
                text.append(f" st.global.b{8 * o['bytes']} [at], {name};")
    text.append(" ret; }")
    return "\n".join(text)


def fresh(random, old, operand, lanes, keeps_warps):
    """Returns new inputs similar to `old`: its elements in a new order and, for plain data, random bits of three kinds."""
    dtype = old.dtype
    if keeps_warps:
        warps = old.reshape(-1, 32)
        return warps[random.integers(0, len(warps), lanes // 32)].reshape(-1).astype(dtype)
    out = old[random.integers(0, len(old), lanes)].copy()
    bits = random.integers(0, 1 << 63, lanes, dtype=numpy.uint64) * numpy.uint64(2) + random.integers(
        0, 2, lanes, dtype=numpy.uint64)
    which = random.integers(0, 4, lanes)
    out[which == 0] = bits[which == 0].astype(dtype)
    real = {"f32": numpy.float32, "f64": numpy.float64, "f16": numpy.float16}.get(operand["type"])
    if real:
        near = (random.standard_normal(lanes) * numpy.exp2(random.integers(-12, 12, lanes))).astype(real).view(dtype)
        out[which == 1] = near[which == 1]
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--golden", required=True, help="folder with manifest.json and inputs.bin (unpacked)")
    parser.add_argument("--out", required=True)
    parser.add_argument("--forms", help="JSON list of further forms: op, ptx, inputs (types), outputs (types)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--lanes", type=int, default=4096)
    parser.add_argument("--only-extra", action="store_true")
    args = parser.parse_args()
    import cupy

    golden = pathlib.Path(args.golden)
    manifest = json.loads((golden / "manifest.json").read_text())
    pool = (golden / "inputs.bin").read_bytes()
    forms = [] if args.only_extra else list(manifest["ops"])
    first_of_type = {}
    for form in manifest["ops"]:
        plain = "sync" not in form["op"] and "mask" not in form["op"]
        for position, operand in enumerate(form["inputs"]):
            if plain:
                first_of_type.setdefault((operand["type"], position), operand)
                first_of_type.setdefault((operand["type"], 0), operand)
    sizes = {"pred": 1, "b16": 2, "s16": 2, "u16": 2, "f16": 2, "bf16": 2}
    if args.forms:
        for extra in json.loads(pathlib.Path(args.forms).read_text()):
            ins = [dict(first_of_type.get((t, i)) or first_of_type[(t, 0)]) for i, t in enumerate(extra["inputs"])]
            outs = [{"type": t, "bytes": sizes.get(t, 8 if t.endswith("64") else 4), "offset": 0}
                    for t in extra["outputs"]]
            forms.append({"op": extra["op"], "ptx": extra["ptx"], "inputs": ins, "outputs": outs})

    random = numpy.random.default_rng(args.seed)
    inputs, outputs, kept, arrays = bytearray(), bytearray(), [], {}
    tmp = cupy.zeros(args.lanes, dtype=cupy.uint64)
    for index, form in enumerate(forms):
        header = ".version 8.3\n.target sm_90\n.address_size 64\n"
        try:
            kernel = load(cupy, header + entry_text(index, form)).get_function(f"form_{index}")
        except Exception as error:  # the assembler rejects the form
            print(f"skipped {form['op']}: {str(error).splitlines()[0]}", file=sys.stderr)
            continue
        new = {"op": form["op"], "ptx": form["ptx"], "inputs": [], "outputs": []}
        device = []
        for operand in form["inputs"]:
            keeps = "mask" in form["op"] and operand is form["inputs"][-1]
            key = (operand["type"], operand["offset"], keeps)
            if key not in arrays:
                dtype = numpy.dtype(f"<u{operand['bytes']}")
                old = numpy.frombuffer(pool, dtype, manifest["lanes"], operand["offset"])
                data = fresh(random, old, operand, args.lanes, keeps)
                inputs.extend(b"\0" * (-len(inputs) % 8))
                arrays[key] = (len(inputs), data)
                inputs.extend(data.tobytes())
            offset, data = arrays[key]
            device.append(cupy.asarray(data))
            new["inputs"].append({"type": operand["type"], "bytes": operand["bytes"], "offset": offset})
        results = [cupy.zeros(args.lanes, dtype=f"<u{o['bytes']}") for o in form["outputs"]]
        tmp.fill(0)
        kernel((args.lanes // BLOCK,), (BLOCK,), (tmp, *device, *results))
        for operand, result in zip(form["outputs"], results):
            outputs.extend(b"\0" * (-len(outputs) % 8))
            new["outputs"].append({"type": operand["type"], "bytes": operand["bytes"], "offset": len(outputs)})
            outputs.extend(cupy.asnumpy(result).tobytes())
        kept.append(new)
    out = pathlib.Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    (out / "manifest.json").write_text(json.dumps({"lanes": args.lanes, "warp_size": 32, "ops": kept}))
    (out / "inputs.bin").write_bytes(bytes(inputs))
    (out / "outputs.bin").write_bytes(bytes(outputs))
    print(f"{len(kept)} forms of {len(forms)} recorded, {args.lanes} lanes each")


def load(cupy, ptx):
    """Loads PTX text as it is."""
    module = cupy.cuda.function.Module()
    module.load(ptx.encode() + b"\0")
    return module


if __name__ == "__main__":
    main()
