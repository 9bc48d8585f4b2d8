# Runs every command, program and policy that the documentation shows, as a reader would.
# SPDX-License-Identifier: Apache-2.0
"""usage: docs_test.py GLINT SOURCE_DIR [Commands|Programs|Inline|Policy|Files|Harness]

The commands of a page run in order in a copy of the tree. workplace.py says what is reduced or not run, and the test prints it."""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import python_case  # noqa: E402
from python_case import GLINT, ROOT  # noqa: E402

import pages  # noqa: E402
import workplace  # noqa: E402

PAGES = pages.pages(ROOT)

# Lists the options of Vulkan-Sim 2.0.0, MOBILE/gpgpusim.config and SM75_RTX2060/gpgpusim.config, and the options that keep their default beside them.
SHIPPED = """
    dram_bnk_indexing_policy dram_bnkgrp_indexing_policy dram_data_command_freq_ratio dram_latency dram_seperate_write_queue_enable dram_write_queue_size
    enable_ptx_file_line_stats gpgpu_TB_launch_latency gpgpu_adaptive_cache_config gpgpu_cache:dl1 gpgpu_cache:dl2 gpgpu_cache:dl2_texture_only gpgpu_cache:il1
    gpgpu_clock_domains gpgpu_coalesce_arch gpgpu_compute_capability_major gpgpu_compute_capability_minor gpgpu_const_cache:l1 gpgpu_deadlock_detect
    gpgpu_dram_burst_length gpgpu_dram_buswidth gpgpu_dram_partition_queues gpgpu_dram_return_queue_size gpgpu_dram_scheduler gpgpu_dram_timing_opt
    gpgpu_dual_issue_diff_exec_units gpgpu_enable_specialized_operand_collector gpgpu_flush_l1_cache gpgpu_flush_l2_cache gpgpu_frfcfs_dram_sched_queue_size
    gpgpu_gmem_skip_L1D gpgpu_heap_size_limit gpgpu_inst_fetch_throughput gpgpu_kernel_launch_latency gpgpu_l1_banks gpgpu_l1_banks_byte_interleaving
    gpgpu_l1_latency gpgpu_l2_rop_latency gpgpu_max_insn_issue_per_warp gpgpu_max_simulated_rt_kernels gpgpu_mem_addr_mapping gpgpu_mem_address_mask
    gpgpu_memlatency_stat gpgpu_memory_partition_indexing gpgpu_n_cluster_ejection_buffer_size gpgpu_n_clusters gpgpu_n_cores_per_cluster
    gpgpu_n_ldst_response_buffer_size gpgpu_n_mem gpgpu_n_mem_per_ctrlr gpgpu_n_sub_partition_per_mchannel gpgpu_num_dp_units gpgpu_num_int_units gpgpu_num_reg_banks
    gpgpu_num_rt_core_units gpgpu_num_sched_per_core gpgpu_num_sfu_units gpgpu_num_sp_units gpgpu_num_tensor_core_units gpgpu_occupancy_sm_number
    gpgpu_operand_collector_num_units_gen gpgpu_perf_sim_memcpy gpgpu_perfect_inst_const_cache gpgpu_perfect_mem gpgpu_pipeline_widths gpgpu_ptx_convert_to_ptxplus
    gpgpu_ptx_force_max_capability gpgpu_ptx_instruction_classification gpgpu_ptx_save_converted_ptxplus gpgpu_ptx_sim_mode gpgpu_reg_file_port_throughput
    gpgpu_registers_per_block gpgpu_rt_cache:l1 gpgpu_rt_coalesce_warps gpgpu_rt_coherence_engine gpgpu_rt_coherence_engine_config gpgpu_rt_disable_rt_cache
    gpgpu_rt_intersection_latency gpgpu_rt_max_mshr gpgpu_rt_max_warps gpgpu_rt_perfect_mem gpgpu_rt_use_l1 gpgpu_runtime_pending_launch_count_limit
    gpgpu_runtime_stat gpgpu_runtime_sync_depth_limit gpgpu_scheduler gpgpu_shader_core_pipeline gpgpu_shader_cta gpgpu_shader_registers
    gpgpu_shmem_limited_broadcast gpgpu_shmem_num_banks gpgpu_shmem_per_block gpgpu_shmem_size gpgpu_shmem_sizeDefault gpgpu_shmem_warp_parts gpgpu_simd_model
    gpgpu_simd_rec_size gpgpu_simd_rec_time_out gpgpu_simd_st_size gpgpu_smem_latency gpgpu_stack_size_limit gpgpu_sub_core_model gpgpu_tensor_core_avail
    gpgpu_tex_cache:l1 icnt_arbiter_algo icnt_flit_size icnt_grant_cycles icnt_in_buffer_limit icnt_out_buffer_limit icnt_subnets network_mode
    power_simulation_enabled power_trace_enabled ptx_opcode_initiation_dp ptx_opcode_initiation_fp ptx_opcode_initiation_int ptx_opcode_initiation_sfu
    ptx_opcode_initiation_tensor ptx_opcode_latency_dp ptx_opcode_latency_fp ptx_opcode_latency_int ptx_opcode_latency_sfu ptx_opcode_latency_tesnor
    steady_power_levels_enabled visualizer_enabled visualizer_outputfile"""


class DocsTest(unittest.TestCase):
    def place(self, page=""):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name)
        self.environment = workplace.make(ROOT, GLINT, path, sys.executable, page)
        return path

    def shell(self, where, script, place):
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=where, env=self.environment, capture_output=True, text=True, timeout=240)
        self.assertEqual(done.returncode, 0, f"{place}: exit code {done.returncode}\n{script}\n{done.stdout[-1500:]}\n{done.stderr[-1500:]}")

    def fixture(self, where, page):
        if page in workplace.FIXTURES:
            self.shell(where, workplace.FIXTURES[page], f"fixture of {page}")


class Commands(DocsTest):
    def test_every_command_block_of_every_page_works(self):
        ran = 0
        for path in PAGES:
            blocks = [block for block in pages.blocks(ROOT, path) if block.kind == "shell"]
            if not blocks:
                continue
            page = blocks[0].page
            missing = [name for name in workplace.NEEDS.get(page, ()) if not shutil.which(name)]
            if missing or (page in workplace.NEEDS and not any((folder / "glint_icd.json").exists() for folder in GLINT.parents)):
                print(f"{page}: SKIPPED, there is no {', '.join(missing) or 'Vulkan driver'}")
                continue
            with self.subTest(page=page):
                where = self.place(page)
                self.fixture(where, page)
                for block in blocks:
                    if page == "docs/howto/policy.md":
                        continue  # test Policy runs these commands, because they need a `glint` that contains the policy
                    self.shell(where, block.text, block.place)
                    ran += 1
                log = where / ".commands/log"
                for line in log.read_text().splitlines() if log.exists() else []:
                    if not line.startswith("as written"):
                        print(f"{page}: {line}")
        print(f"{ran} blocks ran")
        self.assertGreater(ran, 20)


class Programs(DocsTest):
    def test_every_python_block_of_every_page_works(self):
        python_case.need("matplotlib", "numpy", "pandas")
        ran = 0
        for path in PAGES:
            blocks = [block for block in pages.blocks(ROOT, path) if block.kind in ("python", "shell")]
            if not any(block.kind == "python" for block in blocks):
                continue
            with self.subTest(page=blocks[0].page):
                where = self.place(blocks[0].page)
                self.fixture(where, blocks[0].page)
                for block in blocks:  # the commands make what the programs read
                    if block.kind == "shell":
                        self.shell(where, block.text, block.place)
                        continue
                    script = where / "block.py"
                    script.write_text(block.text)
                    self.shell(where, f"{sys.executable} block.py", block.place)
                    ran += 1
        print(f"{ran} blocks ran")
        self.assertGreater(ran, 5)


class Inline(DocsTest):
    def test_inline_commands_name_commands_and_options_that_there_are(self):
        seen, wrong = 0, []
        helps = {}
        for path in PAGES:
            for place, text in pages.inline(ROOT, path):
                seen += 1
                wrong += [f"{place}: {text}: {fault}" for fault in self.faults(text, helps)]
        self.assertEqual(wrong, [])
        self.assertGreater(seen, 40)

    def faults(self, text, helps):
        try:
            words = shlex.split(text)
        except ValueError:
            words = text.split()
        if len(words) < 2 or words[1].isupper() or words[1].startswith("-"):
            return []  # `glint COMMAND --help`
        if words[1] not in helps:
            done = subprocess.run([GLINT, words[1], "--help"], capture_output=True, text=True, check=False)
            # For an unknown command, `glint` prints the general help.
            helps[words[1]] = done.stdout if f"Usage: glint {words[1]} " in done.stdout else None
        known = helps[words[1]]
        if known is None:
            return [f"there is no command {words[1]}"]
        options = [word.split("=")[0] for word in words[2:] if re.match(r"--[a-z]", word)]
        return [f"there is no option {option}" for option in options if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", known)]

    def test_the_migration_page_has_every_option_of_the_shipped_configurations(self):
        text = (ROOT / "docs/vulkan_sim.md").read_text()
        named = [re.escape(name).replace(r"\*", r"\w*") for name in re.findall(r"`-([\w:*]+)", text)]
        self.assertEqual([option for option in SHIPPED.split() if not any(re.fullmatch(name, option) for name in named)], [])

    def test_keys_of_the_migration_page_are_keys_of_the_configuration(self):
        text = (ROOT / "docs/vulkan_sim.md").read_text().split("## Options")[1].split("## Numbers")[0]
        cells = [line.split("|")[2] for line in text.splitlines() if line.startswith("| `-")]
        keys = [key for cell in cells for key in re.findall(r"`([a-z0-9_.]+)(?: = [^`]*)?`", cell)]
        described = subprocess.run([GLINT, "describe", "--markdown", "--config", "vulkan-sim-mobile"], capture_output=True, text=True, check=True).stdout
        self.assertGreater(len(keys), 50)
        self.assertEqual([key for key in keys if f"| `{key}` |" not in described], [])


class Policy(DocsTest):
    def test_the_policy_of_the_page_can_be_linked_and_chosen(self):
        build = GLINT.parents[2]
        ninja = shutil.which("ninja")
        if not ninja or not (build / "build.ninja").exists():
            print("SKIPPED: docs/howto/policy.md: the command does not lie in a build by ninja")
            sys.exit(python_case.SKIPPED)
        blocks = pages.blocks(ROOT, ROOT / "docs/howto/policy.md")
        where = self.place()
        source = where / "youngest.cpp"
        source.write_text(next(block.text for block in blocks if block.kind == "cpp"))
        listed = subprocess.run([ninja, "-C", build, "-t", "commands", "apps/glint/glint"], capture_output=True, text=True, check=True).stdout.splitlines()
        neighbour = next(line for line in listed if "/core/schedulers/oldest.cpp" in line)
        compile_it = re.sub(r"-o \S+ ", f"-o {where}/youngest.o ", re.sub(r"\S+/core/schedulers/oldest\.cpp", str(source), re.sub(r"-M[DFT]+( \S+\.(o|d))?", "", neighbour)))
        link_it = re.sub(r" -o \S*apps/glint/glint ", f" {where}/youngest.o -o {where}/glint-youngest ", listed[-1])
        for command in (compile_it, link_it):
            done = subprocess.run(command, shell=True, cwd=build, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, f"{command}\n{done.stderr[-2000:]}")
        tools = where / ".commands/glint"
        tools.write_text(tools.read_text().replace(str(GLINT), f"{where}/glint-youngest"))
        for block in blocks:
            if block.kind == "shell":
                self.shell(where, block.text, block.place)
        out = subprocess.run([where / "glint-youngest", "list", "policies"], capture_output=True, text=True, check=True).stdout
        self.assertRegex(out, r"core\.issue +youngest +A scheduler issues from the ready warp that was launched last")
        self.assertIn('issue = "youngest"', (where / "out/youngest/config.toml").read_text())


class Harness(DocsTest):
    """Checks that the helpers of these tests notice mistakes."""

    def test_a_command_that_fails_is_noticed_wherever_it_stands_in_its_block(self):
        where = self.place()
        for script in ("glint run NOWHERE --out out/x\ntrue\n", "glint list scenes | grep NOWHERE\n", "cmake --preset nowhere\n", "glint run SHIP --nowhere\ntrue\n"):
            with self.subTest(script=script), self.assertRaises(AssertionError):
                self.shell(where, script, "harness")

    def test_blocks_of_commands_are_found_with_and_without_a_mark(self):
        where = self.place()
        page = where / "page.md"
        page.write_text("```\nglint list scenes\n```\n\n```console\n$ glint run \\\n  SHIP\nits output\n$ true\n```\n\n```\ngpu.cycles 12\n```\n\n`glint run A\n--b`\n")
        found = [(block.kind, block.line, block.text) for block in pages.blocks(where, page)]
        self.assertEqual(found, [("shell", 2, "glint list scenes\n"), ("shell", 6, "glint run \\\n  SHIP\ntrue\n"), ("other", 13, "gpu.cycles 12\n")])
        self.assertEqual(pages.inline(where, page), [("page.md:16", "glint run A --b")])

    def test_scenes_and_suites_are_reduced_and_nothing_else_is(self):
        import reduced
        os.environ["GLINT_DOCS_BENCH"] = "WKND_PT SHIP_SH"
        for written, run in (("run SHIP --size 64x64 --spp 4 --out x", "run SHIP --out x --size 16x16 --spp 1"), ("run PARK_PT", "run BUNNY_PT --size 16x16 --spp 1"),
                             ("bench subset --out x", "bench WKND_PT SHIP_SH --out x --size 16x16 --spp 1"), ("bench SHIP_SH", "bench SHIP_SH --size 16x16 --spp 1"),
                             ("run mine/pipeline.toml --size 64x64", None), ("run shaders/kernels/saxpy.toml", None), ("stats out/a", None), ("run bfs --small", None), ("run --help", None),
                             ("ablate mobile desktop", "ablate mobile desktop --plan")):
            self.assertEqual(reduced.reduced(written.split()), (run or written).split())


class Files(DocsTest):
    def test_every_file_of_a_run_stands_on_the_page_of_files(self):
        where = self.place()
        self.shell(where, "glint run SHIP --shader sh --profile --sample 1000 --out out/all && glint report out/all && glint bench SHIP --out out/bench", "files")
        pages_text = "".join((ROOT / f"docs/{name}.md").read_text() for name in ("files", "profiling", "report"))
        for folder in ("all", "bench", "bench/SHIP_SH"):
            for path in (where / "out" / folder).iterdir():
                if path.is_file():
                    self.assertIn(f"`{path.name}`", pages_text, f"{path} is not documented")

    def test_every_key_of_run_json_stands_on_the_page_of_files(self):
        where = self.place()
        self.shell(where, "glint run SHIP --shader sh --out out/all", "run.json")
        import json
        text = (ROOT / "docs/files.md").read_text()
        missing = [key for key in json.loads((where / "out/all/run.json").read_text()) if f"`{key}`" not in text]
        self.assertEqual(missing, [])


if __name__ == "__main__":
    os.environ.pop("NO_COLOR", None)
    python_case.main()
