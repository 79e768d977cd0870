# Builds the page of report.html into rigor_cases_light, a part of cases. npm installs the packages of package-lock.json
# into the build tree, once. esbuild bundles them with page/src, and the result becomes a C++ source. Rigor needs none
# of this at run time.
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/../reports.cpp ${CMAKE_CURRENT_LIST_DIR}/../../cli/site_command.cpp
  PROPERTIES COMPILE_DEFINITIONS RIGOR_HTML_REPORT=$<BOOL:${RIGOR_HTML_REPORT}>)
set(page ${CMAKE_CURRENT_LIST_DIR}/page)
set(page_build ${CMAKE_BINARY_DIR}/page)
file(MAKE_DIRECTORY ${page_build})
set(RIGOR_PAGE_MODULES ${page_build}/node_modules CACHE INTERNAL "Packages of npm, for pages and their tests")

if(NOT RIGOR_HTML_REPORT)
  get_target_property(sources rigor_cases_light SOURCES)
  list(FILTER sources EXCLUDE REGEX "(/html_report|/report/site/[^/]*)\\.cpp$")
  set_target_properties(rigor_cases_light PROPERTIES SOURCES "${sources}")
  return()
endif()

find_program(RIGOR_NPM npm)
find_program(RIGOR_NODE NAMES node nodejs)
if(NOT RIGOR_NPM OR NOT RIGOR_NODE)
  message(FATAL_ERROR "The HTML report is bundled with Node's npm, which was not found. "
    "Install nodejs and npm, or build without that report: -DRIGOR_HTML_REPORT=OFF")
endif()

rigor_npm(${page_build} "what the report's page is made of" ${page}/package.json ${page}/package-lock.json)

file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${page}/src/*)
add_custom_command(OUTPUT ${page_build}/page_bundle.cpp
  COMMAND ${RIGOR_NODE} ${page}/build.mjs ${RIGOR_PAGE_MODULES} ${page_build}/page_bundle.cpp
  DEPENDS ${page_build}/installed ${page}/build.mjs ${page_sources}
  COMMENT "Bundling the report's page" VERBATIM)
target_sources(rigor_cases_light PRIVATE ${page_build}/page_bundle.cpp)
# The whole page is one string literal. clang warns that other compilers need not support this length.
set_source_files_properties(${page_build}/page_bundle.cpp PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings)
