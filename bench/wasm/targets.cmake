# The target bench-wasm: the core as WebAssembly with and without vector instructions, and the engines of the npm registry
# beside it, in build/PRESET/bench-wasm. No other target needs it.
if(NOT RIGOR_HTML_REPORT OR NOT RIGOR_EMCC OR NOT EXISTS ${emscripten})
  add_custom_target(bench-wasm COMMAND ${CMAKE_COMMAND} -E echo "bench/run --wasm needs emscripten and npm: cases/setup release bench-wasm"
    COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
  return()
endif()

set(wasm_room ${CMAKE_CURRENT_LIST_DIR})
set(wasm_build ${PROJECT_BINARY_DIR}/bench-wasm)
set(npm_engines ${PROJECT_SOURCE_DIR}/adapters/plugin/examples/npm)
file(GLOB_RECURSE wasm_core CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/core/*.cpp ${PROJECT_SOURCE_DIR}/core/*.h)
set(wasm_cores "")
foreach(simd ON OFF)
  set(folder ${wasm_build}/core-simd-${simd})
  add_custom_command(OUTPUT ${folder}/rigor_core.wasm
    COMMAND ${CMAKE_COMMAND} -S ${wasm_room} -B ${folder} -G ${CMAKE_GENERATOR} -DCMAKE_TOOLCHAIN_FILE=${emscripten}
      -DCMAKE_BUILD_TYPE=None -DHEADERS=${PROJECT_BINARY_DIR}/play-build/headers -DVERSION=${PROJECT_VERSION} -DSIMD=${simd}
      -DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${CMAKE_COMMAND} --build ${folder}
    DEPENDS ${wasm_core} ${wasm_room}/entry.cpp ${wasm_room}/CMakeLists.txt
    COMMENT "Compiling the core for WebAssembly, SIMD ${simd}" VERBATIM)
  list(APPEND wasm_cores ${folder}/rigor_core.wasm)
endforeach()
file(GLOB wasm_scripts CONFIGURE_DEPENDS ${wasm_room}/*.mjs ${npm_engines}/*.mjs ${npm_engines}/package*.json)
rigor_npm(${wasm_build}/engines "engines of the npm registry for bench/run --wasm" ${wasm_scripts})
# Rapier's build with vector instructions, by the same plug-in.
set(rapier_simd ${wasm_build}/engines/rapier-simd)
file(GLOB rapier_files CONFIGURE_DEPENDS ${wasm_room}/rapier-simd/package*.json)
rigor_npm(${rapier_simd} "Rapier with vector instructions for bench/run --wasm" ${rapier_files} ${npm_engines}/rapier.mjs
  ${npm_engines}/serve.mjs)
add_custom_target(bench-wasm DEPENDS ${wasm_cores} ${wasm_build}/engines/installed ${rapier_simd}/installed)
