#pragma once

/// Marks a function that also runs on a GPU: kernels share their functors with the CPU.
#ifdef __CUDACC__
#define LAMELLA_HOST_DEVICE __host__ __device__
#else
#define LAMELLA_HOST_DEVICE
#endif
