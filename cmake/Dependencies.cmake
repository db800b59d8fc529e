# Everything that is linked, found in one place. Each library is used by one folder only (named beside it; the table in
# tests/house/include_rule.py keeps it so).
find_package(TBB REQUIRED)             # core: parallel_for
find_package(fmt REQUIRED)             # everywhere: messages
find_package(spdlog REQUIRED)          # run: log.txt
find_package(Eigen3 3.4 REQUIRED NO_MODULE)  # linalg: sparse and dense matrices
find_package(ZLIB REQUIRED)            # io: compressed frames
find_package(HDF5 REQUIRED COMPONENTS C)  # io: checkpoints
find_package(PNG REQUIRED)             # io: pictures
find_package(nlohmann_json REQUIRED)   # scene (importers), run, apps
find_package(tomlplusplus REQUIRED)    # scene
if(LAMELLA_BUILD_APP)
  find_package(CLI11 REQUIRED)         # apps
  find_package(PkgConfig)
  if(PkgConfig_FOUND)
    pkg_check_modules(cpp_httplib IMPORTED_TARGET cpp-httplib)  # apps/lamella/view: the server of `lamella view`
  endif()
  find_program(LAMELLA_NODE node DOC "Node.js, which builds the page of `lamella view`")
endif()

find_package(OpenEXR CONFIG QUIET)     # io, optional: pictures of light
find_package(embree 3.13 CONFIG QUIET) # render, optional: rays

set(LAMELLA_LIBRARY_VERSIONS "oneTBB ${TBB_VERSION}, fmt ${fmt_VERSION}, spdlog ${spdlog_VERSION}, \
Eigen ${Eigen3_VERSION}, zlib ${ZLIB_VERSION_STRING}, HDF5 ${HDF5_VERSION}, nlohmann-json ${nlohmann_json_VERSION}, \
toml++ ${tomlplusplus_VERSION}, libpng ${PNG_VERSION_STRING}")

# Parts that are built only where their dependency is present, as `lamella version` lists them: "cuda, render".
set(LAMELLA_OPTIONAL_PARTS "")
if(LAMELLA_HAS_CUDA)
  list(APPEND LAMELLA_OPTIONAL_PARTS cuda)
  string(APPEND LAMELLA_LIBRARY_VERSIONS ", CUDA ${CUDAToolkit_VERSION}")
endif()
if(LAMELLA_HAS_MPI)
  list(APPEND LAMELLA_OPTIONAL_PARTS mpi)
  string(APPEND LAMELLA_LIBRARY_VERSIONS ", MPI ${MPI_C_VERSION}")
endif()
if(LAMELLA_HAS_HYPRE)
  list(APPEND LAMELLA_OPTIONAL_PARTS hypre)
  string(APPEND LAMELLA_LIBRARY_VERSIONS ", hypre ${LAMELLA_HYPRE_VERSION}")
endif()
if(embree_FOUND)
  list(APPEND LAMELLA_OPTIONAL_PARTS render)
  string(APPEND LAMELLA_LIBRARY_VERSIONS ", Embree ${embree_VERSION}")
endif()
if(OpenEXR_FOUND)
  list(APPEND LAMELLA_OPTIONAL_PARTS exr)
  string(APPEND LAMELLA_LIBRARY_VERSIONS ", OpenEXR ${OpenEXR_VERSION}")
endif()
# The page is built from web/ with the packages that `npm ci` put beside it: a build fetches nothing by itself.
set(LAMELLA_HAS_PAGE OFF)
if(cpp_httplib_FOUND AND LAMELLA_NODE AND EXISTS ${PROJECT_SOURCE_DIR}/web/node_modules/esbuild/package.json)
  set(LAMELLA_HAS_PAGE ON)
  list(APPEND LAMELLA_OPTIONAL_PARTS view)
endif()
list(JOIN LAMELLA_OPTIONAL_PARTS ", " LAMELLA_OPTIONAL_PARTS)
