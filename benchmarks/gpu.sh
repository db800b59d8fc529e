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

# One foam of a million bubbles on two GPUs against the same on one: time of the steps, and what of it went into messages,
# sums and waiting. Starts from the unrelaxed packing, which would take longer than the steps.
lamella=$root/build/release/bin/lamella
gpus=$({ nvidia-smi -L 2>/dev/null || true; } | wc -l)
echo
if [ "$gpus" -lt 2 ]; then
    echo "two processes: they need two GPUs, and here are $gpus"
elif ! [ -x "$lamella" ] || ! "$lamella" version | grep parts | grep mpi | grep -q cuda; then
    echo "two processes: there is no lamella with cuda and mpi in build/release"
else
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    for processes in 1 2; do
        timeout 120 mpirun -np "$processes" "$lamella" run bubble/phase-separation --device cuda --until 0.5 \
            --set bubble.start.max_iterations=0 --out "$folder/$processes" --progress none
        echo "processes: $processes"
        grep -m 1 '^  "steps"' "$folder/$processes/run.json"
        grep -m 1 '"advance"' "$folder/$processes/run.json"  # wall seconds
        grep -m 1 -A 3 '"exchange_seconds"' "$folder/$processes/run.json"
    done
fi
