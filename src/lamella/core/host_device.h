#pragma once

/// Marks a function that also runs on a GPU: kernels share their functors with the CPU.
#ifdef __CUDACC__
#define LAMELLA_HOST_DEVICE __host__ __device__
#else
#define LAMELLA_HOST_DEVICE
#endif

/// For the small functions that a kernel is made of: eight lanes passed through memory would cost more than the work.
#if defined(__GNUC__)
#define LAMELLA_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define LAMELLA_ALWAYS_INLINE inline
#endif
