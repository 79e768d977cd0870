# What is installed works from wherever it is put: the program finds its files, and another project finds the core. The
# package for Debian asks for the libraries that the program is linked to.
# cmake -DBUILD=... -DFOLDER=... -DCOMPILER=... -P package_test.cmake
cmake_minimum_required(VERSION 3.25)

function(run out)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE said ERROR_VARIABLE why RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${code}\n${said}\n${why}")
  endif()
  set(${out} "${said}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${FOLDER})
run(said ${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/first)
file(RENAME ${FOLDER}/first ${FOLDER}/moved)
set(ENV{RIGOR_HOME} "")
set(rigor ${FOLDER}/moved/bin/rigor)

run(said ${rigor} list cases)
if(NOT said MATCHES "springs/fixed-spring")
  message(FATAL_ERROR "the suite is not found beside the program:\n${said}")
endif()
foreach(file bin/rigor share/man/man1/rigor.1 share/bash-completion/completions/rigor share/zsh/vendor-completions/_rigor
    include/rigor_engine.h share/rigor/scene.schema.json share/rigor/adapters/ode/known_deviations.toml)
  if(NOT EXISTS ${FOLDER}/moved/${file})
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()

# Only public headers are installed. The example below shows that they are complete.
foreach(header core/dynamics core/core_methods.h core/scene/toml core/base/thread_pool.h)
  if(EXISTS ${FOLDER}/moved/include/rigor/${header})
    message(FATAL_ERROR "the internal ${header} is installed")
  endif()
endforeach()

run(said ${CMAKE_COMMAND} -G Ninja -S ${FOLDER}/moved/share/rigor/examples/embedding -B ${FOLDER}/build -DCMAKE_PREFIX_PATH=${FOLDER}/moved
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Debug)
run(said ${CMAKE_COMMAND} --build ${FOLDER}/build)
# A stone that is thrown: x = 1 m after 1 s, y = -5 m.
file(WRITE ${FOLDER}/thrown.toml "[scene]\ngravity = [0, -10, 0]\n[[scene.body]]\nname = \"stone\"\nmass = 2\ninertia = [1, 1, 1]\nvelocity = [1, 0, 0]\n")
run(said ${FOLDER}/build/embedding ${FOLDER}/thrown.toml)
if(NOT said MATCHES "^1.000000 -5.000000 0.000000\n")
  message(FATAL_ERROR "the embedded core says: ${said}")
endif()

get_filename_component(tools ${CMAKE_COMMAND} DIRECTORY)
run(said ${tools}/cpack --config ${BUILD}/CPackConfig.cmake -B ${FOLDER}/deb)
file(GLOB package ${FOLDER}/deb/*.deb)
run(depends dpkg-deb --field ${package} Depends)
foreach(library libode8 libbullet libfmt9 libtinyxml2)
  if(NOT depends MATCHES ${library})
    message(FATAL_ERROR "the package does not depend on ${library}: ${depends}")
  endif()
endforeach()
run(said dpkg-deb --extract ${package} ${FOLDER}/unpacked)
run(said ${FOLDER}/unpacked/usr/bin/rigor list cases)
