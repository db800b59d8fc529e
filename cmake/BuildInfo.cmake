# lamella_add_build_info(<target>): gives the target src/lamella/core/build_info.cpp, written at build time so that the
# commit is the one that is being built, not the one that was configured. The file changes only when its text does.

set(LAMELLA_BUILD_INFO_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/WriteBuildInfo.cmake)

function(lamella_add_build_info target)
  set(output ${PROJECT_BINARY_DIR}/generated/build_info.cpp)
  set(template ${PROJECT_SOURCE_DIR}/src/lamella/core/build_info.cpp.in)
  find_package(Git QUIET)

  # Warnings and the definitions of linked libraries change no result; everything else that the compiler was told may.
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  set(options "$<FILTER:$<TARGET_PROPERTY:${target},COMPILE_OPTIONS>,EXCLUDE,^-[WD]>")
  set(flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} $<JOIN:${options}, >")

  add_custom_target(${target}_build_info
    COMMAND ${CMAKE_COMMAND}
      -D "GIT=${GIT_EXECUTABLE}"
      -D "SOURCE_DIR=${PROJECT_SOURCE_DIR}"
      -D "TEMPLATE=${template}"
      -D "OUTPUT=${output}"
      -D "VERSION=${PROJECT_VERSION}"
      -D "COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
      -D "SYSTEM=${CMAKE_SYSTEM_NAME} ${CMAKE_SYSTEM_PROCESSOR}"
      -D "FLAGS=${flags}"
      -D "BUILD_TYPE=$<CONFIG>"
      -D "LIBRARIES=${LAMELLA_LIBRARY_VERSIONS}"
      -D "PARTS=${LAMELLA_OPTIONAL_PARTS}"
      -P ${LAMELLA_BUILD_INFO_SCRIPT}
    BYPRODUCTS ${output}
    DEPENDS ${template} ${LAMELLA_BUILD_INFO_SCRIPT}
    COMMENT "Noting version and commit"
    VERBATIM)
  set_source_files_properties(${output} PROPERTIES GENERATED TRUE)
  target_sources(${target} PRIVATE ${output})
  add_dependencies(${target} ${target}_build_info)
endfunction()
