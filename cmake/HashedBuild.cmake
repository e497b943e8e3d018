# hashed_build(TARGET OUT)
#
# Sets OUT to a text that names how TARGET is compiled: compiler, its flags for every build and for this one, options and
# definitions of the target. Warnings apart: they change nothing. Holds generator expressions.
function(hashed_build TARGET OUT)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  set(options "$<FILTER:$<TARGET_PROPERTY:${TARGET},COMPILE_OPTIONS>,EXCLUDE,^-W>")
  set(definitions "$<TARGET_PROPERTY:${TARGET},COMPILE_DEFINITIONS>")
  string(CONCAT text "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}"
                     " options $<JOIN:${options}, > definitions $<JOIN:${definitions}, >")
  set(${OUT} "${text}" PARENT_SCOPE)
endfunction()
