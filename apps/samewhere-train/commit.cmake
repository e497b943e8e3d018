# Writes the commit of SOURCE, with "-changed" behind it if files differ from it, to the header OUT.
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=40 --exclude=* --dirty=-changed
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
#pragma once

namespace samewhere::train {

inline constexpr const char* kCommit = "@commit@";

}  // namespace samewhere::train
]] @ONLY)
