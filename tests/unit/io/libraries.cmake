# The tests forge checkpoints and look at them with plain HDF5.
target_link_libraries(${name} PRIVATE hdf5::hdf5 ZLIB::ZLIB PNG::PNG)
target_compile_definitions(${name} PRIVATE LAMELLA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")  # for tests/data
