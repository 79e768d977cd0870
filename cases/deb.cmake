# cpack reads this before it packs. Without these two tools it would fail with messages of its own, or make a package
# without dependencies.
foreach(program_of file:file dpkg-shlibdeps:dpkg-dev)
  string(REPLACE ":" ";" pair ${program_of})
  list(GET pair 0 program)
  list(GET pair 1 package)
  find_program(found_${package} ${program})
  if(NOT found_${package})
    message(FATAL_ERROR "a package's dependencies are found by ${program}, which is not here; install ${package}, or make the package by `cases/setup release deb`")
  endif()
endforeach()
