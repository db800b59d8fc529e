# Run by ctest: the commit in the build info is that of the source tree, and "unknown" in a folder that is no checkout.

file(REMOVE_RECURSE ${WORK_DIR})
find_package(Git QUIET REQUIRED)

function(commit_of source_dir result)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -D GIT=${GIT_EXECUTABLE} -D SOURCE_DIR=${source_dir}
            -D TEMPLATE=${SOURCE_DIR}/src/lamella/core/build_info.cpp.in -D OUTPUT=${WORK_DIR}/build_info.cpp
            -P ${SOURCE_DIR}/cmake/WriteBuildInfo.cmake
    COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${WORK_DIR}/build_info.cpp text)
  string(REGEX MATCH "commit = \"([^\"]*)\"" matched "${text}")
  set(${result} "${CMAKE_MATCH_1}" PARENT_SCOPE)
endfunction()

function(git)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${WORK_DIR}/tree -c user.name=a -c user.email=a@b ${ARGV}
                  OUTPUT_VARIABLE output OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect expected)
  commit_of(${WORK_DIR}/tree found)
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "the build info says '${found}', expected '${expected}'")
  endif()
endfunction()

file(WRITE ${WORK_DIR}/tree/file "1")
file(WRITE ${WORK_DIR}/tree/inner/file "1")
git(init --quiet)
git(add file)
git(commit --quiet -m one)
git(rev-parse --short=12 HEAD)
expect(${output})
set(first ${output})

file(WRITE ${WORK_DIR}/tree/file "2")
expect(${first}+changes)
git(commit --quiet -a -m two)
git(rev-parse --short=12 HEAD)
expect(${output})
if(output STREQUAL first)
  message(FATAL_ERROR "the second commit is the first one")
endif()

# A release archive unpacked inside a repository.
commit_of(${WORK_DIR}/tree/inner found)
if(NOT found STREQUAL "unknown")
  message(FATAL_ERROR "a folder inside a repository says commit '${found}'")
endif()
