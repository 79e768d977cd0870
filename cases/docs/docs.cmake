# The documentation site, in build/PRESET/docs: cases/setup release docs
set(RIGOR_DOCS_COMMAND ${CMAKE_CURRENT_LIST_DIR}/build.py --rigor $<TARGET_FILE:rigor> --version ${PROJECT_VERSION}
  ${RIGOR_PUBLIC_HEADERS} adapters/plugin/rigor_engine.h CACHE INTERNAL "Builds the site, with --out DIR")
add_custom_target(docs COMMAND python3 ${RIGOR_DOCS_COMMAND} --out ${PROJECT_BINARY_DIR}/docs
  COMMENT "Building the documentation site" VERBATIM)
add_dependencies(docs rigor)
