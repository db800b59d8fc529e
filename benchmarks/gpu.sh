#!/usr/bin/env bash
# Builds what runs on a GPU (needs nvcc and CMake only), checks it and prints the figures of docs/performance.md. Less than
# ten minutes; the check and the tables come first, so that a run that is cut short still leaves them.
#
# usage: benchmarks/gpu.sh [BUILD_DIR]   (default: build/cuda)
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${1:-$root/build/cuda}

nvcc=$(command -v nvcc || echo /usr/local/cuda/bin/nvcc)
cmake -S "$root/cuda" -B "$build" -DCMAKE_CUDA_COMPILER="$nvcc" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$build" --parallel "$(nproc)"

timeout 120 "$build/cuda_check"
echo
timeout 150 "$build/cuda_bench" 3
timeout 200 "$build/cuda_bench" phase 300 1

# The CPU's figures for the ratio, where the full build is at hand.
bench=$root/build/release/bin/lamella_bench
if [ -x "$bench" ]; then
    "$bench" --benchmark_filter='steps' --benchmark_min_time=1
else
    echo "no lamella_bench in build/release: the ratio to the CPU is owed"
fi
