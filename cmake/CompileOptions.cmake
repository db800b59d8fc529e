# The flags that every target of this project is compiled with; nothing here leaks to users of the installed library.
#
# -ffp-contract=off: the same source line gives the same bits on every instruction set (no silent fused
# multiply-add), which reproducible runs rest on. -fno-math-errno and -fno-trapping-math let loops with a
# square root or a select vectorize; neither changes a result.
#
# The optimization level is the build type's: Release is -O3 -DNDEBUG.

function(lamella_compile_options target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wshadow -Wconversion
    -ffp-contract=off -fno-math-errno -fno-trapping-math)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)  # gcc bug 105651: false alarms inside std::string
  endif()
  if(LAMELLA_NATIVE)
    target_compile_options(${target} PRIVATE -march=native)
    # g++ 12 compiles a constant like {a, a, 0, 0} to {a, a, a, a} when its SLP pass makes an AVX-512 vector of it
    # (seen with 12.2; std::vector<double>{0.01, 0.01, 0.0, 0.0} is enough). The hot loops here do not need the pass.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      target_compile_options(${target} PRIVATE -fno-tree-slp-vectorize)
    endif()
  endif()
  if(LAMELLA_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${LAMELLA_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${LAMELLA_SANITIZE})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # instrumented code makes gcc guess wrong inside the standard library
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
    endif()
  endif()
  if(LAMELLA_BUILD_FUZZERS)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()
