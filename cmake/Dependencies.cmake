# Everything that is linked, found in one place. Each library is used by one folder only (named beside it).
find_package(TBB REQUIRED)             # core: parallel_for
find_package(fmt REQUIRED)             # core: messages
find_package(spdlog REQUIRED)          # run: log.txt
find_package(ZLIB REQUIRED)            # io: compressed frames
find_package(HDF5 REQUIRED COMPONENTS C)  # io: checkpoints
find_package(nlohmann_json REQUIRED)   # scene (importers), run, apps
find_package(tomlplusplus REQUIRED)    # scene
if(LAMELLA_BUILD_APP)
  find_package(CLI11 REQUIRED)         # apps
endif()
