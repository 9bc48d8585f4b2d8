// Says in words the three largest reasons why schedulers did not issue, each with the keys that bear on it.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { number, percent } from "../format.js";
import { runColour } from "../theme.js";

const kSlots = "gpu.core[*].issue_slots";

// Maps a reason of core/stall.h to what it means and to keys of the configuration that change it.
export const kReasons = {
  math_pipe_throttle: ["Execution pipe busy", "Operands were ready, but the pipe was still taking an earlier instruction.", ["core.units.fp32.interval", "core.units.int.interval", "core.schedulers"]],
  register_banks: ["Register banks busy", "Operands were ready, but their banks of the register file were being read.", ["core.register_file.banks"]],
  lsu_throttle: ["Memory queue full", "A memory instruction was ready, but the scheduler’s queue or the table of accesses was full.", ["core.lsu.queue", "core.lsu.sectors_per_cycle", "memory.l1.ports"]],
  tex_throttle: ["Texture queue full", "A texture instruction was ready, but its queue was full.", ["core.texture.queue", "core.texture.samples_per_cycle"]],
  rt_full: ["RT unit full", "Rays were ready, but every warp slot of the RT unit was taken.", ["rt.warps"]],
  raw_fixed: ["Result of fixed latency", "The next instruction needs a result that its pipe has not delivered yet.", ["core.warps", "compiler.schedule", "core.units.fp32.latency"]],
  operand_read: ["Source not read yet", "A register could not be overwritten before a memory instruction had read it.", ["core.lsu.war_latency"]],
  raw_sfu: ["Special function", "The next instruction needs a transcendental or a division.", ["core.units.sfu.latency", "core.warps"]],
  const: ["Constant load", "The next instruction needs a constant.", ["core.units.const.latency", "core.constant.size"]],
  branch: ["Branch", "The target of a branch was not known yet.", ["core.units.branch.latency"]],
  no_instruction: ["Instruction fetch", "The next line of instructions was not there.", ["core.fetch.size", "core.fetch.prefetch"]],
  local_memory: ["Local memory", "The next instruction needs a spilled register or a local array.", ["compiler.max_registers", "memory.l1.size"]],
  shared_memory: ["Shared memory", "The next instruction needs a value from shared memory.", ["core.shared.latency"]],
  texture: ["Texture", "The next instruction needs a texel.", ["core.units.tex.latency", "memory.l1.size"]],
  long_scoreboard: ["Global memory", "The next instruction needs a value from global memory.", ["core.warps", "memory.l1.size", "memory.l1.mshr_merges"]],
  call: ["Shader binding table", "A shader could not be called before its record was read.", ["memory.l1.size"]],
  barrier: ["Barrier", "Other warps of the block had not come yet.", []],
  membar: ["Fence", "Earlier accesses had not been seen yet by those the fence names.", ["core.fence.gpu"]],
  rt_wait: ["Waiting for rays", "Every warp that could go on was waiting for its rays.", ["rt.warps", "core.warps"]],
  dispatch: ["Launch", "The launch, or a warp, was being set up. A larger frame makes it a smaller share.", ["core.launch_latency", "core.warp_launch_latency"]],
  drain: ["Drain", "Warps had ended, their last accesses had not.", []],
  no_warp: ["No warp", "The scheduler had none left: the end of the launch, when others still work. A larger frame, or warps of more equal length, make it a smaller share.", ["core.warp_layout"]],
};

// Says what holds the RT unit up, where schedulers wait for it.
const kUnitReasons = {
  node_request: ["sending requests to the L1", ["rt.requests_per_cycle", "rt.coalescing"]],
  l1_refused: ["refused by the L1", ["memory.l1.ports", "memory.l1.mshr_merges"]],
  mshr_full: ["without a free entry for another node", ["rt.mshr_entries"]],
  test_busy: ["with nodes waiting for a test unit", ["rt.triangle.units", "rt.triangle.interval", "rt.box.units"]],
  waiting_memory: ["with nodes on their way from memory", ["memory.l1.size", "rt.warps"]],
  test_latency: ["with tests in flight and nothing else to do", ["rt.triangle.latency", "rt.box.latency", "rt.warps"]],
  handover: ["handing warps over", ["rt.retires_per_cycle"]],
};

function unitReason(run) {
  const cycles = run.parts("gpu.rt_unit[*].rt.cycles");
  const busy = Object.entries(cycles).filter(([name]) => name in kUnitReasons);
  const total = busy.reduce((sum, [, value]) => sum + value, 0);
  if (!total) return null;
  const largest = busy.sort((a, b) => b[1] - a[1]).slice(0, 2).filter(([, value]) => value > 0.1 * total);
  return { words: largest.map(([name, value]) => `${percent(value / total, 0)} ${kUnitReasons[name][0]}`).join(", "), keys: largest.flatMap(([name]) => kUnitReasons[name][1].slice(0, 2)) };
}

function keysOf(run, keys) {
  const known = keys.filter((key) => run.config(key) !== undefined);
  if (!known.length) return null;
  return h("p", { class: "keys" }, known.map((key) => h("span", { class: "key", title: run.docs.keys[key]?.doc }, h("code", {}, key), ` = ${typeof run.config(key) === "number" ? number(run.config(key)) : run.config(key)}`)));
}

function card(run, reason, share) {
  const [name, words, keys] = kReasons[reason] ?? [reason, "", []];
  const unit = reason === "rt_full" || reason === "rt_wait" ? unitReason(run) : null;
  const inside = unit ? ` The unit’s own cycles while it has warps: ${unit.words}.` : "";
  return h("li", {}, h("div", { class: "share", "data-stat": `${kSlots}::${reason}`, "data-value": run.sum(`${kSlots}::${reason}`) }, percent(share)), h("div", {}, h("h4", {}, name), h("p", {}, words + inside), keysOf(run, [...keys, ...(unit?.keys ?? [])].filter((key, i, all) => all.indexOf(key) === i))));
}

export function stalls(runs) {
  const shown = runs.length > 4 ? [] : runs;
  const list = shown.map((run) => {
    const total = run.part(kSlots, () => true);
    const largest = Object.entries(run.parts(kSlots)).filter(([name, value]) => name !== "issued" && value > 0).sort((a, b) => b[1] - a[1]).slice(0, 3);
    if (!total || !largest.length) return null;
    return h("div", { class: "stalls" }, runs.length > 1 ? h("h3", {}, h("span", { class: "dot", style: `background:var(--${runColour(run.index)})` }), run.label) : null, h("ol", {}, largest.map(([name, value]) => card(run, name, value / total))));
  });
  const known = list.filter(Boolean);
  return known.length ? h("div", { class: known.length > 1 ? "side" : null }, known) : null;
}
