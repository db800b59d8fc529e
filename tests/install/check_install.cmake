# Run by ctest: installs BUILD_DIR (built here first when CONFIGURE_WITH is given), moves the installation, and checks
# that headers, program, scenes and package work from the new place.

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

if(DEFINED CONFIGURE_WITH)
  run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${BUILD_DIR} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=${CONFIG}
      -DCMAKE_CXX_COMPILER=${CXX} -DLAMELLA_BUILD_TESTS=OFF ${CONFIGURE_WITH})
  run(${CMAKE_COMMAND} --build ${BUILD_DIR})
endif()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --config ${CONFIG} --prefix ${WORK_DIR}/first)
file(RENAME ${WORK_DIR}/first ${WORK_DIR}/moved)
set(prefix ${WORK_DIR}/moved)

# Headers: all of the tree but those in detail/ folders.
file(GLOB_RECURSE expected RELATIVE ${SOURCE_DIR}/src ${SOURCE_DIR}/src/lamella/*.h)
list(FILTER expected EXCLUDE REGEX "/detail/")
file(GLOB_RECURSE installed RELATIVE ${prefix}/include ${prefix}/include/*)
set(missing ${expected})
list(REMOVE_ITEM missing ${installed})
list(REMOVE_ITEM installed ${expected})
if(missing OR installed)
  message(FATAL_ERROR "headers that are not installed (missing in a FILE_SET?): ${missing}\n"
                      "installed but not public: ${installed}")
endif()

# Scenes.
file(GLOB_RECURSE expected RELATIVE ${SOURCE_DIR}/scenes ${SOURCE_DIR}/scenes/*)
file(GLOB_RECURSE installed RELATIVE ${prefix}/share/lamella/scenes ${prefix}/share/lamella/scenes/*)
if(NOT expected STREQUAL installed)
  message(FATAL_ERROR "scenes in the tree: ${expected}\ninstalled: ${installed}")
endif()

# No file of the package mentions the folders it was made in.
file(GLOB_RECURSE package_files ${prefix}/*.cmake)
foreach(file IN LISTS package_files)
  file(READ ${file} text)
  foreach(folder IN ITEMS ${SOURCE_DIR} ${WORK_DIR}/first)
    string(FIND "${text}" "${folder}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()

# A project that knows only the installation.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/install/consumer -B ${WORK_DIR}/consumer
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release
    -DEXPECTED_VERSION=${VERSION})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/consumer)
run(${WORK_DIR}/consumer/consumer ${VERSION})
message(STATUS "consumer: ${output}")

# The installed program runs from its new place and lists the scenes.
if(PROGRAM)
  run(${prefix}/bin/${PROGRAM} version)
  if(NOT output MATCHES "${VERSION}")
    message(FATAL_ERROR "`${PROGRAM} version` does not name ${VERSION}:\n${output}")
  endif()
  run(${CMAKE_COMMAND} -E chdir ${WORK_DIR} ${prefix}/bin/${PROGRAM} scenes)
  if(NOT output MATCHES "bubble/coarsening-2d")
    message(FATAL_ERROR "`${PROGRAM} scenes` does not list bubble/coarsening-2d:\n${output}")
  endif()
endif()
