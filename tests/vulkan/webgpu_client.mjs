// Computes with WebGPU: doubles and sums numbers with a shader in WGSL, and prints what came back as JSON.
// usage: node webgpu_client.mjs MODULE, where MODULE is the folder of npm's module webgpu
//        deno run --allow-all webgpu_client.mjs, which has a WebGPU of its own
// SPDX-License-Identifier: Apache-2.0
import process from 'node:process';
import { pathToFileURL } from 'node:url';

async function dawn(folder) {
  const { create, globals } = await import(pathToFileURL(folder + '/index.js'));
  Object.assign(globalThis, globals);
  return create(['backend=vulkan']);
}

const COUNT = 1000, GROUP = 64;
const SHADER = `
struct Size { count: u32, factor: f32 }
@group(0) @binding(0) var<uniform> size: Size;
@group(0) @binding(1) var<storage, read_write> numbers: array<f32>;
@group(0) @binding(2) var<storage, read_write> sums: array<atomic<u32>>;
var<workgroup> part: array<u32, ${GROUP}>;

@compute @workgroup_size(${GROUP})
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
  part[local] = 0;
  if (id.x < size.count) {
    part[local] = u32(numbers[id.x]);
    numbers[id.x] = numbers[id.x] * size.factor + 0.5;
  }
  workgroupBarrier();
  for (var step = ${GROUP}u / 2; step > 0; step /= 2) {
    if (local < step) { part[local] += part[local + step]; }
    workgroupBarrier();
  }
  if (local == 0) { atomicAdd(&sums[0], part[0]); atomicMax(&sums[1], part[0]); }
}`;

async function main() {
  const gpu = process.argv[2] ? await dawn(process.argv[2]) : navigator.gpu;
  const adapter = await gpu.requestAdapter();
  if (!adapter) throw new Error('there is no adapter');
  const device = await adapter.requestDevice();
  device.addEventListener('uncapturederror', (event) => console.error(event.error.message));
  const { STORAGE, UNIFORM, COPY_SRC, COPY_DST, MAP_READ } = GPUBufferUsage;

  const buffer = (usage, words) => {
    const out = device.createBuffer({ size: words.byteLength, usage, mappedAtCreation: true });
    new Uint8Array(out.getMappedRange()).set(new Uint8Array(words.buffer));
    out.unmap();
    return out;
  };
  const size = new DataView(new ArrayBuffer(8));
  size.setUint32(0, COUNT, true), size.setFloat32(4, 2, true);
  const numbers = buffer(STORAGE | COPY_SRC, Float32Array.from({ length: COUNT }, (_, i) => i));
  const sums = buffer(STORAGE | COPY_SRC, new Uint32Array(2));
  const inputs = [buffer(UNIFORM, size), numbers, sums];
  const layout = 'auto', module = device.createShaderModule({ code: SHADER });
  const pipeline = device.createComputePipeline({ layout, compute: { module, entryPoint: 'main' } });
  const entries = inputs.map((each, binding) => ({ binding, resource: { buffer: each } }));
  const group = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });

  const back = device.createBuffer({ size: COUNT * 4 + 8, usage: MAP_READ | COPY_DST });
  const commands = device.createCommandEncoder();
  const pass = commands.beginComputePass();
  pass.setPipeline(pipeline), pass.setBindGroup(0, group);
  pass.dispatchWorkgroups(Math.ceil(COUNT / GROUP)), pass.end();
  commands.copyBufferToBuffer(numbers, 0, back, 0, COUNT * 4);
  commands.copyBufferToBuffer(sums, 0, back, COUNT * 4, 8);
  device.queue.submit([commands.finish()]);
  await back.mapAsync(GPUMapMode.READ);
  const bytes = back.getMappedRange();
  console.log(JSON.stringify({
    adapter: adapter.info.description,
    numbers: Array.from(new Float32Array(bytes, 0, COUNT)),
    sums: Array.from(new Uint32Array(bytes, COUNT * 4, 2)),
  }));
  back.unmap();
  device.destroy();
}

await main();
