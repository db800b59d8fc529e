# Run at build time (cmake -P) by BuildInfo.cmake: fills TEMPLATE into OUTPUT.

# The commit, "+changes" when tracked files differ from it, or "unknown" when SOURCE_DIR is not itself a checkout (a
# release archive unpacked inside somebody else's repository must not report that repository's commit).
set(COMMIT unknown)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} rev-parse --show-prefix
                  OUTPUT_VARIABLE prefix OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed AND prefix STREQUAL "")
    execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} describe --always --abbrev=12 --exclude=* --dirty=+changes
                    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(NOT failed)
      set(COMMIT ${described})
    endif()
  endif()
endif()

# "a, b" becomes the elements of an initializer list: "a", "b"
function(quoted_list text result)
  string(REPLACE ", " ";" items "${text}")
  list(TRANSFORM items REPLACE "(.+)" "\"\\1\"")
  list(JOIN items ", " joined)
  set(${result} "${joined}" PARENT_SCOPE)
endfunction()
quoted_list("${LIBRARIES}" LIBRARIES)
quoted_list("${PARTS}" PARTS)

string(REGEX REPLACE " +" " " FLAGS "${FLAGS}")
string(STRIP "${FLAGS}" FLAGS)
foreach(text IN ITEMS FLAGS COMPILER SYSTEM)  # they become C++ string literals
  string(REPLACE "\\" "\\\\" ${text} "${${text}}")
  string(REPLACE "\"" "\\\"" ${text} "${${text}}")
endforeach()

configure_file(${TEMPLATE} ${OUTPUT} @ONLY)  # leaves the file alone when nothing changed
