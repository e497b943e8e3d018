# Run by `cmake -P`: puts the files of a page into one HTML template, and that into a C++ file that can be compiled.
#
#   PAGE       the page: a line `<!-- include NAME -->` stands for the content of the file NAME, which may include others
#   FILES      the files that may be included, separated by |
#   TEMPLATE   HTML file to write, to look at
#   SOURCE     C++ file to write
#   FUNCTION   the function that it defines, in samewhere::report, with the page as its value
string(REPLACE "|" ";" FILES "${FILES}")
file(READ ${PAGE} page)
# twice: what is included may include others
foreach(path IN LISTS FILES FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} content)
  string(REPLACE "<!-- include ${name} -->" "${content}" page "${page}")
endforeach()
if(page MATCHES "<!-- include ([^ ]+) -->")
  message(FATAL_ERROR "${PAGE}: includes ${CMAKE_MATCH_1}, which is missing")
endif()
file(WRITE ${TEMPLATE} "${page}")

# a string literal has a limit; neighbouring ones are one
set(literals "")
string(LENGTH "${page}" num_bytes)
set(at 0)
while(at LESS num_bytes)
  string(SUBSTRING "${page}" ${at} 16000 part)
  string(APPEND literals "R\"samewhere(${part})samewhere\"\n")
  math(EXPR at "${at} + 16000")
endwhile()
file(WRITE ${SOURCE} "#include <samewhere/report/page_template.hpp>\n
namespace samewhere::report {
std::string_view ${FUNCTION}() {
  static constexpr char kPage[] =
${literals};
  return {kPage, sizeof(kPage) - 1};
}
}  // namespace samewhere::report
")
