# The laboratory, in build/PRESET/play: cases/setup release play. emscripten compiles the simulators in a project of its
# own (wasm/CMakeLists.txt), and esbuild bundles the page. No other target needs any of it.
set(RIGOR_PLAY_PAGE ${PROJECT_BINARY_DIR}/play/index.html CACHE INTERNAL "The laboratory's page")
set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/cli/play_command.cpp PROPERTIES
  COMPILE_DEFINITIONS RIGOR_PLAY_PAGE="${RIGOR_PLAY_PAGE}")
find_program(RIGOR_EMCC em++)
set(emscripten /usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake CACHE FILEPATH "emscripten's toolchain for CMake")
if(NOT RIGOR_HTML_REPORT OR NOT RIGOR_EMCC OR NOT EXISTS ${emscripten})
  add_custom_target(play COMMAND ${CMAKE_COMMAND} -E echo "The laboratory needs emscripten and npm: cases/setup release play"
    COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
  return()
endif()

set(room ${CMAKE_CURRENT_LIST_DIR})
set(play_build ${PROJECT_BINARY_DIR}/play-build)
# The libraries' headers by links: a folder of the machine's own headers would hide emscripten's C library.
file(MAKE_DIRECTORY ${play_build}/headers)
foreach(header Eigen/Core boost/version.hpp fmt/format.h libqhull_r/libqhull_r.h nlohmann/json.hpp toml++/toml.h)
  find_path(found_${header} ${header} PATH_SUFFIXES eigen3 NO_CACHE REQUIRED)
  get_filename_component(folder ${header} DIRECTORY)
  file(CREATE_LINK ${found_${header}}/${folder} ${play_build}/headers/${folder} SYMBOLIC)
endforeach()

# emscripten's own scripts need Debian's acorn, which a Node from elsewhere finds by NODE_PATH.
#
# Debian has no libraries for WebAssembly, but their sources. Without that of Qhull the laboratory leaves convex hulls
# out, without those of ODE and Bullet these engines, and without that of TinyXML-2 the files of robots.
set(fetched ${play_build}/fetched)
set(sources_fetched "")
foreach(package qhull ode bullet tinyxml2)
  add_custom_command(OUTPUT ${fetched}/${package}-fetched
    COMMAND ${room}/wasm/fetch_source ${package} ${fetched}/${package}
    COMMAND ${CMAKE_COMMAND} -E touch ${fetched}/${package}-fetched
    COMMENT "Fetching the source of ${package}" VERBATIM)
  list(APPEND sources_fetched ${fetched}/${package}-fetched)
endforeach()

file(GLOB_RECURSE simulator_sources CONFIGURE_DEPENDS ../core/*.h ../core/*.cpp ../adapters/common/* ../adapters/plugin/*.h ../adapters/plugin/*.cpp ../adapters/ode/*.h ../adapters/ode/*.cpp
  ../adapters/bullet/*.h ../adapters/bullet/*.cpp import/*.h import/*.cpp ../adapters/mjcf/*.h ../adapters/mjcf/*.cpp truth/*.h truth/*.cpp metrics/*.h metrics/*.cpp case/*.h case/*.cpp results/*.h results/*.cpp
  analysis/*.h analysis/*.cpp report/wording/*.h report/wording/*.cpp laboratory/*.h laboratory/*.cpp)
add_custom_command(OUTPUT ${play_build}/wasm/rigor_play.wasm
  COMMAND ${CMAKE_COMMAND} -S ${room}/wasm -B ${play_build}/wasm -G ${CMAKE_GENERATOR} -DCMAKE_TOOLCHAIN_FILE=${emscripten}
    -DCMAKE_BUILD_TYPE=None -DHEADERS=${play_build}/headers -DFETCHED=${fetched} -DVERSION=${PROJECT_VERSION}
    -DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER} -DCMAKE_C_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
  COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${CMAKE_COMMAND} --build ${play_build}/wasm
  DEPENDS ${sources_fetched} ${simulator_sources} ${room}/wasm/CMakeLists.txt ${room}/wasm/engines.cmake
  COMMENT "Compiling the simulators for WebAssembly" VERBATIM)

# Engines of the npm registry; engines.html has them beside the core.
set(RIGOR_PLAY_ENGINES ammo cannon-es havok jolt mujoco physx rapier CACHE STRING "Files of adapters/plugin/examples/npm that the laboratory carries")
set(engines ${play_build}/npm)
file(GLOB engine_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/adapters/plugin/examples/npm/*.mjs ${PROJECT_SOURCE_DIR}/adapters/plugin/examples/npm/package*.json)
rigor_npm(${engines} "engines of the npm registry for the laboratory" ${engine_files})

file(GLOB_RECURSE play_sources CONFIGURE_DEPENDS ${room}/page/* report/html/page/src/* suite/*.toml)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/play)
add_custom_command(OUTPUT ${RIGOR_PLAY_PAGE}
  COMMAND ${RIGOR_NODE} ${room}/page/build.mjs ${RIGOR_PAGE_MODULES} ${play_build}/wasm ${CMAKE_CURRENT_SOURCE_DIR}/suite ${RIGOR_PLAY_PAGE}
    ${engines} ${RIGOR_PLAY_ENGINES}
  DEPENDS ${play_build}/wasm/rigor_play.wasm ${page_build}/installed ${engines}/installed ${play_sources}
  COMMENT "Bundling the laboratory's page" VERBATIM)
add_custom_target(play DEPENDS ${RIGOR_PLAY_PAGE})
