"""Checks that every kernel can be launched: the shared memory that it declares and what its launch
asks for together are at most 48 KiB, which a block gets without asking for more.

kernel_sizes.py [--nvcc PATH] [--arch N] SOURCE…

Compiles the stage sources that use teams, the kernels of which are launched with shared memory,
and reads what ptxas says about each. Exit codes: 0 all fit, 1 some do not, 77 there is no nvcc.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MOST = 48 * 1024
NO_NVCC = 77


def bytes_of_launch():
    """What kernels/parallel/parallel_cuda.h asks for when it launches a team."""
    with open(os.path.join(ROOT, "kernels/parallel/team.h"), encoding="utf-8") as header:
        size = re.search(r"kSharedBytes = (\d+) \* (\d+);", header.read())
    return int(size[1]) * int(size[2])


def uses_teams(source):
    with open(source, encoding="utf-8") as text:
        return re.search(r"\b(for_each_team|with_device_team)\b", text.read()) is not None


def kernels_of(source, nvcc, arch):
    """(mangled name, bytes of static shared memory) of every kernel in the source."""
    command = [nvcc, "-x", "cu", f"-arch=sm_{arch}", "-std=c++20", "-O3", "--fmad=false", "-cubin",
               "-Xptxas", "-v", "-I", ROOT, "-DICLOTH_BUILD=cuda32", "-DICLOTH_REAL=float", source,
               "-o", os.devnull]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr[-4000:]}")
    name = None
    for line in done.stderr.splitlines():
        if entry := re.search(r"Compiling entry function '(\w+)'", line):
            name = entry[1]
        elif name and "Used " in line:
            size = re.search(r"(\d+) bytes smem", line)
            yield name, int(size[1]) if size else 0
            name = None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--nvcc", default=shutil.which("nvcc") or "/usr/local/cuda/bin/nvcc")
    parser.add_argument("--arch", default="90")
    parser.add_argument("sources", nargs="+")
    options = parser.parse_args()
    if not os.path.exists(options.nvcc):
        print("no nvcc, so no sizes")
        return NO_NVCC

    too_large = teams = 0
    for source in filter(uses_teams, options.sources):
        for name, declared in kernels_of(source, options.nvcc, options.arch):
            by_launch = bytes_of_launch() if re.search(r"\d+team_kernel", name) else 0
            teams += by_launch > 0
            if declared + by_launch > MOST:
                too_large += 1
                print(f"{name}: {declared} + {by_launch} bytes of shared memory, at most {MOST}")
            elif declared + by_launch > MOST // 2:
                print(f"{declared:6d} + {by_launch:5d}  {name[:100]}")
    print(f"{teams} kernels of teams, {too_large} kernels too large")
    return 1 if too_large or not teams else 0


if __name__ == "__main__":
    sys.exit(main())
