# LAMELLA_MPI: AUTO uses MPI where it is found, ON insists on it, OFF leaves it out: then one process computes a run.
# Sets LAMELLA_HAS_MPI.
set(LAMELLA_MPI AUTO CACHE STRING "Let several processes compute one run: AUTO, ON or OFF")
set_property(CACHE LAMELLA_MPI PROPERTY STRINGS AUTO ON OFF)
set(LAMELLA_HAS_MPI OFF)
if(LAMELLA_MPI STREQUAL OFF)
  return()
endif()
if(LAMELLA_MPI STREQUAL AUTO)
  find_package(MPI QUIET COMPONENTS C)  # dist: messages between processes
else()
  find_package(MPI REQUIRED COMPONENTS C)
endif()
if(MPI_C_FOUND)
  set(LAMELLA_HAS_MPI ON)
endif()
