# ODE and Bullet from the sources that Debian's packages are made of, with the options of these packages: double
# precision, and ODE with libccd. Sets engine_sources, engine_libraries and scheme_rows. Without the sources the table of engines has
# their schemes as methods of the core alone.
file(GLOB ODE ${FETCHED}/ode/ode-*)
file(GLOB BULLET ${FETCHED}/bullet/bullet3-*/src)
set(engine_libraries "")
set(scheme_rows "")
if(NOT ODE OR NOT BULLET)
  set(engine_sources adapters/ode/ode_twin.cpp adapters/ode/ode_twin_joints.cpp adapters/bullet/bullet_twin.cpp
    adapters/bullet/bullet_twin_joints.cpp adapters/bullet/bullet_twin_rows.cpp)
  set(scheme_rows ${root}/cases/laboratory/wasm/scheme_rows.cpp)
  return()
endif()

set(engine_sources adapters/ode adapters/bullet)
foreach(option BUILD_SHARED_LIBS ODE_WITH_DEMOS ODE_WITH_TESTS ODE_WITH_OU)
  set(${option} OFF CACHE BOOL "" FORCE)
endforeach()
foreach(option ODE_DOUBLE_PRECISION ODE_WITH_LIBCCD ODE_NO_BUILTIN_THREADING_IMPL)
  set(${option} ON CACHE BOOL "" FORCE)
endforeach()
add_subdirectory(${ODE} ode EXCLUDE_FROM_ALL)
# It knows no WebAssembly, and its stopwatch, which nothing calls, is written for the processor.
get_target_property(files ODE SOURCES)
list(FILTER files EXCLUDE REGEX "/timer\\.cpp$")
set_target_properties(ODE PROPERTIES SOURCES "${files}")
target_compile_options(ODE PRIVATE -w -D__linux__)

add_library(bullet STATIC ${BULLET}/btLinearMathAll.cpp ${BULLET}/btBulletCollisionAll.cpp ${BULLET}/btBulletDynamicsAll.cpp)
target_include_directories(bullet SYSTEM PUBLIC ${BULLET})
target_compile_definitions(bullet PUBLIC BT_USE_DOUBLE_PRECISION)
target_compile_options(bullet PRIVATE -w)
set(engine_libraries ODE bullet)
